//! What is said about an effect: the fourth face.

use std::borrow::Cow;

use super::Prior;
use crate::machine::{Growth, Machine, Size};

/// A text of a card: that of a built-in effect is part of the program, that of a formula is its own.
pub type Text = Cow<'static, str>;

/// A text that is part of the program.
pub const fn text(text: &'static str) -> Text {
    Cow::Borrowed(text)
}

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
    /// Chambers that a valve section feeds.
    Valve,
    /// Chambers that a pump of their own feeds.
    Pump,
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
    /// The contact of the piston with the ends of the cylinder.
    EndStop,
}

/// Whether the nominal model of \[A\] has the effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Part of the nominal model of \[A\] or of the frame every simulation needs.
    Base,
    /// How recordings are made, not how the machine works: a nuisance, estimated with every model and never attributed.
    Recording,
    /// How widely the equations round a corner, or where a stop is, which nobody measures: a nuisance, estimated with every model and never attributed.
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
#[derive(Debug, Clone, PartialEq)]
pub enum Start {
    /// At each of these values in turn; the best fit wins.
    At(Cow<'static, [f64]>),
    /// At these quantiles of the measured pump pressure: a threshold can only show inside the range that was visited.
    PumpPressureQuantiles(Cow<'static, [f64]>),
    /// Nowhere: a constant of a law, which has this value.
    Known(f64),
    /// At the beginning (s) of the stretches of time in which the equation of motion fails most.
    WorstStretchBegin,
    /// At the length (s) of those stretches.
    WorstStretchDuration,
}

impl Start {
    /// At each of these values.
    pub const fn at(values: &'static [f64]) -> Start {
        Start::At(Cow::Borrowed(values))
    }

    /// At these quantiles of the measured pump pressure.
    pub const fn pump_pressure_quantiles(quantiles: &'static [f64]) -> Start {
        Start::PumpPressureQuantiles(Cow::Borrowed(quantiles))
    }

    /// Whether the parameter says when something happens in a recording, s.
    pub fn is_a_time(&self) -> bool {
        matches!(self, Start::WorstStretchBegin | Start::WorstStretchDuration)
    }
}

/// One parameter of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterCard {
    /// Name within the effect's site: `arm.` + name.
    pub name: Text,
    /// Symbol in the equation.
    pub symbol: Text,
    /// SI unit, "-" for a pure number.
    pub unit: Text,
    /// What it means.
    pub meaning: Text,
    /// How it enters the rows.
    pub kind: Kind,
    /// How it grows from machine to machine. On the card of an effect, minimum, maximum, typical value and starts are those of the
    /// machine of [`Size::REFERENCE`]; on that of a model's parameter, those of the model's machine.
    pub growth: Growth,
    /// Least physically possible value.
    pub minimum: f64,
    /// Largest plausible value.
    pub maximum: f64,
    /// Order of magnitude; scales searches.
    pub typical: f64,
    /// Where a search begins.
    pub start: Start,
    /// What is known of a nuisance parameter before a recording is read; `None` for a property of the machine.
    pub prior: Option<Prior>,
}

impl ParameterCard {
    /// The same for a place of a machine: its size and its units.
    #[must_use]
    pub fn for_place(&self, machine: &Machine, site: Site) -> ParameterCard {
        let mut card = self.for_size(&machine.size_at(site));
        if let Site::Cylinder(index) = site
            && let Some(cylinder) = machine.cylinders.get(index)
        {
            card.unit = cylinder.unit_of(&card.unit, card.growth);
        }
        card
    }

    /// The same for a machine of another size.
    fn for_size(&self, size: &Size) -> ParameterCard {
        let factor = size.factor(self.growth);
        let start = match &self.start {
            Start::At(values) if factor != 1.0 => Start::At(values.iter().map(|value| value * factor).collect()),
            Start::Known(value) => Start::Known(value * factor),
            other => other.clone(),
        };
        let prior = self.prior.map(|prior| prior.grown(factor));
        let [minimum, maximum, typical] = [self.minimum, self.maximum, self.typical].map(|value| value * factor);
        ParameterCard { minimum, maximum, typical, start, prior, ..self.clone() }
    }
}

/// What is said about an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    /// Name in model files, reports, messages and JSON.
    pub name: Text,
    /// Where it acts.
    pub acts_on: ActsOn,
    /// What a cylinder must have for it.
    pub needs: Needs,
    /// Base or candidate.
    pub family: Family,
    /// One sentence.
    pub summary: Text,
    /// The formula, as in the code.
    pub equation: Text,
    /// Where the formula comes from.
    pub source: Text,
    /// How it shows in data.
    pub shows: Text,
    /// Which experiment shows it best.
    pub experiment: Text,
    /// Its part in the energy balance.
    pub energy: Text,
}
