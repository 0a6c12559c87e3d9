//! Checks the content of a command against the existing valves.

use excavator_msgs::OrificeCommand;

use super::refusal::Refusal;

/// A valve section that can be commanded.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Valve {
    /// Name of its cylinder.
    pub name: String,
    /// Largest orifice area that may be commanded, m².
    pub maximum_area: f64,
}

/// Tolerance for rounding at the largest area: commands computed as 100 % must pass.
const ROUNDING: f64 = 1e-9;

/// Most characters of a name that a refusal quotes; the network may send any number.
const LONGEST_NAME: usize = 60;

fn brief(name: &str) -> String {
    name.chars().take(LONGEST_NAME).collect()
}

/// Returns the commanded areas by index of the valve, or why the command is rejected. A command is never followed in part.
///
/// # Errors
/// [`Refusal`].
pub(super) fn check(command: &OrificeCommand, valves: &[Valve]) -> Result<Vec<(usize, f64)>, Refusal> {
    if command.names.len() != command.areas.len() {
        return Err(Refusal::Lengths { names: command.names.len(), areas: command.areas.len() });
    }
    let mut areas: Vec<(usize, f64)> = Vec::with_capacity(command.names.len());
    for (name, &area) in command.names.iter().zip(&command.areas) {
        // A cylinder without a valve has an empty name here.
        let Some(index) = valves.iter().position(|valve| valve.name == *name && !name.is_empty()) else {
            let known: Vec<&str> =
                valves.iter().map(|valve| valve.name.as_str()).filter(|name| !name.is_empty()).collect();
            let known = if known.is_empty() { "none".to_string() } else { known.join(", ") };
            return Err(Refusal::UnknownCylinder { name: brief(name), known });
        };
        if areas.iter().any(|(earlier, _)| *earlier == index) {
            return Err(Refusal::Twice { name: brief(name) });
        }
        if !area.is_finite() {
            return Err(Refusal::NotANumber { name: brief(name), area });
        }
        let maximum = valves[index].maximum_area;
        if area.abs() > maximum * (1.0 + ROUNDING) {
            return Err(Refusal::OutOfRange { name: brief(name), area, maximum });
        }
        areas.push((index, area.clamp(-maximum, maximum)));
    }
    Ok(areas)
}

#[cfg(test)]
mod tests {
    use super::*;
    use excavator_msgs::Header;

    fn command(pairs: &[(&str, f64)]) -> OrificeCommand {
        OrificeCommand {
            header: Header::default(),
            names: pairs.iter().map(|pair| pair.0.to_string()).collect(),
            areas: pairs.iter().map(|pair| pair.1).collect(),
        }
    }

    fn valves() -> Vec<Valve> {
        ["boom", "arm"].map(|name| Valve { name: name.to_string(), maximum_area: 1e-4 }).to_vec()
    }

    #[test]
    fn good_commands_pass_by_name() {
        assert_eq!(check(&command(&[("arm", -5e-5)]), &valves()), Ok(vec![(1, -5e-5)]));
        assert_eq!(check(&command(&[("arm", 1e-4), ("boom", 0.0)]), &valves()), Ok(vec![(1, 1e-4), (0, 0.0)]));
        assert_eq!(check(&command(&[]), &valves()), Ok(vec![]));
    }

    #[test]
    fn one_bad_entry_refuses_the_whole_command() {
        for bad in [("bucket", 0.0), ("arm", f64::NAN), ("arm", f64::NEG_INFINITY), ("arm", 2e-4), ("boom", 0.0)] {
            assert!(check(&command(&[("boom", 1e-5), bad]), &valves()).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn lengths_must_agree() {
        let mut wrong = command(&[("arm", 1e-5)]);
        wrong.areas.push(0.0);
        assert_eq!(check(&wrong, &valves()), Err(Refusal::Lengths { names: 1, areas: 2 }));
    }
}
