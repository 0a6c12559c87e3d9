//! Converts a trial into a row of scores.

use excavator_model::effects::Family;
use excavator_model::recording::{Recording, standard_deviation};
use excavator_model::{Model, ModelEffect, Parameter, addition_name, site_name};

use super::Trial;
use super::both_sides::is_seen_from_both_sides;
use super::transient::is_transient;
use crate::decision::scores::{
    Block, Bound, EffectScore, FORMAT, Hypothesis, InstrumentScale, Misfit, ParameterScore, Role, Scores, Side,
};
use crate::fit::{Fit, nuisances_shown};
use crate::plausibility::implausible;

/// Scores with the given model only, tried without additions on the recordings that it was fitted to and on others.
pub fn begin(given: &Trial, data_sheet: &Model, identification: &[&Recording], validation: &[&Recording]) -> Scores {
    Scores {
        format: FORMAT,
        machine: given.fit.model.machine.name.clone(),
        identification: side(&given.fit, identification),
        validation: side(&given.validation, validation),
        hypotheses: vec![score(given, &given.fit.model, data_sheet, identification)],
    }
}

/// The compared signals on some recordings.
pub(crate) fn side(fit: &Fit, recordings: &[&Recording]) -> Side {
    let scale = |instrument: &crate::fit::Instrument| InstrumentScale {
        name: instrument.name.clone(),
        unit: instrument.unit.to_string(),
        noise: instrument.noise,
        spread: recordings
            .iter()
            .filter_map(|recording| recording.signal(&instrument.name))
            .map(standard_deviation)
            .fold(0.0, f64::max),
    };
    let blocks = fit.block_places.iter().zip(&fit.block_errors).map(|(&(recording, begin_s), errors)| Block {
        recording,
        begin_s,
        readings: errors.iter().map(|(_, count)| *count).collect(),
    });
    Side {
        sample_interval_s: recordings.iter().map(|recording| recording.sample_interval()).fold(0.0, f64::max),
        instruments: fit.instruments.iter().map(scale).collect(),
        input_floor: Vec::new(),
        blocks: blocks.collect(),
    }
}

/// The row of scores of a trial: errors on both sides, and the properties of each added effect. `given` is the fitted
/// model without additions, `data_sheet` that before any fit, `identification` the recordings that the trial was fitted to.
pub fn score(trial: &Trial, given: &Model, data_sheet: &Model, identification: &[&Recording]) -> Hypothesis {
    let model = &trial.fit.model;
    let effect = |effect: &ModelEffect| EffectScore {
        effect: effect.name().to_string(),
        place: site_name(&model.machine, effect.site).to_string(),
        role: if effect.physics.card().family == Family::Construction { Role::Structural } else { Role::Candidate },
        is_transient: is_transient(effect),
        is_practically_significant: effect.is_practically_significant(),
        is_seen_from_both_sides: is_seen_from_both_sides(effect, identification),
        parameters: parameters(model, effect),
    };
    Hypothesis {
        effects: trial.additions.iter().filter_map(|addition| trial.effect(addition)).map(effect).collect(),
        nuisances: nuisances_shown(given, model)
            .map(|effect| addition_name(effect.name(), site_name(&model.machine, effect.site)))
            .collect(),
        is_plausible: implausible(data_sheet, model).is_empty(),
        identification: misfit(&trial.fit),
        validation: misfit(&trial.validation),
        parameter_count: trial.fit.fitted.len(),
        seconds: trial.seconds,
    }
}

/// Errors of a fit.
pub(crate) fn misfit(fit: &Fit) -> Misfit {
    let ratio = |(&(squares, count), instrument): (&(f64, usize), &crate::fit::Instrument)| {
        let ratio = squares / (count.max(1) as f64 * instrument.noise * instrument.noise);
        // An error that cannot be stored counts as the largest possible one.
        if ratio.is_finite() { (ratio as f32).min(f32::MAX) } else { f32::MAX }
    };
    let blocks = fit.block_errors.iter();
    Misfit { error_ratios: blocks.map(|block| block.iter().zip(&fit.instruments).map(ratio).collect()).collect() }
}

fn parameters(model: &Model, effect: &ModelEffect) -> Vec<ParameterScore> {
    let place = site_name(&model.machine, effect.site);
    let bound = |parameter: &Parameter| match parameter.value {
        _ if parameter.known => None,
        value if value <= parameter.card.minimum => Some(Bound::Lower),
        value if value >= parameter.card.maximum && !effect.physics.has_natural_maximum(&parameter.card.name) => {
            Some(Bound::Upper)
        }
        _ => None,
    };
    let of = |parameter: &Parameter| ParameterScore {
        name: format!("{place}.{}", parameter.card.name),
        unit: parameter.card.unit.to_string(),
        value: parameter.value,
        margin_95: parameter.margin_95.filter(|margin| margin.is_finite()),
        at_bound: bound(parameter),
    };
    effect.parameters.iter().map(of).collect()
}
