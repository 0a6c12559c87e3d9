//! Parameter files: `node: ros__parameters: name: value`, with wildcards for nodes.

use std::path::Path;

use rosbag2::yaml::{self, Yaml};
use rosbag2::{ReadLimits, read_regular_text};

use super::value_text::from_yaml;
use super::{NodeIdentity, RosError, Value};

/// The parameters for a node in the file at `path`, in the order of the file.
///
/// # Errors
/// [`RosError::ParameterFile`].
pub fn read_for(path: &Path, node: &NodeIdentity) -> Result<Vec<(String, Value)>, RosError> {
    let failed = |reason: String| RosError::ParameterFile { path: path.to_path_buf(), reason };
    let text = read_regular_text(path, ReadLimits::DEFAULT.document).map_err(|error| failed(error.to_string()))?;
    from_text(&text, node).map_err(failed)
}

fn from_text(text: &str, node: &NodeIdentity) -> Result<Vec<(String, Value)>, String> {
    let document: Yaml = yaml::from_str(text, &ReadLimits::DEFAULT)?;
    let mut found = Vec::new();
    match document {
        Yaml::Null => {}
        Yaml::Mapping(_) => walk(&document, "", node, &mut found)?,
        _ => return Err("the file is not a map of node names".to_string()),
    }
    Ok(found)
}

/// Descends namespaces until `ros__parameters`.
fn walk(yaml: &Yaml, path: &str, node: &NodeIdentity, found: &mut Vec<(String, Value)>) -> Result<(), String> {
    let Yaml::Mapping(entries) = yaml else {
        return Err(format!("{path} has no ros__parameters"));
    };
    for (key, content) in entries {
        let Yaml::String(key) = key else { return Err(format!("a name under \"{path}\" is not text")) };
        if key == "ros__parameters" {
            if matches(path, &node.full_name()) {
                flatten(content, "", found)?;
            }
        } else {
            walk(content, &format!("{path}/{}", key.trim_matches('/')), node, found)?;
        }
    }
    Ok(())
}

fn flatten(yaml: &Yaml, prefix: &str, found: &mut Vec<(String, Value)>) -> Result<(), String> {
    match yaml {
        Yaml::Null if prefix.is_empty() => Ok(()),
        Yaml::Mapping(entries) => entries.iter().try_for_each(|(key, content)| {
            let Yaml::String(key) = key else { return Err(format!("a parameter under \"{prefix}\" has no name")) };
            let name = if prefix.is_empty() { key.clone() } else { format!("{prefix}.{key}") };
            flatten(content, &name, found)
        }),
        scalar => {
            let value = from_yaml(scalar)
                .ok_or_else(|| format!("{prefix} is neither a scalar nor a list of scalars of one type"))?;
            found.push((prefix.to_string(), value));
            Ok(())
        }
    }
}

/// Whether `pattern` (`/**`, `/*`, `/ns/**/name`) matches the node; `*` is one part, `**` any number of parts.
fn matches(pattern: &str, full_name: &str) -> bool {
    fn tokens(text: &str) -> Vec<&str> {
        text.split('/').filter(|token| !token.is_empty()).collect()
    }
    fn fits(pattern: &[&str], name: &[&str]) -> bool {
        match (pattern.split_first(), name.split_first()) {
            (None, None) => true,
            (Some((&"**", rest)), _) => (0..=name.len()).any(|skipped| fits(rest, &name[skipped..])),
            (Some((token, pattern)), Some((first, name))) => (*token == "*" || token == first) && fits(pattern, name),
            _ => false,
        }
    }
    fits(&tokens(pattern), &tokens(full_name))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn wildcards_and_namespaces_are_followed() {
        let node = NodeIdentity::new("sim", &[]).unwrap();
        let text = "/**:\n  ros__parameters:\n    rate: 500\nsim:\n  ros__parameters:\n    noise: {pressure: 2e3}\n\
                    other:\n  ros__parameters:\n    rate: 1\n/pit:\n  sim:\n    ros__parameters:\n      rate: 2\n";
        let found = from_text(text, &node).unwrap();
        assert_eq!(
            found,
            [("rate".to_string(), Value::Integer(500)), ("noise.pressure".to_string(), Value::Double(2e3))]
        );
    }

    #[test]
    fn patterns_mean_what_they_mean_in_ros() {
        for (pattern, name, expected) in [
            ("/**", "/a/b", true),
            ("/*", "/a", true),
            ("/*", "/a/b", false),
            ("/**/b", "/a/b", true),
            ("/a/*", "/a/b", true),
            ("/a", "/b", false),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }

    #[test]
    fn what_is_no_parameter_file_says_why() {
        let node = NodeIdentity::new("sim", &[]).unwrap();
        for text in ["[1, 2]", "sim: 3", "sim:\n  ros__parameters:\n    a: [1, b]", "a: ["] {
            assert!(from_text(text, &node).is_err(), "{text}");
        }
        assert_eq!(from_text("", &node), Ok(Vec::new()));
    }
}
