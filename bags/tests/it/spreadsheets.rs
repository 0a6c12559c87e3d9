//! Spreadsheets that openpyxl wrote (`samples/make_xlsx.py`), and ones that are broken or made to exhaust the reader.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::support::Numbers;
use excavator_bags::BagError;
use excavator_bags::map::{TopicMap, guess, read_mapped};
use excavator_bags::table::{Table, TableFormat, Values, parse_date};
use rosbag2::ReadLimits;
use zip::write::SimpleFileOptions;

fn sample() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/xlsx/arm-swing.xlsx")
}

fn sheet(name: &str) -> TableFormat {
    TableFormat { sheet: Some(name.to_string()), ..TableFormat::default() }
}

/// A workbook of one sheet with this XML, and shared texts with that.
fn workbook(sheet: &str, texts: &str) -> Vec<u8> {
    let mut file = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    let relation = |id: u8, kind: &str, target: &str| {
        let namespace = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
        format!("<Relationship Id=\"r{id}\" Type=\"{namespace}/{kind}\" Target=\"{target}\"/>")
    };
    let relations = |relations: &str| {
        format!(
            "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">{relations}</Relationships>"
        )
    };
    for (name, text) in [
        ("_rels/.rels", relations(&relation(1, "officeDocument", "xl/workbook.xml"))),
        ("xl/_rels/workbook.xml.rels", relations(&relation(1, "worksheet", "worksheets/sheet1.xml"))),
        (
            "xl/workbook.xml",
            "<workbook xmlns:r=\"http://schemas.openxmlformats.org/officeDocument/2006/relationships\"><sheets>\
             <sheet name=\"one\" sheetId=\"1\" r:id=\"r1\"/></sheets></workbook>"
                .to_string(),
        ),
        ("xl/sharedStrings.xml", texts.to_string()),
        ("xl/worksheets/sheet1.xml", sheet.to_string()),
    ] {
        file.start_file(name, SimpleFileOptions::default()).unwrap();
        file.write_all(text.as_bytes()).unwrap();
    }
    file.finish().unwrap().into_inner()
}

const TEXTS: &str = "<sst uniqueCount=\"2\"><si><t>t</t></si><si><t>x [mm]</t></si></sst>";

fn rows(rows: &str) -> String {
    format!("<worksheet><sheetData>{rows}</sheetData></worksheet>")
}

#[test]
fn a_sheet_is_a_table_like_any_other() {
    let table = Table::read(&sample(), &TableFormat::default()).unwrap();
    let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["when", "Weg", "p_A", "p_B", "Pumpendruck", "Tankdruck", "Ventil", "dp"]);
    let Values::Stamps(stamps) = &table.columns[0].values else { unreachable!() };
    assert_eq!((stamps.len(), stamps[0]), (60, parse_date("2026-05-04T09:30:00Z")));
    assert_eq!(stamps[1].unwrap() - stamps[0].unwrap(), 8_000_000);
    let Values::Numbers(stroke) = &table.columns[1].values else { unreachable!() };
    assert_eq!((table.columns[1].unit.as_deref(), stroke[0], stroke[1]), (Some("mm"), -50.0, -50.00065));
    assert!(stroke[7].is_nan());
    assert_eq!(table.sampling.as_ref().map(|sampling| sampling.rate), Some(125.0));
    assert!(
        table.notes.iter().any(|note| note.contains("sheet \"drive 1\" was read") && note.contains("notes, counted"))
    );
    assert!(table.notes.iter().any(|note| note.contains("1 line before the table")), "{:?}", table.notes);
    // Through a map it is the recording of the text table.
    let map = "[[signals]]\nsignal = \"arm.cap_pressure\"\ncolumn = \"p_A\"\n";
    let map: TopicMap = map.parse().unwrap();
    let (recording, _) = read_mapped(&sample(), &map).unwrap();
    let csv = sample().with_file_name("../arm-swing.csv");
    let clock = "[clock]\ncolumn = \"Zeit\"\nstart = \"2026-05-04T09:30:00Z\"\n";
    let (text, _) = read_mapped(&csv, &(clock.to_string() + &map.to_text().unwrap()).parse().unwrap()).unwrap();
    assert_eq!(recording.start_nanoseconds, text.start_nanoseconds);
    assert_eq!(recording.time, text.time[..60]);
    assert_eq!(recording.cylinders[0].cap_pressure, text.cylinders[0].cap_pressure[..60]);
    assert!(guess(&sample(), "arm").unwrap().map().signals.len() >= 4);
}

#[test]
fn another_sheet_is_read_where_the_map_says_so() {
    let map = "[table]\nsheet = \"counted\"\n[[signals]]\nsignal = \"arm.displacement\"\ncolumn = \"x\"\n\
               [[signals]]\nsignal = \"pump_pressure\"\ncolumn = \"p_A\"\n";
    let (recording, report) = read_mapped(&sample(), &map.parse().unwrap()).unwrap();
    assert_eq!(recording.time, [0.0, 0.001, 0.002, 0.003, 0.004]);
    assert_eq!((recording.cylinders[0].displacement[4], recording.pump_pressure[0]), (4e-3, 10.5e5));
    assert!(report.notes.iter().any(|note| note.contains("1000 rows per second")), "{:?}", report.notes);
    let error = Table::read(&sample(), &sheet("load")).unwrap_err().to_string();
    assert!(error.contains("no sheet \"load\"; the spreadsheet has drive 1, notes, counted"), "{error}");
}

#[test]
fn cells_without_places_errors_and_truths_are_read() {
    let cells = "<row><c t=\"s\"><v>0</v></c><c t=\"s\"><v>1</v></c></row>\
                 <row><c><v>0.5</v></c><c t=\"b\"><v>1</v></c></row><row/>\
                 <row r=\"9\"><c r=\"A9\"><v>1e0</v></c><c r=\"B9\" t=\"e\"><v>#N/A</v></c></row>";
    let table = Table::from_xlsx(workbook(&rows(cells), TEXTS), &TableFormat::default()).unwrap();
    assert_eq!((table.columns.len(), table.columns[1].name.as_str()), (2, "x"));
    let Values::Numbers(x) = &table.columns[1].values else { unreachable!() };
    assert!(x[0] == 1.0 && x[1].is_nan() && x.len() == 2, "{x:?}");
}

#[test]
fn what_exhausts_is_refused_before_it_is_read() {
    let cells = "<row><c><v>0</v></c></row>";
    let refused = |bytes: Vec<u8>| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bomb.xlsx");
        std::fs::write(&path, bytes).unwrap();
        let error = Table::read_within(&path, &TableFormat::default(), &ReadLimits::untrusted()).unwrap_err();
        assert!(matches!(error, BagError::Bag(rosbag2::Error::Limit { .. })), "{error}");
        error.to_string()
    };
    // Text that packs to a thousandth, in a cell, and as texts of nothing.
    let long = format!("<row><c t=\"inlineStr\"><is><t>{}</t></is></c></row>", "a".repeat(64 << 20));
    assert!(refused(workbook(&rows(&long), TEXTS)).contains("made to exhaust"));
    let empty = format!("<sst>{}</sst>", "<si/>".repeat(2 << 20));
    assert!(refused(workbook(&rows(cells), &empty)).contains("made to exhaust"));
    // Room for as many texts as are announced would be 2 TB.
    let announced = TEXTS.replace("\"2\"", "\"99999999999\"");
    assert!(refused(workbook(&rows(cells), &announced)).contains("made to exhaust"));
    // One long text in many cells.
    let texts = format!("<sst><si><t>{}</t></si></sst>", "a".repeat(1 << 20));
    let many = "<row><c t=\"s\"><v>0</v></c></row>".repeat(200_000);
    assert!(refused(workbook(&rows(&many), &texts)).contains("made to exhaust"));
    // A cell at the far end of each row.
    let far: String = (1..40_000).map(|row| format!("<row r=\"{row}\"><c r=\"XFD{row}\"><v>1</v></c></row>")).collect();
    assert!(refused(workbook(&rows(&far), TEXTS)).contains("made to exhaust"));
}

#[test]
fn what_is_no_spreadsheet_is_one_clear_line() {
    for (bytes, part) in [
        (b"".to_vec(), "does not begin with PK"),
        (b"PK\x03\x04 and no more".to_vec(), "is broken"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1".to_vec(), "save it as .xlsx"),
        (workbook("<nothing/>", TEXTS), "is broken"),
        (workbook(&rows("<row>"), TEXTS), "no rows"),
        (workbook(&rows(""), TEXTS), "no rows"),
        (workbook(&rows("\0"), TEXTS), "not text in UTF-8"),
        (workbook(&rows("<row><c t=\"s\"><v>7</v></c></row>"), TEXTS), ""),
    ] {
        let error = Table::from_xlsx(bytes, &TableFormat::default()).unwrap_err();
        assert!(error.contains(part) && error.lines().count() == 1, "{error}");
    }
}

#[test]
fn broken_spreadsheets_never_panic() {
    let good = std::fs::read(sample()).unwrap();
    let mut numbers = Numbers(0x2545_f491_4f6c_dd1d);
    for _ in 0..600 {
        let mut bytes = good.clone();
        for _ in 0..=numbers.below(4) {
            let at = numbers.below(bytes.len());
            bytes[at] = numbers.below(256) as u8;
        }
        bytes.truncate(bytes.len() - numbers.below(2) * numbers.below(good.len()));
        let _ = Table::from_xlsx(bytes, &TableFormat::default());
    }
    // The same in the text of a sheet, which no checksum guards.
    let cells = "<row r=\"1\"><c r=\"A1\" t=\"s\"><v>0</v></c><c r=\"B1\" t=\"inlineStr\"><is><t>x &amp; y</t></is></c></row>\
                 <row r=\"2\"><c r=\"A2\" s=\"0\"><v>1.5</v></c><c r=\"B2\" t=\"str\"><f>A2</f><v>2</v></c></row>";
    let good = rows(cells).into_bytes();
    for _ in 0..2000 {
        let mut bytes = good.clone();
        for _ in 0..=numbers.below(3) {
            let at = numbers.below(bytes.len());
            bytes[at] = b"<>/\"&;=019AZX r\x7f"[numbers.below(16)];
        }
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let _ = Table::from_xlsx(workbook(&text, TEXTS), &TableFormat::default());
        let _ = Table::from_xlsx(workbook(&rows(cells), &text), &TableFormat::default());
    }
}
