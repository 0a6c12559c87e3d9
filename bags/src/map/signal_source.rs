//! Where one signal of a map comes from.

use std::path::PathBuf;

use rosbag2::dynamic::FieldPath;
use serde::{Deserialize, Serialize};

use super::clock_source::{ColumnName, Stamp};
use super::error::MapError;
use super::quantity::Quantity;
use super::signal::SignalName;

/// The value of a signal between the messages that carry it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Resampling {
    /// On the straight line between the message before and the one after.
    Linear,
    /// That of the message before.
    Hold,
}

/// Where one signal comes from, and how its numbers become SI values:
/// value = `sign` · `scale` · (number in `unit`, as SI) + `offset`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SignalSource {
    /// The signal: `arm.displacement`, `pump_pressure`.
    pub signal: SignalName,
    /// Bags: the topic.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub topic: Option<String>,
    /// Bags: the field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field: Option<FieldPath>,
    /// Topics of CAN frames: the message of the DBC file; `field` is a signal of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Tables: the column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<ColumnName>,
    /// The joined file that the column is in; without, the data themselves, else the joined file that has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// None of these: a formula over columns, names and other signals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// None of these: a known constant, in SI or with its unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<Quantity>,
    /// Unit of the numbers; SI when not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Factor; with its unit where `unit` measures something else than the signal (`"25 bar/V"`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<Quantity>,
    /// Added last; in the unit of the signal, not of the numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<Quantity>,
    /// -1 turns the direction around.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sign: Option<i8>,
    /// Bags: which time the message has.
    #[serde(default, skip_serializing_if = "super::is_default")]
    pub stamp: Stamp,
    /// Added to that time, s: negative for a sensor whose stamps are late.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_shift: Option<f64>,
    /// Between messages; without, `linear`, and `hold` for commands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resample: Option<Resampling>,
    /// Longest time over which a value is interpolated or held, s; beyond it the signal is not measured. Without, five
    /// median intervals of its own for `linear`, no limit for `hold`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum_gap: Option<f64>,
}

impl SignalSource {
    /// A signal of which only the name is known yet.
    pub fn new(signal: SignalName) -> SignalSource {
        SignalSource {
            signal,
            topic: None,
            field: None,
            message: None,
            column: None,
            file: None,
            formula: None,
            value: None,
            unit: None,
            scale: None,
            offset: None,
            sign: None,
            stamp: Stamp::Auto,
            time_shift: None,
            resample: None,
            maximum_gap: None,
        }
    }

    pub(super) fn check(&self) -> Result<(), MapError> {
        let signal = self.signal.to_string();
        let is_field = self.topic.is_some() && self.field.is_some();
        let sources = [is_field, self.column.is_some(), self.formula.is_some(), self.value.is_some()];
        let is_half_a_field = self.topic.is_some() != self.field.is_some();
        if is_half_a_field || sources.iter().filter(|given| **given).count() != 1 {
            return Err(MapError::NoSource { signal });
        }
        check_place(&signal, self.message.is_some() && !is_field, self.file.is_some() && self.column.is_none())?;
        check_times(&signal, self.maximum_gap, self.time_shift)
    }

    /// Whether the heading of a column or a DBC file may still say the unit.
    pub(super) fn may_learn_its_unit(&self) -> bool {
        (self.column.is_some() || self.message.is_some()) && self.unit.is_none()
    }
}

/// Rejects keys that specify details of a source that is not given.
pub(super) fn check_place(place: &str, message_of_nothing: bool, file_of_nothing: bool) -> Result<(), MapError> {
    for (wrong, key, wanted) in
        [(message_of_nothing, "message", "`topic` and `field`"), (file_of_nothing, "file", "`column`")]
    {
        if wrong {
            return Err(MapError::KeyWithout { place: place.to_string(), key, wanted });
        }
    }
    Ok(())
}

/// Rejects invalid times (s).
pub(super) fn check_times(place: &str, maximum_gap: Option<f64>, time_shift: Option<f64>) -> Result<(), MapError> {
    let bad = |key, found, wanted| MapError::BadNumber { place: place.to_string(), key, found, wanted };
    if let Some(gap) = maximum_gap.filter(|gap| !(gap.is_finite() && *gap > 0.0)) {
        return Err(bad("maximum_gap", gap, "positive"));
    }
    if let Some(shift) = time_shift.filter(|shift| shift.is_nan() || shift.abs() > 1e6) {
        return Err(bad("time_shift", shift, "under 1e6 s"));
    }
    Ok(())
}
