//! A built-in model beside a recording: `cargo run -p excavator-study --example compare -- [DATA]`.
//!
//! DATA is a bag or table, also a part of one (`BAG@1..3`, s); without, a sample of the repository is read. What a person should
//! know goes to standard error, the result as JSON to standard output.

use std::error::Error;
use std::path::PathBuf;

use excavator_bags::prelude::*;
use excavator_model::document::built_in;
use excavator_study::prelude::*;

/// Four seconds of an arm.
const SAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../bags/samples/arm-swing");

fn main() -> Result<(), Box<dyn Error>> {
    let data = std::env::args_os().nth(1).map_or_else(|| PathBuf::from(SAMPLE), PathBuf::from);
    let model = built_in("zx30u-arm")?;
    let (path, part) = Part::split(&data)?;
    let (mut recording, report) = read_recording_or_mapped(&path, Origin::default())?;
    if let Some(part) = part {
        recording = part.of(&recording, &data)?;
    }
    let mut remarks = report.problems();
    let usage = Use::default();
    let recording = checked("recording", recording, &report, &usage, &model, &mut remarks)?;
    let compared = Study::of_recording(model, recording).compare(None, None)?;
    remarks.push(compared.sentence());
    eprintln!("{}", remarks.join("\n"));
    print!("{}", compared.json()?);
    Ok(())
}
