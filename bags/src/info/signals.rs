//! The signals of a recording, and what they can identify.

use std::collections::BTreeSet;

use excavator_model::recording::Recording;
use serde::Serialize;

/// One measured signal.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SignalInfo {
    /// Contract name: `arm.displacement`.
    pub name: String,
    /// Share of the samples without value, 0 to 1.
    pub missing: f64,
    /// Smallest value, SI.
    pub least: f64,
    /// Largest value, SI.
    pub most: f64,
}

/// One equation of the model and the signals that it lacks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct EquationInfo {
    /// `arm motion`, `arm chambers`, `pump line`.
    pub equation: String,
    /// The signals that must be measured before the equation can be identified; empty when it can.
    pub missing: Vec<String>,
    /// The signals that are not measured and must be constants of the machine then.
    pub constant: Vec<String>,
}

/// What can be identified from a recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[must_use]
#[non_exhaustive]
pub struct SignalsInfo {
    /// Samples of the clock.
    pub samples: usize,
    /// Time from the first sample to the last, s.
    #[serde(skip)]
    pub duration: f64,
    /// Measured signals, in the order of the messages.
    pub measured: Vec<SignalInfo>,
    /// The equations that such a machine has.
    pub equations: Vec<EquationInfo>,
}

/// The known properties of the signals of a recording that is read in blocks.
#[derive(Debug, Clone, Default)]
pub struct SignalsTally {
    samples: usize,
    /// First and last stamp, ns.
    span: Option<[i64; 2]>,
    cylinders: Vec<String>,
    signals: Vec<Range>,
}

/// Statistics of one signal so far.
#[derive(Debug, Clone)]
struct Range {
    name: String,
    finite: usize,
    least: f64,
    most: f64,
}

impl Range {
    fn new(name: String) -> Self {
        Range { name, finite: 0, least: f64::INFINITY, most: f64::NEG_INFINITY }
    }

    fn add(&mut self, values: &[f64]) {
        for &value in values.iter().filter(|value| value.is_finite()) {
            self.finite += 1;
            self.least = self.least.min(value);
            self.most = self.most.max(value);
        }
    }

    fn info(self, samples: usize) -> SignalInfo {
        let missing = 1.0 - self.finite as f64 / samples.max(1) as f64;
        SignalInfo { name: self.name, missing, least: self.least, most: self.most }
    }
}

impl SignalsTally {
    /// Adds the next block.
    pub fn add(&mut self, block: &Recording) {
        self.samples += block.len();
        let last = block.start_nanoseconds.saturating_add((block.duration() * 1e9).round() as i64);
        let [start, end] = self.span.unwrap_or([block.start_nanoseconds, last]);
        self.span = Some([start, end.max(last)]);
        for cylinder in &block.cylinders {
            if !self.cylinders.contains(&cylinder.name) {
                self.cylinders.push(cylinder.name.clone());
            }
        }
        for (name, values) in block.signals() {
            match self.signals.iter_mut().find(|signal| signal.name == name) {
                Some(signal) => signal.add(values),
                None => {
                    let mut signal = Range::new(name);
                    signal.add(values);
                    self.signals.push(signal);
                }
            }
        }
    }

    /// The summary of all blocks.
    pub fn info(self) -> SignalsInfo {
        let measured = self.signals.iter().filter(|signal| signal.finite > 0).map(|signal| signal.name.clone());
        let known = Measured(measured.collect());
        let mut equations: Vec<EquationInfo> = Vec::new();
        for cylinder in &self.cylinders {
            equations.push(known.motion(cylinder));
            // A drive without any hydraulic measurement cannot be shown to have chambers.
            if known.has_oil(cylinder) {
                equations.push(known.chambers(cylinder));
            }
        }
        if self.cylinders.iter().any(|cylinder| known.has_oil(cylinder)) {
            equations.push(known.pump_line(&self.cylinders));
        }
        let [start, end] = self.span.unwrap_or_default();
        let signals = self.signals.into_iter().filter(|signal| signal.finite > 0);
        SignalsInfo {
            samples: self.samples,
            duration: end.saturating_sub(start) as f64 / 1e9,
            measured: signals.map(|signal| signal.info(self.samples)).collect(),
            equations,
        }
    }
}

impl SignalsInfo {
    /// Summarizes every signal of a recording.
    ///
    /// ```
    /// use excavator_bags::SignalsInfo;
    /// use excavator_model::recording::Recording;
    ///
    /// let mut recording = Recording::unmeasured("a drive", vec![0.0, 0.01, 0.02], &["arm"]);
    /// recording.cylinders[0].displacement = vec![0.1, 0.2, 0.3];
    /// let found = SignalsInfo::of(&recording);
    /// assert_eq!(found.measured[0].name, "arm.displacement");
    /// assert_eq!((found.measured[0].least, found.measured[0].most), (0.1, 0.3));
    /// for equation in &found.equations {
    ///     println!("{} lacks {}", equation.equation, equation.missing.join(", "));
    /// }
    /// ```
    pub fn of(recording: &Recording) -> SignalsInfo {
        let mut tally = SignalsTally::default();
        tally.add(recording);
        tally.info()
    }
}

impl SignalInfo {
    /// Summarizes all values of a signal.
    pub(super) fn of(name: String, values: &[f64]) -> SignalInfo {
        let mut range = Range::new(name);
        range.add(values);
        range.info(values.len())
    }
}

/// Names of the measured signals.
struct Measured(BTreeSet<String>);

impl Measured {
    fn is(&self, cylinder: &str, signal: &str) -> bool {
        self.0.contains(&format!("{cylinder}.{signal}"))
    }

    fn has_oil(&self, cylinder: &str) -> bool {
        ["cap_pressure", "rod_pressure", "orifice_area", "orifice_command"].iter().any(|own| self.is(cylinder, own))
    }

    fn position(&self, cylinder: &str, missing: &mut Vec<String>) {
        if !self.is(cylinder, "displacement") && !self.is(cylinder, "joint_angle") {
            missing.push(format!("{cylinder}.displacement or {cylinder}.joint_angle"));
        }
    }

    fn pressures(&self, cylinder: &str, missing: &mut Vec<String>) {
        let lacking = ["cap_pressure", "rod_pressure"].into_iter().filter(|own| !self.is(cylinder, own));
        missing.extend(lacking.map(|own| format!("{cylinder}.{own}")));
    }

    fn opening(&self, cylinder: &str, missing: &mut Vec<String>) {
        if !self.is(cylinder, "orifice_area") && !self.is(cylinder, "orifice_command") {
            missing.push(format!("{cylinder}.orifice_area or {cylinder}.orifice_command"));
        }
    }

    /// Torque or force on the load of the cylinder: from both pressures, or from a load cell alone.
    fn motion(&self, cylinder: &str) -> EquationInfo {
        let mut missing = Vec::new();
        self.position(cylinder, &mut missing);
        if !self.is(cylinder, "rod_force") {
            self.pressures(cylinder, &mut missing);
            if !self.has_oil(cylinder) {
                missing.retain(|name| !name.ends_with("_pressure"));
                missing.push(format!("{cylinder}.rod_force, or {cylinder}.cap_pressure and {cylinder}.rod_pressure"));
            }
        }
        EquationInfo { equation: format!("{cylinder} motion"), missing, constant: Vec::new() }
    }

    /// Continuity of both chambers.
    fn chambers(&self, cylinder: &str) -> EquationInfo {
        let mut missing = Vec::new();
        self.position(cylinder, &mut missing);
        self.pressures(cylinder, &mut missing);
        self.opening(cylinder, &mut missing);
        let constant = self.lacking(&["pump_pressure", "tank_pressure"]);
        EquationInfo { equation: format!("{cylinder} chambers"), missing, constant }
    }

    /// Continuity of the line between pump and valves.
    fn pump_line(&self, cylinders: &[String]) -> EquationInfo {
        let mut missing = self.lacking(&["pump_pressure"]);
        let constant = self.lacking(&["tank_pressure", "pump_flow"]);
        for cylinder in cylinders.iter().filter(|cylinder| self.has_oil(cylinder)) {
            self.opening(cylinder, &mut missing);
        }
        EquationInfo { equation: "pump line".to_string(), missing, constant }
    }

    fn lacking(&self, signals: &[&str]) -> Vec<String> {
        signals.iter().filter(|signal| !self.0.contains(**signal)).map(|signal| signal.to_string()).collect()
    }
}
