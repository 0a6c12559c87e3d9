//! Other people's data through the program: import, guess, maps in every verb, info.

use std::path::{Path, PathBuf};

use crate::common::{assert_one_clear_line, complaint, excavator, json, shared};

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../bags/samples").join(name)
}

fn map(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../config/maps").join(name)
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Panics unless the program succeeded, and gives what it printed.
fn printed(folder: &Path, words: &[&str]) -> String {
    let output = excavator(folder, words);
    assert!(output.status.success(), "{words:?}: {}", complaint(&output));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_table_becomes_a_bag_that_every_verb_takes() {
    let folder = tempfile::tempdir().unwrap();
    let line = printed(folder.path(), &["import", text(&sample("arm-swing.csv")), "-o", "swing"]);
    assert!(line.contains("501 samples") && line.contains("arm.cap_pressure"), "{line}");
    let compare =
        |bag: &str| json(&excavator(folder.path(), &["compare", "--model", "zx30u-arm", "--bag", bag, "--json", "-"]));
    let imported = compare("swing");
    // The table itself, and the same recording as topics of other people, through the maps beside them.
    assert_eq!(compare(text(&sample("arm-swing.csv"))), imported);
    let foreign = compare(text(&sample("joint-states")));
    for signal in ["arm.displacement", "arm.cap_pressure", "arm.rod_pressure"] {
        let nmse = |value: &serde_json::Value| value["signals"][signal]["nmse"].as_f64().unwrap();
        assert!((nmse(&foreign) - nmse(&imported)).abs() < 1e-6, "{signal}: {} {}", nmse(&foreign), nmse(&imported));
    }
    let output = excavator(folder.path(), &["import", text(&sample("arm-swing.csv")), "-o", "swing"]);
    assert_one_clear_line(&output, &["swing exists already"]);
}

#[test]
fn a_guess_can_be_written_corrected_and_used() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("drive.csv");
    std::fs::copy(sample("arm-swing.csv"), &table).unwrap();
    let output = excavator(folder.path(), &["import", "drive.csv", "-o", "bag"]);
    assert_one_clear_line(&output, &["drive.csv", "--map", "--guess"]);
    let shown = printed(folder.path(), &["import", "drive.csv", "--guess", "-o", "guessed.toml"]);
    assert!(shown.contains("signal = \"arm.rod_pressure\"") && shown.contains("# the heading says so"), "{shown}");
    assert_eq!(std::fs::read_to_string(folder.path().join("guessed.toml")).unwrap().trim_end(), shown.trim_end());
    printed(folder.path(), &["import", "drive.csv", "--map", "guessed.toml", "-o", "bag"]);
    let info = json(&excavator(folder.path(), &["info", "bag", "--json", "-"]));
    let measured: Vec<&str> =
        info["signals"]["measured"].as_array().unwrap().iter().map(|signal| signal["name"].as_str().unwrap()).collect();
    assert!(measured.contains(&"arm.displacement") && measured.contains(&"pump_pressure"), "{measured:?}");
}

#[test]
fn info_says_what_is_there_and_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    // A copy with a short name: lines hold the name of the bag, and their width is checked.
    std::fs::create_dir(folder.path().join("machine")).unwrap();
    for file in std::fs::read_dir(sample("joint-states")).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), folder.path().join("machine").join(file.file_name())).unwrap();
    }
    let shown = printed(folder.path(), &["info", "machine"]);
    for part in
        ["/joint_states", "sensor_msgs/JointState", "125.0", "arm.orifice_command", "arm motion: can be identified"]
    {
        assert!(shown.contains(part), "\"{part}\" is missing in:\n{shown}");
    }
    assert!(shown.lines().all(|line| line.chars().count() <= 110), "{shown}");
    let other = folder.path().join("other");
    std::fs::create_dir(&other).unwrap();
    std::fs::copy(sample("joint-states/joint-states.db3"), other.join("other.db3")).unwrap();
    let shown = printed(folder.path(), &["info", "other"]);
    assert!(shown.contains("has no topic /arm/state") && shown.contains("import --guess"), "{shown}");
    let output = excavator(folder.path(), &["info", "other", "--map", "missing.toml"]);
    assert_one_clear_line(&output, &["missing.toml"]);
}

#[test]
fn info_of_a_table_without_map_shows_its_columns() {
    let folder = tempfile::tempdir().unwrap();
    let table = "when,lever [%],x [mm],note\n2026-05-04T09:30:00Z,-20,150,a\n2026-05-04T09:30:01Z,40,,b\n";
    std::fs::write(folder.path().join("drive.csv"), table).unwrap();
    let shown = printed(folder.path(), &["info", "drive.csv", "--json", "info.json"]);
    for part in
        ["2 rows, 4 columns", "2026-05-04T09:30:01Z", "-20.00", "50.0 %", "100.0 %", "clock: when", "import --guess"]
    {
        assert!(shown.contains(part), "\"{part}\" is missing in:\n{shown}");
    }
    let written: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("info.json")).unwrap()).unwrap();
    assert_eq!((&written["columns"][2]["name"], &written["columns"][2]["unit"]), (&"x".into(), &"mm".into()));
    std::fs::write(folder.path().join("empty.csv"), "").unwrap();
    assert_one_clear_line(&excavator(folder.path(), &["info", "empty.csv"]), &["empty.csv", "no rows"]);
}

#[test]
fn a_wrong_map_is_told_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let data = sample("arm-swing.csv");
    for (content, parts) in [
        ("[[signals]]\nsignal = \"arm.stroke\"\ncolumn = 1\n", &["map.toml", "arm.stroke", "displacement"][..]),
        (
            "[[signals]]\nsignal = \"arm.displacement\"\ncolumn = \"p_A\"\n",
            &["arm.displacement is a length", "pressure"],
        ),
        ("[[signals]]\nsignal = \"arm.displacement\"\ncolumn = \"weg2\"\n", &["no column \"weg2\"", "Weg"]),
        ("signals = 3", &["map.toml"]),
    ] {
        std::fs::write(folder.path().join("map.toml"), content).unwrap();
        let output = excavator(folder.path(), &["import", text(&data), "--map", "map.toml", "-o", "bag"]);
        assert_one_clear_line(&output, parts);
    }
}

/// Rows of a table at 100 Hz with a displacement in mm and a pressure in bar.
fn rows(count: usize) -> String {
    let row = |i: usize| format!("{},{},{}\n", i as f64 / 100.0, i % 50, 100 + i % 7);
    "t,x [mm],Druck A [bar]\n".to_string() + &(0..count).map(row).collect::<String>()
}

const PIECES: &str = r#"
[names]
p = "Druck A [bar]"

[[signals]]
signal = "arm.displacement"
column = "x"

[[signals]]
signal = "arm.cap_pressure"
formula = "p * 1e5"
"#;

#[test]
fn several_files_become_one_recording() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("a.csv", &rows(300));
    write("b.csv", &rows(200));
    write("map.toml", PIECES);
    let output = excavator(folder.path(), &["import", "a.csv", "b.csv", "--map", "map.toml", "-o", "drives"]);
    assert!(output.status.success(), "{}", complaint(&output));
    let (line, told) = (String::from_utf8_lossy(&output.stdout), complaint(&output));
    assert!(line.contains("2 files, 500 samples") && line.contains("arm.cap_pressure"), "{line}");
    assert!(told.contains("b.csv counts time from its own start: it begins 10.010 s after the end of a.csv"), "{told}");
    // The bag has the pieces.
    let info = json(&excavator(folder.path(), &["info", "drives", "--json", "-"]));
    assert!(info["duration"].as_f64().unwrap() > 14.9, "{info:#}");
    // A table beside the data, by the command line and with a clock of its own.
    write("daq.csv", "Sampling rate: 10 Hz\np_B [bar]\n5\n6\n7\n8\n9\n10\n");
    write("join.toml", &(PIECES.to_string() + "\n[[signals]]\nsignal = \"arm.rod_pressure\"\ncolumn = \"p_B\"\n"));
    let words = ["import", "a.csv", "--join", "daq.csv", "--map", "join.toml", "-o", "joined"];
    let output = excavator(folder.path(), &words);
    assert!(output.status.success(), "{}", complaint(&output));
    assert!(complaint(&output).contains("10 rows per second"), "{}", complaint(&output));
    assert!(String::from_utf8_lossy(&output.stdout).contains("arm.rod_pressure"));
    let output =
        excavator(folder.path(), &["import", "a.csv", "b.csv", "--join", "daq.csv", "--map", "join.toml", "-o", "c"]);
    assert_one_clear_line(&output, &["--join goes with one file"]);
    let output = excavator(folder.path(), &["import", "a.csv", "--join", "daq.csv", "-o", "c"]);
    assert_one_clear_line(&output, &["daq.csv", "--map"]);
    let output = excavator(folder.path(), &["import", "a.csv", "--join", "none.csv", "--map", "join.toml", "-o", "c"]);
    assert_one_clear_line(&output, &["none.csv"]);
    let output = excavator(folder.path(), &["import", "a.csv", "b.csv", "--guess"]);
    assert_one_clear_line(&output, &["guessed from one file, not from 2"]);
    write("wrong.toml", &PIECES.replace("p * 1e5", "q * 1e5"));
    let output = excavator(folder.path(), &["import", "a.csv", "--map", "wrong.toml", "-o", "c"]);
    assert_one_clear_line(&output, &["arm.cap_pressure: formula: unknown name \"q\"", "it may use p"]);
}

#[test]
fn a_spreadsheet_is_guessed_and_imported() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(sample("xlsx/arm-swing.xlsx"), folder.path().join("drive.xlsx")).unwrap();
    printed(folder.path(), &["import", "drive.xlsx", "--guess", "-o", "map.toml"]);
    let line = printed(folder.path(), &["import", "drive.xlsx", "--map", "map.toml", "-o", "bag"]);
    assert!(line.contains("60 samples") && line.contains("arm.displacement"), "{line}");
    std::fs::write(folder.path().join("empty.xlsx"), "").unwrap();
    let output = excavator(folder.path(), &["import", "empty.xlsx", "--map", "map.toml", "-o", "other"]);
    assert_one_clear_line(&output, &["empty.xlsx", "no spreadsheet"]);
}

#[test]
fn what_is_not_sure_is_not_taken() {
    let folder = tempfile::tempdir().unwrap();
    let mut table = "t,stroke [mm],position [mm],p_pump [bar],pressure 7,pressure 8\n".to_string();
    for i in 0..300 {
        let swing = (0.05 * f64::from(i)).sin();
        let (t, x, y) = (0.01 * f64::from(i), 90.0 * swing, 80.0 * swing);
        table += &format!("{t},{x},{y},{},{},{}\n", 200.0 + swing, 9.0 + swing, 7.0 - swing);
    }
    std::fs::write(folder.path().join("drive.csv"), table).unwrap();
    let output = excavator(folder.path(), &["import", "drive.csv", "--guess", "-o", "map.toml"]);
    assert!(output.status.success(), "{}", complaint(&output));
    let (shown, told) = (String::from_utf8_lossy(&output.stdout), complaint(&output));
    assert!(told.contains("not sure of 3 signals") && told.contains("arm.cap_pressure"), "{told}");
    assert!(shown.contains("# sure: named"), "{shown}");
    assert!(shown.contains("# signal = \"arm.displacement\"") && shown.contains("unsure: "), "{shown}");
    assert!(shown.contains("#   or column = \"position\""), "{shown}");
    let line = printed(folder.path(), &["import", "drive.csv", "--map", "map.toml", "-o", "bag"]);
    assert!(
        line.contains("pump_pressure") && !line.contains("displacement") && !line.contains("cap_pressure"),
        "{line}"
    );
    // Without the marks it is a map of everything.
    let bare = |line: &str| match line.strip_prefix("# ") {
        Some(rest) if rest.starts_with("[[") || rest.split(" = ").next().is_some_and(|key| !key.contains(' ')) => {
            rest.to_string()
        }
        _ => line.to_string(),
    };
    let map: String = shown.lines().map(|line| bare(line) + "\n").collect();
    std::fs::write(folder.path().join("whole.toml"), map).unwrap();
    let line = printed(folder.path(), &["import", "drive.csv", "--map", "whole.toml", "-o", "whole"]);
    assert!(line.contains("arm.displacement") && line.contains("arm.rod_pressure"), "{line}");
}

#[test]
fn emps_is_identified_straight_from_its_matlab_file() {
    let Some(shared) = shared() else { return };
    let folder = tempfile::tempdir().unwrap();
    let identify = |words: &[&str]| {
        let words = [&["identify", "--model", "emps", "--method", "weak-form", "--json", "-", "--bag"], words].concat();
        json(&excavator(folder.path(), &words))
    };
    let table = shared.join("realdata/emps/DATA_EMPS.mat");
    let from_table = identify(&[text(&table), "--map", text(&map("emps.toml"))]);
    let from_bag = identify(&[text(&shared.join("realdata/emps/identification"))]);
    for (a, b) in from_table["parameters"].as_array().unwrap().iter().zip(from_bag["parameters"].as_array().unwrap()) {
        let (found, expected) = (a["value"].as_f64().unwrap(), b["value"].as_f64().unwrap());
        println!("{}: {found} from the table, {expected} from the bag", a["name"]);
        // Stamps differ by up to 128 ns.
        assert!((found - expected).abs() < 1e-3 * expected.abs(), "{}: {found} {expected}", a["name"]);
    }
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    /// Measured friction of a seal at four pressures (bags/samples/seal-friction): the level rises with the pressure, a model
    /// with a constant level is missing that, and the slope is that of the measurement's authors.
    #[test]
    fn seal_friction_that_grows_with_pressure_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let rig = sample("seal-friction/rig.toml");
        let map = sample("seal-friction/map.toml");
        let table = |pressure: u8| sample(&format!("seal-friction/O-ring_{pressure}bar.csv"));
        let (one, three, five, seven) = (table(1), table(3), table(5), table(7));
        let words = ["diagnose", "--model", text(&rig), "--map", text(&map), "--json", "-"];
        let recordings = ["--identification", text(&one), text(&five), "--validation", text(&three), text(&seven)];
        let diagnosis = json(&excavator(folder.path(), &[&words[..], &recordings[..]].concat()));
        let first = &diagnosis["candidates"][0];
        assert_eq!(first["effect"], "pressure_dependent_friction", "{diagnosis:#}");
        assert_eq!(first["tied_with_first"], false, "{diagnosis:#}");
    }
}
