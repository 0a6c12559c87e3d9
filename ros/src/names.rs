//! Names of topics, services and nodes, and how the command line remaps them.

use super::RosError;

/// One rule `from:=to`, for all nodes or for one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remap {
    /// Node that the rule applies to, `None` for all.
    pub node: Option<String>,
    /// Name as the program uses it.
    pub from: String,
    /// Name that replaces it.
    pub to: String,
}

/// Name and namespace of a node with the rules that apply to it.
///
/// ```
/// use excavator_ros::{NodeIdentity, RosArguments};
///
/// let words = ["--ros-args", "-r", "__ns:=/left", "-r", "/clock:=/simulation/clock"].map(String::from);
/// let (ros, _) = RosArguments::parse(&words)?;
/// let identity = NodeIdentity::new("arm_bridge", &ros.remaps)?;
/// assert_eq!(identity.full_name(), "/left/arm_bridge");
/// assert_eq!(identity.resolve("arm/state")?, "/left/arm/state");
/// assert_eq!(identity.resolve("/clock")?, "/simulation/clock");
/// # Ok::<(), excavator_ros::RosError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NodeIdentity {
    namespace: String,
    name: String,
    remaps: Vec<Remap>,
}

impl NodeIdentity {
    /// The node that the program calls `default_name`, after the rules `__node` and `__ns`.
    ///
    /// # Errors
    /// [`RosError::Name`] for a name that ROS does not allow.
    pub fn new(default_name: &str, remaps: &[Remap]) -> Result<Self, RosError> {
        let for_us = |rule: &&Remap| rule.node.as_deref().is_none_or(|node| node == default_name);
        let last = |special: &[&str]| remaps.iter().filter(for_us).rfind(|rule| special.contains(&rule.from.as_str()));
        // rcl accepts both names.
        let name = last(&["__node", "__name"]).map_or(default_name, |rule| rule.to.as_str()).to_string();
        check_token(&name, &name)?;
        let namespace = last(&["__ns"]).map_or("/", |rule| rule.to.as_str());
        let namespace = if namespace.starts_with('/') { namespace.to_string() } else { format!("/{namespace}") };
        if namespace != "/" {
            check_full(&namespace)?;
        }
        let special = |rule: &&Remap| !matches!(rule.from.as_str(), "__node" | "__ns" | "__name");
        let rules = remaps.iter().filter(for_us).filter(special).cloned().collect();
        Ok(NodeIdentity { namespace, name, remaps: rules })
    }

    /// Name without namespace.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Namespace, beginning with a slash.
    pub fn namespace(&self) -> &str {
        &self.namespace
    }

    /// Namespace and name.
    pub fn full_name(&self) -> String {
        join(&self.namespace, &self.name)
    }

    /// The full name of a topic or service that the program calls `name`, after the rules.
    ///
    /// # Errors
    /// [`RosError::Name`].
    pub fn resolve(&self, name: &str) -> Result<String, RosError> {
        let full = self.expand(name)?;
        for rule in &self.remaps {
            if self.expand(&rule.from)? == full {
                return self.expand(&rule.to);
            }
        }
        Ok(full)
    }

    fn expand(&self, name: &str) -> Result<String, RosError> {
        let name = name.strip_prefix("rostopic://").or(name.strip_prefix("rosservice://")).unwrap_or(name);
        let full = if name == "~" {
            self.full_name()
        } else if let Some(private) = name.strip_prefix("~/") {
            join(&self.full_name(), private)
        } else if name.starts_with('/') {
            name.to_string()
        } else {
            join(&self.namespace, name)
        };
        check_full(&full)?;
        Ok(full)
    }
}

fn join(namespace: &str, name: &str) -> String {
    format!("{}/{name}", namespace.trim_end_matches('/'))
}

fn check_full(name: &str) -> Result<(), RosError> {
    let tokens = name.strip_prefix('/').unwrap_or(name);
    tokens.split('/').try_for_each(|token| check_token(token, name))
}

fn check_token(token: &str, whole: &str) -> Result<(), RosError> {
    let refuse = |reason: &str| Err(RosError::Name { name: whole.to_string(), reason: reason.to_string() });
    if token.is_empty() {
        return refuse("a part between slashes is empty");
    }
    if token.starts_with(|first: char| first.is_ascii_digit()) {
        return refuse("a part begins with a digit");
    }
    if !token.chars().all(|character| character.is_ascii_alphanumeric() || character == '_') {
        return refuse("only letters, digits and underscores stand between slashes");
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn rule(node: Option<&str>, from: &str, to: &str) -> Remap {
        Remap { node: node.map(str::to_string), from: from.to_string(), to: to.to_string() }
    }

    #[test]
    fn node_and_namespace_can_be_given() {
        let identity = NodeIdentity::new("arm_simulator", &[rule(None, "__node", "left"), rule(None, "__ns", "/pit")]);
        let identity = identity.unwrap();
        assert_eq!(identity.full_name(), "/pit/left");
        assert_eq!(identity.resolve("/arm/state").unwrap(), "/arm/state");
        assert_eq!(NodeIdentity::new("a", &[rule(None, "__name", "b")]).unwrap().name(), "b");
        assert_eq!(identity.resolve("arm/state").unwrap(), "/pit/arm/state");
        assert_eq!(identity.resolve("~/status").unwrap(), "/pit/left/status");
    }

    #[test]
    fn rules_of_other_nodes_do_not_count() {
        let rules = [rule(Some("other"), "/a", "/b"), rule(Some("me"), "/a", "/c"), rule(Some("other"), "__ns", "/x")];
        let identity = NodeIdentity::new("me", &rules).unwrap();
        assert_eq!(identity.resolve("/a").unwrap(), "/c");
        assert_eq!(identity.namespace(), "/");
    }

    #[test]
    fn names_that_ros_refuses_are_refused() {
        for bad in ["/a//b", "/1a", "/a b", "", "/", "/a/"] {
            assert!(NodeIdentity::new("me", &[]).unwrap().resolve(bad).is_err(), "{bad}");
        }
        assert!(NodeIdentity::new("me", &[rule(None, "__node", "a/b")]).is_err());
    }
}
