//! Models as text (TOML): every number with its unit and its source.
//!
//! The text is what is read from and written to model files; reading and writing files is left to the caller.

mod built_in;
mod catalogue_text;
mod cylinder_text;
mod fault;
mod machine_text;
mod model_text;
mod quantity;
mod reference;
mod schema;

pub use built_in::{BUILT_IN, built_in};
pub use catalogue_text::{catalogue_text, parse_catalogue};
pub use fault::{TomlFault, toml_fault};
pub use model_text::{parse, to_text};
pub use reference::reference;
pub use schema::schema;

/// What can be wrong with a model text.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DocumentError {
    /// Not TOML, or not of a model's form.
    #[error("{name} is not a model file: {reason}")]
    Syntax {
        /// File or built-in name.
        name: String,
        /// What the reader says, in one line.
        reason: String,
        /// The faulty line and a mark under it; empty where there is none.
        excerpt: String,
    },
    /// Not TOML, or not of a catalogue's form.
    #[error("{name} is not a catalogue file: {reason}")]
    Catalogue {
        /// File name.
        name: String,
        /// What the reader says, in one line.
        reason: String,
        /// The faulty line and a mark under it; empty where there is none.
        excerpt: String,
    },
    /// A number has another unit than it must have.
    #[error("{name}: {quantity} is given in \"{found}\", but must be in \"{expected}\"")]
    WrongUnit {
        /// File or built-in name.
        name: String,
        /// Which number.
        quantity: String,
        /// Unit in the text.
        found: String,
        /// Unit that it must have.
        expected: String,
    },
    /// A number is impossible.
    #[error("{name}: {quantity} = {value} is impossible; it must be {must}")]
    Impossible {
        /// File or built-in name.
        name: String,
        /// Which number.
        quantity: String,
        /// Its value.
        value: f64,
        /// What it must be.
        must: String,
    },
    /// A parameter of an effect is missing or unknown.
    #[error("{name}: effect {effect} {problem}")]
    Parameter {
        /// File or built-in name.
        name: String,
        /// Which effect.
        effect: String,
        /// What is wrong.
        problem: String,
    },
    /// The machine or its effects do not fit together.
    #[error("{name}: {reason}")]
    Inconsistent {
        /// File or built-in name.
        name: String,
        /// Why.
        reason: String,
    },
    /// Neither a file nor a built-in model.
    #[error("unknown model \"{name}\"{suggestion}; built in are {}, or give a model file (.toml)", BUILT_IN_NAMES)]
    Unknown {
        /// What was asked for.
        name: String,
        /// "(did you mean ...?)" or nothing.
        suggestion: String,
    },
}

const BUILT_IN_NAMES: &str = "zx30u-arm, zx30u, zx30u-bucket, zx30u-excavator, servo-bench, emps";

impl DocumentError {
    /// The faulty line of the text with a mark at the place; empty where there is none. It is for the person whose file it is.
    pub fn excerpt(&self) -> &str {
        match self {
            DocumentError::Syntax { excerpt, .. } | DocumentError::Catalogue { excerpt, .. } => excerpt,
            _ => "",
        }
    }
}
