//! A member of a type, as its definition has it.

/// How many elements a member has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Count {
    /// A single value.
    One,
    /// An array of fixed length.
    Fixed(usize),
    /// A sequence whose length is in the message.
    Sequence,
}

/// One member of a definition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct DefinedMember {
    pub name: String,
    /// A primitive by its `ros2msg` name, or `package/Type`.
    pub type_name: String,
    pub count: Count,
}
