//! The page's data on the machine itself: its robot description and the scales of its cylinders.

use excavator_model::document::parse;
use excavator_model::effects::Catalogue;
use excavator_model::machine::{CommandUnit, Cylinder};
use serde_json::{Map, Value, json};

use super::bounded::MOST_SHOWN;

/// Longest robot description and longest model accepted, bytes.
const LONGEST_TEXT: usize = 256 << 10;

/// Description and scales, with a version number that changes with them.
#[derive(Default)]
pub(super) struct Machine {
    version: u64,
    description: String,
    cylinders: Map<String, Value>,
}

impl Machine {
    /// Stores a robot description, unless it is too long. Only browsers parse it.
    pub fn describe(&mut self, mut description: String) {
        if description.len() > LONGEST_TEXT || description == self.description {
            return;
        }
        description.shrink_to_fit();
        self.description = description;
        self.version += 1;
    }

    /// Stores the scales of all cylinders.
    pub fn scale(&mut self, cylinders: Map<String, Value>) {
        if cylinders != self.cylinders {
            self.cylinders = cylinders;
            self.version += 1;
        }
    }

    /// The version. A page that has another version requests the data again.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// All data, for a page.
    pub fn to_json(&self) -> Value {
        json!({"version": self.version, "description": self.description, "cylinders": self.cylinders})
    }
}

/// Ends of stroke, kind of actuator and unit of the command of each cylinder of a model; `None` if the model cannot be read.
pub(super) fn scales(text: &str) -> Option<Map<String, Value>> {
    if text.len() > LONGEST_TEXT {
        return None;
    }
    let model = parse("arm/model", text, &Catalogue::built_in()).ok()?;
    let cylinders = model.machine.cylinders.iter().take(MOST_SHOWN);
    Some(cylinders.map(|cylinder| (cylinder.name.clone(), scale(cylinder))).collect())
}

/// JSON has no infinity: the ends of a motor become `null`.
fn scale(cylinder: &Cylinder) -> Value {
    let (factor, symbol) = match cylinder.chambers.map(|chambers| chambers.drive.command_unit()) {
        Some(CommandUnit::SquareMetre) | None => (1e6, "mm²"),
        Some(other) => other.for_people(),
    };
    json!({
        "ends": cylinder.ends, "motor": cylinder.is_motor(),
        "command": {"factor": factor, "symbol": symbol},
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::{built_in, to_text};

    use super::*;

    #[test]
    fn a_model_gives_the_stroke_and_the_unit_of_the_command() {
        let text = to_text(&built_in("zx30u-arm").unwrap()).unwrap();
        let all = scales(&text).unwrap();
        let arm = &all["arm"];
        assert_eq!(arm["ends"], json!([-0.3, 0.3]));
        assert_eq!(arm["motor"], json!(false));
        assert_eq!(arm["command"], json!({"factor": 1e6, "symbol": "mm²"}));
        assert!(scales("no model").is_none() && scales(&"#".repeat(LONGEST_TEXT + 1)).is_none());
    }

    #[test]
    fn only_a_change_is_a_new_version_and_a_long_description_is_none() {
        let mut machine = Machine::default();
        machine.describe("<robot/>".into());
        machine.describe("<robot/>".into());
        machine.describe("x".repeat(LONGEST_TEXT + 1));
        assert_eq!((machine.version(), machine.to_json()["description"].as_str()), (1, Some("<robot/>")));
    }
}
