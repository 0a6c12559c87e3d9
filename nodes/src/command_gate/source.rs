//! Sources of commands: named topics with priorities.

/// A topic that carries commands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Source {
    /// Name for display: "remote_control", "autonomy".
    pub name: String,
    /// The writer whose source has the higher number takes the valve.
    pub priority: i32,
    /// Topic, before remapping.
    pub topic: String,
}

impl Source {
    /// Reads `NAME:PRIORITY:TOPIC`.
    ///
    /// # Errors
    /// A message for the user.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut parts = text.splitn(3, ':');
        let (Some(name), Some(priority), Some(topic)) = (parts.next(), parts.next(), parts.next()) else {
            return Err(format!("command_sources: \"{text}\" is not of the form NAME:PRIORITY:TOPIC"));
        };
        let priority = priority
            .parse()
            .map_err(|_| format!("command_sources: the priority \"{priority}\" in \"{text}\" is no whole number"))?;
        if name.is_empty() || topic.is_empty() {
            return Err(format!("command_sources: \"{text}\" has an empty name or topic"));
        }
        Ok(Source { name: name.to_string(), priority, topic: topic.to_string() })
    }

    /// Reads all sources. Names and topics must be unique.
    ///
    /// # Errors
    /// A message for the user.
    pub fn parse_all(texts: &[String]) -> Result<Vec<Self>, String> {
        let sources = texts.iter().map(|text| Source::parse(text)).collect::<Result<Vec<_>, _>>()?;
        for (index, source) in sources.iter().enumerate() {
            let same = |other: &&Source| other.name == source.name || other.topic == source.topic;
            if let Some(other) = sources[..index].iter().find(same) {
                return Err(format!(
                    "command_sources: \"{}\" and \"{}\" share a name or a topic",
                    other.name, source.name
                ));
            }
        }
        Ok(sources)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_is_a_name_a_priority_and_a_topic() {
        let expected = Source { name: "remote".into(), priority: -3, topic: "/left/arm/orifice_command".into() };
        assert_eq!(Source::parse("remote:-3:/left/arm/orifice_command"), Ok(expected));
        for wrong in ["", "remote", "remote:1", "remote:high:/a", ":1:/a", "remote:1:"] {
            assert!(Source::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn two_sources_are_told_apart() {
        let of = |texts: &[&str]| Source::parse_all(&texts.iter().map(|text| text.to_string()).collect::<Vec<_>>());
        assert_eq!(of(&["a:0:/a", "b:1:/b"]).map(|all| all.len()), Ok(2));
        assert!(of(&["a:0:/a", "a:1:/b"]).is_err());
        assert!(of(&["a:0:/a", "b:1:/a"]).is_err());
    }
}
