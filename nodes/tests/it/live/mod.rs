//! Programs of this package on networks of their own.
//!
//! A network namespace with a loopback that has multicast keeps tests apart from each other and from the machine. Where
//! namespaces cannot be made (no root), the tests that need them skip with a line that says so.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

const PROGRAM: &str = env!("CARGO_BIN_EXE_excavator");

/// A network namespace, gone when dropped.
pub struct Network {
    name: String,
}

fn ip(words: &[&str]) -> bool {
    Command::new("ip").args(words).stderr(Stdio::null()).stdout(Stdio::null()).status().is_ok_and(|s| s.success())
}

impl Network {
    /// A namespace with a loopback; `None`, with a line that says so, where that is not possible.
    pub fn new(name: &str) -> Option<Network> {
        let name = format!("exc-{name}-{}", std::process::id());
        if !ip(&["netns", "add", &name]) {
            println!("skipped: network namespaces cannot be made here (root and iproute2 are needed)");
            return None;
        }
        let network = Network { name };
        assert!(network.ip(&["link", "set", "lo", "up"]));
        assert!(network.ip(&["link", "set", "lo", "multicast", "on"]));
        assert!(network.ip(&["route", "add", "224.0.0.0/4", "dev", "lo"]));
        Some(network)
    }

    /// Two namespaces joined by a cable: 10.99.0.1 and 10.99.0.2.
    pub fn pair(name: &str) -> Option<(Network, Network)> {
        let (left, right) = (Network::new(&format!("{name}-a"))?, Network::new(&format!("{name}-b"))?);
        // Interface names have fifteen characters at most, and other tests of this process lay cables too.
        static CABLES: AtomicU32 = AtomicU32::new(0);
        let number = CABLES.fetch_add(1, Ordering::Relaxed);
        let (one, other) = (format!("xa{number}-{}", std::process::id()), format!("xb{number}-{}", std::process::id()));
        if !ip(&["link", "add", &one, "type", "veth", "peer", "name", &other]) {
            println!("skipped: virtual cables cannot be made here");
            return None;
        }
        for (network, cable, address) in [(&left, &one, "10.99.0.1/24"), (&right, &other, "10.99.0.2/24")] {
            assert!(ip(&["link", "set", cable, "netns", &network.name]));
            assert!(network.ip(&["link", "set", cable, "name", "cable"]));
            assert!(network.ip(&["addr", "add", address, "dev", "cable"]));
            assert!(network.ip(&["route", "del", "224.0.0.0/4", "dev", "lo"]));
            network.plug();
        }
        Some((left, right))
    }

    /// `ip` inside.
    pub fn ip(&self, words: &[&str]) -> bool {
        ip(&[&["-n", &self.name], words].concat())
    }

    /// Name of the namespace.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub fn unplug(&self) {
        assert!(self.ip(&["link", "set", "cable", "down"]));
    }

    pub fn plug(&self) {
        assert!(self.ip(&["link", "set", "cable", "up"]));
        // The route goes with the link.
        self.ip(&["route", "add", "224.0.0.0/4", "dev", "cable"]);
    }

    /// Starts our program inside.
    pub fn start(&self, words: &[&str]) -> Program {
        self.start_other(Path::new(PROGRAM), words, &[])
    }

    /// Starts another program inside.
    pub fn start_other(&self, program: &Path, words: &[&str], environment: &[(&str, &str)]) -> Program {
        let mut command = Command::new("ip");
        command.args(["netns", "exec", &self.name]).arg(program).args(words);
        command.env_remove("ROS_DOMAIN_ID").env_remove("RMW_IMPLEMENTATION").env_remove("ROS_LOCALHOST_ONLY");
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command.envs(environment.iter().copied());
        Program { child: command.spawn().unwrap() }
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        ip(&["netns", "del", &self.name]);
    }
}

/// A program of ours that runs; killed when dropped.
pub struct Program {
    child: Child,
}

impl Program {
    /// Number of the process.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    pub fn signal(&self, signal: &str) {
        assert!(Command::new("kill").args([signal, &self.child.id().to_string()]).status().unwrap().success());
    }

    /// Ctrl-C; returns exit status and log.
    pub fn interrupt(self) -> (i32, String) {
        self.signal("-INT");
        self.wait(Duration::from_secs(15))
    }

    /// Waits for the end; returns exit status and log.
    pub fn wait(mut self, time: Duration) -> (i32, String) {
        let end = Instant::now() + time;
        while self.child.try_wait().unwrap().is_none() {
            assert!(Instant::now() < end, "the program does not end");
            std::thread::sleep(Duration::from_millis(20));
        }
        let mut log = String::new();
        use std::io::Read;
        self.child.stderr.take().unwrap().read_to_string(&mut log).unwrap();
        (self.child.wait().unwrap().code().unwrap_or(-1), log)
    }

    pub fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub fn sleep(seconds: f64) {
    std::thread::sleep(Duration::from_secs_f64(seconds));
}

/// All messages of a topic: log time in s after the first message of the bag, and content.
pub fn messages<M: excavator_msgs::Message>(bag: &Path, topic: &str) -> Vec<(f64, M)> {
    let mut start = None;
    let mut found = Vec::new();
    for message in rosbag2::RawMessages::open(bag).unwrap() {
        let message = message.unwrap();
        let start = *start.get_or_insert(message.log_time);
        if message.topic.name == topic {
            let time = (message.log_time as f64 - start as f64) * 1e-9;
            found.push((time, rosbag2::cdr::decode(&message.data).unwrap()));
        }
    }
    found
}

/// An interpreter with another DDS, Eclipse Cyclone; `None`, with a line that says so, where there is none.
pub fn python_with_cyclone() -> Option<PathBuf> {
    let python = match std::env::var_os("EXCAVATOR_PYTHON") {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../.venv/bin/python"),
    };
    let found = Command::new(&python).args(["-c", "import cyclonedds"]).output().is_ok_and(|run| run.status.success());
    if !found {
        println!("skipped: {} has no cyclonedds (set EXCAVATOR_PYTHON to an interpreter that has)", python.display());
    }
    found.then_some(python)
}

/// Number that `custom_data` of a bag's metadata has under a key.
pub fn custom_number(bag: &Path, key: &str) -> u64 {
    let text = std::fs::read_to_string(bag.join("metadata.yaml")).unwrap();
    let line = text
        .lines()
        .find(|line| line.trim_start_matches([' ', '"', '\'']).starts_with(key))
        .unwrap_or_else(|| panic!("{key}: {text}"));
    line.rsplit(['\'', '"']).nth(1).unwrap().parse().unwrap()
}

pub fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_path_buf();
    (folder, path)
}
