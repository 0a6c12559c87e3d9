//! Text as a topic map: to text and back, and used on a table and on a bag.

use excavator_bags::map::{TopicMap, read_mapped};

use crate::samples;

/// # Panics
/// When a map changes on the way, or gives a recording that breaks its promises.
#[allow(clippy::panic)]
pub fn run(bytes: &[u8]) -> bool {
    let Ok(map) = String::from_utf8_lossy(bytes).parse::<TopicMap>() else { return false };
    let text = map.to_text().unwrap_or_default();
    match text.parse::<TopicMap>() {
        Ok(again) if again == map => {}
        other => panic!("{map:?} became {other:?} through\n{text}"),
    }
    for data in ["bags/samples/parquet/none.parquet", "bags/samples/joint-states"] {
        if let Ok((recording, _)) = read_mapped(&samples::path(data), &map)
            && let Err(error) = recording.validate()
        {
            panic!("{data}: {error}");
        }
    }
    true
}

pub fn seeds() -> Vec<Vec<u8>> {
    let names = [
        "bags/samples/arm-swing.csv.map.toml",
        "bags/samples/joint-states/map.toml",
        "bags/samples/seal-friction/map.toml",
        "config/maps/emps.toml",
        "config/maps/seal-friction.toml",
        "config/maps/sjoberg-actuator.toml",
    ];
    let mut seeds = names.map(samples::bytes).to_vec();
    seeds.push(COMPUTED.as_bytes().to_vec());
    seeds
}

/// Names, a formula, and a table beside the data.
const COMPUTED: &str = r#"
[names]
p_hi = "p_A [bar]"
s = { column = 2, unit = "mm", maximum_gap = 0.1 }

[[join]]
file = "snappy.parquet"
offset = 0.004
clock.column = 1

[[signals]]
signal = "arm.cap_pressure"
formula = "if(p_hi > 0, (p_hi - p_B) * 1e5, 0) + 0*rate(s)"

[[signals]]
signal = "arm.displacement"
column = "Weg"
file = "snappy.parquet"
resample = "hold"
"#;
