//! What fuzz targets call, and a seeded test of the default run as well: each takes any bytes and must return.

use std::io::Write;

use crate::dynamic::{Definitions, Layout, Selector, numeric_leaves};
use crate::map::TopicMap;
use crate::table::{Table, TableFormat};
use crate::{Topics, cdr, info, read_recording};

/// Types that together have every kind of field.
const TYPES: [&str; 5] = [
    "excavator_msgs/ArmState",
    "sensor_msgs/JointState",
    "std_msgs/Float64MultiArray",
    "diagnostic_msgs/DiagnosticArray",
    "sensor_msgs/BatteryState",
];

/// Bytes as messages of several types.
pub fn message(bytes: &[u8]) {
    for type_name in TYPES {
        let Ok(layout) = Layout::build(type_name, &[]) else { continue };
        let _ = layout.check(bytes);
        for path in numeric_leaves(&layout, bytes).unwrap_or_default() {
            if let Ok(selector) = Selector::number(&layout, &path) {
                let _ = selector.read(&layout, bytes);
            }
        }
    }
    let _ = cdr::decode::<excavator_msgs::ArmState>(bytes);
}

/// Bytes as text of a definition.
pub fn definition(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    for encoding in ["ros2msg", "ros2idl"] {
        if let Ok(definitions) = Definitions::from_schema("p/msg/Root", encoding, &text)
            && let Ok(layout) = Layout::build("p/Root", &[&definitions])
        {
            let _ = layout.check(&[[0, 1, 0, 0].as_slice(), bytes].concat());
        }
    }
}

/// Bytes as text of a map; one that is a map must survive the way to text and back.
///
/// # Panics
/// When it does not: that is what a fuzzer looks for.
#[allow(clippy::panic)]
pub fn map(bytes: &[u8]) {
    let Ok(map) = String::from_utf8_lossy(bytes).parse::<TopicMap>() else { return };
    let text = map.to_text().unwrap_or_default();
    match text.parse::<TopicMap>() {
        Ok(again) if again == map => {}
        other => panic!("{map:?} became {other:?} through\n{text}"),
    }
}

/// Bytes as a table.
pub fn table(bytes: &[u8]) {
    let _ = Table::from_text(bytes, &TableFormat::default());
    let _ = Table::from_mat(bytes);
}

/// Bytes as the file of a bag; what is read must keep the promises of a recording.
///
/// # Panics
/// When it does not: that is what a fuzzer looks for.
#[allow(clippy::panic)]
pub fn bag(bytes: &[u8]) {
    let Ok(mut file) = tempfile::NamedTempFile::new() else { return };
    if file.write_all(bytes).is_err() {
        return;
    }
    let _ = info(file.path());
    if let Ok((recording, _)) = read_recording(file.path(), &Topics::default())
        && let Err(error) = recording.validate()
    {
        panic!("{error}");
    }
}
