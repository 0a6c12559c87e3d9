//! Reads messages of any type by the definition in the bag: one number of one field at a time, without building the
//! message in memory.

mod common_interfaces;
mod cursor;
mod defined_member;
mod definitions;
mod error;
mod field_path;
mod fields;
mod layout;
mod leaves;
mod ros2idl;
mod ros2msg;
mod selector;

pub use defined_member::Count;
pub use definitions::Definitions;
pub use error::{LayoutError, PathError};
pub use field_path::{FieldPath, Index, Step};
pub use layout::{Kind, Layout, Member, Primitive, StructLayout};
pub use leaves::numeric_leaves;
pub use selector::Selector;
