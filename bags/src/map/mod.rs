//! Topic maps: which field of which topic, or which column of which table, is which signal.
//!
//! ```
//! use excavator_bags::map::TopicMap;
//!
//! let map: TopicMap = r#"
//!     [clock]
//!     topic = "/joint_states"
//!
//!     [[signals]]
//!     signal = "arm.displacement"
//!     topic = "/joint_states"
//!     field = "position[name=arm_cylinder]"
//!     unit = "mm"
//!     offset = "-350 mm"
//!
//!     [[signals]]
//!     signal = "arm.cap_pressure"
//!     topic = "/pressures"
//!     field = "data[3]"
//!     unit = "V"
//!     scale = "25 bar/V"
//!     resample = "hold"
//! "#
//! .parse()?;
//! assert_eq!(map.signals.len(), 2);
//! # Ok::<(), excavator_bags::map::MapError>(())
//! ```

mod assemble;
mod channels;
mod clock_source;
mod conversion;
mod day_serial;
mod document;
mod error;
mod fault_code;
mod guess;
mod join;
mod joined;
mod least_delays;
mod leave_out;
mod mapped_topic;
mod message_times;
mod messages;
mod named;
mod one_clock;
mod opera;
mod pieces;
mod quantity;
mod read_bag;
mod read_mapped;
mod read_table;
mod resample;
mod signal;
mod signal_source;
mod sparse;
mod spike_line;
mod table_clock;
mod track;
mod traps;
mod unit;
mod unit_words;
mod wanted;

pub use clock_source::{ClockSource, ColumnName, Stamp};
pub use conversion::Conversion;
pub use document::TopicMap;
pub use error::MapError;
pub(crate) use guess::clock_of_table;
pub use guess::{
    Confidence, Guess, GuessedSignal, Hints, NO_COLUMNS, Possibility, SheetColumn, TimedColumn, ZeroAt, guess,
    timed_columns,
};
pub use join::Join;
pub use leave_out::LeaveOut;
pub use named::NamedColumn;
pub use opera::OPERA;
pub use pieces::read_pieces;
pub use quantity::Quantity;
pub use read_mapped::{Origin, read_mapped, read_recording_or_mapped, read_signals};
pub use signal::{SignalKind, SignalName};
pub use signal_source::{Resampling, SignalSource};
pub use spike_line::spike_line;
pub use unit::{Dimension, Unit};

/// Whether a key of a map file can be left out.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
