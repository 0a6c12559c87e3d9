//! Bytes as tables, gone through as a user goes: read, a map guessed, the recording read through it.

use std::io::{Cursor, Read, Write};

use excavator_bags::map::{TopicMap, guess, read_mapped};
use excavator_bags::table::{Table, TableFormat};

use crate::samples;

pub fn text(bytes: &[u8]) -> bool {
    through(bytes, ".csv")
}

pub fn matlab(bytes: &[u8]) -> bool {
    through(bytes, ".mat")
}

pub fn parquet(bytes: &[u8]) -> bool {
    through(bytes, ".parquet")
}

/// The XML of a sheet, in a workbook that is well packed: checksums would stop most changes before anything reads them.
pub fn sheet(bytes: &[u8]) -> bool {
    workbook(bytes).is_some_and(|bytes| through(&bytes, ".xlsx"))
}

fn workbook(sheet: &[u8]) -> Option<Vec<u8>> {
    const SHEET: &str = "xl/worksheets/sheet1.xml";
    let whole = samples::bytes("bags/samples/xlsx/arm-swing.xlsx");
    let mut from = zip::ZipArchive::new(Cursor::new(whole)).ok()?;
    let mut to = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for number in 0..from.len() {
        let part = from.by_index_raw(number).ok()?;
        if part.name().ok()? != SHEET {
            to.raw_copy_file(part).ok()?;
        }
    }
    to.start_file(SHEET, zip::write::SimpleFileOptions::default()).ok()?;
    to.write_all(sheet).ok()?;
    Some(to.finish().ok()?.into_inner())
}

pub fn sheet_seeds() -> Vec<Vec<u8>> {
    let whole = samples::bytes("bags/samples/xlsx/arm-swing.xlsx");
    let sheet = |name: &str| {
        let mut bytes = Vec::new();
        zip::ZipArchive::new(Cursor::new(&whole)).ok()?.by_name(name).ok()?.read_to_end(&mut bytes).ok()?;
        Some(bytes)
    };
    ["xl/worksheets/sheet1.xml", "xl/worksheets/sheet3.xml"].iter().filter_map(|name| sheet(name)).collect()
}

/// # Panics
/// When a guess is no map, a recording breaks its promises, or an error takes more than a line.
#[allow(clippy::panic)]
fn through(bytes: &[u8], ending: &str) -> bool {
    let Ok(mut file) = tempfile::Builder::new().suffix(ending).tempfile() else { return false };
    if file.write_all(bytes).is_err() {
        return false;
    }
    match Table::read(file.path(), &TableFormat::default()) {
        Err(error) => {
            let text = error.to_string();
            assert_eq!(text.lines().count(), 1, "{text}");
            return false;
        }
        Ok(table) => assert!(table.columns.iter().all(|column| !column.name.is_empty()), "a column without name"),
    }
    let Ok(guessed) = guess(file.path(), "arm") else { return false };
    let Ok(text) = guessed.to_text() else { return true };
    match text.parse::<TopicMap>() {
        Ok(map) => {
            if let Ok((recording, _)) = read_mapped(file.path(), &map)
                && let Err(error) = recording.validate()
            {
                panic!("{error} through\n{text}");
            }
        }
        // A table without any sure signal is guessed as a map without any, which is none.
        Err(error) => assert!(guessed.map().signals.is_empty(), "{error} in\n{text}"),
    }
    true
}

pub fn text_seeds() -> Vec<Vec<u8>> {
    let names = ["bags/samples/arm-swing.csv", "bags/samples/seal-friction/O-ring_1bar.csv"];
    let mut seeds = names.map(|name| samples::lines(name, 1_500)).to_vec();
    seeds.push(b"Rig 3\nSampling rate: 500 Hz\nx;p;u\n25.1mm;1.2M;3 bar\n24.9mm;950k;4 bar\n".to_vec());
    seeds.push(b"time,x [mm],v [mm/s]\n2017-07-14T02:40:00.5Z,1,0\n2017-07-14 02:40:01.5,2,1\n".to_vec());
    seeds
}

pub fn matlab_seeds() -> Vec<Vec<u8>> {
    ["4", "6", "7"].map(|version| samples::bytes(&format!("bags/samples/matlab/version-{version}.mat"))).to_vec()
}

pub fn parquet_seeds() -> Vec<Vec<u8>> {
    let names = ["none", "snappy", "gzip", "lz4", "zstd", "pages-2", "kinds", "kinds"];
    names.map(|name| samples::bytes(&format!("bags/samples/parquet/{name}.parquet"))).to_vec()
}
