//! Network namespaces: a loopback with multicast of its own for each test, or two joined by a cable.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

use super::Program;

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
        command.envs(environment.iter().copied());
        Program::spawn(command)
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        ip(&["netns", "del", &self.name]);
    }
}
