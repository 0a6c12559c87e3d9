//! Copies of a bag the wanted topics: `cargo run -p excavator-store --example thin -- [ADDRESS [FOLDER [TOPIC...]]]`.
//!
//! ADDRESS is a path or a URL (`file://`, `s3://`, `gs://`, `az://`); without, a sample of the repository is copied. A TOPIC that
//! begins with `*` means every topic that ends with the rest; without any, the states are wanted.

use std::error::Error;
use std::path::PathBuf;

use excavator_store::{Options, thin_copy};

/// Four seconds of an arm.
const SAMPLE: &str = concat!("file://", env!("CARGO_MANIFEST_DIR"), "/../bags/samples/arm-swing/arm-swing_0.mcap");

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let address = arguments.next().unwrap_or_else(|| SAMPLE.to_string());
    let folder = arguments.next().map_or_else(|| std::env::temp_dir().join("thin"), PathBuf::from);
    let mut topics: Vec<String> = arguments.collect();
    if topics.is_empty() {
        topics.push("*/state".to_string());
    }
    let copy = thin_copy(&address, Some(&topics), &folder, &Options::new())?;
    println!("{}: {} messages", copy.path.display(), copy.messages);
    println!("{} of {} bytes were read", copy.bytes_read, copy.bytes_total);
    for reason in &copy.whole {
        println!("copied whole: {reason}");
    }
    Ok(())
}
