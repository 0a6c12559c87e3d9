//! The live nodes: time of processors, latency from state to energy, and what is lost.

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use rosbag2::RawMessages;

use crate::clock::processor_time;
use crate::figures::{Group, Run};
use crate::verbs::Program;

/// Time over which is measured, s.
const SECONDS: f64 = 20.0;
/// Time in which nodes find each other, s.
const START: f64 = 5.0;
/// Half width of the monitor's window as it comes, ns.
const HALF_WIDTH: u64 = 10_000_000;
/// A domain that no robot is likely to be in.
const DOMAIN: &str = "87";

/// One machine at 1 kHz, one at 4 kHz, four at 1 kHz.
///
/// # Errors
/// In words, where a node does not start or its recording cannot be read.
pub fn live(program: &Program<'_>) -> Result<Group, String> {
    let mut runs = Vec::new();
    for (machines, rate) in [(1, 1000.0), (1, 4000.0), (4, 1000.0)] {
        runs.push(scene(program, machines, rate)?);
    }
    Ok(Group {
        name: "Live nodes".into(),
        what: format!(
            "Simulator, energy monitor and recorder are processes on one computer; {SECONDS:.0} s. Latency: from the \
             arrival of a state at the recorder to that of the energies that it sets off."
        ),
        result: "share of a core, latency, losses".into(),
        runs,
    })
}

/// A process that is stopped when it is dropped.
struct Node(Child);

impl Node {
    fn start(program: &Path, arguments: &[String]) -> Result<Self, String> {
        Command::new(program)
            .args(arguments)
            .env("ROS_DOMAIN_ID", DOMAIN)
            .env("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .map(Node)
            .map_err(|error| format!("{}: {error}", program.display()))
    }

    fn files(&self) -> PathBuf {
        PathBuf::from("/proc").join(self.0.id().to_string())
    }

    /// Ends it as Ctrl-C does.
    fn end(&mut self) {
        if let Ok(id) = i32::try_from(self.0.id()) {
            // One that has ended by itself needs no signal.
            let _ = kill(Pid::from_raw(id), Signal::SIGINT);
        }
        let _ = self.0.wait();
    }
}

impl Drop for Node {
    fn drop(&mut self) {
        self.end();
    }
}

fn scene(program: &Program<'_>, machines: usize, rate: f64) -> Result<Run, String> {
    let bag = program.folder.join(format!("live-{machines}-{rate:.0}"));
    let node = |name: &str, machine: usize, parameters: &[String]| {
        let mut arguments = vec!["node".to_string(), name.to_string(), "--ros-args".to_string()];
        for topic in ["arm/state", "arm/energy", "arm/orifice_command", "arm/model", "joint_states"] {
            arguments.extend(["-r".to_string(), format!("/{topic}:=/m{machine}/{topic}")]);
        }
        arguments.extend(["-r".to_string(), format!("__ns:=/m{machine}")]);
        arguments.extend(parameters.iter().cloned());
        Node::start(&program.path, &arguments)
    };
    let simulators = (0..machines)
        .map(|machine| node("arm-simulator", machine, &["-p".to_string(), format!("rate:={rate:.1}")]))
        .collect::<Result<Vec<_>, _>>()?;
    let monitors = (0..machines).map(|machine| node("energy-monitor", machine, &[])).collect::<Result<Vec<_>, _>>()?;
    let mut words = vec!["record".to_string(), "--output".to_string(), bag.display().to_string()];
    words.extend((0..machines).flat_map(|machine| ["state", "energy"].map(|topic| format!("/m{machine}/arm/{topic}"))));
    let mut recorder = Node::start(&program.path, &words)?;
    std::thread::sleep(Duration::from_secs_f64(START));
    let used = |nodes: &[Node]| nodes.iter().filter_map(|node| processor_time(&node.files())).sum::<f64>();
    let from = system_nanoseconds();
    let (begin, before) = (Instant::now(), [used(&simulators), used(&monitors)]);
    std::thread::sleep(Duration::from_secs_f64(SECONDS));
    let wall = begin.elapsed().as_secs_f64();
    let [simulator, monitor] = [used(&simulators) - before[0], used(&monitors) - before[1]]
        .map(|seconds| 100.0 * seconds / wall / machines as f64);
    let window = from..system_nanoseconds();
    recorder.end();
    drop((simulators, monitors));
    // While eight nodes find each other, a core can be away for longer than a simulator catches up with.
    let traffic = Traffic::of(&bag, rate, &window)?;
    let [median, high] = traffic.latency_milliseconds();
    let name = format!("{machines} machine{} at {:.0} kHz", if machines == 1 { "" } else { "s" }, rate / 1e3);
    let result = format!(
        "simulator {simulator:.1} %, monitor {monitor:.1} % of a core each; p50 {median:.2} ms, p99 {high:.2} ms; {} states, {} missing, \
         {} without energies",
        traffic.states, traffic.missing, traffic.without_energy
    );
    Ok(Run::untimed(name, result))
}

/// What a recorder saw.
struct Traffic {
    states: usize,
    /// States that were never seen between the first and the last.
    missing: usize,
    /// States in the middle of the recording whose energies were never seen.
    without_energy: usize,
    /// From state to energies, s, sorted.
    latencies: Vec<f64>,
}

impl Traffic {
    /// Of messages that arrived within the window, ns since the epoch.
    fn of(bag: &Path, rate: f64, window: &Range<u64>) -> Result<Self, String> {
        let mut states: HashMap<(String, u64), u64> = HashMap::new();
        let mut energies: HashMap<(String, u64), u64> = HashMap::new();
        for message in RawMessages::open(bag).map_err(|error| error.to_string())? {
            let message = message.map_err(|error| error.to_string())?;
            let Some(stamp) = stamp_of(&message.data).filter(|_| window.contains(&message.log_time)) else { continue };
            let Some((machine, topic)) = message.topic.name.split_once("/arm/") else { continue };
            let seen = if topic == "state" { &mut states } else { &mut energies };
            seen.insert((machine.to_string(), stamp), message.log_time);
        }
        let mut missing = 0;
        let mut machines: HashMap<&str, Vec<u64>> = HashMap::new();
        states.keys().for_each(|(machine, stamp)| machines.entry(machine).or_default().push(*stamp));
        for stamps in machines.values_mut() {
            stamps.sort_unstable();
            let span = stamps.last().zip(stamps.first()).map_or(0, |(last, first)| last - first);
            missing += ((span as f64 * 1e-9 * rate).round() as usize + 1).saturating_sub(stamps.len());
        }
        // Energies belong to a moment in the middle of the monitor's window; the state that completes the window sets them off.
        let mut by_stamp: HashMap<&str, Vec<(u64, u64)>> = HashMap::new();
        for ((machine, stamp), &arrived) in &states {
            by_stamp.entry(machine).or_default().push((*stamp, arrived));
        }
        by_stamp.values_mut().for_each(|states| states.sort_unstable());
        let mut latencies: Vec<f64> = energies
            .iter()
            .filter_map(|((machine, stamp), &arrived)| {
                let states = by_stamp.get(machine.as_str())?;
                let last = states.partition_point(|(other, _)| *other < stamp + HALF_WIDTH);
                let (_, set_off) = states.get(last)?;
                Some((arrived as f64 - *set_off as f64) * 1e-9)
            })
            .collect();
        latencies.sort_by(f64::total_cmp);
        // What was under way when the recorder began and ended is no loss.
        let first = energies.keys().map(|(_, stamp)| *stamp).min().unwrap_or(0);
        let last = energies.keys().map(|(_, stamp)| *stamp).max().unwrap_or(0);
        let middle = states.keys().filter(|(_, stamp)| (first..=last).contains(stamp));
        let without_energy = middle.filter(|key| !energies.contains_key(*key)).count();
        Ok(Traffic { states: states.len(), missing, without_energy, latencies })
    }

    /// Median and 99th percentile.
    fn latency_milliseconds(&self) -> [f64; 2] {
        let at = |share: f64| {
            let place = (self.latencies.len() as f64 * share) as usize;
            self.latencies
                .get(place.min(self.latencies.len().saturating_sub(1)))
                .map_or(f64::NAN, |seconds| 1e3 * seconds)
        };
        [at(0.5), at(0.99)]
    }
}

fn system_nanoseconds() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64)
}

/// Stamp of a header at the begin of a message in little-endian CDR, ns.
fn stamp_of(message: &[u8]) -> Option<u64> {
    let number = |from: usize| message.get(from..from + 4)?.try_into().ok().map(u32::from_le_bytes);
    Some(u64::from(number(4)?) * 1_000_000_000 + u64::from(number(8)?))
}
