//! The card of an effect: its description and its parameters.

use std::borrow::Cow;

use super::Prior;
use super::site::Site;
use crate::machine::{Growth, Machine, Size};

/// A text of a card: static for built-in effects, owned for formulas.
pub type Text = Cow<'static, str>;

/// A static text.
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
    /// Cylinders with chambers and the pump line.
    CylinderOrPumpLine,
    /// Instruments: those of a cylinder, that of the pump line, or all instruments of the machine at once.
    Instruments,
}

/// Requirements of an effect on the cylinder where it acts, besides a moving piston. A pump line meets all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    /// Nothing: a cylinder driven by a measured force can have it.
    Nothing,
    /// Pressures, but no flows: chambers, or an imposed motion with measured pressures.
    Pressures,
    /// Oil flow: chambers.
    Oil,
    /// Chambers that a valve section feeds.
    Valve,
    /// Chambers fed by their own pump.
    Pump,
}

/// A corner in a law that the equations round, and whose rounding an effect of family [`Family::Rounding`] changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corner {
    /// The sign of the velocity in the friction of a piston.
    Friction,
    /// The root law of the flow through the valve's edges.
    OrificeFlow,
    /// The contact of the piston with the ends of the cylinder.
    EndStop,
}

/// The role of an effect in models and in a diagnosis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Part of the nominal model of \[A\] or of the frame every simulation needs.
    Base,
    /// A property of the recordings, not of the machine: a nuisance, estimated with every model and never attributed.
    Recording,
    /// The width of a corner in the equations, or the position of a stop, which is not measured: a nuisance, estimated with every
    /// model and never attributed.
    Rounding,
    /// A design feature from the machine's data sheet: added by hand, never a candidate.
    Construction,
    /// A loss that the nominal model of \[A\] has, and a candidate if another model lacks it.
    Loss,
    /// A candidate for physics missing from a nominal model.
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

/// Where a search for a parameter starts.
#[derive(Debug, Clone, PartialEq)]
pub enum Start {
    /// At each of these values in turn; the best fit wins.
    At(Cow<'static, [f64]>),
    /// At these quantiles of the measured pump pressure: a threshold has a visible effect only inside the measured range.
    PumpPressureQuantiles(Cow<'static, [f64]>),
    /// No search: a constant of a law, with this value.
    Known(f64),
    /// At the beginning (s) of the intervals with the largest residual of the equation of motion.
    WorstStretchBegin,
    /// At the length (s) of those intervals.
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

    /// Whether the parameter is a time in a recording, s.
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
    /// Its meaning.
    pub meaning: Text,
    /// How it enters the rows.
    pub kind: Kind,
    /// How it scales with machine size. On the card of an effect, minimum, maximum, typical value and starts refer to the machine
    /// of [`Size::REFERENCE`]; on the card of a model's parameter, to the model's machine.
    pub growth: Growth,
    /// Least physically possible value.
    pub minimum: f64,
    /// Largest plausible value.
    pub maximum: f64,
    /// Order of magnitude; scales searches.
    pub typical: f64,
    /// Where a search starts.
    pub start: Start,
    /// Prior of a nuisance parameter, before a recording is read; `None` for a property of the machine.
    pub prior: Option<Prior>,
}

impl ParameterCard {
    /// The same card for a place of a machine: scaled to its size, in its units.
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

    /// The same card for a machine of another size.
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

/// Description of an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    /// Name in model files, reports, messages and JSON.
    pub name: Text,
    /// Where it acts.
    pub acts_on: ActsOn,
    /// What a cylinder must have.
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

impl Card {
    /// Whether the effect acts in the flow balances of chambers and pump line, and not in the force balance of a joint.
    pub fn is_of_flows(&self) -> bool {
        matches!(self.needs, Needs::Oil | Needs::Valve | Needs::Pump) || self.acts_on == ActsOn::PumpLine
    }
}
