//! Tables of other programs: dialects of CSV, headings, dates, MATLAB files; and no panic on anything.

use std::io::Write;
use std::path::PathBuf;

use crate::support::Numbers;
use excavator_bags::map::{TopicMap, read_mapped};
use excavator_bags::table::{Table, TableFormat, Values};
use proptest::prelude::*;

struct File {
    folder: tempfile::TempDir,
}

impl File {
    fn new() -> File {
        File { folder: tempfile::tempdir().unwrap() }
    }

    fn write(&self, name: &str, content: &[u8]) -> PathBuf {
        let path = self.folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    fn csv(&self, text: &str) -> Table {
        Table::read(&self.write("table.csv", text.as_bytes()), &TableFormat::default()).unwrap()
    }
}

fn columns(table: &Table) -> Vec<(String, Option<String>, Vec<f64>)> {
    let numbers = |values: &Values| match values {
        Values::Numbers(numbers) => numbers.clone(),
        Values::Stamps(stamps) => stamps.iter().map(|stamp| stamp.map_or(f64::NAN, |stamp| stamp as f64)).collect(),
    };
    table.columns.iter().map(|c| (c.name.clone(), c.unit.clone(), numbers(&c.values))).collect()
}

fn column(name: &str, unit: &str, values: &[f64]) -> (String, Option<String>, Vec<f64>) {
    (name.to_string(), (!unit.is_empty()).then(|| unit.to_string()), values.to_vec())
}

#[test]
fn the_same_table_in_five_dialects() {
    let file = File::new();
    let expected = [column("t", "s", &[0.0, 0.5, 1.0]), column("p", "bar", &[1.5, -2.25, 3e2])];
    for text in [
        "t [s],p [bar]\n0,1.5\n0.5,-2.25\n1.0,3e2\n",
        "t (s);p (bar)\r\n0;1,5\r\n0,5;-2,25\r\n1,0;3e2\r\n",
        "\u{feff}\"t [s]\"\t\"p [bar]\"\n0\t1.5\n0.5\t-2.25\n1.0\t3e2",
        "# made by a logger\nt;p\ns;bar\n0;1,5\n0,5;-2,25\n1,0;300\n",
        "t[s]   p[bar]\n  0    1.5\n  0.5  -2.25\n  1.0  300\n",
    ] {
        let table = file.csv(text);
        assert_eq!(columns(&table), expected, "{text}");
        assert_eq!(table.notes, Vec::<String>::new(), "{text}");
    }
}

#[test]
fn holes_and_words_are_not_measured() {
    let file = File::new();
    let table = file.csv("t,x\n0,1\n1,\n2,NaN\n3,broken\n4\n");
    let Values::Numbers(x) = &table.columns[1].values else { unreachable!() };
    assert!(x[0] == 1.0 && x[1..].iter().all(|value| value.is_nan()) && x.len() == 5);
    assert!(table.notes.iter().any(|note| note.contains("column x: 1 cells")), "{:?}", table.notes);
    assert!(table.notes.iter().any(|note| note.contains("1 rows have another number")), "{:?}", table.notes);
}

#[test]
fn one_endless_line_makes_no_endless_table() {
    // 60 000 columns of 20 000 rows would be 9.6 GB.
    let mut text = "t,x\n".to_string();
    for row in 0..20_000 {
        text += &if row == 5 { ",".repeat(60_000) + "\n" } else { format!("{row},1\n") };
    }
    let table = File::new().csv(&text);
    assert!((2..100).contains(&table.columns.len()), "{} columns", table.columns.len());
    assert_eq!((table.columns[1].name.as_str(), table.columns[1].values.len()), ("x", 20_000));
    assert!(table.notes[0].contains("60001 cells"), "{:?}", table.notes);
}

#[test]
fn dates_and_units_of_time_make_the_clock() {
    let file = File::new();
    let signals = "[[signals]]\nsignal = \"arm.displacement\"\ncolumn = 2\n";
    let read = |text: &str, clock: &str| {
        let map: TopicMap = format!("[clock]\n{clock}\n{signals}").parse().unwrap();
        read_mapped(&file.write("table.csv", text.as_bytes()), &map).unwrap().0
    };
    let dated = read("time,x [mm]\n2017-07-14T02:40:00.5Z,1\n2017-07-14 02:40:01.5,2\n", "");
    assert_eq!((dated.start_nanoseconds, dated.time), (1_500_000_000_500_000_000, vec![0.0, 1.0]));
    assert_eq!(dated.cylinders[0].displacement, [1e-3, 2e-3]);
    let plain = "when,x [mm]\n0,1\n20,2\n";
    let started = read(plain, "column = \"when\"\nunit = \"ms\"\nstart = \"2017-07-14T02:40:00Z\"");
    assert_eq!((started.start_nanoseconds, started.time), (1_500_000_000_000_000_000, vec![0.0, 0.02]));
    assert_eq!(read(plain, "rate = 50.0").time, [0.0, 0.02]);
    let epoch = read("t,x [mm]\n1500000000,1\n1500000001,2\n", "");
    assert_eq!((epoch.start_nanoseconds, epoch.time), (1_500_000_000_000_000_000, vec![0.0, 1.0]));
    let unsorted = read("t,x [mm]\n2,3\n1,2\n1,9\n0,1\n", "");
    assert_eq!(
        (unsorted.time, &unsorted.cylinders[0].displacement[..]),
        (vec![0.0, 1.0, 2.0], &[1e-3, 2e-3, 3e-3][..])
    );
}

#[test]
fn what_is_missing_is_told_in_one_line() {
    let file = File::new();
    let error = |text: &str, map: &str| {
        read_mapped(&file.write("table.csv", text.as_bytes()), &map.parse().unwrap()).unwrap_err().to_string()
    };
    let signals = "[[signals]]\nsignal = \"arm.displacement\"\ncolumn = \"x\"\n";
    for (found, part) in [
        (error("a,x\n0,1\n", signals), "does not say when"),
        (error("t,y\n0,1\n", signals), "no column \"x\"; the table has t, y"),
        (error("t,x [bar]\n0,1\n", signals), "is a length, but bar is a pressure"),
        (error("t,x\n", signals), "no rows"),
        (error("", signals), "no rows"),
        (error("t,x\n0,1\n", &format!("[clock]\ntopic = \"/a\"\n{signals}")), "is taken from a topic"),
        (error("t,x\n0,1\n", &format!("[clock]\nrate = 5.0\nstart = \"today\"\n{signals}")), "start = \"today\""),
        (error("t,x\nnan,1\n", signals), "the clock (column t) has no time; times are numbers"),
        (error("Time,x\n20.11.2023,1\n20.11.2023,2\n", signals), "all 2 rows have the same; times are numbers"),
        (error("Time,x\n10h00,1\n10h01,2\n", signals), "the first is \"10h00\"; times are numbers"),
    ] {
        assert!(found.contains(part), "\"{part}\" is missing in: {found}");
        assert_eq!(found.lines().count(), 1, "{found}");
    }
}

/// The columns of a map with these signals, read from a table.
fn mapped(text: &str, name: &str, map: &str) -> (excavator_model::recording::Recording, Vec<String>) {
    let file = File::new();
    let (recording, report) = read_mapped(&file.write(name, text.as_bytes()), &map.parse().unwrap()).unwrap();
    (recording, report.notes)
}

const POSITION_AND_PRESSURE: &str = "[[signals]]\nsignal = \"load.displacement\"\ncolumn = \"Position\"\n\
                                     [[signals]]\nsignal = \"load.cap_pressure\"\ncolumn = \"Pressure A\"\n";

#[test]
fn headers_of_loggers_are_no_rows() {
    let labview = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t,\n***End_of_Header***\t\n\t\nChannels\t2\t\t\t\n\
                   Samples\t5\t5\t\nDate\t2023/11/20\t2023/11/20\t\nTime\t10:20:00,1\t10:20:00,1\t\nY_Unit_Label\tmm\tbar\t\n\
                   X0\t0,0E+0\t0,0E+0\t\nDelta_X\t0,002\t0,002\t\n***End_of_Header***\t\t\t\nX_Value\tPosition\tPressure A\tComment\n";
    let rows: String = (0..5).map(|row| format!("0,00{}\t3{row},5\t1{row},25\n", 2 * row)).collect();
    let (recording, _) = mapped(&(labview.to_string() + &rows), "bench.lvm", POSITION_AND_PRESSURE);
    assert_eq!(recording.time, [0.0, 0.002, 0.004, 0.006, 0.008]);
    assert_eq!((recording.cylinders[0].displacement[1], recording.cylinders[0].cap_pressure[4]), (0.0315, 14.25e5));
}

#[test]
fn each_channel_may_have_its_own_times() {
    let mut text = "Name;Scope;;\nStart;1;Monday;\nName;Position;Name;Pressure A\nSymbolName;MAIN.x;SymbolName;MAIN.p\nUnit;mm;Unit;bar\n\
                    SampleTime[ms];2;SampleTime[ms];4\n;;;\n"
        .to_string();
    for row in 0..10 {
        let slow = if row < 6 { format!("{};{}", 4 * row - 1, 10 * (4 * row - 1)) } else { ";".to_string() };
        text += &format!("{};{};{slow}\n", 2 * row, 100 + 2 * row);
    }
    let (recording, notes) = mapped(&text, "scope.csv", &format!("[clock]\ncolumn = 1\n{POSITION_AND_PRESSURE}"));
    assert_eq!((recording.len(), recording.time[9]), (10, 0.018));
    let load = &recording.cylinders[0];
    for (sample, (x, p)) in load.displacement.iter().zip(&load.cap_pressure).enumerate() {
        let t = 2.0 * sample as f64;
        assert!((x - (0.1 + 1e-3 * t)).abs() < 1e-9 && (p - 1e6 * t).abs() < 1e-3, "{sample}: {x} {p} {notes:?}");
    }
}

#[test]
fn codes_of_loggers_are_not_measured_and_are_listed() {
    let mut text = "t [s],Position [mm],Pressure A [bar]\n".to_string();
    for row in 0..100 {
        let x = if row % 20 == 3 { "-999".to_string() } else { (20.0 + f64::from(row) / 10.0).to_string() };
        text += &format!("{},{x},{}\n", 0.01 * f64::from(row), if row == 50 { "1e30" } else { "55" });
    }
    let (recording, notes) = mapped(&text, "t.csv", POSITION_AND_PRESSURE);
    let holes = |values: &[f64]| values.iter().filter(|value| value.is_nan()).count();
    let load = &recording.cylinders[0];
    assert_eq!([holes(&load.displacement), holes(&load.cap_pressure)], [5, 1]);
    assert!(
        notes.iter().any(|note| note.contains("5 of 100 readings are a code") && note.contains("-999 (5 times)")),
        "{notes:?}"
    );
    assert!(notes.iter().any(|note| note.contains("1e30 (1 times)")), "{notes:?}");
}

#[test]
fn a_compressed_table_is_a_table() {
    let file = File::new();
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(b"t [s];x [mm]\n0;1,5\n1;2,5\n2;3,5\n").unwrap();
    let packed = encoder.finish().unwrap();
    let path = file.write("table.csv.gz", &packed);
    assert!(Table::is_table(&path));
    let table = Table::read(&path, &TableFormat::default()).unwrap();
    assert_eq!(columns(&table), [column("t", "s", &[0.0, 1.0, 2.0]), column("x", "mm", &[1.5, 2.5, 3.5])]);
    let cut = Table::read(&file.write("cut.csv.gz", &packed[..packed.len() - 9]), &TableFormat::default());
    assert!(cut.is_ok_and(|table| table.notes.iter().any(|note| note.contains("cut off"))));
    assert!(Table::read(&file.write("odd.csv.gz", b"t,x\n0,1\n"), &TableFormat::default()).is_err());
}

/// One element of a MATLAB 5 file.
fn element(kind: u32, content: &[u8]) -> Vec<u8> {
    let mut bytes = [kind.to_le_bytes(), (content.len() as u32).to_le_bytes()].concat();
    bytes.extend(content);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

fn matrix(name: &str, rows: i32, class: u32, flags: u32, data: &[u8]) -> Vec<u8> {
    let columns = 2;
    let size = [rows.to_le_bytes(), i32::to_le_bytes(columns)].concat();
    let parts = [
        element(6, &[(class | flags << 8).to_le_bytes(), [0; 4]].concat()),
        element(5, &size),
        element(1, name.as_bytes()),
        data.to_vec(),
    ];
    element(14, &parts.concat())
}

fn mat5(elements: &[Vec<u8>]) -> Vec<u8> {
    let mut file = b"MATLAB 5.0 MAT-file".to_vec();
    file.resize(124, b' ');
    file.extend([0, 1, b'I', b'M']);
    file.extend(elements.concat());
    file
}

fn packed(element: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(element).unwrap();
    let packed = encoder.finish().unwrap();
    [&15_u32.to_le_bytes()[..], &(packed.len() as u32).to_le_bytes(), &packed].concat()
}

fn doubles(values: &[f64]) -> Vec<u8> {
    element(9, &values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>())
}

#[test]
fn matlab_variables_are_columns() {
    let file = File::new();
    // A double array that MATLAB stores as bytes because the numbers fit, in the tag itself.
    let small = [(2_u32 | 4 << 16).to_le_bytes().to_vec(), vec![1, 2, 3, 4]].concat();
    let bytes = mat5(&[
        matrix("wide", 2, 6, 0, &doubles(&[1.0, 2.0, 3.0, 4.0])),
        packed(&matrix("small", 2, 6, 0, &small)),
        packed(&matrix("text", 2, 4, 0, &small)),
        packed(&matrix("complex", 2, 6, 8, &doubles(&[1.0; 4]))),
        matrix("lies", 2, 6, 0, &doubles(&[1.0])),
    ]);
    let path = file.write("table.mat", &bytes);
    let table = Table::read(&path, &TableFormat::default()).unwrap();
    let expected = [
        column("wide[1]", "", &[1.0, 2.0]),
        column("wide[2]", "", &[3.0, 4.0]),
        column("small[1]", "", &[1.0, 2.0]),
        column("small[2]", "", &[3.0, 4.0]),
    ];
    assert_eq!(columns(&table), expected);
    for name in ["text", "complex", "lies"] {
        assert!(table.notes.iter().any(|note| note.starts_with(name)), "{:?}", table.notes);
    }
    let nameless = mat5(&[matrix("", 2, 6, 0, &doubles(&[1.0, 2.0, 3.0, 4.0]))]);
    let nameless = Table::from_mat(&nameless).unwrap();
    assert_eq!(columns(&nameless)[1], column("column_1[2]", "", &[3.0, 4.0]));
    let cut = file.write("cut.mat", &bytes[..300]);
    let cut = Table::read(&cut, &TableFormat::default()).unwrap();
    assert!(cut.notes.iter().any(|note| note.contains("cut off")), "{:?}", cut.notes);
    for (content, part) in
        [(&b"\x89HDF\r\n\x1a\n"[..], "7.3"), (b"nonsense that is long enough for a header", "MATLAB")]
    {
        let error = Table::read(&file.write("odd.mat", content), &TableFormat::default()).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
}

/// A matrix of any class and size with these parts after its name.
fn array(name: &str, class: u32, size: [i32; 2], parts: &[Vec<u8>]) -> Vec<u8> {
    let head = [
        element(6, &[class.to_le_bytes(), [0; 4]].concat()),
        element(5, &size.map(i32::to_le_bytes).concat()),
        element(1, name.as_bytes()),
    ];
    element(14, &[head.concat(), parts.concat()].concat())
}

/// A struct array with these fields, element by element.
fn structs(name: &str, count: i32, fields: &[&str], values: &[Vec<u8>]) -> Vec<u8> {
    let mut names: Vec<u8> = Vec::new();
    for field in fields {
        let mut padded = field.as_bytes().to_vec();
        padded.resize(16, 0);
        names.extend(padded);
    }
    let head = [element(5, &16_i32.to_le_bytes()), element(1, &names)];
    array(name, 2, [1, count], &[head.concat(), values.concat()])
}

#[test]
fn structs_of_signals_are_columns_with_their_names_and_units() {
    let text = |text: &str| array("", 4, [1, text.len() as i32], &[element(16, text.as_bytes())]);
    let numbers = |values: &[f64]| array("", 6, [values.len() as i32, 1], &[doubles(values)]);
    let signal = |name: &str, unit: &str, values: &[f64]| [text(name), numbers(values), text(unit), numbers(&[4.0])];
    let y = [signal("Position", "mm", &[1.0, 2.0, 3.0]), signal("Pressure A", "bar", &[4.0, 5.0, 6.0])].concat();
    let file = mat5(&[structs(
        "rec",
        1,
        &["t", "Y"],
        &[numbers(&[0.0, 0.1, 0.2]), structs("", 2, &["Name", "Data", "Unit", "Type"], &y)],
    )]);
    let expected = [
        column("rec.t", "", &[0.0, 0.1, 0.2]),
        column("Position", "mm", &[1.0, 2.0, 3.0]),
        column("Pressure A", "bar", &[4.0, 5.0, 6.0]),
    ];
    assert_eq!(columns(&Table::from_mat(&file).unwrap()), expected);
}

#[test]
fn signals_of_several_rates_have_their_own_times() {
    let numbers = |values: &[f64]| array("", 6, [values.len() as i32, 1], &[doubles(values)]);
    let slow: Vec<f64> = (0..20).map(f64::from).collect();
    let fast: Vec<f64> = (0..39).map(|i| 0.5 * f64::from(i)).collect();
    let tenfold = |times: &[f64]| times.iter().map(|time| 10.0 * time).collect::<Vec<f64>>();
    let x = [numbers(&slow), numbers(&fast)];
    let y = [numbers(&tenfold(&slow)), numbers(&[1.0]), numbers(&tenfold(&fast)), numbers(&[2.0])];
    let file = mat5(&[structs(
        "rec",
        1,
        &["X", "Y"],
        &[structs("", 2, &["Data"], &x), structs("", 2, &["Data", "XIndex"], &y)],
    )]);
    let folder = File::new();
    let path = folder.write("rates.mat", &file);
    let map = "[clock]\ncolumn = \"rec.X(1).Data\"\n[[signals]]\nsignal = \"load.displacement\"\ncolumn = \"rec.Y(1).Data\"\n\
               [[signals]]\nsignal = \"load.cap_pressure\"\ncolumn = \"rec.Y(2).Data\"\n";
    let (recording, _) = read_mapped(&path, &map.parse().unwrap()).unwrap();
    assert_eq!((recording.len(), recording.cylinders[0].displacement[7]), (20, 70.0));
    assert_eq!(recording.cylinders[0].displacement, recording.cylinders[0].cap_pressure);
}

#[test]
fn signals_in_rows_are_turned_and_objects_are_refused_with_a_remedy() {
    let long: Vec<f64> = (0..20).flat_map(|sample| [f64::from(sample), 7.0]).collect();
    let rows = Table::from_mat(&mat5(&[array("ans", 6, [2, 20], &[doubles(&long)])])).unwrap();
    assert_eq!((rows.columns.len(), rows.columns[0].values.len()), (2, 20));
    assert_eq!(rows.columns[1].values, Values::Numbers(vec![7.0; 20]));
    let object = element(
        14,
        &[element(6, &[17_u32.to_le_bytes(), [0; 4]].concat()), element(1, b"ts"), element(1, b"MCOS")].concat(),
    );
    let error = Table::from_mat(&mat5(&[object])).unwrap_err();
    assert!(error.contains("ts: an object of MATLAB") && error.contains("t = ts.Time"), "{error}");
}

#[test]
fn broken_matlab_files_never_panic() {
    let file = File::new();
    let good = mat5(&[
        matrix("wide", 2, 6, 0, &doubles(&[1.0, 2.0, 3.0, 4.0])),
        packed(&matrix("packed", 2, 6, 0, &doubles(&[1.0, 2.0, 3.0, 4.0]))),
    ]);
    let mut version_4 =
        [[0_u32; 5].map(u32::to_le_bytes).concat(), b"x\0".to_vec(), 1.5_f64.to_le_bytes().to_vec()].concat();
    version_4[4] = 1;
    version_4[8] = 1;
    version_4[16] = 2;
    let table = Table::read(&file.write("four.mat", &version_4), &TableFormat::default()).unwrap();
    assert_eq!(columns(&table), [column("x", "", &[1.5])]);
    let mut numbers = Numbers(0x1234_5678_9abc_def1);
    for round in 0..1500 {
        let mut bytes = if round % 2 == 0 { good.clone() } else { version_4.clone() };
        for _ in 0..1 + numbers.below(4) {
            let at = numbers.below(bytes.len());
            bytes[at] = [0, 1, 0x7f, 0x80, 0xff, numbers.below(256) as u8][numbers.below(6)];
        }
        if round % 5 == 0 {
            bytes.truncate(numbers.below(bytes.len()));
        }
        let _ = Table::read(&file.write("broken.mat", &bytes), &TableFormat::default());
    }
}

proptest! {
    #[test]
    fn numbers_survive_every_dialect(
        rows in prop::collection::vec((-1e9..1e9_f64, -1.0..1.0_f64, 0.0..1e-12_f64), 2..30),
        dialect in 0..4_usize,
    ) {
        let (delimiter, decimal) = [(",", "."), (";", ","), ("\t", "."), (";", ".")][dialect];
        let line = |cells: Vec<String>| cells.join(delimiter) + "\n";
        let mut text = line(vec!["a".into(), "b [mm]".into(), "c".into()]);
        for (a, b, c) in &rows {
            text += &line([a, b, c].map(|value| value.to_string().replace('.', decimal)).to_vec());
        }
        let file = File::new();
        let table = file.csv(&text);
        let expected = [
            column("a", "", &rows.iter().map(|row| row.0).collect::<Vec<_>>()),
            column("b", "mm", &rows.iter().map(|row| row.1).collect::<Vec<_>>()),
            column("c", "", &rows.iter().map(|row| row.2).collect::<Vec<_>>()),
        ];
        prop_assert_eq!(columns(&table), expected);
    }

    #[test]
    fn random_text_never_panics(text in "[-0-9a-z,;.\t\" \n\r\\[\\]/#:äµ²]{0,200}", bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let file = File::new();
        for content in [text.as_bytes(), &bytes] {
            for name in ["table.csv", "table.mat"] {
                let _ = Table::read(&file.write(name, content), &TableFormat::default());
            }
        }
    }
}
