//! The order and types of the bytes of a message.

use std::collections::HashMap;

use super::defined_member::Count;
use super::definitions::Definitions;
use super::error::LayoutError;
use super::fields::short_name;
use crate::{ReadLimits, Topic};

/// Maximum nesting of types; message readers recurse to the same depth.
const DEPTH_LIMIT: usize = ReadLimits::DEFAULT.nesting;
/// Maximum number of fields, including those of all contained types.
const FIELD_LIMIT: usize = ReadLimits::DEFAULT.fields;

/// The types that are a single number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Primitive {
    Bool,
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Primitive {
    /// Size of one value, and its alignment, bytes.
    pub fn size(self) -> usize {
        match self {
            Primitive::Bool | Primitive::I8 | Primitive::U8 => 1,
            Primitive::I16 | Primitive::U16 => 2,
            Primitive::I32 | Primitive::U32 | Primitive::F32 => 4,
            Primitive::I64 | Primitive::U64 | Primitive::F64 => 8,
        }
    }
}

/// The kind of one element of a member.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Primitive(Primitive),
    /// Text.
    Text,
    /// Another struct of the layout, by its index.
    Struct(usize),
    /// A type that writers encode differently (`wstring`, `long double`): nothing after it can be read.
    Unreadable(String),
}

/// One member of a struct.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member {
    /// Name of the field.
    pub name: String,
    /// Kind of one element.
    pub kind: Kind,
    /// Number of elements.
    pub count: Count,
}

/// The members of one type in serialization order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StructLayout {
    /// `package/Type`.
    pub name: String,
    /// In order.
    pub members: Vec<Member>,
}

/// The layout of a message: its type and all types that it contains.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    structs: Vec<StructLayout>,
}

impl Layout {
    /// The layout of a topic's messages. Sources in order: the definition in the bag, the given definitions, the
    /// built-in common interfaces.
    ///
    /// # Errors
    /// [`LayoutError`].
    pub fn of_topic(topic: &Topic, extra: &Definitions) -> Result<Layout, LayoutError> {
        let own = Definitions::from_schema(&topic.type_name, &topic.schema_encoding, &topic.schema)?;
        Layout::build(&topic.type_name, &[&own, extra])
    }

    /// The layout of a type. For each contained type, the first source that defines it is used; the built-in common
    /// interfaces come last.
    ///
    /// # Errors
    /// [`LayoutError`].
    pub fn build(type_name: &str, sources: &[&Definitions]) -> Result<Layout, LayoutError> {
        let common = Definitions::common();
        let sources: Vec<&Definitions> = sources.iter().copied().chain([common]).collect();
        let mut builder = Builder { sources, structs: Vec::new(), known: HashMap::new(), fields: 0 };
        builder.add(&short_name(type_name), "", 0)?;
        Ok(Layout { structs: builder.structs })
    }

    /// The struct with this index; 0 is the message itself. `None` for an index that no [`Kind::Struct`] has.
    pub fn structure(&self, number: usize) -> Option<&StructLayout> {
        self.structs.get(number)
    }
}

struct Builder<'s> {
    sources: Vec<&'s Definitions>,
    structs: Vec<StructLayout>,
    /// Index and nesting height of each finished struct.
    known: HashMap<String, (usize, usize)>,
    fields: usize,
}

impl Builder<'_> {
    /// Adds a type at nesting depth `depth`. Returns its index and its own nesting height.
    fn add(&mut self, type_name: &str, parent: &str, depth: usize) -> Result<(usize, usize), LayoutError> {
        check_depth(type_name, depth)?;
        let Some(members) = self.sources.iter().find_map(|source| source.members(type_name)) else {
            return Err(LayoutError::UnknownType { type_name: type_name.to_string(), parent: parent.to_string() });
        };
        self.fields += members.len();
        if self.fields > FIELD_LIMIT {
            return Err(LayoutError::TooLarge { type_name: type_name.to_string(), limit: FIELD_LIMIT });
        }
        // Its index is assigned before those of its members: the message itself is 0.
        let number = self.structs.len();
        self.structs.push(StructLayout { name: type_name.to_string(), members: Vec::new() });
        let members = members.to_vec();
        let mut laid_out = Vec::with_capacity(members.len());
        let mut height = 0;
        for member in members {
            let kind = match primitive(&member.type_name) {
                Some(kind) => kind,
                None => {
                    let (number, below) = match self.known.get(&member.type_name) {
                        Some(&known) => known,
                        None => self.add(&member.type_name, type_name, depth + 1)?,
                    };
                    // A known type passed the depth check where it was first used; here it may be too deep.
                    check_depth(&member.type_name, depth + 1 + below)?;
                    height = height.max(below + 1);
                    Kind::Struct(number)
                }
            };
            laid_out.push(Member { name: member.name, kind, count: member.count });
        }
        self.structs[number].members = laid_out;
        // Registered only now: a type that contains itself is not known yet, so it nests until the depth limit.
        self.known.insert(type_name.to_string(), (number, height));
        Ok((number, height))
    }
}

fn check_depth(type_name: &str, depth: usize) -> Result<(), LayoutError> {
    if depth > DEPTH_LIMIT {
        return Err(LayoutError::TooDeep { type_name: type_name.to_string(), limit: DEPTH_LIMIT });
    }
    Ok(())
}

/// The primitive with this `ros2msg` name; `None` for the name of a struct.
fn primitive(type_name: &str) -> Option<Kind> {
    Some(Kind::Primitive(match type_name {
        "bool" => Primitive::Bool,
        "int8" => Primitive::I8,
        "uint8" | "byte" | "char" => Primitive::U8,
        "int16" => Primitive::I16,
        "uint16" => Primitive::U16,
        "int32" => Primitive::I32,
        "uint32" => Primitive::U32,
        "int64" => Primitive::I64,
        "uint64" => Primitive::U64,
        "float32" => Primitive::F32,
        "float64" => Primitive::F64,
        "string" => return Some(Kind::Text),
        "wstring" | "wchar" | "long double" => return Some(Kind::Unreadable(type_name.to_string())),
        _ => return None,
    }))
}
