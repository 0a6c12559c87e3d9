//! The test itself inside a network namespace, and what it sees of the programs there.

use std::fs::File;
use std::process::Command;

use excavator_msgs::{Header, OrificeCommand, Time};
use excavator_ros::{RosArguments, Supervisor};
use nix::sched::{CloneFlags, setns};

use crate::live::Network;

/// Runs `work` on a thread in the namespace of `network` and waits for it; threads that it starts are there too.
pub fn inside<T: Send + 'static>(network: &Network, work: impl FnOnce() -> T + Send + 'static) -> T {
    match start_inside(network, work).join() {
        Ok(result) => result,
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// Starts `work` on a thread in the namespace of `network`.
pub fn start_inside<T: Send + 'static>(
    network: &Network,
    work: impl FnOnce() -> T + Send + 'static,
) -> std::thread::JoinHandle<T> {
    // Opened here: the name may be gone when the thread starts, the namespace is not.
    let namespace = File::open(format!("/run/netns/{}", network.name())).unwrap();
    std::thread::spawn(move || {
        setns(namespace, CloneFlags::CLONE_NEWNET).unwrap();
        work()
    })
}

/// A command for the arm, stamped with the time of now: without a stamp the gate refuses it.
pub fn command_of_now(area: f64) -> OrificeCommand {
    let since_1970 = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap();
    let stamp = Time::from_nanoseconds(since_1970.as_nanos() as i64).unwrap();
    let header = Header { stamp, frame_id: String::new() };
    OrificeCommand { header, names: vec!["arm".to_string()], areas: vec![area] }
}

/// Peak memory of the program in the namespace whose command line has `word`, MB.
pub fn peak_memory(network: &Network, word: &str) -> f64 {
    let listed = Command::new("ip").args(["netns", "pids", network.name()]).output().unwrap();
    for pid in String::from_utf8(listed.stdout).unwrap().split_whitespace() {
        let read = |file: &str| std::fs::read_to_string(format!("/proc/{pid}/{file}")).unwrap_or_default();
        if read("cmdline").contains(word) {
            let status = read("status");
            let line = status.lines().find(|line| line.starts_with("VmHWM:")).unwrap();
            return line.split_whitespace().nth(1).unwrap().parse::<f64>().unwrap() / 1024.0;
        }
    }
    panic!("no program with {word} in {}", network.name());
}

/// A node of the test itself, on the thread that runs inside the network.
pub fn node_of_the_test(name: &str) -> Supervisor {
    let ros = RosArguments::default();
    Supervisor::start(name, &ros, Vec::new()).unwrap()
}
