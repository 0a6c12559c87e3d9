//! The description of the sources of signals.

use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};

use excavator_model::document::toml_fault;
use rosbag2::{ReadLimits, read_regular_text};
use serde::Deserialize;

use super::signals::Treatment;

/// The whole description.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Description {
    /// States per second, Hz.
    #[serde(default = "default_rate")]
    pub rate: f64,
    /// Which machine this is, for `hardware_id` of its diagnostics: a serial number, as a rule.
    #[serde(default)]
    pub hardware: String,
    /// Sources of datagrams.
    #[serde(default)]
    pub udp: Vec<Udp>,
    /// CAN buses.
    #[serde(default)]
    pub can: Vec<Can>,
    /// Topics of other nodes.
    #[serde(default)]
    pub topics: Vec<TopicSource>,
}

/// 100 Hz: enough for an arm, and a small load.
fn default_rate() -> f64 {
    100.0
}

/// Datagrams of fixed layout on one port.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Udp {
    /// Port to listen at.
    pub port: u16,
    /// Address to listen at: this machine alone without, all networks with 0.0.0.0.
    #[serde(default = "loopback")]
    pub address: IpAddr,
    /// Addresses whose datagrams are taken; empty, on loopback only: all.
    #[serde(default)]
    pub senders: Vec<IpAddr>,
    /// Length of a datagram, bytes.
    pub length: usize,
    /// Order of the bytes of a number.
    #[serde(default)]
    pub byte_order: ByteOrder,
    /// Where the number of the datagram is, which rises by one from each to the next.
    pub sequence: Option<SequenceField>,
    /// What is where.
    pub fields: Vec<DatagramField>,
}

/// Address used unless the description sets another: only programs of this machine can send.
pub(super) const LOOPBACK: IpAddr = IpAddr::V4(Ipv4Addr::LOCALHOST);

fn loopback() -> IpAddr {
    LOOPBACK
}

impl Udp {
    /// Checks that the layout can be read, and that its senders are named.
    ///
    /// # Errors
    /// What is wrong, in one line.
    fn check(&self) -> Result<(), String> {
        let fields = self.fields.iter().map(|field| (field.treatment.signal.as_str(), field.at, field.kind.length()));
        let sequence = self.sequence.iter().map(|field| ("sequence", field.at, field.kind.length()));
        for (name, at, length) in fields.chain(sequence) {
            let end = at.saturating_add(length);
            if end > self.length {
                return Err(format!("{name} ends at byte {end} of a datagram of {} bytes", self.length));
            }
        }
        if !self.address.is_loopback() && self.senders.is_empty() {
            return Err(format!(
                "the [[udp]] of port {} listens at {}: name the instruments whose datagrams are taken, such as \
                 senders = [\"192.168.1.20\"]",
                self.port, self.address
            ));
        }
        Ok(())
    }
}

/// Where the number of a datagram is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SequenceField {
    /// First byte.
    pub at: usize,
    /// Type.
    pub kind: SequenceKind,
}

/// Type of the number of a datagram; it begins anew at zero after its largest value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub(super) enum SequenceKind {
    U8,
    U16,
    U32,
}

impl SequenceKind {
    /// Length, bytes.
    pub fn length(self) -> usize {
        match self {
            SequenceKind::U8 => 1,
            SequenceKind::U16 => 2,
            SequenceKind::U32 => 4,
        }
    }
}

/// Order of the bytes of a number.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum ByteOrder {
    #[default]
    Little,
    Big,
}

/// One number of a datagram.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct DatagramField {
    /// First byte.
    pub at: usize,
    /// Type.
    pub kind: NumberKind,
    /// What becomes of it.
    #[serde(flatten)]
    pub treatment: Treatment,
}

/// Type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub(super) enum NumberKind {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    F32,
    F64,
}

impl NumberKind {
    /// Length, bytes.
    pub fn length(self) -> usize {
        match self {
            NumberKind::U8 | NumberKind::I8 => 1,
            NumberKind::U16 | NumberKind::I16 => 2,
            NumberKind::U32 | NumberKind::I32 | NumberKind::F32 => 4,
            NumberKind::F64 => 8,
        }
    }
}

/// Frames of one CAN bus.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Can {
    /// DBC file, seen from the description.
    pub dbc: PathBuf,
    /// SocketCAN device.
    pub device: Option<String>,
    /// Log of `candump -L` in place of a device, seen from the description.
    pub log: Option<PathBuf>,
    /// Device whose frames of the log are read; all without.
    pub channel: Option<String>,
    /// How fast a log is read.
    #[serde(default)]
    pub pace: LogPace,
    /// What is where.
    pub signals: Vec<CanSignal>,
}

/// How fast a log is read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum LogPace {
    /// As fast as its stamps say.
    #[default]
    Stamps,
    /// As fast as states can be published; they have the stamps of the log then.
    Fastest,
}

/// One signal of a CAN bus.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct CanSignal {
    /// Name of the message in the DBC file.
    pub message: String,
    /// Name of the signal there.
    pub name: String,
    /// What becomes of the physical value, which has the unit of the DBC file.
    #[serde(flatten)]
    pub treatment: Treatment,
}

/// One value of a topic.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct TopicSource {
    /// Name of the topic.
    pub topic: String,
    /// Type of its messages.
    pub kind: TopicKind,
    /// Joint of a joint state.
    #[serde(default)]
    pub joint: String,
    /// Field of a joint state.
    #[serde(default)]
    pub field: JointField,
    /// Element of an array: the frame of a pressure, or the label of a dimension.
    #[serde(default)]
    pub name: String,
    /// What becomes of the value.
    #[serde(flatten)]
    pub treatment: Treatment,
}

/// Types of messages that are understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum TopicKind {
    /// `sensor_msgs/msg/JointState`.
    JointState,
    /// `sensor_msgs/msg/FluidPressure`.
    FluidPressure,
    /// `com3_msgs/msg/FluidPressureArray`.
    FluidPressureArray,
    /// `std_msgs/msg/Float64MultiArray`, in which each dimension labels a number.
    LabelledNumbers,
}

/// Fields of a joint state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub(super) enum JointField {
    #[default]
    Position,
    Velocity,
    Effort,
}

impl Description {
    /// The description in a file.
    ///
    /// # Errors
    /// What is wrong, in one line.
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = read_regular_text(path, ReadLimits::DEFAULT.document).map_err(|error| error.to_string())?;
        let mut description = Self::parse(&text).map_err(|reason| format!("{}: {reason}", path.display()))?;
        // File names are relative to the description, not to the working directory.
        let folder = path.parent().unwrap_or(Path::new("."));
        for can in &mut description.can {
            can.dbc = folder.join(&can.dbc);
            can.log = can.log.as_ref().map(|log| folder.join(log));
        }
        Ok(description)
    }

    fn parse(text: &str) -> Result<Self, String> {
        let description: Description = toml::from_str(text).map_err(|error| toml_fault(text, &error).message)?;
        if !(0.1..=2000.0).contains(&description.rate) {
            return Err(format!("rate = {} is outside 0.1 to 2000 Hz", description.rate));
        }
        for udp in &description.udp {
            udp.check()?;
        }
        let sources = description.udp.len() + description.can.len() + description.topics.len();
        for can in &description.can {
            if can.device.is_some() == can.log.is_some() {
                return Err("a [[can]] needs either a device or a log".to_string());
            }
            if can.pace == LogPace::Fastest && (can.log.is_none() || sources > 1) {
                return Err("pace = \"fastest\" is for a log that is the only source".to_string());
            }
        }
        let treatments = description.treatments();
        for (index, treatment) in treatments.iter().enumerate() {
            treatment.check()?;
            if treatments[..index].iter().any(|other| other.signal == treatment.signal) {
                return Err(format!("{} has two sources", treatment.signal));
            }
        }
        if treatments.is_empty() {
            return Err("no signal has a source".to_string());
        }
        Ok(description)
    }

    /// The treatment of each signal: those of datagrams first, then CAN, then topics, in the order of the description.
    pub fn treatments(&self) -> Vec<Treatment> {
        let udp = self.udp.iter().flat_map(|udp| udp.fields.iter().map(|field| field.treatment.clone()));
        let can = self.can.iter().flat_map(|can| can.signals.iter().map(|signal| signal.treatment.clone()));
        udp.chain(can).chain(self.topics.iter().map(|topic| topic.treatment.clone())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_of_the_documentation_is_understood() {
        let text = include_str!("mod.rs");
        let example: String = text
            .lines()
            .skip_while(|line| !line.contains("```toml"))
            .skip(1)
            .take_while(|line| !line.contains("```"))
            .map(|line| line.trim_start_matches("//!").to_string() + "\n")
            .collect();
        let description = Description::parse(&example);
        assert!(
            description.as_ref().is_ok_and(|d| d.udp.len() == 1 && d.can.len() == 1 && d.topics.len() == 1),
            "{description:?}"
        );
    }

    #[test]
    fn nonsense_is_refused_with_a_reason() {
        let udp = "[[udp]]\nport = 1\nlength = 4\n[[udp.fields]]\n";
        let with = |line: &str| udp.replace("length", &format!("{line}\nlength"));
        let can = "[[can]]\ndbc = \"x.dbc\"\n";
        let signal = "[[can.signals]]\nmessage = \"M\"\nname = \"S\"\nsignal = \"pump_flow\"\n";
        for (text, word) in [
            (String::new(), "no signal"),
            ("rate = -1".to_string(), "rate"),
            (format!("{udp}at = 2\nkind = \"f32\"\nsignal = \"pump_flow\""), "byte 6"),
            (format!("{}at = 0\nkind = \"u8\"\nsignal = \"pump_flow\"", with("address = \"0.0.0.0\"")), "senders = ["),
            (format!("{}at = 0\nkind = \"u8\"\nsignal = \"pump_flow\"", with("senders = [\"pit\"]")), "IP address"),
            (
                format!(
                    "{}at = 0\nkind = \"u8\"\nsignal = \"pump_flow\"",
                    with("sequence = { at = 3, kind = \"u16\" }")
                ),
                "sequence ends",
            ),
            (format!("{udp}at = 0\nkind = \"f32\"\nsignal = \"arm.colour\""), "arm.colour"),
            (format!("{udp}at = 0\nkind = \"f16\"\nsignal = \"pump_flow\""), "f16"),
            (format!("{udp}at = 0\nkind = \"f32\"\nsignal = \"pump_flow\"\ndelay = 2.0"), "delay"),
            (format!("{can}{signal}"), "device or a log"),
            (format!("{can}device = \"can0\"\npace = \"fastest\"\n{signal}"), "only source"),
        ] {
            let refused = Description::parse(&text);
            assert!(refused.as_ref().is_err_and(|reason| reason.contains(word)), "{word}: {refused:?}");
        }
    }
}
