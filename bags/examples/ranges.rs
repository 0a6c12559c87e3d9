//! Ranges of the signals of a recording: `cargo run -p excavator-bags --example ranges -- [DATA]`.
//!
//! DATA is a bag of `arm/state`, or any bag or table with a map beside it; without, a sample of the repository is read.

use std::error::Error;
use std::path::PathBuf;

use excavator_bags::map::{Dimension, SignalName};
use excavator_bags::prelude::*;
use rosbag2::printable;

/// Four seconds of an arm.
const SAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/samples/arm-swing");

fn main() -> Result<(), Box<dyn Error>> {
    let data = std::env::args_os().nth(1).map_or_else(|| PathBuf::from(SAMPLE), PathBuf::from);
    let (recording, report) = read_recording_or_mapped(&data, Origin::default())?;
    println!("{} samples in {:.2} s", recording.len(), recording.duration());
    for signal in SignalsInfo::of(&recording).measured {
        let name: SignalName = signal.name.parse()?;
        let unit = unit_for_people(name.kind.dimension());
        let (least, most) = (signal.least / unit.factor(), signal.most / unit.factor());
        println!("{:24} {least:10.3} to {most:10.3} {}", printable(&signal.name), unit.name);
    }
    for problem in report.problems() {
        eprintln!("{problem}");
    }
    Ok(())
}

/// The unit of data sheets and gauges.
fn unit_for_people(dimension: Dimension) -> Unit {
    let name = match dimension {
        Dimension::Length => "mm",
        Dimension::Angle => "deg",
        Dimension::Velocity => "mm/s",
        Dimension::Pressure => "MPa",
        Dimension::Force => "kN",
        Dimension::Flow => "l/min",
        Dimension::Area => "mm2",
        other => other.si_unit(),
    };
    Unit::named(name).unwrap_or(Unit::si(dimension))
}
