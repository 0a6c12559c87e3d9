//! Every branch of the decision, on synthetic scores.
#![allow(clippy::unwrap_used, clippy::panic)]

use super::made_scores::{BLOCKS, hypothesis, misfit, parameter, scores};
use super::scores::{Bound, Misfit, Role};
use super::{Hypothesis, Kind, Policy, Reason, Scores, Verdict, decide, leaves_nothing, presence};

fn decided(given: f64, hypotheses: Vec<Hypothesis>) -> Verdict {
    decide(&with(given, hypotheses), &Policy::default())
}

fn with(given: f64, hypotheses: Vec<Hypothesis>) -> Scores {
    let mut scores = scores(given);
    scores.hypotheses.extend(hypotheses);
    scores
}

fn changed(effects: &[&str], ratio: f64, change: impl FnOnce(&mut Hypothesis)) -> Hypothesis {
    let mut hypothesis = hypothesis(effects, ratio);
    change(&mut hypothesis);
    hypothesis
}

fn structural(ratio: f64) -> Hypothesis {
    changed(&["joint_spring"], ratio, |one| one.effects[0].role = Role::Structural)
}

#[test]
fn noise_is_adequate() {
    let verdict = decided(0.1, Vec::new());
    assert_eq!((verdict.kind, verdict.best, verdict.set.len()), (Kind::Adequate, 0, 0));
    assert!(matches!(verdict.reasons[..], [Reason::WithinNoise { .. }]), "{:?}", verdict.reasons);
}

#[test]
fn a_few_bad_moments_are_told_and_do_not_count() {
    let mut scores = scores(0.0);
    scores.hypotheses[0].validation.error_ratios[7] = vec![100.0];
    let verdict = decide(&scores, &Policy::default());
    assert_eq!(verdict.kind, Kind::Adequate);
    let share = 1.0 / BLOCKS as f64;
    assert!(verdict.reasons.contains(&Reason::ExceptMoments { share_of_time: share }), "{:?}", verdict.reasons);
}

#[test]
fn an_error_that_is_small_for_the_signal_is_adequate_up_to_a_ceiling() {
    // Noise is a hundredth of the signal: 0.6 is 0.8e-4 of its variance, 1.2 is 2.3e-4.
    assert!(matches!(decided(0.6, Vec::new()).reasons[..], [Reason::SmallError { .. }]));
    assert_eq!(decided(1.2, Vec::new()).kind, Kind::Unexplained);
    let mut quiet = scores(1.2);
    quiet.validation.instruments[0].spread = 1.0;
    assert_eq!(decide(&quiet, &Policy::default()).kind, Kind::Unexplained, "several times the noise has a cause");
}

#[test]
fn what_the_inputs_leave_open_excuses_a_small_error_and_no_large_one() {
    let mut scores = scores(2.0);
    scores.validation.input_floor = vec![9.0];
    scores.identification.input_floor = vec![9.0];
    let verdict = decide(&scores, &Policy::default());
    assert!(matches!(verdict.reasons[..], [Reason::WithinInputs { .. }]), "{verdict:?}");
    assert_eq!(verdict.kind, Kind::Adequate);
    scores.validation.instruments[0].spread = 1e-3;
    let verdict = decide(&scores, &Policy::default());
    assert_eq!(verdict.kind, Kind::Unexplained);
    assert!(verdict.is_too_coarse(), "{verdict:?}");
}

#[test]
fn a_large_error_is_never_noise() {
    let mut scores = scores(0.15);
    scores.validation.instruments[0].spread = 2e-4;
    assert_eq!(decide(&scores, &Policy::default()).kind, Kind::Unexplained);
}

#[test]
fn what_explains_nearly_all_is_attributed() {
    let verdict = decided(2.0, vec![hypothesis(&["a"], 0.0), hypothesis(&["b"], 1.5)]);
    assert_eq!((verdict.kind, verdict.best, &verdict.set[..]), (Kind::MissingEffect, 1, &[1][..]));
    assert!(matches!(verdict.reasons[..], [Reason::Explained { .. }]), "{:?}", verdict.reasons);
    assert!((verdict.standings[1].improvement - 2.0).abs() < 0.1 && verdict.standings[2].is_admissible);
    assert_eq!(verdict.standings[1].set_p_value, Some(1.0));
    assert_eq!(verdict.standings[2].set_p_value, Some(0.0));
    assert!((verdict.standings[1].is_first - 1.0).abs() < 1e-9);
}

#[test]
fn a_tenth_may_remain_of_what_is_large() {
    assert_eq!(decided(5.0, vec![hypothesis(&["a"], 0.4)]).kind, Kind::MissingEffect);
    let verdict = decided(2.0, vec![hypothesis(&["a"], 0.4)]);
    assert_eq!((verdict.kind, verdict.best), (Kind::Unexplained, 1));
    assert!(matches!(verdict.reasons[..], [Reason::PartlyExplained { .. }]), "{:?}", verdict.reasons);
}

#[test]
fn two_effects_may_leave_as_much_as_one() {
    let pair = |left: f64| {
        let singles = vec![hypothesis(&["a"], 1.0), hypothesis(&["b"], 1.2)];
        decided(2.0, [singles, vec![hypothesis(&["a", "b"], left)]].concat())
    };
    assert_eq!((pair(0.0).kind, pair(0.0).best), (Kind::MissingEffect, 3));
    assert_eq!((pair(0.15).kind, pair(0.15).best), (Kind::MissingEffect, 3));
    assert_eq!((pair(0.25).kind, pair(0.25).best), (Kind::Unexplained, 3));
    assert_eq!(decided(2.0, vec![hypothesis(&["a"], 0.15)]).kind, Kind::MissingEffect);
}

#[test]
fn effects_of_a_set_that_explains_are_there_and_an_imitation_alone_is_not() {
    let scores =
        |left: f64| with(2.0, vec![hypothesis(&["a"], 1.0), hypothesis(&["b"], 1.2), hypothesis(&["a", "b"], left)]);
    let probability = |scores: &Scores| {
        let verdict = decide(scores, &Policy::default());
        presence(scores, &verdict, &scores.hypotheses[verdict.best].effects[0], &Policy::default())
    };
    assert!(probability(&scores(0.0)) > 0.95);
    let partly = probability(&scores(0.5));
    assert!((0.1..0.5).contains(&partly), "{partly}");
    let alone = with(2.0, vec![hypothesis(&["a"], 1.0)]);
    assert!(probability(&alone) < 0.1);
}

#[test]
fn an_effect_that_is_not_needed_goes() {
    let verdict = decided(2.0, vec![hypothesis(&["a"], 0.05), hypothesis(&["a", "b"], 0.0)]);
    assert_eq!((verdict.kind, verdict.best), (Kind::MissingEffect, 1));
    assert!(!verdict.standings[2].is_admissible);
}

#[test]
fn a_hypothesis_that_leaves_the_data_sheet_gives_way_to_one_that_does_not() {
    let verdict = |is_plausible: bool, left: f64| {
        let less = changed(&["a"], 0.15, |one| one.is_plausible = is_plausible);
        decided(2.0, vec![less, hypothesis(&["b"], 1.5), hypothesis(&["a", "b"], left)])
    };
    assert_eq!(verdict(true, 0.1).best, 1, "an improvement of 0.05 is too little");
    let found = verdict(false, 0.1);
    assert_eq!((found.kind, found.best), (Kind::MissingEffect, 3));
    assert!(!found.standings[1].is_admissible);
    assert_eq!(verdict(false, 0.2).best, 1, "what is worse does not replace it");
}

#[test]
fn sets_that_differ_only_within_noise_give_what_they_share() {
    let verdict = |shared: f64| {
        let pair = |other: &str| hypothesis(&["a", other], shared - 0.15);
        let mut spring = pair("joint_spring");
        spring.effects[1].role = Role::Structural;
        decided(2.0, vec![hypothesis(&["a"], shared), pair("b"), spring])
    };
    let found = verdict(0.18);
    assert_eq!((found.kind, &found.set[..]), (Kind::MissingEffect, &[1][..]));
    assert!(found.structural_alternative().is_none());
    assert!(verdict(0.5).structural_alternative().is_some(), "what matters stays open");
}

#[test]
fn nothing_helps() {
    let verdict = decided(2.0, vec![hypothesis(&["a"], 1.95)]);
    assert_eq!((verdict.kind, verdict.best), (Kind::Unexplained, 0));
    assert!(matches!(verdict.reasons[..], [Reason::NothingHelps { .. }]), "{:?}", verdict.reasons);
}

#[test]
fn hypotheses_within_chance_are_a_set_of_those_with_the_fewest_effects() {
    let alike = vec![hypothesis(&["a"], 0.0), hypothesis(&["b"], 0.001), hypothesis(&["c", "d"], 0.0)];
    let verdict = decided(2.0, alike);
    assert_eq!(verdict.kind, Kind::MissingEffect);
    assert_eq!(verdict.set, [1, 2]);
    assert!(verdict.reasons.contains(&Reason::Indistinguishable { hypotheses: vec![1, 2] }), "{:?}", verdict.reasons);
}

#[test]
fn a_lead_that_is_less_than_what_remains_is_none() {
    let verdict = decided(4.0, vec![hypothesis(&["a"], 0.3), hypothesis(&["b"], 0.45)]);
    assert_eq!((verdict.kind, &verdict.set[..]), (Kind::MissingEffect, &[1, 2][..]));
    let verdict = decided(4.0, vec![hypothesis(&["a"], 0.3), hypothesis(&["b"], 0.6)]);
    assert_eq!(verdict.set, [1]);
}

#[test]
fn what_the_recordings_determine_comes_first() {
    let vague = changed(&["a"], 0.0, |one| one.effects[0].parameters[0].margin_95 = Some(5.0));
    let verdict = decided(2.0, vec![vague, hypothesis(&["b"], 0.001)]);
    assert_eq!(verdict.set, [2, 1]);
}

#[test]
fn an_effect_must_show_and_have_a_sensible_size() {
    let refused = |change: fn(&mut Hypothesis)| decided(2.0, vec![changed(&["a"], 0.0, change)]).best == 0;
    assert!(refused(|one| one.effects[0].is_practically_significant = false));
    assert!(refused(|one| one.effects[0].is_seen_from_both_sides = false));
    assert!(refused(|one| one.effects[0].parameters = vec![parameter(Some(Bound::Upper))]));
    assert!(refused(|one| one.effects[0].parameters = vec![parameter(Some(Bound::Lower))]));
    assert!(!refused(|one| one.effects[0].parameters.push(parameter(Some(Bound::Lower)))), "some may be nothing");
}

#[test]
fn a_gain_on_one_kind_of_recordings_only_is_none() {
    let only_fitted = changed(&["a"], 0.0, |one| one.validation = misfit(2.0, 0));
    assert_eq!(decided(2.0, vec![only_fitted]).best, 0);
    let only_validated = changed(&["a"], 0.0, |one| one.identification = misfit(2.0, 0));
    assert_eq!(decided(2.0, vec![only_validated]).best, 0);
}

#[test]
fn a_transient_effect_counts_by_the_smaller_of_both_improvements() {
    let transient = |left_where_fitted: f64| {
        changed(&["external_contact"], 0.0, |one| {
            one.effects[0].is_transient = true;
            one.identification = misfit(left_where_fitted, 0);
        })
    };
    let improvement = |left: f64| decided(2.0, vec![transient(left)]).standings[1].improvement;
    assert!((improvement(0.0) - 2.0).abs() < 0.1 && (improvement(1.5) - 0.5).abs() < 0.1);
}

#[test]
fn an_improvement_in_few_moments_may_be_chance() {
    let mut scores = scores(1.2);
    let mut lucky = hypothesis(&["a"], 1.2);
    // One stretch is much better, the others are not: the mean improves by 0.25.
    let better = |side: &mut Misfit| (4..8).for_each(|block| side.error_ratios[block] = vec![0.1]);
    better(&mut lucky.validation);
    better(&mut lucky.identification);
    scores.hypotheses.push(lucky);
    let verdict = decide(&scores, &Policy::default());
    assert!(verdict.standings[1].improvement > 0.15, "{:?}", verdict.standings);
    assert!(!verdict.standings[1].is_admissible, "{:?}", verdict.standings);
}

#[test]
fn an_adequate_model_needs_a_larger_improvement_that_explains_it() {
    assert_eq!(decided(0.18, vec![hypothesis(&["a"], 0.03)]).kind, Kind::Adequate, "0.15 is too little");
    let verdict = decided(0.18, vec![hypothesis(&["a"], -0.05)]);
    assert_eq!((verdict.kind, verdict.best), (Kind::MissingEffect, 1), "{:?}", verdict.reasons);
    // A small error that is partly explained is no reason to doubt the model.
    assert_eq!(decided(0.6, vec![hypothesis(&["a"], 0.3)]).kind, Kind::Adequate);
}

#[test]
fn a_structural_alternative_forbids_an_attribution() {
    let level = decided(2.0, vec![hypothesis(&["a"], 0.0), structural(0.001)]);
    assert_eq!((level.kind, level.best, level.supported()), (Kind::Unexplained, 1, 0));
    assert!(level.reasons.contains(&Reason::StructuralAlternative { hypothesis: 2, is_preferred: false }));
    let ahead = decided(2.0, vec![hypothesis(&["a"], 0.4), structural(0.0)]);
    assert_eq!(ahead.structural_alternative(), Some(2));
    assert!(ahead.reasons.contains(&Reason::StructuralAlternative { hypothesis: 2, is_preferred: true }));
    let behind = decided(2.0, vec![hypothesis(&["a"], 0.0), structural(0.5)]);
    assert_eq!((behind.kind, behind.structural_alternative()), (Kind::MissingEffect, None));
    let alone = decided(2.0, vec![structural(0.0)]);
    assert_eq!((alone.kind, alone.best, alone.structural_alternative()), (Kind::Unexplained, 0, Some(1)));
}

#[test]
fn little_is_left_where_no_further_effect_could_be_attributed() {
    let scores = with(2.0, vec![hypothesis(&["a"], 0.0), hypothesis(&["b"], 0.2)]);
    let left = |number| leaves_nothing(&scores, number, &Policy::default());
    assert!(!left(0) && left(1) && !left(2));
}

#[test]
fn the_same_scores_get_the_same_verdict() {
    let scores = with(2.0, vec![hypothesis(&["a"], 0.0), hypothesis(&["b"], 0.001)]);
    let text = serde_json::to_string(&scores).unwrap();
    let read = Scores::from_json(&text).unwrap();
    assert_eq!(read, scores);
    assert_eq!(decide(&read, &Policy::default()), decide(&scores, &Policy::default()));
}

#[test]
fn damaged_scores_are_refused_in_one_line() {
    let mut scores = with(2.0, vec![hypothesis(&["a"], 0.0)]);
    scores.hypotheses[1].validation.error_ratios.pop();
    let error = Scores::from_json(&serde_json::to_string(&scores).unwrap()).unwrap_err().to_string();
    assert!(error.contains("hypothesis 1 has 39 error ratios on the validation recordings, which have 40"), "{error}");
    scores.format = 99;
    let error = Scores::from_json(&serde_json::to_string(&scores).unwrap()).unwrap_err().to_string();
    assert!(error.contains("format 99"), "{error}");
    scores.format = super::scores::FORMAT;
    scores.hypotheses.clear();
    assert!(Scores::from_json(&serde_json::to_string(&scores).unwrap()).is_err());
    assert!(Scores::from_json("{").is_err());
}

/// A number that can change a verdict belongs in the policy, where its meaning is documented.
#[test]
fn numbers_stand_in_the_policy() {
    let files = [
        ("adequacy", include_str!("adequacy.rs")),
        ("assessment", include_str!("assessment.rs")),
        ("confidence_set", include_str!("confidence_set.rs")),
        ("decide", include_str!("decide.rs")),
        ("presence", include_str!("presence.rs")),
        ("remainder", include_str!("../diagnosis/remainder.rs")),
        ("residual_map", include_str!("../diagnosis/residual_map.rs")),
        ("diagnose", include_str!("../diagnosis/diagnose.rs")),
        ("candidates", include_str!("../diagnosis/candidates.rs")),
        ("resampling", include_str!("resampling.rs")),
        ("statistic", include_str!("statistic.rs")),
        ("changes", include_str!("../change/changes.rs")),
    ];
    // The numerical settings of the bootstrap, which change a p-value by its standard error, and the words for regimes.
    let numerical = ["DRAWS", "TOGETHER", "SEED", "CLOSED", "SLOW"];
    for (file, text) in files {
        for line in
            text.lines().filter(|line| line.trim_start().trim_start_matches("pub(super) ").starts_with("const "))
        {
            let name = line.split("const ").nth(1).unwrap().split(':').next().unwrap();
            assert!(numerical.contains(&name), "{file}.rs: {line}");
        }
    }
    let policy = include_str!("policy.rs");
    let fields = policy.split("impl Default").next().unwrap().matches("    pub ").count();
    assert!(fields <= 21, "{fields} numbers in the policy");
}
