//! Definitions of types from bags, from `.msg` files, and the built-in ones.

use std::collections::HashMap;
use std::path::Path;
use std::sync::LazyLock;

use super::common_interfaces;
use super::defined_member::DefinedMember;
use super::error::LayoutError;
use super::fields::short_name;
use super::{ros2idl, ros2msg};
use crate::Error;
use crate::limits::{Limit, ReadLimits};
use crate::regular_file::read_regular_text;

/// Types by their short names, `package/Type`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Definitions {
    types: HashMap<String, Vec<DefinedMember>>,
}

impl Definitions {
    /// The types in the schema of a topic: `ros2msg` or `ros2idl`. Empty for an empty schema or another language, since
    /// the type may be defined elsewhere.
    ///
    /// # Errors
    /// [`LayoutError::Syntax`], [`LayoutError::Limit`].
    pub fn from_schema(type_name: &str, encoding: &str, schema: &str) -> Result<Definitions, LayoutError> {
        if schema.trim().is_empty() {
            return Ok(Definitions::default());
        }
        // The parsers use up to fifty times the size of the text in memory.
        Limit::Definition.check(schema.len() as u64, ReadLimits::DEFAULT.definition)?;
        let types = match encoding {
            "ros2msg" => ros2msg::parse(type_name, schema)?,
            "ros2idl" => ros2idl::parse(schema)?,
            _ => HashMap::new(),
        };
        Ok(Definitions { types })
    }

    /// The built-in common interfaces.
    pub(super) fn common() -> &'static Definitions {
        static COMMON: LazyLock<Definitions> = LazyLock::new(Definitions::read_common);
        &COMMON
    }

    fn read_common() -> Definitions {
        let mut definitions = Definitions::default();
        for (name, text) in common_interfaces::TEXTS {
            // The texts are built in: a test parses every one.
            definitions.types.extend(ros2msg::parse(name, text).unwrap_or_default());
        }
        definitions
    }

    /// Adds the type `type_name` (`package/Type` or `package/msg/Type`) from the text of its `.msg` file. The
    /// definitions of contained types may follow, as in a bag. A known type gets the new definition.
    ///
    /// # Errors
    /// [`LayoutError::Syntax`].
    pub fn add(&mut self, type_name: &str, text: &str) -> Result<(), LayoutError> {
        self.types.extend(ros2msg::parse(type_name, text)?);
        Ok(())
    }

    /// Adds the type in a `.msg` file. Its package is the folder above `msg/`, otherwise the folder of the file.
    ///
    /// # Errors
    /// [`Error::NotARegularFile`], [`Error::Limit`], [`Error::Io`], [`Error::BadDefinition`].
    pub fn add_file(&mut self, path: &Path) -> Result<(), Error> {
        let text = read_regular_text(path, ReadLimits::DEFAULT.definition)?;
        let name_of = |part: Option<&std::ffi::OsStr>| part.map(|name| name.to_string_lossy().into_owned());
        let folders: Vec<String> = path.ancestors().skip(1).take(2).filter_map(|f| name_of(f.file_name())).collect();
        let package = match folders.as_slice() {
            [first, second] if first == "msg" => second.as_str(),
            [first, ..] => first.as_str(),
            [] => "",
        };
        let name = format!("{package}/{}", name_of(path.file_stem()).unwrap_or_default());
        let types = ros2msg::parse(&name, &text)
            .map_err(|source| Error::BadDefinition { place: path.display().to_string(), source })?;
        self.types.extend(types);
        Ok(())
    }

    pub(super) fn members(&self, type_name: &str) -> Option<&[DefinedMember]> {
        self.types.get(&short_name(type_name)).map(Vec::as_slice)
    }
}
