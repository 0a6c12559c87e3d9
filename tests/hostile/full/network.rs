//! A stranger on the machine's network, without keys: packets in the name of others.
//!
//! The stranger is a participant in a namespace of its own: plain discovery gives it the identities and addresses of all
//! endpoints. Packets in the name of others are sent beside it.

use std::io::Write;
use std::net::{SocketAddr, UdpSocket};
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use excavator_msgs::{Header, OrificeCommand};
use rustdds::policy::{Durability, History, Reliability};
use rustdds::{DomainParticipant, DomainParticipantBuilder, GUID, QosPolicyBuilder, TopicKind};

use crate::hostile::fault::Fault;
use crate::hostile::inside::start_inside;
use crate::live::{Network, Program, folder, found, messages_so_far, openings, records, until};

/// Most memory that a node may ever need, MB.
pub const MOST_MEMORY: f64 = 200.0;
/// What the operator commands, m².
const OPEN: f64 = 2e-5;
/// Topic of the operator.
pub const COMMANDS: &str = "rt/arm/orifice_command";

/// Most memory that a program ever had, MB.
pub fn peak(program: &Program) -> f64 {
    memory(program, "VmHWM:")
}

/// Memory that a program has now, MB.
fn resident(program: &Program) -> f64 {
    memory(program, "VmRSS:")
}

fn memory(program: &Program, row: &str) -> f64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", program.id())).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix(row)).unwrap();
    line.split_whitespace().next().unwrap().parse::<f64>().unwrap() / 1024.0
}

/// Somebody who commands the arm's valve every 20 ms: zero at first, and open once told so.
pub struct Operator {
    open: Arc<AtomicBool>,
    stop: Arc<AtomicBool>,
    thread: std::thread::JoinHandle<f64>,
}

impl Operator {
    /// Begins to command, with options of the middleware.
    pub fn new(network: &Network, options: ros2_client::ContextOptions) -> Operator {
        let (open, stop) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
        let (opens, stops) = (Arc::clone(&open), Arc::clone(&stop));
        Operator { open, stop, thread: start_inside(network, move || command(options, &opens, &stops)) }
    }

    /// Commands an open valve from here on.
    pub fn opens(&self) {
        self.open.store(true, Ordering::Relaxed);
    }

    /// Commands a closed valve from here on.
    pub fn closes(&self) {
        self.open.store(false, Ordering::Relaxed);
    }

    /// Ends; returns when the last command was sent, s since the epoch. An error where it could not begin.
    pub fn falls_silent(self) -> std::thread::Result<f64> {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.join()
    }
}

/// Publishes commands until `stop`; returns when the last one was sent, s since the epoch.
fn command(options: ros2_client::ContextOptions, open: &AtomicBool, stop: &AtomicBool) -> f64 {
    let context = ros2_client::Context::with_options(options).unwrap();
    let name = ros2_client::NodeName::new("/", "operator").unwrap();
    let mut node = context.new_node(name, ros2_client::NodeOptions::new().enable_rosout(false)).unwrap();
    let qos = QosPolicyBuilder::new()
        .reliability(Reliability::Reliable { max_blocking_time: rustdds::Duration::ZERO })
        .durability(Durability::Volatile)
        .history(History::KeepLast { depth: 10 })
        .build();
    let topic = context
        .domain_participant()
        .create_topic(COMMANDS.into(), "excavator_msgs::msg::dds_::OrificeCommand_".into(), &qos, TopicKind::NoKey)
        .unwrap();
    let publisher = node.create_publisher::<OrificeCommand>(&topic, None).unwrap();
    let mut last = 0.0;
    while !stop.load(Ordering::Relaxed) {
        let area = if open.load(Ordering::Relaxed) { OPEN } else { 0.0 };
        last = now();
        let header = Header { stamp: stamp(last), frame_id: String::new() };
        // Nobody reads yet, or the window is full: the next one comes at once.
        let _ = publisher.publish(OrificeCommand { header, names: vec!["arm".into()], areas: vec![area] });
        std::thread::sleep(Duration::from_millis(20));
    }
    last
}

pub fn now() -> f64 {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_secs_f64()
}

fn stamp(seconds: f64) -> excavator_msgs::Time {
    excavator_msgs::Time { sec: seconds as i32, nanosec: (seconds.fract() * 1e9) as u32 }
}

/// A reader or writer of somebody.
#[derive(Debug, Clone)]
pub struct Endpoint {
    pub topic: String,
    pub identity: [u8; 16],
    pub addresses: Vec<SocketAddr>,
}

impl Endpoint {
    /// The first twelve bytes of the identity.
    pub fn participant(&self) -> &[u8] {
        &self.identity[..12]
    }
}

/// What plain discovery shows: readers and writers of topics.
pub struct Seen {
    pub readers: Vec<Endpoint>,
    pub writers: Vec<Endpoint>,
}

fn identity(guid: GUID) -> [u8; 16] {
    ros2_client::Gid::from(guid).to_bytes16()
}

fn addresses<L: Copy + Into<SocketAddr>>(locators: &[L]) -> Vec<SocketAddr> {
    let all = locators.iter().map(|locator| (*locator).into());
    all.filter(|address: &SocketAddr| address.is_ipv4() && !address.ip().is_loopback()).collect()
}

pub fn look(participant: &DomainParticipant) -> Seen {
    let readers = participant.discovered_readers();
    let writers = participant.discovered_writers();
    Seen {
        readers: readers
            .iter()
            .map(|reader| Endpoint {
                topic: reader.subscription_topic_data.topic_name().clone(),
                identity: identity(reader.reader_proxy.remote_reader_guid),
                addresses: addresses(&reader.reader_proxy.unicast_locator_list),
            })
            .collect(),
        writers: writers
            .iter()
            .map(|writer| Endpoint {
                topic: writer.publication_topic_data.topic_name.clone(),
                identity: identity(writer.writer_proxy.remote_writer_guid),
                addresses: addresses(&writer.writer_proxy.unicast_locator_list),
            })
            .collect(),
    }
}

/// A message in the name of `from` to the participant of `to`, with one submessage.
fn message(from: &Endpoint, to: &Endpoint, kind: u8, body: &[u8]) -> Vec<u8> {
    let mut bytes = b"RTPS\x02\x04\x01\x12".to_vec();
    bytes.extend(&from.identity[..12]);
    bytes.extend([0x0e, 1, 12, 0]);
    bytes.extend(&to.identity[..12]);
    bytes.extend([kind, 1]);
    bytes.extend(u16::try_from(body.len()).unwrap().to_le_bytes());
    bytes.extend(body);
    bytes
}

/// Little endian numbers, one behind the other.
#[derive(Default)]
struct Body(Vec<u8>);

impl Body {
    fn of(reader: &Endpoint, writer: &Endpoint) -> Self {
        Body([&reader.identity[12..], &writer.identity[12..]].concat())
    }

    fn number(mut self, number: i64) -> Self {
        self.0.extend(((number >> 32) as i32).to_le_bytes());
        self.word(number as u32)
    }

    fn word(mut self, word: u32) -> Self {
        self.0.extend(word.to_le_bytes());
        self
    }

    fn half(mut self, half: u16) -> Self {
        self.0.extend(half.to_le_bytes());
        self
    }
}

pub fn heartbeat(reader: &Endpoint, writer: &Endpoint, last: i64, count: u32) -> Vec<u8> {
    heartbeat_from(reader, writer, [1, last], count)
}

pub fn heartbeat_from(reader: &Endpoint, writer: &Endpoint, [first, last]: [i64; 2], count: u32) -> Vec<u8> {
    message(writer, reader, 0x07, &Body::of(reader, writer).number(first).number(last).word(count).0)
}

/// All samples before `base` are acknowledged, in the name of the reader.
pub fn acknowledged(reader: &Endpoint, writer: &Endpoint, base: i64, count: u32) -> Vec<u8> {
    message(reader, writer, 0x06, &Body::of(reader, writer).number(base).word(0).word(count).0)
}

pub fn gap(reader: &Endpoint, writer: &Endpoint, start: i64, base: i64) -> Vec<u8> {
    message(writer, reader, 0x08, &Body::of(reader, writer).number(start).number(base).word(0).0)
}

pub fn fragment(reader: &Endpoint, writer: &Endpoint, sample: i64, bytes: u32) -> Vec<u8> {
    let head = Body(vec![0, 0, 28, 0]);
    let ids = Body::of(reader, writer).0;
    let mut body = Body([head.0, ids].concat()).number(sample).word(1).half(1).half(256).word(bytes);
    body.0.extend([7; 256]);
    message(writer, reader, 0x16, &body.0)
}

fn fragment_asked_for(reader: &Endpoint, writer: &Endpoint, sample: i64, first: u32, count: u32) -> Vec<u8> {
    let body = Body::of(reader, writer).number(sample).word(first).word(1).word(0x8000_0000).word(count);
    message(reader, writer, 0x12, &body.0)
}

/// A stranger that looks around until it has seen what it wants, makes packets of that, and sends each to where it belongs.
pub fn stranger(
    network: &Network,
    has_seen: impl Fn(&Seen) -> bool + Send + 'static,
    packets: impl Fn(&Seen) -> Vec<(Vec<u8>, Vec<SocketAddr>)> + Send + 'static,
) -> std::thread::JoinHandle<usize> {
    start_inside(network, move || {
        let participant = DomainParticipantBuilder::new(0).build().unwrap();
        let seen = found("everybody to be seen", || Some(look(&participant)).filter(&has_seen));
        let packets = packets(&seen);
        let socket = UdpSocket::bind("0.0.0.0:0").unwrap();
        for (packet, addresses) in &packets {
            for address in addresses {
                socket.send_to(packet, address).unwrap();
            }
            // One after the other, so that none is lost for want of room.
            std::thread::sleep(Duration::from_millis(2));
        }
        packets.len()
    })
}

/// Number of endpoints of a topic.
pub fn count(endpoints: &[Endpoint], topic: &str) -> usize {
    endpoints.iter().filter(|endpoint| endpoint.topic == topic).count()
}

/// Every reader with the writers of its topic that it is matched with. Readers of the operator are left out: it runs in this
/// test's own process, without a guard.
pub fn pairs(seen: &Seen) -> Vec<(&Endpoint, &Endpoint)> {
    let operator = operator_of(seen);
    let others = seen.readers.iter().filter(|reader| Some(reader.participant()) != operator);
    let writers = |reader: &Endpoint| {
        let topic = reader.topic.clone();
        seen.writers.iter().filter(move |writer| writer.topic == topic)
    };
    others
        .flat_map(|reader| writers(reader).map(move |writer| (reader, writer)))
        .filter(|(reader, writer)| reader.participant() != writer.participant())
        .collect()
}

/// The participant that commands.
pub fn operator_of(seen: &Seen) -> Option<&[u8]> {
    seen.writers.iter().find(|writer| writer.topic == COMMANDS).map(|writer| writer.participant())
}

/// What a machine's programs went through: memory of each, states, and the valve.
struct Machine {
    peaks: Vec<(&'static str, f64)>,
    longest_gap: f64,
    closed_after: f64,
    refused: u64,
    sent: usize,
}

/// Simulator, monitor and recorder on one side and an operator who opens the arm's valve; a stranger on the other side sends
/// its packets. After 200 more states the operator falls silent, and when the valve has closed all ends.
fn machine(name: &str, packets: impl Fn(&Seen) -> Vec<(Vec<u8>, Vec<SocketAddr>)> + Send + 'static) -> Option<Machine> {
    let (left, right) = Network::pair(name)?;
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let programs = [
        ("simulator", left.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=200"])),
        ("monitor", left.start(&["node", "energy-monitor", "--ros-args", "-p", "model:=zx30u-arm"])),
        ("recorder", left.start(&["record", "/arm/state", "/diagnostics", "-o", bag.to_str().unwrap()])),
    ];
    let operator = Operator::new(&left, ros2_client::ContextOptions::new());
    records(&bag, "/arm/state", 1);
    operator.opens();
    until("an open valve", || openings(&bag).iter().any(|(_, area)| *area > 0.0));
    // Monitor and recorder hear states and diagnostics, the simulator hears commands.
    let all = |seen: &Seen| {
        count(&seen.readers, "rt/arm/state") >= 2
            && count(&seen.readers, "rt/diagnostics") >= 1
            && count(&seen.readers, COMMANDS) >= 1
            && [COMMANDS, "rt/arm/state"].into_iter().all(|topic| count(&seen.writers, topic) >= 1)
            && count(&seen.writers, "rt/diagnostics") >= 3
    };
    let sent = stranger(&right, all, packets).join().unwrap();
    let attacked = now();
    records(&bag, "/arm/state", 200);
    until("refused packets in the diagnostics", || refused(&bag) > 0);
    let silent = operator.falls_silent().unwrap();
    let closed = || openings(&bag).into_iter().find(|(stamp, area)| *stamp > silent && *area == 0.0);
    let (closed, _) = found("a closed valve", closed);
    let peaks = programs.iter().map(|(name, program)| (*name, peak(program))).collect();
    for (name, program) in programs.into_iter().rev() {
        let (status, log) = program.interrupt();
        assert_eq!(status, 0, "{name}: {log}");
    }
    let states = openings(&bag);
    let open = states.iter().filter(|(stamp, area)| (attacked..silent).contains(stamp) && *area > 0.0).count();
    assert!(open > 20, "{open} states with an open valve between the attack and the operator's last word");
    Some(Machine {
        peaks,
        longest_gap: states.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(0.0, f64::max),
        closed_after: closed - silent,
        refused: refused(&bag),
        sent,
    })
}

/// Packets that the simulator has refused, as its diagnostics in the bag tell so far.
fn refused(bag: &Path) -> u64 {
    messages_so_far::<excavator_msgs::common::DiagnosticArray>(bag, "/diagnostics")
        .into_iter()
        .flat_map(|(_, array)| array.status)
        .filter(|status| status.name == "arm_simulator: link")
        .flat_map(|status| status.values)
        .filter(|value| value.key == "packets refused or lost by the kernel")
        .filter_map(|value| value.value.parse().ok())
        .max()
        .unwrap_or(0)
}

impl Machine {
    /// Nothing happened, and the packets of the stranger were counted; the row of the table.
    fn went_on(&self, tried: &'static str) {
        let heaviest = self.peaks.iter().map(|(_, megabytes)| *megabytes).fold(0.0, f64::max);
        for (name, megabytes) in &self.peaks {
            assert!(*megabytes < MOST_MEMORY, "{name}: {megabytes} MB");
        }
        // The machine's own clock: hundreds of periods of 5 ms, so that only an attack and no busy machine makes such a gap.
        assert!(self.longest_gap < 3.0, "no state for {} s", self.longest_gap);
        // 0.1 s for the lease, 0.2 s for the ramp, and a busy machine.
        assert!(self.closed_after < 3.0, "the valve closed {} s after the operator fell silent", self.closed_after);
        assert!(self.refused > 0, "the simulator's diagnostics count no refused packet");
        Fault {
            group: "Network",
            tried,
            outcome: "dropped in the kernel before the middleware reads them and counted; states go on, the valve closes \
                      within the lease",
        }
        .survived(&[
            ("packets sent", self.sent.to_string()),
            ("most memory of a node [MB]", format!("{heaviest:.0}")),
            ("longest time without a state [s]", format!("{:.3}", self.longest_gap)),
            ("valve closed after the operator's last word [s]", format!("{:.2}", self.closed_after)),
        ]);
    }
}

#[test]
fn heartbeats_in_the_name_of_a_writer() {
    let packets = |seen: &Seen| {
        let pairs = pairs(seen);
        assert!(pairs.iter().any(|(reader, _)| reader.topic == COMMANDS), "{:?}", seen.readers);
        let each = |count: u32| {
            let of = move |(reader, writer): (&Endpoint, &Endpoint)| {
                (heartbeat(reader, writer, i64::MAX - i64::from(count), 1_000_000 + count), reader.addresses.clone())
            };
            pairs.clone().into_iter().map(of)
        };
        (0..15).flat_map(each).collect()
    };
    let Some(machine) = machine("heartbeat", packets) else { return };
    machine.went_on("HEARTBEATs of 52 bytes with a huge last number, in the name of a matched writer");
}

#[test]
fn other_packets_with_huge_numbers() {
    let packets = |seen: &Seen| {
        let pairs = pairs(seen);
        let operator = operator_of(seen);
        let each = |count: u32| {
            let of = move |(reader, writer): (&Endpoint, &Endpoint)| {
                let number = i64::from(count);
                // Nothing is asked of the operator's writers: it has no guard.
                let asked = if Some(writer.participant()) == operator { Vec::new() } else { writer.addresses.clone() };
                let nobody = Endpoint { identity: [count as u8; 16], ..writer.clone() };
                [
                    (gap(reader, writer, 1 << 39, (1 << 40) - 1 - number), reader.addresses.clone()),
                    (fragment(reader, writer, (1 << 30) + number, u32::MAX - count), reader.addresses.clone()),
                    (fragment(reader, &nobody, 1 + number, u32::MAX - count), reader.addresses.clone()),
                    (fragment_asked_for(reader, writer, 1 + number, u32::MAX, count), asked.clone()),
                    (fragment_asked_for(reader, writer, 1 + number, 0, 100 + count), asked),
                ]
            };
            pairs.clone().into_iter().flat_map(of)
        };
        (0..15).flat_map(each).collect()
    };
    let Some(machine) = machine("numbers", packets) else { return };
    machine.went_on("GAPs, fragments and questions for fragments with huge numbers, from known and unknown writers");
}

/// The same HEARTBEAT, with a number that this test's machine can bear, and no guard: what the guard is for.
#[test]
fn without_the_guard_the_same_heartbeat_fills_the_memory() {
    let Some((left, right)) = Network::pair("naked") else { return };
    let words = ["node", "arm-simulator", "--ros-args", "-p", "rate:=200"];
    let naked =
        left.start_other(Path::new(env!("CARGO_BIN_EXE_excavator")), &words, &[("EXCAVATOR_PACKET_GUARD", "off")]);
    let guarded = left.start(&["node", "arm-simulator", "--ros-args", "-r", "__node:=guarded", "-p", "rate:=200"]);
    let operator = Operator::new(&left, ros2_client::ContextOptions::new());
    let all = |seen: &Seen| count(&seen.readers, COMMANDS) >= 2 && count(&seen.writers, COMMANDS) >= 1;
    let packets = |seen: &Seen| {
        pairs(seen)
            .into_iter()
            .filter(|(reader, _)| reader.topic == COMMANDS)
            .map(|(reader, writer)| (heartbeat(reader, writer, 1 << 26, 1_000_000), reader.addresses.clone()))
            .collect()
    };
    assert!(stranger(&right, all, packets).join().unwrap() >= 2);
    // In vain if the middleware does not list missing numbers any more: then the guard can go.
    until("300 MB in the program without a guard", || peak(&naked) > 300.0);
    operator.falls_silent().unwrap();
    let (naked, guarded) = (peak(&naked), peak(&guarded));
    let _ = std::io::stdout().write_all(format!("{naked:.0} MB without, {guarded:.0} MB with the guard\n").as_bytes());
    assert!(guarded < MOST_MEMORY, "{guarded} MB");
}

/// What the guard lets through is bounded one by one, but not in number: the second line of defence is the memory watch.
#[test]
fn a_flood_of_fragments_within_the_limits() {
    let Some((left, right)) = Network::pair("flood") else { return };
    let simulator = left.start(&["node", "arm-simulator", "--ros-args", "-p", "rate:=200"]);
    let packets = |seen: &Seen| {
        let reader = seen.readers.iter().find(|reader| reader.topic == COMMANDS).unwrap();
        let writer = |number: u8| Endpoint { identity: [number; 16], ..reader.clone() };
        (0..200).map(|number| (fragment(reader, &writer(number), 1, (1 << 20) - 1), reader.addresses.clone())).collect()
    };
    let reader = |seen: &Seen| count(&seen.readers, COMMANDS) >= 1;
    assert_eq!(stranger(&right, reader, packets).join().unwrap(), 200);
    simulator.says("memory has grown from");
    until("its memory to be released", || resident(&simulator) < 100.0);
    let (peak, after) = (peak(&simulator), resident(&simulator));
    let (status, log) = simulator.interrupt();
    assert_eq!(status, 0, "{log}");
    assert!(peak > 100.0 && after < 100.0, "{peak} MB at most, {after} MB afterwards: {log}");
    Fault {
        group: "Network",
        tried: "200 fragments of samples of 1 MB each, from writers that never were",
        outcome: "the link is rebuilt when the memory has grown by 96 MB, and its memory is released",
    }
    .survived(&[("most memory [MB]", format!("{peak:.0}")), ("memory afterwards [MB]", format!("{after:.0}"))]);
}

/// Runs the program until it ends by itself; status and standard error.
fn run(words: &[&str], environment: &[(&str, &str)]) -> (i32, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_excavator"));
    command.args(words).envs(environment.iter().copied());
    Program::spawn(command).wait()
}

#[test]
fn security_that_cannot_be_had_is_refused() {
    let (_keep, folder) = folder();
    let bag = folder.join("bag");
    let bag = bag.to_str().unwrap();
    let programs: [&[&str]; 6] = [
        &["node", "arm-simulator"],
        &["node", "energy-monitor"],
        &["node", "identification"],
        &["record", "--all", "-o", bag],
        &["dashboard", "--port", "0"],
        &["up", "--no-record"],
    ];
    let enforce = [("ROS_SECURITY_ENABLE", "true"), ("ROS_SECURITY_STRATEGY", "Enforce")];
    for words in programs {
        let (status, log) = run(words, &enforce);
        assert_ne!(status, 0, "{words:?}: {log}");
        assert!(log.contains("ROS_SECURITY_STRATEGY=Enforce, not starting: "), "{words:?}: {log}");
        assert_eq!(log.trim_end().lines().count(), 1, "{words:?}: {log}");
    }
    for (name, value) in [("ROS_SECURITY_ENABLE", "True"), ("ROS_SECURITY_STRATEGY", "enforce")] {
        let (status, log) = run(programs[0], &[("ROS_SECURITY_ENABLE", "true"), (name, value)]);
        assert!(status != 0 && log.contains(&format!("{name}={value}")), "{log}");
    }
    Fault {
        group: "Network",
        tried: "ROS_SECURITY_STRATEGY=Enforce without keys, or in a build without DDS Security",
        outcome: "every program that joins the graph refuses to start, in one line that says what is missing",
    }
    .survived(&[("programs that refuse", programs.len().to_string())]);
}
