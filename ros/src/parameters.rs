//! The parameters of a node: declared once, set from the command line, from files and by other nodes.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::{Parameter, RosError, Value};

/// Checks a new value of a parameter before it is set, and returns the reason if it refuses it. It has no side effects:
/// nodes read parameters where they use them.
pub type OnSet = Box<dyn Fn(&str, &Value) -> Result<(), String> + Send>;

/// All parameters of a node; clones share them.
#[derive(Clone)]
pub struct Parameters {
    shared: Arc<Mutex<Shared>>,
}

struct Shared {
    parameters: BTreeMap<&'static str, Parameter>,
    on_set: Option<OnSet>,
}

impl Parameters {
    /// Declares `parameters` with the `overrides` of command line and files. Overrides of unknown parameters are
    /// returned as warnings with the nearest name, so that a mistyped name does not go unnoticed.
    ///
    /// ```
    /// use excavator_ros::{Parameter, Parameters, Value};
    ///
    /// let rate = Parameter::new("rate", Value::Double(1000.0), "samples per second [Hz]").within(1.0, 2000.0);
    /// let overrides = [("rate".to_string(), Value::Integer(500))];
    /// let (parameters, warnings) = Parameters::declare(vec![rate], &overrides)?;
    /// assert_eq!(parameters.double("rate"), 500.0);
    /// assert!(warnings.is_empty());
    /// # Ok::<(), excavator_ros::RosError>(())
    /// ```
    ///
    /// # Errors
    /// [`RosError::Parameter`] for a value of the wrong type or out of range.
    pub fn declare(parameters: Vec<Parameter>, overrides: &[(String, Value)]) -> Result<(Self, Vec<String>), RosError> {
        let mut all: BTreeMap<&'static str, Parameter> =
            parameters.into_iter().map(|parameter| (parameter.name, parameter)).collect();
        let sim_time = "take the time from /clock instead of the system's clock";
        all.entry("use_sim_time").or_insert_with(|| Parameter::new("use_sim_time", Value::Boolean(false), sim_time));
        let mut warnings = Vec::new();
        for (name, value) in overrides {
            match all.get_mut(name.as_str()) {
                Some(parameter) => {
                    parameter.value = parameter.checked(value.clone()).map_err(RosError::Parameter)?;
                }
                None if name.starts_with("qos_overrides.") => {}
                None => warnings.push(unknown(name, all.keys().copied())),
            }
        }
        Ok((Parameters { shared: Arc::new(Mutex::new(Shared { parameters: all, on_set: None })) }, warnings))
    }

    /// Sets the check that runs before a parameter changes while the node runs.
    pub fn on_set(&self, check: OnSet) {
        self.lock().on_set = Some(check);
    }

    /// Sets several parameters, or none of them.
    ///
    /// # Errors
    /// The reason why the first refused parameter cannot be set, as a message for the user.
    pub fn set_all(&self, values: Vec<(String, Value)>) -> Result<Vec<(String, Value)>, String> {
        let mut shared = self.lock();
        let mut checked = Vec::new();
        for (name, value) in values {
            let value = shared.check(&name, value)?;
            checked.push((name, value));
        }
        for (name, value) in &checked {
            if let Some(parameter) = shared.parameters.get_mut(name.as_str()) {
                parameter.value = value.clone();
            }
        }
        Ok(checked)
    }

    /// The parameter of this name.
    pub fn get(&self, name: &str) -> Option<Parameter> {
        self.lock().parameters.get(name).cloned()
    }

    /// All parameters, sorted by name.
    pub fn all(&self) -> Vec<Parameter> {
        self.lock().parameters.values().cloned().collect()
    }

    /// Value of a numeric parameter; `NaN` for one that does not exist, which every range rejects.
    pub fn double(&self, name: &str) -> f64 {
        self.get(name).and_then(|parameter| parameter.value.as_double()).unwrap_or(f64::NAN)
    }

    /// Value of an integer parameter; zero for one that does not exist.
    pub fn integer(&self, name: &str) -> i64 {
        self.get(name).and_then(|parameter| parameter.value.as_integer()).unwrap_or_default()
    }

    /// Value of a boolean parameter; `false` for one that does not exist.
    pub fn flag(&self, name: &str) -> bool {
        self.get(name).and_then(|parameter| parameter.value.as_bool()).unwrap_or_default()
    }

    /// Value of a string parameter; empty for one that does not exist.
    pub fn text(&self, name: &str) -> String {
        self.get(name).and_then(|parameter| parameter.value.as_text().map(str::to_string)).unwrap_or_default()
    }

    /// Value of a list of numbers; empty for one that does not exist.
    pub fn doubles(&self, name: &str) -> Vec<f64> {
        match self.get(name).map(|parameter| parameter.value) {
            Some(Value::DoubleArray(values)) => values,
            _ => Vec::new(),
        }
    }

    /// Value of a list of texts; empty for one that does not exist.
    pub fn texts(&self, name: &str) -> Vec<String> {
        match self.get(name).map(|parameter| parameter.value) {
            Some(Value::StringArray(values)) => values,
            _ => Vec::new(),
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Shared> {
        // A panic in a callback leaves only complete values behind, so the data is usable.
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Shared {
    fn check(&self, name: &str, value: Value) -> Result<Value, String> {
        let Some(parameter) = self.parameters.get(name) else {
            return Err(unknown(name, self.parameters.keys().copied()));
        };
        if parameter.read_only {
            return Err(format!("{name} is read-only: give it when the node starts, with -p {name}:=VALUE"));
        }
        let value = parameter.checked(value)?;
        if let Some(check) = &self.on_set {
            check(name, &value)?;
        }
        Ok(value)
    }
}

fn unknown<'n>(name: &str, known: impl Iterator<Item = &'n str>) -> String {
    let near = known
        .map(|candidate| (strsim::jaro_winkler(name, candidate), candidate))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(likeness, _)| *likeness > 0.7);
    let suggestion = near.map_or(String::new(), |(_, candidate)| format!(" (did you mean \"{candidate}\"?)"));
    format!("there is no parameter \"{name}\"{suggestion}")
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn declared() -> Vec<Parameter> {
        vec![
            Parameter::new("rate", Value::Double(1000.0), "samples per second [Hz]").within(1.0, 2000.0).read_only(),
            Parameter::new("command_timeout", Value::Double(0.1), "lease of a command [s]").within(0.001, 10.0),
            Parameter::new("seed", Value::Integer(1), "draws the noise"),
        ]
    }

    #[test]
    fn overrides_come_in_and_mistyped_names_are_told() {
        let overrides = [("rate".to_string(), Value::Integer(500)), ("sed".to_string(), Value::Integer(2))];
        let (parameters, warnings) = Parameters::declare(declared(), &overrides).unwrap();
        assert_eq!(parameters.double("rate"), 500.0);
        assert_eq!(warnings, ["there is no parameter \"sed\" (did you mean \"seed\"?)"]);
        assert!(parameters.get("use_sim_time").is_some());
    }

    #[test]
    fn an_override_out_of_range_ends_the_start() {
        assert!(Parameters::declare(declared(), &[("rate".to_string(), Value::Double(1e6))]).is_err());
    }

    #[test]
    fn several_are_set_together_or_not_at_all() {
        let (parameters, _) = Parameters::declare(declared(), &[]).unwrap();
        let bad = vec![("command_timeout".to_string(), Value::Double(0.2)), ("seed".to_string(), Value::Double(0.5))];
        assert!(parameters.set_all(bad).is_err());
        assert_eq!(parameters.double("command_timeout"), 0.1);
        let good = vec![("command_timeout".to_string(), Value::Double(0.2)), ("seed".to_string(), Value::Integer(5))];
        assert!(parameters.set_all(good).is_ok());
        assert_eq!((parameters.double("command_timeout"), parameters.integer("seed")), (0.2, 5));
    }

    #[test]
    fn read_only_parameters_stay() {
        let (parameters, _) = Parameters::declare(declared(), &[]).unwrap();
        assert!(parameters.set_all(vec![("rate".to_string(), Value::Double(100.0))]).is_err());
        assert_eq!(parameters.double("rate"), 1000.0);
    }

    #[test]
    fn the_node_can_refuse() {
        let (parameters, _) = Parameters::declare(declared(), &[]).unwrap();
        parameters.on_set(Box::new(|name, _| Err(format!("not {name} now"))));
        assert_eq!(parameters.set_all(vec![("seed".to_string(), Value::Integer(3))]), Err("not seed now".to_string()));
    }
}
