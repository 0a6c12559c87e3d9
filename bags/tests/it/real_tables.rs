//! Tables as people have them: computed columns, several files, lines above the headings, prefixes and units in cells.

use std::path::PathBuf;

use excavator_bags::ReadReport;
use excavator_bags::map::{TopicMap, read_mapped, read_pieces};
use excavator_bags::table::{Table, TableFormat, Values};
use excavator_model::recording::Recording;
use proptest::prelude::*;

struct Folder {
    folder: tempfile::TempDir,
}

impl Folder {
    fn new() -> Folder {
        Folder { folder: tempfile::tempdir().unwrap() }
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    }

    fn read(&self, name: &str, map: &str) -> Result<(Recording, ReadReport), String> {
        let map: TopicMap = map.parse().map_err(|error: excavator_bags::map::MapError| error.to_string())?;
        read_mapped(&self.folder.path().join(name), &map).map_err(|error| error.to_string())
    }
}

/// A table of so many rows, 100 per second from time `from` on; the other columns are functions of the time.
fn table(headings: &str, from: f64, rows: usize, columns: &[fn(f64) -> f64]) -> String {
    let mut text = headings.to_string() + "\n";
    for row in 0..rows {
        let t = from + row as f64 / 100.0;
        let cells = columns.iter().map(|column| column(t).to_string());
        text += &(std::iter::once(t.to_string()).chain(cells).collect::<Vec<_>>().join(",") + "\n");
    }
    text
}

fn near(found: f64, wanted: f64) -> bool {
    (found - wanted).abs() < 1e-9 * wanted.abs().max(1.0)
}

#[test]
fn signals_are_computed_from_columns() {
    let folder = Folder::new();
    let columns: [fn(f64) -> f64; 3] = [|t| 100.0 + t, |t| 40.0 - t, |t| 250.0 + 100.0 * t];
    folder.write("drive.csv", &table("t,Druck A [bar],p_lo [bar],x [mm]", 0.0, 50, &columns));
    let map = r#"
        [names]
        p_hi = "Druck A [bar]"
        s = { column = "x", unit = "mm" }

        [[signals]]
        signal = "arm.cap_pressure"
        formula = "(p_hi - p_lo) * 1e5"

        [[signals]]
        signal = "arm.rod_pressure"
        formula = "p_lo"
        unit = "bar"
        offset = "-1 bar"

        [[signals]]
        signal = "arm.displacement"
        column = "x"
        offset = "-250 mm"

        [[signals]]
        signal = "arm.velocity"
        formula = "rate(s)"

        [[signals]]
        signal = "pump_pressure"
        formula = "if(arm.displacement > 0.2, 1e5, 2e5)"
    "#;
    let (recording, report) = folder.read("drive.csv", map).unwrap();
    let arm = recording.cylinder("arm").unwrap();
    for sample in 0..50 {
        let t = sample as f64 / 100.0;
        assert!(near(arm.cap_pressure[sample], (60.0 + 2.0 * t) * 1e5), "{}", arm.cap_pressure[sample]);
        assert!(near(arm.rod_pressure[sample], (39.0 - t) * 1e5), "{}", arm.rod_pressure[sample]);
        assert!(near(arm.velocity[sample], 0.1), "{}", arm.velocity[sample]);
        assert_eq!(recording.pump_pressure[sample], if arm.displacement[sample] > 0.2 { 1e5 } else { 2e5 });
    }
    assert_eq!(report.notes, Vec::<String>::new());
    // The map says it again.
    let parsed: TopicMap = map.parse().unwrap();
    assert_eq!(parsed.to_text().unwrap().parse::<TopicMap>().unwrap(), parsed);
}

#[test]
fn what_cannot_be_computed_is_told_in_one_line() {
    let folder = Folder::new();
    folder.write("drive.csv", "t,p_hi,p_lo\n0,1,2\n1,2,\n");
    let formula = |text: &str| format!("[[signals]]\nsignal = \"pump_pressure\"\nformula = \"{text}\"\n");
    let error = |map: &str| folder.read("drive.csv", map).unwrap_err();
    for (map, parts) in [
        (formula("p_hj * 2"), &["pump_pressure: formula", "p_hj", "did you mean", "it may use t, p_hi, p_lo"][..]),
        (formula("p_hi *"), &["expected a number"]),
        (formula("p_cap"), &["unknown name \"p_cap\""]),
        (formula("p_hi") + "column = 2\n", &["either `topic` and `field`, or `column`, or `formula`, or `value`"]),
        (formula("p_hi") + "unit = \"mm\"\n", &["pump_pressure is a pressure, but mm is a length"]),
        ("[names]\n\"p hi\" = 2\n".to_string() + &formula("p_hi"), &["\"p hi\" is no name"]),
        ("[names]\nq = { unit = \"bar\" }\n".to_string() + &formula("p_hi"), &["[names] q: give either a `column`"]),
        ("[names]\nq = { column = 2, unit = \"furlong\" }\n".to_string() + &formula("q"), &["furlong", "known are"]),
        ("[names]\nq = true\n".to_string() + &formula("q"), &["a heading, the number of a column"]),
        ("[names]\nq = \"Druck\"\n".to_string() + &formula("q"), &["no column \"Druck\"; the table has t, p_hi, p_lo"]),
        ("[names]\nq = { topic = \"/a\", field = \"b\" }\n".to_string() + &formula("q"), &["q is taken from a topic"]),
    ] {
        let found = error(&map);
        assert!(parts.iter().all(|part| found.contains(part)) && !found.contains('\n'), "{found}");
    }
    let (recording, report) = folder.read("drive.csv", &formula("p_hi + p_lo")).unwrap();
    assert!(recording.pump_pressure[0] == 3.0 && recording.pump_pressure[1].is_nan());
    assert!(report.notes.iter().any(|note| note.contains("no value at 1 of 2")), "{:?}", report.notes);
}

#[test]
fn tables_beside_the_data_are_brought_onto_its_times() {
    let folder = Folder::new();
    folder.write("drive.csv", &table("t,x [mm]", 0.0, 100, &[|t| 10.0 * t]));
    // Slower, in ms, 0.2 s late.
    let mut other = "time_ms,p [bar],x\n".to_string();
    for row in 0..20 {
        other += &format!("{},{},0\n", 50 * row, 100 + row);
    }
    folder.write("daq.csv", &other);
    let signals = "[[signals]]\nsignal = \"arm.displacement\"\ncolumn = \"x\"\n\
                   [[signals]]\nsignal = \"arm.cap_pressure\"\ncolumn = \"p\"\n";
    let map = |more: &str| format!("[[join]]\nfile = \"daq.csv\"\nclock.column = 1\n{more}\n{signals}");
    let (recording, _) = folder.read("drive.csv", &map("offset = 0.2")).unwrap();
    let arm = recording.cylinder("arm").unwrap();
    assert_eq!(recording.len(), 100);
    assert!(arm.cap_pressure[19].is_nan() && near(arm.cap_pressure[20], 1e7), "{:?}", &arm.cap_pressure[18..23]);
    // Half way between two rows of the other table.
    assert!(near(arm.cap_pressure[30], 102.0 * 1e5) && near(arm.cap_pressure[45], 105.0 * 1e5));
    assert!(near(arm.displacement[50], 5e-3));
    let held = map("").replace("column = \"p\"\n", "column = \"p\"\nresample = \"hold\"\n");
    assert!(near(folder.read("drive.csv", &held).unwrap().0.cylinders[0].cap_pressure[9], 101.0 * 1e5));
    // Columns of the other table are named with the file, and computed with those of the data.
    let formula = map("")
        + "[[signals]]\nsignal = \"pump_pressure\"\nformula = \"y * 1e5 + 0 * x\"\n\
                             [names]\ny = { column = 2, file = \"daq.csv\" }\n";
    assert!(near(folder.read("drive.csv", &formula).unwrap().0.pump_pressure[50], 110.0 * 1e5));
    let error = |map: &str| folder.read("drive.csv", map).unwrap_err();
    let apart = error(&map("offset = 500.0"));
    assert!(apart.contains("daq.csv has no time in common") && apart.contains("from 500.000 s"), "{apart}");
    let dated = error(&map("clock.start = \"2026-05-04T09:30:00Z\""));
    assert!(dated.contains("only the file has dates") && dated.contains("offset"), "{dated}");
    let placed = map("clock.start = \"2026-05-04T09:30:00Z\"\noffset = 0.1");
    assert!(near(folder.read("drive.csv", &placed).unwrap().0.cylinders[0].cap_pressure[10], 1e7));
    let elsewhere = error(&(map("") + "file = \"b.csv\"\n"));
    assert!(elsewhere.contains("b.csv is not joined; the map joins daq.csv"), "{elsewhere}");
    let missing = error(&map("").replace("\"p\"", "\"q\""));
    assert!(missing.contains("no column \"q\"") && missing.contains("time_ms"), "{missing}");
    assert!(error(&map("").replace("daq.csv", "none.csv")).contains("none.csv"));
    let twice = format!("[[join]]\nfile = \"daq.csv\"\nclock.column = 1\n{}", map(""));
    assert!(error(&twice).contains("say which with `file`"), "{}", error(&twice));
}

const X: &str = "[[signals]]\nsignal = \"arm.displacement\"\ncolumn = \"x\"\n";

#[test]
fn files_that_follow_each_other_are_pieces_of_one_recording() {
    let folder = Folder::new();
    let map = folder.write("map.toml", X);
    let a = folder.write("a.csv", &table("t,x [mm]", 0.0, 300, &[|t| t]));
    let b = folder.write("b.csv", &table("t,x [mm]", 0.0, 200, &[|t| 7.0 + t]));
    let read = |paths: &[&PathBuf]| {
        let paths: Vec<PathBuf> = paths.iter().copied().cloned().collect();
        read_pieces(&paths, Some(&map), &[]).map_err(|error| error.to_string())
    };
    let (recording, report) = read(&[&a, &b]).unwrap();
    recording.validate().unwrap();
    assert_eq!(recording.pieces(), [0..300, 300..500]);
    // The shortest pause that makes two pieces: at 100 Hz a little more than 10 s.
    assert!(near(recording.time[300] - recording.time[299], 10.01), "{}", recording.time[300] - recording.time[299]);
    assert!(near(recording.cylinders[0].displacement[300], 7e-3));
    assert!(report.notes.iter().any(|note| note.contains("b.csv counts time from its own start")), "{report:?}");
    assert_eq!(report.messages["rows"], 500);
    // What goes on where the other ends has times that say so.
    let c = folder.write("c.csv", &table("t,x [mm]", 3.0, 100, &[|t| t]));
    assert_eq!(read(&[&a, &c]).unwrap().0.pieces(), [0..400]);
    // Dates are kept, in their order.
    let dated = |name: &str, minute: u8| {
        let rows: String = (0..50).map(|i| format!("2026-05-04T09:{minute:02}:00.{:02}Z,{minute}\n", 2 * i)).collect();
        folder.write(name, &format!("when,x [mm]\n{rows}"))
    };
    let (early, late) = (dated("early.csv", 5), dated("late.csv", 6));
    let (recording, report) = read(&[&late, &early]).unwrap();
    assert!(near(recording.time[50] - recording.time[0], 60.0) && report.notes.is_empty(), "{report:?}");
    assert!(near(recording.cylinders[0].displacement[0], 5e-3));
    let error = read(&[&early, &early]).unwrap_err();
    assert!(error.contains("early.csv and") && error.contains("overlap by 0.980 s"), "{error}");
    // One alone is as it is.
    assert_eq!(read(&[&a]).unwrap().0.len(), 300);
    let error = read_pieces(&[a, b], Some(&map), &[c]).unwrap_err().to_string();
    assert!(error.contains("--join goes with one file, not with 2"), "{error}");
}

#[test]
fn lines_above_the_headings_say_how_often_rows_were_taken() {
    let folder = Folder::new();
    let rows = "1;2\n3;4\n5;6\n7;8\n";
    for above in ["Rig 3\nSampling rate: 500 Hz\n\n", "# fs=500\n", "dt = 0,002 s\n", "Abtastrate [Hz]; 500\n"] {
        folder.write("drive.csv", &format!("{above}x [mm];p [bar]\n{rows}"));
        let (recording, report) = folder.read("drive.csv", X).unwrap();
        assert_eq!(recording.time, [0.0, 0.002, 0.004, 0.006], "{above}");
        let told = report.notes.iter().filter(|note| note.contains("no column of times: 500 rows per second")).count();
        assert_eq!(told, 1, "{:?}", report.notes);
        // What the map says is meant.
        let (recording, _) = folder.read("drive.csv", &format!("[clock]\nrate = 100.0\n{X}")).unwrap();
        assert_eq!(recording.time[1], 0.01);
    }
    folder.write("drive.csv", &format!("fs = 500\nTitle\nx [mm];p [bar]\n{rows}"));
    let (_, report) = folder.read("drive.csv", &format!("[table]\nskip_lines = 2\n{X}")).unwrap();
    assert!(report.notes.iter().any(|note| note.contains("500 rows per second")), "{:?}", report.notes);
    // Times in the table count more.
    folder.write("drive.csv", &format!("fs = 500\nt;x [mm]\n{rows}"));
    let (recording, report) = folder.read("drive.csv", X).unwrap();
    assert_eq!((recording.time[1], report.notes.len()), (2.0, 0), "{:?}", report.notes);
    folder.write("drive.csv", &format!("fs = 500\ndt = 1 s\nx [mm];p [bar]\n{rows}"));
    assert!(folder.read("drive.csv", X).unwrap_err().contains("does not say when"));
}

#[test]
fn cells_with_prefixes_and_units() {
    let folder = Folder::new();
    folder.write("drive.csv", "t,x,p,u\n0,25.1mm,1.2M,40%\n1,-3 mm,950k,0 %\n2,0.5mm,1100000,-40%\n");
    let map = format!(
        "{X}[[signals]]\nsignal = \"pump_pressure\"\ncolumn = \"p\"\n\
         [[signals]]\nsignal = \"arm.orifice_command\"\ncolumn = \"u\"\nscale = \"10 mm2/%\"\n"
    );
    let (recording, report) = folder.read("drive.csv", &map).unwrap();
    assert_eq!(report.notes, Vec::<String>::new());
    assert_eq!(recording.cylinders[0].displacement, [25.1e-3, -3e-3, 0.5e-3]);
    assert_eq!(recording.pump_pressure, [1.2e6, 0.95e6, 1.1e6]);
    assert!(near(recording.cylinders[0].orifice_command[0] * 1e6, 400.0));
    // Headings like "1 bar" stay headings.
    let path = folder.write("seal.csv", "v,1 bar,3 bar\n0.1,5,6\n0.2,7,8\n");
    let table = Table::read(&path, &TableFormat::default()).unwrap();
    assert_eq!(table.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>(), ["v", "1 bar", "3 bar"]);
    let path = folder.write("seal.csv", "1 bar,3 bar\n5,6\n7,8\n");
    assert_eq!(Table::read(&path, &TableFormat::default()).unwrap().columns[0].name, "1 bar");
    let path = folder.write("none.csv", "0,25m\n1,30m\n2,0.5\n");
    let table = Table::read(&path, &TableFormat::default()).unwrap();
    assert_eq!(table.columns[1].values, Values::Numbers(vec![0.025, 0.03, 0.5]));
}

proptest! {
    #[test]
    fn no_cell_makes_the_reader_panic(
        cells in prop::collection::vec("[-+0-9.,eEµmkMGun°%²/ barHz\"#:;]{0,12}", 1..40),
        above in prop::collection::vec("[a-zA-Z =:,;#\\[\\]0-9.Hzs]{0,30}", 0..4),
        columns in 1..4_usize,
        sign in prop::sample::select(vec![',', ';', '\t', ' ']),
    ) {
        let mut text: String = above.iter().map(|line| line.clone() + "\n").collect();
        for row in cells.chunks(columns) {
            text += &(row.join(&sign.to_string()) + "\n");
        }
        if let Ok(table) = Table::from_text(text.as_bytes(), &TableFormat::default()) {
            for column in &table.columns {
                prop_assert_eq!(column.values.len(), table.columns[0].values.len());
            }
            prop_assert!(table.sampling.is_none_or(|sampling| sampling.rate > 0.0 && sampling.rate.is_finite()));
        }
    }

    #[test]
    fn a_number_with_a_prefix_is_that_number(number in -1e6..1e6_f64, prefix in prop::sample::select(vec!["k", "M", "u", "n", "m"])) {
        let factor = match prefix { "k" => 1e3, "M" => 1e6, "u" => 1e-6, "n" => 1e-9, _ => 1e-3 };
        let text = format!("t,x\n0,{number}{prefix}\n1,{number}{prefix}\n");
        let table = Table::from_text(text.as_bytes(), &TableFormat::default()).unwrap();
        let Values::Numbers(values) = &table.columns[1].values else { unreachable!() };
        prop_assert!((values[0] - number * factor).abs() <= 1e-12 * (number * factor).abs(), "{} {}", values[0], text);
    }
}
