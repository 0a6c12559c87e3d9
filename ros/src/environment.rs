//! Network settings from the environment variables.

use std::net::{IpAddr, Ipv4Addr};

use super::security::choose;
use super::{RosError, Security};

/// Range of discovery.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DiscoveryRange {
    /// Other processes on this machine.
    Localhost,
    /// All peers that multicast reaches.
    Subnet,
}

/// How services are mapped to topics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mapping {
    /// As in rmw_cyclonedds_cpp: the identity of the request precedes the request in the payload.
    Cyclone,
    /// As in rmw_fastrtps_cpp and rmw_connextdds: the identity is sent as inline QoS.
    Enhanced,
}

/// Default limit for samples in fragments, bytes. A model has some kB.
const LARGEST_SAMPLE: u32 = 1 << 20;

/// Network settings from the environment variables.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Environment {
    /// `ROS_DOMAIN_ID`, 0 to 232.
    pub domain: u16,
    /// `ROS_AUTOMATIC_DISCOVERY_RANGE`, or `ROS_LOCALHOST_ONLY=1` of older distributions.
    pub range: DiscoveryRange,
    /// From `RMW_IMPLEMENTATION`; the default of ROS 2 is rmw_fastrtps_cpp.
    pub mapping: Mapping,
    /// `EXCAVATOR_LARGEST_SAMPLE`: samples in fragments above this limit are dropped, bytes. Rounded up to a power of
    /// two.
    pub largest_sample: u32,
    /// `ROS_SECURITY_ENABLE`, `ROS_SECURITY_STRATEGY`, `ROS_SECURITY_KEYSTORE`, `ROS_SECURITY_ENCLAVE_OVERRIDE`.
    pub security: Security,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

impl Environment {
    /// Reads the environment of this process. `enclave` is the one from the command line.
    ///
    /// # Errors
    /// [`RosError::Environment`], [`RosError::Security`].
    pub fn read(enclave: Option<&str>) -> Result<Self, RosError> {
        Self::from_lookup(|name| std::env::var(name).ok(), enclave)
    }

    /// Accepts samples in fragments up to `bytes`, unless the environment sets the limit.
    #[must_use]
    pub fn with_samples_of(mut self, bytes: u32) -> Self {
        if self.largest_sample == LARGEST_SAMPLE {
            self.largest_sample = bytes;
        }
        self
    }

    fn from_lookup(lookup: impl Fn(&str) -> Option<String>, enclave: Option<&str>) -> Result<Self, RosError> {
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
            Some("LOCALHOST") => DiscoveryRange::Localhost,
            Some("OFF") => {
                return Err(RosError::Environment {
                    variable: "ROS_AUTOMATIC_DISCOVERY_RANGE",
                    value: "OFF".to_string(),
                    problem: "not possible: discovery cannot be switched off here; LOCALHOST keeps it on this machine"
                        .to_string(),
                });
            }
            Some(other) => {
                return Err(RosError::Environment {
                    variable: "ROS_AUTOMATIC_DISCOVERY_RANGE",
                    value: other.to_string(),
                    problem: "none of SUBNET, LOCALHOST, SYSTEM_DEFAULT".to_string(),
                });
            }
        };
        let localhost_only = value("ROS_LOCALHOST_ONLY").is_some_and(|text| text == "1");
        let range = if localhost_only { DiscoveryRange::Localhost } else { range };
        let mapping = match value("RMW_IMPLEMENTATION").as_deref() {
            Some("rmw_cyclonedds_cpp") => Mapping::Cyclone,
            None | Some("rmw_fastrtps_cpp" | "rmw_fastrtps_dynamic_cpp" | "rmw_connextdds") => Mapping::Enhanced,
            Some(other) => {
                return Err(RosError::Environment {
                    variable: "RMW_IMPLEMENTATION",
                    value: other.to_string(),
                    problem: "a middleware that these nodes cannot talk to; they speak DDS, as rmw_fastrtps_cpp, \
                              rmw_cyclonedds_cpp and rmw_connextdds do"
                        .to_string(),
                });
            }
        };
        let largest_sample = match value("EXCAVATOR_LARGEST_SAMPLE") {
            None => LARGEST_SAMPLE,
            Some(text) => text.trim().parse().ok().filter(|bytes| *bytes <= 1 << 30).ok_or(RosError::Environment {
                variable: "EXCAVATOR_LARGEST_SAMPLE",
                value: text,
                problem: "not a number of bytes up to 1073741824".to_string(),
            })?,
        };
        let chosen = choose(&lookup, enclave)?;
        let (security, mut warnings) = (chosen.security, chosen.warnings);
        if let Some(peers) = value("ROS_STATIC_PEERS") {
            warnings.push(format!("ROS_STATIC_PEERS={peers} is not followed: peers are found by multicast alone"));
        }
        if let (Some(enclave), Security::Off) = (enclave, &security) {
            warnings.push(format!("--enclave {enclave} has no effect: DDS Security is off (ROS_SECURITY_ENABLE)"));
        }
        Ok(Environment { domain, range, mapping, largest_sample, security, warnings })
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
        let lookup = |name: &str| pairs.iter().find(|(key, _)| *key == name).map(|(_, value)| value.to_string());
        Environment::from_lookup(lookup, None)
    }

    #[test]
    fn defaults_are_those_of_ros() {
        let found = of(&[]).unwrap();
        let expected = (0, DiscoveryRange::Subnet, Mapping::Enhanced, Security::Off);
        assert_eq!((found.domain, found.range, found.mapping, found.security), expected);
    }

    #[test]
    fn variables_are_followed() {
        let found = of(&[
            ("ROS_DOMAIN_ID", "42"),
            ("ROS_AUTOMATIC_DISCOVERY_RANGE", "localhost"),
            ("RMW_IMPLEMENTATION", "rmw_cyclonedds_cpp"),
        ])
        .unwrap();
        assert_eq!((found.domain, found.range, found.mapping), (42, DiscoveryRange::Localhost, Mapping::Cyclone));
        assert_eq!(of(&[("ROS_LOCALHOST_ONLY", "1")]).unwrap().range, DiscoveryRange::Localhost);
    }

    #[test]
    fn nonsense_is_refused() {
        assert!(of(&[("ROS_DOMAIN_ID", "233")]).is_err());
        assert!(of(&[("ROS_DOMAIN_ID", "x")]).is_err());
        assert!(of(&[("ROS_AUTOMATIC_DISCOVERY_RANGE", "off")]).is_err());
        assert!(of(&[("RMW_IMPLEMENTATION", "rmw_zenoh_cpp")]).is_err());
        assert!(of(&[("ROS_AUTOMATIC_DISCOVERY_RANGE", "moon")]).is_err());
        assert!(of(&[("EXCAVATOR_LARGEST_SAMPLE", "-1")]).is_err());
        assert!(of(&[("ROS_SECURITY_ENABLE", "yes")]).is_err());
    }

    #[test]
    fn what_is_not_followed_is_told() {
        assert_eq!(of(&[("ROS_STATIC_PEERS", "10.0.0.7")]).unwrap().warnings.len(), 1);
        let without_security = Environment::from_lookup(|_| None, Some("/left/arm")).unwrap();
        assert_eq!(without_security.warnings.len(), 1);
    }

    #[test]
    fn the_user_s_word_on_large_samples_is_the_last() {
        let large = 1 << 23;
        assert_eq!(of(&[]).unwrap().with_samples_of(large).largest_sample, large);
        assert_eq!(of(&[("EXCAVATOR_LARGEST_SAMPLE", "65536")]).unwrap().with_samples_of(large).largest_sample, 65536);
    }
}
