//! Parquet tables that pyarrow wrote (`samples/make_parquet.py`): the same as CSV, every type and codec, and one clear line
//! for what is broken.

use crate::support;
use std::path::{Path, PathBuf};

use crate::support::Numbers;
use excavator_bags::map::{Origin, guess, read_recording_or_mapped};
use excavator_bags::table::{Column, Table, TableFormat, Values, parse_date};

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("samples").join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(sample(name)).unwrap()
}

fn table(name: &str) -> Table {
    Table::read(&sample(name), &TableFormat::default()).unwrap()
}

fn column<'t>(table: &'t Table, name: &str) -> &'t Column {
    table.columns.iter().find(|column| column.name == name).unwrap()
}

/// Numbers of a column; dates as ns.
fn numbers(column: &Column) -> Vec<f64> {
    match &column.values {
        Values::Numbers(numbers) => numbers.clone(),
        Values::Stamps(stamps) => stamps.iter().map(|stamp| stamp.map_or(f64::NAN, |stamp| stamp as f64)).collect(),
    }
}

#[test]
fn a_parquet_table_is_the_recording_that_its_csv_is() {
    let map = sample("arm-swing.csv.map.toml");
    let (csv, _) = read_recording_or_mapped(&sample("arm-swing.csv"), Origin::default()).unwrap();
    let (parquet, report) =
        read_recording_or_mapped(&sample("parquet/arm-swing.parquet"), Origin { map: Some(&map), ..Origin::default() })
            .unwrap();
    assert_eq!(report.problems(), Vec::<String>::new());
    assert_eq!(parquet.len(), 501);
    support::assert_equal(&parquet, &csv);
}

#[test]
fn the_guess_is_that_of_the_csv() {
    let guessed = |name: &str| guess(&sample(name), "arm").unwrap();
    let (csv, parquet) = (guessed("arm-swing.csv"), guessed("parquet/arm-swing.parquet"));
    assert_eq!((csv.signals.len(), &csv.clock, &csv.left), (6, &parquet.clock, &parquet.left));
    assert_eq!(csv.signals, parquet.signals);
}

#[test]
fn every_codec_and_both_kinds_of_pages_give_the_same_table() {
    let expected = table("parquet/none.parquet");
    assert_eq!((expected.columns.len(), expected.columns[0].values.len()), (7, 40));
    assert_eq!(expected.columns[2].unit.as_deref(), Some("bar"));
    for name in ["snappy", "gzip", "lz4", "zstd", "pages-2"] {
        assert_eq!(table(&format!("parquet/{name}.parquet")), expected, "{name}");
    }
}

#[test]
fn every_type_is_what_python_wrote() {
    let table = table("parquet/kinds.parquet");
    let start = parse_date("2026-05-04T09:30:00Z").unwrap() as f64;
    let expect = |name: &str, expected: &dyn Fn(f64) -> f64| {
        for (row, found) in numbers(column(&table, name)).into_iter().enumerate() {
            // Nothing stands in for a null, least of all the value before it.
            let expected = if row == 3 { f64::NAN } else { expected(row as f64) };
            assert!(found == expected || (found.is_nan() && expected.is_nan()), "{name} {row}: {found} {expected}");
        }
    };
    expect("when_utc", &|row| start + 10_250_000.0 * row);
    expect("when_berlin", &|row| start + 10_250_000.0 * row);
    expect("when_plain", &|row| start + 1_000_000.0 * row);
    expect("day", &|row| parse_date("2026-05-04T00:00:00Z").unwrap() as f64 + 86_400e9 * row);
    expect("of_day", &|row| 1e6 * row);
    expect("switch", &|row| row % 2.0);
    expect("i8", &|row| row - 100.0);
    expect("u8", &|row| row + 200.0);
    expect("i64", &|row| -(2_f64.powi(40)) * row);
    expect("u32", &|row| f64::from(u32::MAX) - row);
    expect("u64", &|_| 2_f64.powi(64) - 2048.0);
    expect("half", &|row| 0.5 * row - 1.0);
    expect("single", &|row| 0.25 * row);
    expect("p_A", &|row| 100.0 + row);
    expect("money", &|row| (row - 4.0) / 4.0);
    expect("wide", &|row| (2_f64.powi(80) - 2_f64.powi(40) * row) / 8.0);
    expect("arm.x", &|row| row);
    let unit = |name| column(&table, name).unit.as_deref();
    assert_eq!((unit("p_A"), unit("of_day"), unit("i8")), (Some("bar"), Some("us"), None));
    for (name, what) in [("name", "text"), ("spectrum.list.element", "lists"), ("raw", "bytes")] {
        let note = format!("column {name} holds {what} and was left out");
        assert!(table.notes.contains(&note), "{note} is missing in {:?}", table.notes);
    }
    assert_eq!((table.columns.len(), table.notes.len()), (17, 3));
}

#[test]
fn broken_files_are_told_in_one_line() {
    let good = bytes("parquet/none.parquet");
    let error = |bytes: &[u8]| Table::from_parquet(bytes.to_vec()).unwrap_err();
    let mut long_footer = good.clone();
    let at = long_footer.len() - 8;
    long_footer[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
    for (found, part) in [
        (error(b""), "does not begin with PAR1"),
        (error(b"a,b\n1,2\n"), "does not begin with PAR1"),
        (error(b"PAR1"), "broken"),
        (error(&good[..good.len() / 2]), "the end is missing"),
        (error(&long_footer), "broken"),
        (error(&[&good[..8], &good[1500..]].concat()), "broken"),
    ] {
        assert!(found.contains(part), "\"{part}\" is missing in: {found}");
        assert_eq!(found.lines().count(), 1, "{found}");
    }
    // A page of 4 GB that is not there, after 4 bytes of magic and the type of the page.
    let mut huge = bytes("parquet/zstd.parquet");
    assert_eq!(huge[4..7], [0x15, 0x04, 0x15]);
    let size = [0xfe, 0xff, 0xff, 0xff, 0x0f];
    huge.splice(7..9, size);
    let found = error(&huge);
    assert!(found.contains("needs 2147483647 bytes of memory"), "{found}");
}

/// Flipped bytes where they hurt most: in the footer, which has all offsets, types and counts.
#[test]
fn broken_footers_never_panic() {
    let good = bytes("parquet/kinds.parquet");
    let length = u32::from_le_bytes(good[good.len() - 8..good.len() - 4].try_into().unwrap()) as usize;
    let footer = good.len() - 8 - length;
    let mut numbers = Numbers(0x0bad_f007_e120_77aa);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..3000 {
        let mut bytes = good.clone();
        for _ in 0..1 + numbers.below(3) {
            let at = footer + numbers.below(length);
            bytes[at] = [0, 1, 0x7f, 0x80, 0xff, numbers.below(256) as u8][numbers.below(6)];
        }
        match Table::from_parquet(bytes) {
            Ok(table) => {
                read += 1;
                assert!(table.columns.iter().all(|column| column.values.len() < 1_000_000 + 128 * good.len()));
            }
            Err(reason) => {
                refused += 1;
                assert_eq!(reason.lines().count(), 1, "{reason}");
            }
        }
    }
    assert!(read > 100 && refused > 100, "{read} read, {refused} refused");
}
