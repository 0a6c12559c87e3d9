//! What the environment says about the network.

use std::net::{IpAddr, Ipv4Addr};

use super::RosError;

/// How far peers are looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DiscoveryRange {
    /// Other programs on this machine.
    Localhost,
    /// Everybody whom multicast reaches.
    Subnet,
}

/// How services are laid over topics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mapping {
    /// As rmw_cyclonedds_cpp does: the request's identity stands before the request.
    Cyclone,
    /// As rmw_fastrtps_cpp and rmw_connextdds do: the identity travels as inline quality of service.
    Enhanced,
}

/// What the environment says about the network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Environment {
    /// `ROS_DOMAIN_ID`, 0 to 232.
    pub domain: u16,
    /// `ROS_AUTOMATIC_DISCOVERY_RANGE`, or `ROS_LOCALHOST_ONLY=1` of older distributions.
    pub range: DiscoveryRange,
    /// From `RMW_IMPLEMENTATION`; the default of ROS 2 is rmw_fastrtps_cpp.
    pub mapping: Mapping,
}

impl Environment {
    /// Reads the environment of this process.
    ///
    /// # Errors
    /// [`RosError::Environment`].
    pub fn read() -> Result<Self, RosError> {
        Self::from_lookup(|name| std::env::var(name).ok())
    }

    fn from_lookup(lookup: impl Fn(&str) -> Option<String>) -> Result<Self, RosError> {
        let value = |name: &str| lookup(name).filter(|text| !text.trim().is_empty());
        let domain = match value("ROS_DOMAIN_ID") {
            None => 0,
            Some(text) => text.trim().parse().ok().filter(|domain| *domain <= 232).ok_or(RosError::Environment {
                variable: "ROS_DOMAIN_ID",
                value: text,
                problem: "not a whole number from 0 to 232".to_string(),
            })?,
        };
        let range = match value("ROS_AUTOMATIC_DISCOVERY_RANGE").map(|text| text.to_ascii_uppercase()).as_deref() {
            None | Some("SUBNET" | "SYSTEM_DEFAULT") => DiscoveryRange::Subnet,
            // Discovery cannot be switched off; on this machine only is the nearest that there is.
            Some("LOCALHOST" | "OFF") => DiscoveryRange::Localhost,
            Some(other) => {
                return Err(RosError::Environment {
                    variable: "ROS_AUTOMATIC_DISCOVERY_RANGE",
                    value: other.to_string(),
                    problem: "none of SUBNET, LOCALHOST, OFF, SYSTEM_DEFAULT".to_string(),
                });
            }
        };
        let localhost_only = value("ROS_LOCALHOST_ONLY").is_some_and(|text| text == "1");
        let range = if localhost_only { DiscoveryRange::Localhost } else { range };
        let cyclone = value("RMW_IMPLEMENTATION").is_some_and(|name| name.contains("cyclone"));
        let mapping = if cyclone { Mapping::Cyclone } else { Mapping::Enhanced };
        Ok(Environment { domain, range, mapping })
    }

    /// Addresses of the networks to use, `None` for all.
    pub fn networks(&self) -> Option<[IpAddr; 1]> {
        (self.range == DiscoveryRange::Localhost).then_some([IpAddr::V4(Ipv4Addr::LOCALHOST)])
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn of(pairs: &[(&str, &str)]) -> Result<Environment, RosError> {
        Environment::from_lookup(|name| pairs.iter().find(|(key, _)| *key == name).map(|(_, value)| value.to_string()))
    }

    #[test]
    fn defaults_are_those_of_ros() {
        let expected = Environment { domain: 0, range: DiscoveryRange::Subnet, mapping: Mapping::Enhanced };
        assert_eq!(of(&[]).unwrap(), expected);
    }

    #[test]
    fn variables_are_followed() {
        let environment = of(&[
            ("ROS_DOMAIN_ID", "42"),
            ("ROS_AUTOMATIC_DISCOVERY_RANGE", "localhost"),
            ("RMW_IMPLEMENTATION", "rmw_cyclonedds_cpp"),
        ])
        .unwrap();
        let expected = Environment { domain: 42, range: DiscoveryRange::Localhost, mapping: Mapping::Cyclone };
        assert_eq!(environment, expected);
        assert_eq!(of(&[("ROS_LOCALHOST_ONLY", "1")]).unwrap().range, DiscoveryRange::Localhost);
    }

    #[test]
    fn nonsense_is_refused() {
        assert!(of(&[("ROS_DOMAIN_ID", "233")]).is_err());
        assert!(of(&[("ROS_DOMAIN_ID", "x")]).is_err());
        assert!(of(&[("ROS_AUTOMATIC_DISCOVERY_RANGE", "moon")]).is_err());
    }
}
