//! Synthetic scores for tests of the rules.

use super::scores::{
    Block, Bound, EffectScore, FORMAT, Hypothesis, InstrumentScale, Misfit, ParameterScore, Role, Scores, Side,
};

/// Blocks of each kind of recordings.
pub const BLOCKS: usize = 40;

/// Scores of one instrument whose signal is 100 times its noise, with this log error ratio for the given model.
pub fn scores(given: f64) -> Scores {
    let side = Side {
        sample_interval_s: 2e-3,
        instruments: vec![InstrumentScale {
            name: "arm.displacement".into(),
            unit: "m".into(),
            noise: 1e-4,
            spread: 1e-2,
        }],
        input_floor: Vec::new(),
        blocks: (0..BLOCKS)
            .map(|block| Block { recording: 0, begin_s: 0.5 * block as f64, readings: vec![85] })
            .collect(),
    };
    Scores {
        format: FORMAT,
        machine: "machine".into(),
        identification: side.clone(),
        validation: side,
        hypotheses: vec![hypothesis(&[], given)],
    }
}

/// A hypothesis that adds these effects and has this log error ratio on both kinds of recordings.
pub fn hypothesis(effects: &[&str], log_error_ratio: f64) -> Hypothesis {
    let seed = effects.iter().flat_map(|name| name.bytes()).map(u64::from).sum();
    let misfit = misfit(log_error_ratio, seed);
    Hypothesis {
        effects: effects.iter().map(|name| effect(name)).collect(),
        nuisances: Vec::new(),
        is_plausible: true,
        identification: misfit.clone(),
        validation: misfit,
        parameter_count: 10 + effects.len(),
        seconds: 1.0,
    }
}

/// Errors that scatter by a few per cent between blocks around this log error ratio.
pub fn misfit(log_error_ratio: f64, seed: u64) -> Misfit {
    let ratio = |block: usize| {
        let scatter = 0.05 * ((block as u64 * 37 + seed * 11) % 13) as f64 / 6.0 - 0.05;
        // The inverse of the cost of a block.
        let cost = log_error_ratio + scatter;
        if cost > 0.0 { cost.exp() } else { 1.0 + cost }
    };
    Misfit { error_ratios: (0..BLOCKS).map(|block| vec![ratio(block) as f32]).collect() }
}

/// A sensible effect of the catalogue.
pub fn effect(name: &str) -> EffectScore {
    EffectScore {
        effect: name.into(),
        place: "arm".into(),
        role: Role::Candidate,
        is_transient: false,
        is_practically_significant: true,
        is_seen_from_both_sides: true,
        parameters: vec![parameter(None)],
    }
}

/// A parameter of 2 +- 0.1.
pub fn parameter(at_bound: Option<Bound>) -> ParameterScore {
    ParameterScore { name: "arm.size".into(), unit: "N".into(), value: 2.0, margin_95: Some(0.1), at_bound }
}
