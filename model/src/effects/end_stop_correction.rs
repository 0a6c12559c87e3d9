//! True position, stiffness and damping of the end stops.

use super::{
    ActsOn, Card, Corner, Family, Finding, Growth, Kind, Needs, ParameterCard, Physics, Prior, PriorScale, Scalar,
    Site, Spread, Start, text,
};
use crate::equations::{EndStopCorrection as Correction, Situation};
use crate::machine::Machine;

/// True position, stiffness and damping of the end stops.
///
/// Nobody measures the stiffness of a stop, and the stroke on a data sheet differs from the real one by a few millimetres. A
/// piston pressed against a stop rests at the stop's true position, so an error there is large but is not a fault of the machine.
pub struct EndStopCorrection;

static CARD: Card = Card {
    name: text("end_stop_correction"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Rounding,
    summary: text("The end stops differ from the model file in position or stiffness."),
    equation: text(
        "in the end stop: k becomes fk k, c becomes fc c, the ends +L/2 + d+ and -L/2 - d-; d v x/(x + 0.1 mm) more",
    ),
    source: text("convention (nobody measures a stop); Hunt-Crossley contact, textbook"),
    shows: text("An error of the position and of both pressures while the piston is at an end, none elsewhere."),
    experiment: text("Drive gently into both ends, and press."),
    energy: text("None of its own: it changes what the end stop stores and dissipates."),
};

/// A guessed stiffness is right within a factor of four in two cases out of three, and within sixty nearly always.
const STIFFNESS: Prior = Prior { spread: Spread::Fixed(4.0), scale: PriorScale::Logarithmic, range: [-3.0, 3.0] };

/// The same for a damping, which is less well known.
const DAMPING: Prior = Prior { spread: Spread::Fixed(4.0), scale: PriorScale::Logarithmic, range: [-4.0, 4.0] };

/// Rubber or an oil film brakes at any depth: up to a force of 10 kN at 0.1 m/s, the speed of the arm at full pump flow.
const VISCOUS: Prior = Prior { spread: Spread::Fixed(1e5), scale: PriorScale::Linear, range: [0.0, 10.0] };

/// An end is within 3 mm of the data sheet for a stroke of 0.6 m; with ten times as much, the stroke is wrong.
const SHIFT: Prior = Prior { spread: Spread::Fixed(3e-3), scale: PriorScale::Linear, range: [-10.0, 10.0] };

const fn factor(name: &'static str, symbol: &'static str, meaning: &'static str, prior: Prior) -> ParameterCard {
    ParameterCard {
        name: text(name),
        symbol: text(symbol),
        unit: text("-"),
        meaning: text(meaning),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 1e-3,
        maximum: 1e3,
        typical: 1.0,
        start: Start::at(&[1.0]),
        prior: Some(prior),
    }
}

const fn shift(name: &'static str, symbol: &'static str, meaning: &'static str) -> ParameterCard {
    ParameterCard {
        name: text(name),
        symbol: text(symbol),
        unit: text("m"),
        meaning: text(meaning),
        kind: Kind::Shape,
        growth: Growth::LENGTH,
        minimum: -0.03,
        maximum: 0.03,
        typical: 1e-3,
        start: Start::at(&[0.0]),
        prior: Some(SHIFT),
    }
}

static PARAMETERS: &[ParameterCard] = &[
    factor("stop_stiffness_factor", "fk", "real stiffness over that of the model file", STIFFNESS),
    factor("stop_damping_factor", "fc", "real damping factor over that of the model file", DAMPING),
    ParameterCard {
        name: text("stop_viscous_damping"),
        symbol: text("d"),
        unit: text("N s/m"),
        meaning: text("damping of the contact that does not grow with the depth"),
        kind: Kind::Shape,
        growth: Growth::DAMPING,
        minimum: 0.0,
        maximum: 1e6,
        typical: 1e4,
        start: Start::at(&[0.0]),
        prior: Some(VISCOUS),
    },
    shift("stop_shift_extended", "d+", "how much farther than half the stroke the piston moves out"),
    shift("stop_shift_retracted", "d-", "how much farther than half the stroke the piston moves in"),
];

impl Physics for EndStopCorrection {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn finding(&self, parameters: &[(f64, &str)]) -> Option<Finding> {
        let &[(stiffness, _), _, _, (extended, _), (retracted, _)] = parameters else { return None };
        let sentences =
            ["The end stops are not as the model file says", "The end stops are not as the model file says"];
        let value = format!(
            "has {stiffness:.2} times the stiffness, and its ends are {:+.2} mm and {:+.2} mm farther out and in",
            1e3 * extended,
            1e3 * retracted
        );
        Some(Finding { sentences, value })
    }

    fn has_power(&self) -> bool {
        false
    }

    fn rounds(&self) -> Option<Corner> {
        Some(Corner::EndStop)
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn adjust<T: Scalar>(&self, site: Site, parameters: &[T], now: &mut Situation<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        now.pistons[cylinder].rounding.end_stop = Some(Correction {
            stiffness: parameters[0],
            damping: parameters[1],
            viscous_damping: parameters[2],
            shifts: [parameters[3], parameters[4]],
        });
    }
}
