//! The items that most programs need: `use excavator_bags::prelude::*;`.

pub use crate::map::{Guess, Origin, TopicMap, Unit, guess, read_mapped, read_recording_or_mapped};
pub use crate::table::{Table, TableFormat};
pub use crate::{BagError, ReadReport, SignalsInfo, Topics, read_recording, read_recording_in_blocks, write_recording};
