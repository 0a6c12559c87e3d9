//! Selects the topics to record.

use regex::Regex;

use excavator_ros::RosError;

/// The topics to record.
#[derive(Debug)]
pub(super) struct Selection {
    names: Vec<String>,
    pattern: Option<Regex>,
    exclude: Option<Regex>,
    hidden: bool,
}

impl Selection {
    /// Topics with these full names, or that match the pattern; all topics if neither is given.
    ///
    /// # Errors
    /// [`RosError::Arguments`] for an invalid pattern.
    pub fn new(
        names: Vec<String>,
        pattern: Option<&str>,
        exclude: Option<&str>,
        hidden: bool,
    ) -> Result<Self, RosError> {
        let compiled = |text: Option<&str>| {
            text.map(|text| {
                // The pattern has to match the whole name, as with `ros2 bag record`.
                Regex::new(&format!("^(?:{text})$"))
                    .map_err(|error| RosError::Arguments(format!("\"{text}\" is not a pattern: {error}")))
            })
            .transpose()
        };
        Ok(Selection { names, pattern: compiled(pattern)?, exclude: compiled(exclude)?, hidden })
    }

    /// Whether the topic is recorded.
    pub fn takes(&self, topic: &str) -> bool {
        if self.names.iter().any(|name| name == topic) {
            return true;
        }
        if self.exclude.as_ref().is_some_and(|exclude| exclude.is_match(topic)) || (is_hidden(topic) && !self.hidden) {
            return false;
        }
        match &self.pattern {
            Some(pattern) => pattern.is_match(topic),
            None => self.names.is_empty(),
        }
    }

    /// The names requested, to report those that never appeared.
    pub fn names(&self) -> &[String] {
        &self.names
    }
}

/// Names with a part that begins with an underscore, such as those of actions, are internal topics.
fn is_hidden(topic: &str) -> bool {
    topic.split('/').any(|part| part.starts_with('_'))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn all_means_all_but_plumbing() {
        let all = Selection::new(Vec::new(), None, None, false).unwrap();
        assert!(all.takes("/arm/state"));
        assert!(!all.takes("/identification/run/_action/feedback"));
        assert!(Selection::new(Vec::new(), None, None, true).unwrap().takes("/x/_action/status"));
    }

    #[test]
    fn names_patterns_and_exceptions() {
        let named = Selection::new(vec!["/a".into()], Some("/arm/.*"), Some(".*/energy"), false).unwrap();
        assert!(named.takes("/a") && named.takes("/arm/state"));
        assert!(!named.takes("/b") && !named.takes("/arm/energy") && !named.takes("/left/arm/state"));
        assert!(Selection::new(Vec::new(), Some("("), None, false).is_err());
    }
}
