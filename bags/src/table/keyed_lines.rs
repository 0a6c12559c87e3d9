//! Lines before the numbers that say by a key what they are: `Unit;mm;bar`, or `Name;Position;Name;Pressure` where each channel has its
//! own times.

use super::heading;
use crate::map::{Dimension, Unit};

/// Keys of a line of units, in lower case.
const UNIT_KEYS: [&str; 12] = [
    "unit",
    "units",
    "y_unit_label",
    "vunit",
    "yunit",
    "y unit label",
    "einheit",
    "einheiten",
    "eng. unit",
    "engineering unit",
    "unité",
    "physical unit",
];
/// Keys of a line of names, the better first.
const NAME_KEYS: [&str; 14] = [
    "name",
    "names",
    "channel name",
    "tracename",
    "trace name",
    "channel names",
    "channelname",
    "signal name",
    "signal",
    "channel",
    "kanalname",
    "kanal",
    "signalname",
    "symbolname",
];

/// Whether a cell is the key of a line of units.
pub(super) fn is_unit_key(cell: &str) -> bool {
    UNIT_KEYS.contains(&key(cell).as_str())
}

/// Whether a cell is the key of a line of names.
pub(super) fn is_name_key(cell: &str) -> bool {
    NAME_KEYS.contains(&key(cell).as_str())
}

fn key(cell: &str) -> String {
    cell.trim_end_matches([':', '=', ' ']).to_lowercase()
}

/// The channels of a table in which each has a column of times before that of its values.
#[derive(Debug, PartialEq)]
pub(super) struct Channels {
    pub names: Vec<String>,
    pub units: Vec<Option<String>>,
    /// Unit of the times, if a line gives it.
    pub time_unit: Option<String>,
}

/// The channels that these lines describe, in a table of `width` columns. Every other cell of such a line is its key.
pub(super) fn channels<'r>(rows: impl Iterator<Item = &'r [String]>, width: usize) -> Option<Channels> {
    if width < 2 || !width.is_multiple_of(2) {
        return None;
    }
    let keyed: Vec<&[String]> = rows.filter(|row| is_keyed(row, width)).collect();
    let values = |row: &[String]| -> Vec<String> { row.iter().skip(1).step_by(2).cloned().collect() };
    let names = NAME_KEYS.iter().find_map(|name| keyed.iter().find(|row| key(&row[0]) == *name))?;
    let units = keyed.iter().find(|row| is_unit_key(&row[0]));
    // One channel alone looks like a line with a name and a value.
    if width == 2 && units.is_none() {
        return None;
    }
    let of_time = |row: &&[String]| heading::split(&row[0]).1.and_then(|unit| Unit::named(&unit));
    let time_unit = keyed.iter().filter_map(of_time).find(|unit| unit.dimension == Dimension::Time);
    let units = units.map_or(vec![None; width / 2], |row| values(row).into_iter().map(Some).collect());
    Some(Channels { names: values(names), units, time_unit: time_unit.map(|unit| unit.name.to_string()) })
}

fn is_keyed(row: &[String], width: usize) -> bool {
    row.len() == width && !row[0].is_empty() && row.iter().step_by(2).all(|cell| *cell == row[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_channel_has_name_and_unit() {
        let rows: Vec<Vec<String>> =
            ["Name;Position;Name;Pressure", "Unit;mm;Unit;bar", "SampleTime[ms];2;SampleTime[ms];2"]
                .iter()
                .map(|line| line.split(';').map(str::to_string).collect())
                .collect();
        let found = channels(rows.iter().map(Vec::as_slice), 4);
        let wanted = Channels {
            names: vec!["Position".to_string(), "Pressure".to_string()],
            units: vec![Some("mm".to_string()), Some("bar".to_string())],
            time_unit: Some("ms".to_string()),
        };
        assert_eq!(found, Some(wanted));
        assert_eq!(channels(rows.iter().map(Vec::as_slice), 6), None);
        assert_eq!(channels(rows[1..].iter().map(Vec::as_slice), 4), None);
        assert!(
            is_unit_key("Y_Unit_Label") && is_unit_key("Units:") && !is_unit_key("mm") && is_name_key("Channel name:")
        );
    }
}
