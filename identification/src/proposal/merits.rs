//! Merits and drawbacks of a law, besides its error.

use excavator_model::ModelEffect;

use super::grammar::COEFFICIENT;
use super::memory::memory_along;
use excavator_model::effects::Site;
use excavator_model::equations::Situation;
use excavator_model::formula::{Law, Row};

/// Properties of a law to check before it is used.
#[derive(Debug, Clone, PartialEq)]
pub struct Merits {
    /// Whether it never puts energy into the machine.
    pub dissipates: bool,
    /// Exponent with which it grows beyond the recorded speed, pressure, ..., if it is more than a square.
    pub steep: Option<f64>,
    /// Coefficients whose 95 % interval contains zero, and so both signs.
    pub unsure_signs: Vec<String>,
}

/// A law may put in this share of the energy that it takes out, because of measurement noise.
const LEAST_SHARE: f64 = 0.01;

/// Exponent beyond which a law is steep: laws of friction and flow are at most squares.
const STEEP: f64 = 2.2;

/// Merits of a fitted law along the recordings that `situations` come from.
pub(super) fn merits(law: &Law, effect: &ModelEffect, situations: &[Situation<'_, f64>]) -> Merits {
    let parameters: Vec<f64> = effect.parameters.iter().map(|parameter| parameter.value).collect();
    let (mut given, mut taken) = (0.0, 0.0);
    let mut extreme: Option<(f64, &Situation<'_, f64>, &[f64])> = None;
    let memory = memory_along(law, effect.site, &parameters, situations);
    for (sample, now) in situations.iter().enumerate() {
        let states = memory.get(sample).map_or(&[][..], Vec::as_slice);
        let value = change(law, effect.site, &parameters, states, now);
        let power = power(law.row(), effect.site, value, now);
        if power > 0.0 {
            given += power
        } else {
            taken -= power
        }
        if value.is_finite() && extreme.is_none_or(|(largest, ..)| value.abs() > largest) {
            extreme = Some((value.abs(), now, states));
        }
    }
    let steep = extreme.filter(|(value, ..)| *value > 0.0).and_then(|(value, now, states)| {
        let power = (change(law, effect.site, &parameters, states, &times(2.0, now)).abs() / value).log2();
        (power.is_finite() && power > STEEP).then_some(power)
    });
    let unsure = effect.parameters.iter().filter(|parameter| {
        !parameter.known
            && parameter.card.meaning == COEFFICIENT
            && parameter.margin_95.is_some_and(|margin| margin.is_nan() || margin >= parameter.value.abs())
    });
    Merits {
        dissipates: given <= LEAST_SHARE * taken,
        steep,
        unsure_signs: unsure.map(|parameter| parameter.card.name.to_string()).collect(),
    }
}

/// What a law adds to its row; for an opening, its change.
pub(super) fn change(law: &Law, site: Site, parameters: &[f64], states: &[f64], now: &Situation<'_, f64>) -> f64 {
    let value = law.value(site, parameters, states, now);
    match (law.row(), site) {
        (row, Site::Cylinder(cylinder)) if row.is_an_opening() => value - now.pistons[cylinder].opening,
        _ => value,
    }
}

/// Power that a law with this value puts into the machine, W. Zero if it acts on an opening or an instrument.
fn power(row: Row, site: Site, value: f64, now: &Situation<'_, f64>) -> f64 {
    let (pump, tank) = (now.pump_pressure, now.tank_pressure);
    if row == Row::PumpLeak {
        return -value * (pump - tank);
    }
    let Site::Cylinder(cylinder) = site else { return 0.0 };
    let piston = &now.pistons[cylinder];
    let (cap, rod) = (piston.cap_pressure, piston.rod_pressure);
    let power = match row {
        Row::PistonForce => value * piston.velocity,
        Row::JointTorque => value * piston.rate,
        Row::CapFlow => value * (cap - tank),
        Row::RodFlow => value * (rod - tank),
        Row::PistonLeak => -value * (cap - rod),
        Row::PumpToCap => -value * (pump - cap),
        Row::PumpToRod => -value * (pump - rod),
        Row::CapToTank => -value * (cap - tank),
        Row::RodToTank => -value * (rod - tank),
        _ => 0.0,
    };
    if power.is_finite() { power } else { 0.0 }
}

/// Scales the distances, speeds, pressures and openings by `factor`.
pub(super) fn times<'m>(factor: f64, now: &Situation<'m, f64>) -> Situation<'m, f64> {
    let mut stronger = now.clone();
    for piston in &mut stronger.pistons {
        for value in [
            &mut piston.displacement,
            &mut piston.velocity,
            &mut piston.rate,
            &mut piston.cap_pressure,
            &mut piston.rod_pressure,
            &mut piston.opening,
        ] {
            *value *= factor;
        }
    }
    stronger.pump_pressure *= factor;
    stronger.tank_pressure *= factor;
    stronger
}

/// The law of an effect that was read from a formula.
pub(super) fn law_of(effect: &ModelEffect) -> Option<Law> {
    Law::read(effect.physics.formula()?).ok()
}
