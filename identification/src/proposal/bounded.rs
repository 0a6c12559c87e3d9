//! Finds laws that would reverse an opening beyond the recorded range, and bounds them.

use std::sync::Arc;

use excavator_model::effects::Site;
use excavator_model::equations::Situation;
use excavator_model::formula::{FormulaText, Law};
use excavator_model::recording::Recording;

use super::merits::{law_of, times};
use super::proposals::situations_of;
use crate::search::{Addition, Pool, Trial};

/// Factor beyond the recorded range at which a law is checked: valves of mobile machines see 25 MPa, and recordings of
/// light work have two or three.
const STRONGEST: f64 = 10.0;

/// Converts a law whose opening would have the wrong sign if everything were [`STRONGEST`] times as strong as recorded.
/// Returns the form that closes instead, with the number of the trial that it extends. Returns `None` if the law does
/// not need it.
///
/// A law that reduces an opening in proportion to a pressure or a speed closes it at some value. A product continues
/// beyond that, so that the valve would meter to the other side. The recording cannot show this, because it ends
/// before.
pub(super) fn bounded(pool: &Pool<'_>, number: usize, recordings: &[&Recording]) -> Option<(usize, Addition)> {
    let trial = pool.trials.get(number)?;
    let (addition, before) = trial.additions.split_last()?;
    if !reverses_an_opening(trial, &situations_of(trial, recordings)) {
        return None;
    }
    let law = Law::read(&closing(addition.physics.formula()?)).ok()?;
    let base = pool.trials.iter().position(|other| other.additions == before)?;
    Some((base, Addition { physics: Arc::new(law), site: addition.site }))
}

/// Whether the last law of a trial reverses the sign of an opening if everything is [`STRONGEST`] times as strong as
/// recorded.
pub(super) fn reverses_an_opening(trial: &Trial, situations: &[Situation<'_, f64>]) -> bool {
    let Some(effect) = trial.additions.last().and_then(|addition| trial.effect(addition)) else { return false };
    let Some(law) = law_of(effect).filter(|law| law.row().is_an_opening()) else { return false };
    let Site::Cylinder(cylinder) = effect.site else { return false };
    let parameters: Vec<f64> = effect.parameters.iter().map(|parameter| parameter.value).collect();
    situations.iter().any(|now| {
        let now = times(STRONGEST, now);
        law.value(effect.site, &parameters, &[], &now) * now.pistons[cylinder].opening < 0.0
    })
}

/// The law that closes the opening where the given one would reverse it.
fn closing(text: &FormulaText) -> FormulaText {
    let formula = match text.formula.strip_prefix("u - k*u*") {
        Some(rest) if !has_sum(rest) => format!("u*max(1 - k*{rest}, 0)"),
        _ => format!("if(u > 0, max({0}, 0), min({0}, 0))", text.formula),
    };
    let name = format!("closing_{}", text.name).chars().take(LONGEST_NAME).collect();
    FormulaText { name, formula, ..text.clone() }
}

/// Whether there is a sum outside all brackets.
fn has_sum(formula: &str) -> bool {
    let mut depth = 0;
    formula.chars().any(|letter| {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        depth == 0 && matches!(letter, '+' | '-')
    })
}

/// Longest name of a formula effect.
const LONGEST_NAME: usize = 60;

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn an_opening_closes_instead_of_turning_round() {
        let of = |formula: &str| {
            let text = serde_json::json!({ "name": "own", "acts_on": "opening", "formula": formula });
            closing(&serde_json::from_value(text).unwrap()).formula
        };
        assert_eq!(
            of("u - k*u*if(u > 0, p_pump - p_cap, p_pump - p_rod)"),
            "u*max(1 - k*if(u > 0, p_pump - p_cap, p_pump - p_rod), 0)"
        );
        assert_eq!(
            of("u - k*u*p_cap + k_2*u^3"),
            "if(u > 0, max(u - k*u*p_cap + k_2*u^3, 0), min(u - k*u*p_cap + k_2*u^3, 0))"
        );
    }
}
