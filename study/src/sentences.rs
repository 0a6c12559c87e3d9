//! Result sentences that no page contains.

use std::collections::BTreeMap;

use excavator_identification::design::{ParameterDesign, Plan, SeparationDesign};
use excavator_identification::energy::{EnergyAnalysis, MissingPower};
use excavator_identification::fit::{ProfileInterval, is_nuisance};
use excavator_identification::identify::{HeldOut, Identified};
use excavator_model::simulation::Profile;
use excavator_model::{Model, Parameter};
use excavator_report::budget_sentence;

use crate::WorkError;
use crate::numbers::number;
use crate::profile_file::{ProfileFile, usual_rate};

/// Number of identified parameters, their accuracy, and the remaining residual of the equations.
pub fn identification_sentence(result: &Identified) -> String {
    let machine = &result.model.machine.name;
    let asked = result.fitted.len() + result.not_identified.len();
    let names = result.model.parameter_names();
    let share = |(index, parameter): (usize, &Parameter)| {
        let margin = parameter.margin_95.filter(|margin| margin.is_finite() && parameter.value != 0.0)?;
        Some((margin / parameter.value.abs(), names[index].as_str()))
    };
    // Nuisances scatter around zero, where a share of the value says nothing.
    let is_of_the_machine = |effect: usize| !is_nuisance(result.model.effects[effect].physics.card().family);
    let parameters = result.model.parameters().enumerate();
    let fitted = parameters
        .filter(|(index, (effect, _))| result.fitted.contains(index) && is_of_the_machine(*effect))
        .map(|(index, (_, parameter))| (index, parameter));
    let widest = fitted.filter_map(share).max_by(|a, b| a.0.total_cmp(&b.0));
    let mut text = format!("Identified {} of {asked} unknown parameters of {machine}.", result.fitted.len());
    if let Some((share, name)) = widest {
        text += &format!(" The widest 95 % interval is that of {name}: ± {:.1} % of its value.", 100.0 * share);
    }
    let known = result.equations.iter().filter(|gauge| gauge.chi_squared_per_row.is_finite());
    if let Some(worst) = known.max_by(|a, b| a.chi_squared_per_row.total_cmp(&b.chi_squared_per_row)) {
        text += &format!(
            " The largest residual is that of {}: {} times the variance of sensor noise.",
            worst.equation,
            number(worst.chi_squared_per_row)
        );
    }
    if let Some(sentence) = method_sentence(result) {
        text += &format!(" {sentence}");
    }
    text
}

/// Why this method was used, if it was chosen.
fn method_sentence(result: &Identified) -> Option<String> {
    let error = |one: &HeldOut| one.nmse.map_or("fails".to_string(), |nmse| format!("has {}", number(nmse)));
    let own = result.held_out.iter().find(|one| one.method == result.method)?.nmse?;
    let others = result.held_out.iter().filter(|one| one.method != result.method);
    let others: Vec<String> = others.map(|one| format!("{} {}", one.method, error(one))).collect();
    Some(format!(
        "Method: {}, which predicts the last third of the recordings from the rest with a mean NMSE of {}; {}.",
        result.method,
        number(own),
        others.join(", ")
    ))
}

/// What the recordings determine about a parameter that is weakly identifiable.
pub fn profile_sentence(profile: &ProfileInterval, model: &Model) -> String {
    let names = model.parameter_names();
    let unit = model.parameters().nth(profile.index).map_or("", |(_, parameter)| &*parameter.card.unit);
    let name = &names[profile.index];
    let mut text = match (profile.lower, profile.upper) {
        (None, None) => {
            format!("{name} is not identifiable from these recordings: all values in its range fit equally well")
        }
        (Some(lower), None) => {
            format!("{name} is at least {} {unit} (95 %); every larger value fits as well", number(lower))
        }
        (None, Some(upper)) => {
            format!("{name} is at most {} {unit} (95 %); every smaller value fits as well", number(upper))
        }
        (Some(lower), Some(upper)) => {
            format!("{name} is between {} and {} {unit} (95 %, profile likelihood)", number(lower), number(upper))
        }
    };
    if let Some((other, correlation)) = profile.companion {
        text += &format!("; {} compensates for changes of it (correlation {correlation:.2})", names[other]);
    }
    text
}

/// Whether the energy ledger of a recording closes. `missing` is the missing power.
pub fn ledger_sentence(model: &Model, analysis: &EnergyAnalysis, missing: &[MissingPower]) -> String {
    let over = format!("{:.1} s of {}", analysis.duration, analysis.source);
    let machine = &model.machine.name;
    let closes = match missing.first() {
        None => format!("The ledger of {machine} closes over {over}: every residual is within the noise."),
        Some(first) => format!("The ledger of {machine} does not close over {over}. {}", first.sentence),
    };
    format!("{closes} {}", budget_sentence(model, analysis))
}

/// Number of pairs that a profile is expected to separate.
pub fn separation_sentence(design: &SeparationDesign) -> String {
    let separated = design.pairs.iter().filter(|pair| pair.separated).count();
    let pairs = design.pairs.len();
    format!(
        "A profile of {:.1} s is expected to separate {separated} of {pairs} {}.",
        design.plan.duration,
        if pairs == 1 { "pair" } else { "pairs" }
    )
}

/// Expected accuracy of a parameter with a profile.
pub fn determination_sentence(design: &ParameterDesign) -> String {
    format!(
        "A profile of {:.1} s is expected to determine {} to within {:.1} % (one standard error).",
        design.plan.duration,
        design.name,
        100.0 * (design.trial_run_error / design.value).abs()
    )
}

/// The profile file of a design that separates.
///
/// # Errors
/// [`WorkError::ProfileWrite`].
pub fn separation_profile(model: &Model, design: &SeparationDesign) -> Result<String, WorkError> {
    let expectation = design.pairs.iter().map(|pair| {
        format!(
            "{} from {}: expected improvement {:.2} ({:.1} standard errors), {}",
            pair.first,
            pair.second,
            pair.expected_improvement,
            pair.expected_significance,
            if pair.separated { "separated" } else { "not separated" }
        )
    });
    profile_text(model, &design.profiles, &design.plan, expectation.collect())
}

/// The profile file of a design that determines.
///
/// # Errors
/// [`WorkError::ProfileWrite`].
pub fn determination_profile(model: &Model, design: &ParameterDesign) -> Result<String, WorkError> {
    let expectation = format!(
        "{}: expected standard error {} {} of {}",
        design.name,
        number(design.trial_run_error),
        design.unit,
        number(design.value)
    );
    profile_text(model, &design.profiles, &design.plan, vec![expectation])
}

fn profile_text(
    model: &Model,
    profiles: &[Profile],
    plan: &Plan,
    expectation: Vec<String>,
) -> Result<String, WorkError> {
    let file = ProfileFile { rate: usual_rate(), start: BTreeMap::new(), profiles: profiles.to_vec() };
    let mut comment = vec![format!(
        "Proposed by `excavator design` for {}: {:.1} s from rest at mid-stroke. Areas in m2, times in s.",
        model.machine.name, plan.duration
    )];
    comment.extend(plan.chosen.iter().map(|(name, start)| format!("{start:6.1} s  {name}")));
    comment.extend(expectation);
    file.text(&comment)
}
