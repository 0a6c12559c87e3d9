//! What is said about an effect: the fourth face.

use super::Prior;

/// Which part of the machine an effect belongs to; decides where it can be added.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ActsOn {
    /// A joint, its piston or its chambers: one instance per cylinder.
    Cylinder,
    /// The valve section of a cylinder: one instance per cylinder with chambers.
    Valve,
    /// The pump line: one instance per machine.
    PumpLine,
    /// Cylinders with chambers and the pump line alike.
    CylinderOrPumpLine,
    /// Instruments: those of a cylinder, that of the pump line, or all of the machine at once.
    Instruments,
}

/// What an effect needs of the cylinder at which it acts, beyond a piston that moves. A pump line has all of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// Nothing: a cylinder that is driven by a measured force can have it.
    Nothing,
    /// Pressures, but no flows: chambers, or an imposed motion with measured pressures.
    Pressures,
    /// Oil that flows: chambers.
    Oil,
}

/// Where one instance of an effect sits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Site {
    /// At the cylinder (or joint) with this index.
    Cylinder(usize),
    /// At the pump line.
    PumpLine,
    /// Everywhere at once: one effect with one set of parameters for all cylinders and the pump line.
    Machine,
}

/// A corner in a law, which the equations round and an effect of family [`Family::Rounding`] rounds otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corner {
    /// The sign of the velocity in the friction of a piston.
    Friction,
    /// The root of the pressure drop in the flow through the valve's edges.
    OrificeFlow,
}

/// Whether the nominal model of \[A\] has the effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Part of the nominal model of \[A\] or of the frame every simulation needs.
    Base,
    /// How recordings are made, not how the machine works: a nuisance, estimated with every model and never attributed.
    Recording,
    /// How widely the equations round a corner, which no machine knows: a nuisance, estimated with every model and never attributed.
    Rounding,
    /// How a machine is built, which its data sheet says: added by hand, never a candidate.
    Construction,
    /// A loss that the nominal model of \[A\] has, and a candidate where another model leaves it out.
    Loss,
    /// A candidate for what a nominal model may be missing.
    Candidate,
}

impl Family {
    /// Whether a diagnosis tries the effect.
    pub fn is_candidate(self) -> bool {
        matches!(self, Family::Loss | Family::Candidate)
    }
}

/// How a parameter enters the rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The rows are linear in the parameter.
    Linear,
    /// The rows are linear in one over the parameter (bulk moduli).
    Reciprocal,
    /// The rows depend on the parameter nonlinearly (thresholds, speeds, time constants).
    Shape,
}

/// Where a search for a parameter begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// At each of these values in turn; the best fit wins.
    At(&'static [f64]),
    /// At these quantiles of the measured pump pressure: a threshold can only show inside the range that was visited.
    PumpPressureQuantiles(&'static [f64]),
    /// At the beginning (s) of the stretches of time in which the equation of motion fails most.
    WorstStretchBegin,
    /// At the length (s) of those stretches.
    WorstStretchDuration,
}

impl Start {
    /// Whether the parameter says when something happens in a recording, s.
    pub fn is_a_time(self) -> bool {
        matches!(self, Start::WorstStretchBegin | Start::WorstStretchDuration)
    }
}

/// One parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParameterCard {
    /// Name within the effect's site: `arm.` + name.
    pub name: &'static str,
    /// Symbol in the equation.
    pub symbol: &'static str,
    /// SI unit, "-" for a pure number.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// How it enters the rows.
    pub kind: Kind,
    /// Least physically possible value.
    pub minimum: f64,
    /// Largest plausible value.
    pub maximum: f64,
    /// Order of magnitude on a machine of the 3 t class; scales searches.
    pub typical: f64,
    /// Where a search begins.
    pub start: Start,
    /// What is known of a nuisance parameter before a recording is read; `None` for a property of the machine.
    pub prior: Option<Prior>,
}

/// What is said about an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Card {
    /// Name in model files, reports, messages and JSON.
    pub name: &'static str,
    /// Where it acts.
    pub acts_on: ActsOn,
    /// What a cylinder must have for it.
    pub needs: Needs,
    /// Base or candidate.
    pub family: Family,
    /// One sentence.
    pub summary: &'static str,
    /// The formula, as in the code.
    pub equation: &'static str,
    /// Where the formula comes from.
    pub source: &'static str,
    /// How it shows in data.
    pub shows: &'static str,
    /// Which experiment shows it best.
    pub experiment: &'static str,
    /// Its part in the energy balance.
    pub energy: &'static str,
}
