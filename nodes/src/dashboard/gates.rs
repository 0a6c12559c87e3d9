//! Extracts the state of a node's command gate from its diagnostics.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use crate::command_gate::{CLOSED_BECAUSE, COMMAND_AGE, COMMANDED_BY, STOPPED_BY};

#[derive(Default)]
struct Valve<'p> {
    owner: Option<&'p str>,
    age: Option<f64>,
    closed: Option<&'p str>,
}

/// The node of this namespace (`left/`, or empty) whose part `commands` has this name.
pub(super) fn node_of<'p>(part: &'p str, namespace: &str) -> Option<&'p str> {
    let node = part.strip_suffix(": commands")?.strip_prefix(namespace)?;
    // Another namespace is another machine.
    (!node.contains('/')).then_some(node)
}

/// Who commands each valve, which are closed and why, and who has stopped the machine.
pub(super) fn gate(node: &str, message: &str, values: &[(String, String)]) -> Value {
    let mut valves: BTreeMap<&str, Valve<'_>> = BTreeMap::new();
    for (key, value) in values {
        if let Some(name) = key.strip_suffix(COMMANDED_BY) {
            valves.entry(name).or_default().owner = (value != "-").then_some(value.as_str());
        } else if let Some(name) = key.strip_suffix(COMMAND_AGE) {
            valves.entry(name).or_default().age = value.parse().ok();
        } else if let Some(name) = key.strip_suffix(CLOSED_BECAUSE) {
            valves.entry(name).or_default().closed = Some(value.as_str());
        }
    }
    let valves: Map<String, Value> = valves
        .into_iter()
        .map(|(name, Valve { owner, age, closed })| {
            (name.to_string(), json!({"commanded_by": owner, "age": age, "closed_because": closed}))
        })
        .collect();
    json!({"node": node, "message": message, "stopped_by": message.strip_prefix(STOPPED_BY), "valves": valves})
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gate_is_one_of_its_own_namespace() {
        assert_eq!(node_of("arm_simulator: commands", ""), Some("arm_simulator"));
        assert_eq!(node_of("left/arm_simulator: commands", "left/"), Some("arm_simulator"));
        for (part, namespace) in [
            ("left/arm_simulator: commands", ""),
            ("arm_simulator: commands", "left/"),
            ("left/inner/arm_simulator: commands", "left/"),
            ("arm_simulator: refusal", ""),
        ] {
            assert_eq!(node_of(part, namespace), None, "{part}");
        }
    }

    #[test]
    fn owners_ages_and_reasons_are_told_by_valve() {
        let values = [
            ("arm: commanded by", "/player (source autonomy, priority 0)"),
            ("arm: age of the last command [s]", "0.012"),
            ("boom: commanded by", "-"),
            ("boom: age of the last command [s]", "-"),
            ("boom: closed because", "the lease of /player has run out"),
            ("something else", "1"),
        ]
        .map(|(key, value)| (key.to_string(), value.to_string()));
        let gate = gate("arm_simulator", "following commands", &values);
        assert_eq!(gate["stopped_by"], Value::Null);
        let expected = json!({
            "arm": {"commanded_by": "/player (source autonomy, priority 0)", "age": 0.012, "closed_because": null},
            "boom": {"commanded_by": null, "age": null, "closed_because": "the lease of /player has run out"},
        });
        assert_eq!(gate["valves"], expected);
    }

    #[test]
    fn a_stop_has_a_name() {
        assert_eq!(gate("arm_simulator", "stopped by /panel", &[])["stopped_by"], "/panel");
    }
}
