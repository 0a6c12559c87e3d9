//! Decides which writers may command.
//!
//! Without DDS Security anyone can write under any name: the list prevents mistakes, not attacks. With DDS Security a
//! participant proves its identity, and its node name can be relied on.

use std::net::IpAddr;

/// A writer of commands, as described by discovery.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Writer {
    /// GUID of the DDS writer: twelve bytes of the participant and four of the entity.
    pub guid: [u8; 16],
    /// Full name of its node, if discovery knows it.
    pub node: Option<String>,
    /// Addresses at which its participant receives packets.
    pub addresses: Vec<IpAddr>,
}

impl Writer {
    /// Name for display: the node's, or else the identity of the participant.
    pub fn name(&self) -> String {
        self.node.clone().unwrap_or_else(|| format!("writer {}", hexadecimal(&self.guid[..12])))
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// One entry of the list of allowed writers.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Entry {
    Node(String),
    Participant(String),
    Address(IpAddr),
}

impl Entry {
    fn parse(text: &str) -> Result<Self, String> {
        if text.starts_with('/') {
            return Ok(Entry::Node(text.to_string()));
        }
        if let Ok(address) = text.parse() {
            return Ok(Entry::Address(address));
        }
        let is_prefix = text.len() == 24 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        if is_prefix {
            return Ok(Entry::Participant(text.to_ascii_lowercase()));
        }
        Err(format!(
            "command_writers: \"{text}\" is neither a full node name (/operator), nor an IP address, nor a GUID prefix of 24 \
             hexadecimal digits"
        ))
    }

    fn means(&self, writer: &Writer) -> bool {
        match self {
            Entry::Node(name) => writer.node.as_ref() == Some(name),
            Entry::Participant(prefix) => hexadecimal(&writer.guid[..12]) == *prefix,
            Entry::Address(address) => writer.addresses.contains(address),
        }
    }
}

/// The list of allowed writers.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct AllowList(Vec<Entry>);

impl AllowList {
    /// Parses the entries: full node names, IP addresses, GUID prefixes.
    ///
    /// # Errors
    /// A message for the user.
    pub fn parse(texts: &[String]) -> Result<Self, String> {
        texts.iter().map(|text| Entry::parse(text)).collect::<Result<_, _>>().map(AllowList)
    }

    /// Whether this writer may command. An empty list allows every writer.
    pub fn allows(&self, writer: &Writer) -> bool {
        self.0.is_empty() || self.0.iter().any(|entry| entry.means(writer))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn list(texts: &[&str]) -> Result<AllowList, String> {
        AllowList::parse(&texts.iter().map(|text| text.to_string()).collect::<Vec<_>>())
    }

    #[test]
    fn writers_are_known_by_node_address_or_participant() {
        let writer =
            Writer { guid: [0xab; 16], node: Some("/operator".into()), addresses: vec!["10.0.0.5".parse().unwrap()] };
        for good in ["/operator", "10.0.0.5", "ABABABABABABABABABABABAB"] {
            assert!(list(&["/other", good]).unwrap().allows(&writer), "{good}");
        }
        for other in ["/operator2", "10.0.0.6", "ababababababababababab00"] {
            assert!(!list(&[other]).unwrap().allows(&writer), "{other}");
        }
        assert!(list(&[]).unwrap().allows(&writer));
        assert!(!list(&["/operator"]).unwrap().allows(&Writer { node: None, ..writer }));
    }

    #[test]
    fn entries_that_mean_nothing_are_refused() {
        for wrong in ["operator", "10.0.0", "abc", ""] {
            assert!(list(&[wrong]).is_err(), "{wrong}");
        }
    }
}
