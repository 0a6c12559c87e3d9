//! Finds fitted values that point to a wrong unit or a wrong length rather than to a missing effect. A model whose pressures are
//! all ten times too large fits as well as the right one, with ten times the inertia.

use excavator_model::effects::{Family, Kind, Text};
use excavator_model::template::ESTIMATE;
use excavator_model::{Model, ModelEffect, Parameter};

/// A fitted value that is hard to believe.
#[derive(Debug, Clone, PartialEq)]
pub struct Implausible {
    /// The parameter, as in `arm.inertia`.
    pub name: String,
    /// What was fitted, in `unit`.
    pub value: f64,
    /// SI unit.
    pub unit: Text,
    /// Why it is hard to believe.
    pub why: Doubt,
}

/// Why a fitted value is hard to believe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Doubt {
    /// The value differs strongly from that of the given model.
    FarFromGiven {
        /// Value in the given model.
        given: f64,
    },
    /// A bulk modulus that no hydraulic fluid has.
    StifferThanFluid,
}

/// Factor between fitted and given value above which the fitted one is implausible. Drawings give inertias, moments and flow
/// gains to within a third. A bulk modulus with air and hoses is less certain, but hardly by more than this factor.
const FAR: f64 = 4.0;

/// Bulk modulus, Pa, that no hydraulic fluid reaches: mineral oil has 1.4e9 to 2e9, water 2.2e9, both a fifth more at 400 bar.
const STIFFEST_FLUID: f64 = 3e9;

/// Returns the implausible values among the fitted parameters of `found`; `given` is the model before the fit. Only effects that
/// every machine has are examined, because friction and leakage differ more between machines. A value that the recordings hardly
/// determine is not reported.
pub fn implausible(given: &Model, found: &Model) -> Vec<Implausible> {
    let names = found.parameter_names();
    let given_names = given.parameter_names();
    let guessed = |name: &str| {
        let own = given.parameters().zip(&given_names).find(|(_, own)| *own == name);
        own.is_some_and(|((_, parameter), _)| is_guessed(parameter))
    };
    let fitted = found
        .parameters()
        .zip(names)
        .filter(|((effect, parameter), _)| is_known_roughly(&found.effects[*effect], parameter));
    fitted
        .filter_map(|((_, parameter), name)| {
            let why = doubt(given.value_of(&name).filter(|_| !guessed(&name)), parameter)?;
            Some(Implausible { name, value: parameter.value, unit: parameter.card.unit.clone(), why })
        })
        .collect()
}

/// Whether a parameter is usually known within a factor before it is fitted.
fn is_known_roughly(effect: &ModelEffect, parameter: &Parameter) -> bool {
    effect.physics.card().family == Family::Base && !parameter.known && parameter.card.kind != Kind::Shape
}

/// Whether a value is an estimate for a machine of this size, which says nothing about the fitted one. A bulk modulus is similar in all
/// machines.
fn is_guessed(parameter: &Parameter) -> bool {
    parameter.source.starts_with(ESTIMATE) && parameter.card.kind != Kind::Reciprocal
}

fn doubt(given: Option<f64>, parameter: &Parameter) -> Option<Doubt> {
    let margin = parameter.margin_95.or(parameter.standard_error.map(|error| 2.0 * error))?;
    let size = parameter.value.abs();
    let (least, most) = (size - margin, size + margin);
    let is_bulk_modulus = parameter.card.kind == Kind::Reciprocal;
    if is_bulk_modulus && least > STIFFEST_FLUID {
        return Some(Doubt::StifferThanFluid);
    }
    let given = given.filter(|given| *given != 0.0)?;
    (least > FAR * given.abs() || most < given.abs() / FAR).then_some(Doubt::FarFromGiven { given })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

    fn doubts(change: &[(&str, f64)], relative_error: f64) -> Vec<(String, Doubt)> {
        let given = built_in("zx30u-arm").unwrap();
        let mut found = given.clone();
        let names = found.parameter_names();
        for (name, parameter) in names.iter().zip(found.parameters_mut()) {
            parameter.value *= change.iter().find(|(wanted, _)| wanted == name).map_or(1.0, |(_, factor)| *factor);
            parameter.standard_error = Some(relative_error * parameter.value.abs());
        }
        implausible(&given, &found).into_iter().map(|one| (one.name, one.why)).collect()
    }

    #[test]
    fn only_what_people_know_roughly_is_doubted() {
        assert_eq!(doubts(&[("arm.inertia", 1.3), ("arm.bulk_modulus", 0.4)], 0.01), []);
        assert_eq!(doubts(&[("arm.internal_leakage", 0.01), ("arm.coulomb_friction", 9.0)], 0.01), []);
    }

    #[test]
    fn pressures_of_another_unit_show() {
        let found = doubts(&[("arm.inertia", 10.0), ("arm.gravity_moment", 10.0), ("arm.viscous_damping", 10.0)], 0.01);
        let given = |name: &str, given: f64| (name.to_string(), Doubt::FarFromGiven { given });
        assert_eq!(found, [given("arm.inertia", 230.0), given("arm.gravity_moment", 190.0)]);
        assert_eq!(doubts(&[("arm.inertia", 0.1)], 0.01), [given("arm.inertia", 230.0)]);
    }

    #[test]
    fn what_the_recordings_hardly_show_is_not_doubted() {
        assert_eq!(doubts(&[("arm.inertia", 10.0)], 0.4), []);
    }

    #[test]
    fn no_oil_is_that_stiff() {
        let bulk_modulus = built_in("zx30u-arm").unwrap().value_of("arm.bulk_modulus").unwrap();
        let found = doubts(&[("arm.bulk_modulus", 4e9 / bulk_modulus)], 0.01);
        assert_eq!(found, [("arm.bulk_modulus".to_string(), Doubt::StifferThanFluid)]);
    }
}
