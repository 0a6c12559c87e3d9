//! What happens to a recording: its file goes, its disk is full, everybody is told to end at once.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use excavator_msgs::ArmState;

use crate::hostile::fault::Fault;
use crate::live::{Network, Program, folder, kill, messages, records, until};

const PROGRAM: &str = env!("CARGO_BIN_EXE_excavator");
/// Bytes at both ends of an MCAP file.
const MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// Waits for something; returns how long it took.
fn duration_of(what: &str, happened: impl FnMut() -> bool) -> Duration {
    let start = Instant::now();
    until(what, happened);
    start.elapsed()
}

fn size(path: &Path) -> u64 {
    path.metadata().map_or(0, |found| found.len())
}

/// Whether the file is closed.
fn is_closed(path: &Path) -> bool {
    std::fs::read(path).is_ok_and(|bytes| bytes.len() > 2 * MAGIC.len() && bytes.ends_with(MAGIC))
}

/// Messages of the state in a bag that is closed, described and in good order: as many as its metadata say.
fn states_of_whole(bag: &Path) -> usize {
    let report = rosbag2::info(bag).unwrap();
    assert!(report.problems.is_empty(), "{:?}", report.problems);
    let states = messages::<ArmState>(bag, "/arm/state").len();
    let metadata = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
    let total = rosbag2::RawMessages::open(bag).unwrap().filter(Result::is_ok).count();
    assert!(metadata.contains(&format!("\n  message_count: {total}\n")), "{total} in {metadata}");
    states
}

#[test]
fn a_recorder_whose_file_is_deleted_says_so_and_goes_on() {
    let Some(network) = Network::new("gone") else { return };
    let (_keep, folder) = folder();
    let (bag, watch) = (folder.join("bag"), folder.join("watch"));
    let _simulator = network.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=200"]);
    let watcher = network.start(&["record", "/diagnostics", "-o", watch.to_str().unwrap()]);
    let recorder = network.start(&["record", "/arm/state", "-o", bag.to_str().unwrap()]);
    let (first, second) = (bag.join("bag_0.mcap"), bag.join("bag_1.mcap"));
    until("something to be recorded", || size(&first) > 5000);
    std::fs::remove_file(&first).unwrap();
    let noticed = duration_of("the deletion to be noticed", || recorder.log().contains("bag_0.mcap ("));
    until("the bag to go on", || size(&second) > 5000);
    until("the watcher to hear of it", || text_of(&watch).contains("was deleted or moved"));
    recorder.signal("-INT");
    let (status, log) = recorder.wait();
    assert_eq!(status, 1, "{log}");
    assert!(
        log.contains("in files that are gone") && log.contains("excavator: files of the recording were deleted"),
        "{log}"
    );
    let states = states_of_whole(&bag);
    assert!(states > 10, "{states}");
    watcher.interrupt();
    Fault {
        group: "Recorder",
        tried: "the file that is being recorded to is deleted",
        outcome: "an error in log and diagnostics, another file of the bag, exit status 1 with what is gone",
    }
    .survived(&[("time to the message [s]", format!("{:.2}", noticed.as_secs_f64()))]);
}

/// What is in the messages of a bag that is being written, as text.
fn text_of(bag: &Path) -> String {
    let Ok(found) = rosbag2::RawMessages::open(bag) else { return String::new() };
    found.flatten().map(|message| String::from_utf8_lossy(&message.data).into_owned()).collect()
}

#[test]
fn a_recorder_whose_folder_is_moved_completes_it_and_goes_on() {
    let Some(network) = Network::new("moved") else { return };
    let (_keep, folder) = folder();
    let (bag, moved) = (folder.join("bag"), folder.join("moved"));
    let _simulator = network.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=200"]);
    let recorder = network.start(&["record", "/arm/state", "-o", bag.to_str().unwrap()]);
    until("something to be recorded", || size(&bag.join("bag_0.mcap")) > 5000);
    std::fs::rename(&bag, &moved).unwrap();
    let noticed = duration_of("the bag to go on", || size(&bag.join("bag_1.mcap")) > 5000);
    recorder.signal("-TERM");
    let (status, log) = recorder.wait();
    assert_eq!(status, 1, "{log}");
    assert!(is_closed(&moved.join("bag_0.mcap")));
    let (before, after) = (messages::<ArmState>(&moved, "/arm/state"), messages::<ArmState>(&bag, "/arm/state"));
    assert!(before.len() > 10 && after.len() == states_of_whole(&bag), "{} {}", before.len(), after.len());
    // Not one state is between the two.
    let stamp = |state: &(f64, ArmState)| state.1.header.stamp.nanoseconds();
    let gap = stamp(&after[0]) - stamp(&before[before.len() - 1]);
    assert!((4_000_000..6_000_000).contains(&gap), "{gap} ns at 200 Hz");
    Fault {
        group: "Recorder",
        tried: "the folder that is being recorded to is moved",
        outcome: "the moved file is complete, the bag goes on at its place without a gap, exit status 1",
    }
    .survived(&[("time to the new file's data [s]", format!("{:.2}", noticed.as_secs_f64()))]);
}

/// A small disk in memory, gone when dropped.
struct Disk(PathBuf);

impl Disk {
    fn new(path: PathBuf, bytes: &str) -> Option<Disk> {
        std::fs::create_dir(&path).unwrap();
        let size = format!("size={bytes}");
        let words = ["-t", "tmpfs", "-o", &size, "none", path.to_str().unwrap()];
        if Command::new("mount").args(words).stderr(Stdio::null()).status().is_ok_and(|status| status.success()) {
            return Some(Disk(path));
        }
        println!("skipped: file systems cannot be mounted here (root is needed)");
        None
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").args(["-l", self.0.to_str().unwrap()]).status();
    }
}

#[test]
fn a_full_disk_ends_the_recording_with_a_closed_bag() {
    let Some(network) = Network::new("full") else { return };
    let (_keep, folder) = folder();
    let _simulator = network.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=1000"]);
    let mut measured = Vec::new();
    for (compression, bytes) in [("none", "1m"), ("zstd", "512k"), ("lz4", "512k")] {
        let Some(disk) = Disk::new(folder.join(compression), bytes) else { return };
        let bag = disk.0.join("bag");
        let words = ["record", "/arm/state", "--compression", compression, "-o", bag.to_str().unwrap()];
        let recorder = network.start(&words);
        let (status, log) = recorder.wait();
        assert_eq!(status, 1, "{log}");
        let line = log.lines().find(|line| line.starts_with("excavator: ")).unwrap();
        assert!(line.contains("no space left on the disk of") && line.contains("bag_0.mcap"), "{line}");
        assert!(is_closed(&bag.join("bag_0.mcap")));
        let written = format!(" {} bytes of the recording", size(&bag.join("bag_0.mcap")) - 50);
        assert!(line.contains(&written), "{written} in: {line}");
        let states = states_of_whole(&bag);
        assert!(states > 500, "{states}");
        measured.push((compression, states.to_string()));
    }
    let named: Vec<(String, String)> =
        measured.into_iter().map(|(name, states)| (format!("messages in the bag, {name} [1]"), states)).collect();
    let measured: Vec<(&str, String)> = named.iter().map(|(name, states)| (name.as_str(), states.clone())).collect();
    Fault {
        group: "Recorder",
        tried: "the disk is full",
        outcome: "\"no space left\", with the bytes that are written; exit status 1; the bag has its metadata and is in good order",
    }
    .survived(&measured);
}

/// Starts everything and waits until something is recorded.
fn up(network: &Network, before: &[&str], bag: &Path, more: &[&str]) -> Program {
    let words = [before, &[PROGRAM, "up", "-o", bag.to_str().unwrap()], more].concat();
    let started = network.start_other(Path::new(words[0]), &words[1..], &[]);
    let name = format!("{}_0.mcap", bag.file_name().unwrap().to_str().unwrap());
    until("everything to be recorded", || {
        started.log().contains("recording /arm/state (") && size(&bag.join(&name)) > 20_000
    });
    started
}

/// Ctrl-C in a terminal, in three ways; returns how many of the bags are whole.
fn interrupted(rounds: usize) {
    let Some(network) = Network::new("group") else { return };
    let (_keep, folder) = folder();
    let mut slowest = Duration::ZERO;
    for round in 0..rounds {
        let bag = folder.join(format!("bag{round}"));
        let started = up(&network, &[], &bag, &[]);
        let children = started.children();
        assert_eq!(children.len(), 3);
        records(&bag, "/arm/state", 101);
        let start = Instant::now();
        // A terminal signals the whole group.
        started.signal_group("-INT");
        match round % 3 {
            // Also one who has put the parts into that group.
            1 => children.iter().for_each(|child| kill("-INT", &child.to_string())),
            // A person who does not want to wait.
            2 => {
                started.says("stopping");
                let _ = Command::new("kill").args(["-INT", &started.id().to_string()]).stderr(Stdio::null()).status();
            }
            _ => {}
        }
        let (status, log) = started.wait();
        slowest = slowest.max(start.elapsed());
        assert_eq!(status, 0, "{round}: {log}");
        assert!(is_closed(&bag.join(format!("bag{round}_0.mcap"))), "{round}: {log}");
        let written = states_of_whole(&bag);
        assert!(
            written > 100 && log.contains(&format!("/arm/state: {written} messages")),
            "{round}: {written} of {log}"
        );
    }
    Fault {
        group: "Recorder",
        tried: "Ctrl-C on `excavator up -o bag`: the terminal signals the whole group, also a second time",
        outcome: "all bags are closed and have their metadata; a third Ctrl-C ends at once",
    }
    .survived(&[
        ("bags whole [1]", format!("{rounds} of {rounds}")),
        ("slowest end [s]", format!("{:.1}", slowest.as_secs_f64())),
    ]);
}

#[test]
fn ctrl_c_closes_every_bag() {
    interrupted(3);
}

#[test]
#[ignore = "takes a minute"]
fn ctrl_c_closes_every_bag_nine_times() {
    interrupted(9);
}

#[test]
fn parts_end_with_a_parent_that_is_killed() {
    let Some(network) = Network::new("orphans") else { return };
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let started = up(&network, &[], &bag, &[]);
    let children = started.children();
    let start = Instant::now();
    started.signal("-KILL");
    let (_, log) = started.wait();
    let took = start.elapsed();
    until("all parts to be gone", || children.iter().all(|child| !Path::new(&format!("/proc/{child}")).exists()));
    assert!(is_closed(&bag.join("bag_0.mcap")) && states_of_whole(&bag) > 100, "{log}");
    Fault {
        group: "Recorder",
        tried: "`excavator up` is killed with SIGKILL",
        outcome: "simulator, monitor and recorder end by themselves; the bag is closed",
    }
    .survived(&[("time to the end of all [s]", format!("{:.1}", took.as_secs_f64()))]);
}

#[test]
fn a_script_that_is_deaf_to_ctrl_c_gets_whole_bags() {
    let Some(network) = Network::new("deaf") else { return };
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    // As a shell starts what runs in its background.
    let deaf = ["sh", "-c", "trap '' INT; exec \"$@\"", "sh"];
    let started = up(&network, &deaf, &bag, &["-d", "4"]);
    let (status, log) = started.wait();
    assert_eq!(status, 0, "{log}");
    assert!(is_closed(&bag.join("bag_0.mcap")) && states_of_whole(&bag) > 100, "{log}");
    Fault {
        group: "Recorder",
        tried: "`excavator up` in the background of a script, where SIGINT is ignored",
        outcome: "its parts are ended by SIGTERM; the bag is closed",
    }
    .survived(&[]);
}
