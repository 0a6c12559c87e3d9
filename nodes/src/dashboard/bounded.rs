//! Truncates foreign messages to what a page shows.

use excavator_msgs::common::{DiagnosticStatus, KeyValue};
use excavator_msgs::{ArmState, EnergyState, OrificeCommand};

/// Most cylinders, effects of each, and values of a part that are shown.
pub(super) const MOST_SHOWN: usize = 32;
/// Longest name, bytes.
const LONGEST_NAME: usize = 128;
/// Longest message of a part, bytes.
const LONGEST_MESSAGE: usize = 512;

/// Keeps the first cylinders, with names that are not too long.
pub(super) fn state(mut state: ArmState) -> ArmState {
    state.header.frame_id = String::new();
    cut_list(&mut state.cylinders);
    state.cylinders.iter_mut().for_each(|cylinder| cut(&mut cylinder.name, LONGEST_NAME));
    state
}

/// Keeps the first valves.
pub(super) fn command(mut command: OrificeCommand) -> OrificeCommand {
    command.header.frame_id = String::new();
    cut_list(&mut command.names);
    cut_list(&mut command.areas);
    command.names.iter_mut().for_each(|name| cut(name, LONGEST_NAME));
    command
}

/// Keeps the first cylinders and effects.
pub(super) fn energy(mut energy: EnergyState) -> EnergyState {
    energy.header.frame_id = String::new();
    cut_list(&mut energy.cylinders);
    for cylinder in &mut energy.cylinders {
        cut(&mut cylinder.name, LONGEST_NAME);
        cut_list(&mut cylinder.terms);
        cylinder.terms.iter_mut().for_each(|term| cut(&mut term.effect, LONGEST_NAME));
    }
    energy
}

/// Keeps the status of a part and its first values.
pub(super) fn status(mut status: DiagnosticStatus) -> DiagnosticStatus {
    cut(&mut status.name, LONGEST_NAME);
    cut(&mut status.message, LONGEST_MESSAGE);
    cut_list(&mut status.values);
    for KeyValue { key, value } in &mut status.values {
        cut(key, LONGEST_NAME);
        cut(value, LONGEST_NAME);
    }
    status
}

/// Truncates a list and frees the memory of the rest.
fn cut_list<T>(list: &mut Vec<T>) {
    list.truncate(MOST_SHOWN);
    list.shrink_to_fit();
}

fn cut(text: &mut String, longest: usize) {
    text.truncate(text.floor_char_boundary(longest));
    text.shrink_to_fit();
}

#[cfg(test)]
mod tests {
    use excavator_msgs::CylinderState;

    use super::*;

    #[test]
    fn what_a_stranger_says_is_cut() {
        let mut large = ArmState {
            header: Default::default(),
            cylinders: vec![CylinderState::unmeasured(&"ä".repeat(50_000)); 5000],
            pump_pressure: 0.0,
            tank_pressure: 0.0,
            pump_flow: 0.0,
            oil_temperature: 0.0,
        };
        large.header.frame_id = "x".repeat(100_000);
        let small = state(large);
        assert_eq!((small.cylinders.len(), small.header.frame_id.len()), (MOST_SHOWN, 0));
        assert!(small.cylinders.capacity() <= 2 * MOST_SHOWN);
        assert!(small.cylinders.iter().all(|cylinder| cylinder.name.len() == LONGEST_NAME));
    }
}
