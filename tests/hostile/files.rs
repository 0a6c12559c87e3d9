//! Files that the program writes: nothing that exists is lost, and names of others do nothing to a terminal.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Instant;

use excavator_bags::{Topics, write_recording};
use excavator_model::recording::Recording;
use rosbag2::WriteOptions;

use crate::hostile::child::run;
use crate::hostile::fault::Fault;

const PROGRAM: &str = env!("CARGO_BIN_EXE_excavator");

fn excavator(folder: &Path, words: &[&str]) -> Output {
    Command::new(PROGRAM).args(words).current_dir(folder).output().unwrap()
}

/// Exit status 1 and one line that has all of `parts`.
fn refused(folder: &Path, words: &[&str], parts: &[&str]) -> String {
    let output = excavator(folder, words);
    let line = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{words:?}: {line}");
    assert_eq!(line.lines().filter(|line| line.starts_with("excavator: ")).count(), 1, "{line}");
    assert!(parts.iter().all(|part| line.contains(part)), "{parts:?} in: {line}");
    line
}

fn succeeds(folder: &Path, words: &[&str]) -> String {
    let output = excavator(folder, words);
    assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn read(path: &Path) -> Vec<u8> {
    std::fs::read(path).unwrap()
}

/// A folder with a bag of the built-in arm at rest in it.
fn with_bag() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    let profile = "[[profiles]]\ncylinder = \"arm\"\nsegments = [{ kind = \"sine\", duration = 2.0, amplitude = 5e-5, \
                   frequency = 0.5 }]\n";
    std::fs::write(folder.path().join("profile.toml"), profile).unwrap();
    succeeds(folder.path(), &["simulate", "--model", "zx30u-arm", "--input", "profile.toml", "-o", "bag"]);
    (folder, bag)
}

const TABLE: &str = "time [s],arm stroke [mm]\n0,1\n0.1,2\n0.2,3\n0.3,4\n";

#[test]
fn a_guessed_map_does_not_replace_its_table() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("t.csv");
    std::fs::write(&table, TABLE).unwrap();
    let words = ["import", "--guess", "t.csv", "-o", "t.csv"];
    refused(folder.path(), &words, &["t.csv would be lost", "read by this command"]);
    refused(folder.path(), &[&words[..], &["--force"]].concat(), &["t.csv would be lost"]);
    assert_eq!(read(&table), TABLE.as_bytes());
    succeeds(folder.path(), &["import", "--guess", "t.csv", "-o", "map.toml"]);
    refused(folder.path(), &["import", "--guess", "t.csv", "-o", "map.toml"], &["map.toml exists already", "--force"]);
    succeeds(folder.path(), &["import", "--guess", "t.csv", "-o", "map.toml", "--force"]);
    Fault {
        group: "Files",
        tried: "`import --guess t.csv -o t.csv`",
        outcome: "refused, also with `--force`; the table is unchanged",
    }
    .survived(&[]);
}

#[test]
fn a_report_does_not_replace_a_part_of_its_bag() {
    let (folder, bag) = with_bag();
    let part = bag.join("bag_0.mcap");
    let before = read(&part);
    let words = ["compare", "--model", "zx30u-arm", "--bag", "bag", "--report", "bag/bag_0.mcap", "--force"];
    let start = Instant::now();
    refused(folder.path(), &words, &["bag_0.mcap would be lost", "read by this command"]);
    let took = start.elapsed();
    let metadata = ["compare", "--model", "zx30u-arm", "--bag", "bag@0..1", "--json", "bag/metadata.yaml", "--force"];
    refused(folder.path(), &metadata, &["metadata.yaml would be lost"]);
    std::fs::hard_link(&part, folder.path().join("other-name")).unwrap();
    let hard = ["compare", "--model", "zx30u-arm", "--bag", "bag", "--json", "other-name", "--force"];
    refused(folder.path(), &hard, &["other-name would be lost"]);
    assert_eq!(read(&part), before);
    Fault {
        group: "Files",
        tried: "`compare --bag bag --report bag/bag_0.mcap`, also by another name of the file",
        outcome: "refused before anything is computed, also with `--force`; the bag is unchanged",
    }
    .survived(&[("time to the refusal [s]", format!("{:.2}", took.as_secs_f64()))]);
}

#[test]
fn results_do_not_replace_the_model() {
    let (folder, _) = with_bag();
    let text = "machine = \"zx30u-arm\"\n";
    let model = folder.path().join("model.toml");
    let identify = ["identify", "--model", "zx30u-arm", "--bag", "bag", "-o", "model.toml"];
    succeeds(folder.path(), &identify);
    let before = read(&model);
    assert_ne!(before, text.as_bytes());
    refused(folder.path(), &identify, &["model.toml exists already", "--force"]);
    let json = ["compare", "--model", "model.toml", "--bag", "bag", "--json", "model.toml", "--force"];
    refused(folder.path(), &json, &["model.toml would be lost"]);
    let both = ["identify", "--model", "zx30u-arm", "--bag", "bag", "-o", "new.toml", "--json", "./new.toml"];
    refused(folder.path(), &both, &["new.toml would be lost", "-o is the same file"]);
    assert_eq!(read(&model), before);
    // Its own successor, with a longer history, when that is asked for.
    let again = ["identify", "--model", "model.toml", "--bag", "bag", "-o", "model.toml", "--force"];
    succeeds(folder.path(), &again);
    assert!(read(&model).len() > before.len());
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| !name.to_string_lossy().starts_with('.')), "{left:?}");
    Fault {
        group: "Files",
        tried: "`--json model.toml`, and `identify -o` on a model that exists",
        outcome: "refused; with `--force` `-o` makes the model its own successor, `--json` is still refused",
    }
    .survived(&[]);
}

#[test]
fn nothing_is_written_through_a_symbolic_link() {
    let (folder, _) = with_bag();
    let target = folder.path().join("target");
    std::fs::write(&target, "precious").unwrap();
    std::os::unix::fs::symlink(&target, folder.path().join("link")).unwrap();
    std::os::unix::fs::symlink(folder.path().join("nowhere"), folder.path().join("dangling")).unwrap();
    std::os::unix::fs::symlink(folder.path().join("bag"), folder.path().join("bag-link")).unwrap();
    for (words, name) in [
        (vec!["info", "bag", "--json", "link"], "link is a symbolic link"),
        (vec!["info", "bag", "--json", "link", "--force"], "link is a symbolic link"),
        (vec!["info", "bag", "--json", "dangling"], "dangling is a symbolic link"),
        (vec!["import", "bag", "-o", "bag-link", "--force"], "bag-link is a symbolic link"),
        (vec!["import", "bag", "-o", "dangling"], "dangling is a symbolic link"),
    ] {
        refused(folder.path(), &words, &[name]);
    }
    assert_eq!(read(&target), b"precious");
    assert!(!folder.path().join("nowhere").exists());
    // What a user names explicitly: devices, and what the shell has opened.
    succeeds(folder.path(), &["info", "bag", "--json", "/dev/null"]);
    let shown = succeeds(folder.path(), &["info", "bag", "--json", "/dev/stdout"]);
    assert!(shown.contains("\"message_count\""), "{shown}");
    Fault {
        group: "Files",
        tried: "`--json` and `-o` at a symbolic link, also a dangling one",
        outcome: "refused, also with `--force`; `/dev/null`, `/dev/stdout` and pipes are written",
    }
    .survived(&[]);
}

#[test]
fn bags_are_replaced_by_force_alone_and_only_where_they_are_bags() {
    let (folder, bag) = with_bag();
    let simulate = ["simulate", "--model", "zx30u-arm", "--input", "profile.toml", "-o", "bag"];
    refused(folder.path(), &simulate, &["bag exists already", "--force"]);
    refused(
        folder.path(),
        &["simulate", "--model", "zx30u-arm", "--input", "bag", "-o", "bag", "--force"],
        &["bag would be lost"],
    );
    succeeds(folder.path(), &[&simulate[..], &["--force"]].concat());
    std::fs::write(bag.join("notes.txt"), "text").unwrap();
    refused(folder.path(), &[&simulate[..], &["--force"]].concat(), &["notes.txt in it is no part of a bag"]);
    assert_eq!(read(&bag.join("notes.txt")), b"text");
    Fault {
        group: "Files",
        tried: "`simulate -o` and `import -o` on a bag or folder that exists",
        outcome: "refused; with `--force` a bag is replaced when the new one is complete, a folder with anything else is not",
    }
    .survived(&[]);
}

/// What a terminal acts on, in names of columns and topics: a new title, a cleared screen, 8-bit control sequences, and text
/// that runs backwards.
const ESCAPES: &str = "\u{1b}]0;owned\u{7}\u{1b}[2J\u{9b}31m\u{202e}";

fn is_safe(bytes: &[u8]) {
    let text = String::from_utf8(bytes.to_vec()).unwrap();
    let acts = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
    assert!(!text.chars().any(acts), "{text:?}");
}

#[test]
fn names_of_others_do_nothing_to_a_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let table = format!("time [s],{ESCAPES}x [mm]\n0,1\n0.1,2\n0.2,3\n0.3,4\n");
    std::fs::write(folder.path().join("t.csv"), table).unwrap();
    let mut recording = Recording::unmeasured("bag", (0..100).map(|i| 0.01 * f64::from(i)).collect(), &["arm"]);
    recording.cylinders[0].name = format!("arm{ESCAPES}");
    recording.cylinders[0].displacement.fill(0.1);
    let topics = Topics { state: format!("/state{ESCAPES}"), ..Topics::default() };
    let bag = format!("bag{ESCAPES}");
    write_recording(&folder.path().join(&bag), &recording, &topics, &WriteOptions::default()).unwrap();
    let mut lines = 0;
    for words in [
        vec!["info", "t.csv"],
        vec!["info", &bag],
        vec!["info", &format!("none{ESCAPES}")],
        vec!["compare", "--model", "zx30u-arm", "--bag", &bag],
        vec!["import", "t.csv", "-o", "out", "--map", &format!("map{ESCAPES}")],
        vec!["import", "--guess", &format!("another{ESCAPES}")],
    ] {
        let output = excavator(folder.path(), &words);
        is_safe(&output.stdout);
        is_safe(&output.stderr);
        // What the usage is printed with leaves the longer escapes out.
        let visible = |bytes: &[u8]| String::from_utf8_lossy(bytes).contains("\\u{9b}31m\\u{202e}");
        assert!(visible(&output.stdout) || visible(&output.stderr), "{words:?}: {output:?}");
        lines += 1;
    }
    Fault {
        group: "Files",
        tried: "terminal escapes in names of columns, topics, cylinders and files",
        outcome: "shown as `\\u{1b}` and the like, in tables, errors, warnings, logs and usage",
    }
    .survived(&[("commands tried", lines.to_string())]);
}

fn hold(folder: &Path, duration: f64) {
    let text = format!(
        "[[profiles]]\ncylinder = \"arm\"\nsegments = [{{ kind = \"hold\", duration = {duration:?}, area = 0.0 }}]\n"
    );
    std::fs::write(folder.join("profile.toml"), text).unwrap();
}

const SIMULATE: [&str; 7] = ["simulate", "--model", "zx30u-arm", "--input", "profile.toml", "-o", "bag"];

#[test]
fn a_profile_of_twelve_days_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    hold(folder.path(), 1e6);
    let done = run(folder.path(), &SIMULATE, 10.0);
    done.refused(&["1000000 s", "1000 samples per second", "limit"]);
    let peak = done.megabytes;
    assert!(peak < 100.0, "{peak} MB");
    Fault {
        group: "Files",
        tried: "a profile with `duration = 1e6`",
        outcome: "refused before anything is computed; the line names duration, rate and the limit",
    }
    .survived(&[("peak memory [MB]", format!("{peak:.0}"))]);
}

#[test]
#[ignore = "takes a minute"]
fn the_longest_profile_stays_within_its_memory() {
    let folder = tempfile::tempdir().unwrap();
    hold(folder.path(), 3600.0);
    let done = run(folder.path(), &SIMULATE, 600.0);
    assert_eq!(done.status, Some(0), "{}", done.complaint);
    let peak = done.megabytes;
    assert!(peak < 1000.0, "{peak} MB");
    Fault {
        group: "Files",
        tried: "the longest profile that is simulated, an hour at 1 kHz",
        outcome: "simulated within bounded memory",
    }
    .survived(&[("peak memory [MB]", format!("{peak:.0}")), ("processor time [s]", format!("{:.0}", done.seconds))]);
}
