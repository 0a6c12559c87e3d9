//! The description of where signals come from.

use std::path::Path;

use serde::Deserialize;

use super::signals::Treatment;

/// The whole description.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Description {
    /// States per second, Hz.
    #[serde(default = "default_rate")]
    pub rate: f64,
    /// Sources of datagrams.
    #[serde(default)]
    pub udp: Vec<Udp>,
    /// Topics of other nodes.
    #[serde(default)]
    pub topics: Vec<TopicSource>,
}

/// 100 Hz: enough for an arm, and no load for anybody.
fn default_rate() -> f64 {
    100.0
}

/// Datagrams of fixed layout on one port.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Udp {
    /// Port to listen at.
    pub port: u16,
    /// Length of a datagram, bytes.
    pub length: usize,
    /// Order of the bytes of a number.
    #[serde(default)]
    pub byte_order: ByteOrder,
    /// What is where.
    pub fields: Vec<DatagramField>,
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
        let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        Self::parse(&text).map_err(|reason| format!("{}: {reason}", path.display()))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let description: Description =
            toml::from_str(text).map_err(|error| error.message().lines().collect::<Vec<_>>().join(" "))?;
        if !(0.1..=2000.0).contains(&description.rate) {
            return Err(format!("rate = {} is outside 0.1 to 2000 Hz", description.rate));
        }
        for udp in &description.udp {
            for field in &udp.fields {
                let end = field.at.saturating_add(field.kind.length());
                if end > udp.length {
                    let signal = &field.treatment.signal;
                    return Err(format!("{signal} ends at byte {end} of a datagram of {} bytes", udp.length));
                }
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

    /// What becomes of each signal: those of datagrams first, in the order of the description.
    pub fn treatments(&self) -> Vec<Treatment> {
        let udp = self.udp.iter().flat_map(|udp| udp.fields.iter().map(|field| field.treatment.clone()));
        udp.chain(self.topics.iter().map(|topic| topic.treatment.clone())).collect()
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
        assert!(description.as_ref().is_ok_and(|d| d.udp.len() == 1 && d.topics.len() == 1), "{description:?}");
    }

    #[test]
    fn nonsense_is_refused_with_a_reason() {
        let udp = "[[udp]]\nport = 1\nlength = 4\n[[udp.fields]]\n";
        for (text, word) in [
            (String::new(), "no signal"),
            ("rate = -1".to_string(), "rate"),
            (format!("{udp}at = 2\nkind = \"f32\"\nsignal = \"pump_flow\""), "byte 6"),
            (format!("{udp}at = 0\nkind = \"f32\"\nsignal = \"arm.colour\""), "arm.colour"),
            (format!("{udp}at = 0\nkind = \"f16\"\nsignal = \"pump_flow\""), "f16"),
        ] {
            let refused = Description::parse(&text);
            assert!(refused.as_ref().is_err_and(|reason| reason.contains(word)), "{word}: {refused:?}");
        }
    }
}
