//! Pages as a whole, made from a simulation instead of a recording.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{self, Family, Site};
use excavator_model::recording::Recording;

use super::{comparison_page, diagnosis_page, refinement_page, verdict_sentence};
use crate::diagnosis::{
    Adequacy, Candidate, Diagnosis, Evidence, Inclusion, NamedVerdict, Share, Unexplained, Verdict,
};

use crate::energy::{MissingPower, Regime};
use crate::fit::Fit;
use crate::fit::made_up::made_up_fit;
use crate::refinement::{Reason, Refinement, Step};
use crate::validation::{Comparison, SignalComparison};

const HOSTILE: &str = "</script><b>bag & \"co\"</b>";
const SIGNALS: [&str; 5] =
    ["arm.displacement", "arm.velocity", "arm.cap_pressure", "arm.rod_pressure", "pump_pressure"];

fn model() -> Model {
    let mut model = built_in("zx30u-arm").unwrap();
    model.machine.description = HOSTILE.into();
    model
}

fn recording(source: &str, error: f64) -> Recording {
    let time: Vec<f64> = (0..6000).map(|index| index as f64 * 0.002).collect();
    let wave = |size: f64| time.iter().map(|t| size * (1.0 + error) * (3.0 * t).sin()).collect::<Vec<f64>>();
    let mut recording = Recording::unmeasured(source, time.clone(), &["arm"]);
    let arm = &mut recording.cylinders[0];
    (arm.displacement, arm.velocity) = (wave(0.1), wave(0.3));
    (arm.cap_pressure, arm.rod_pressure, arm.orifice_area) = (wave(4e6), wave(3e6), wave(3e-5));
    recording.pump_pressure = wave(8e6);
    recording
}

fn comparison(error: f64) -> Comparison {
    let mut measured = recording(HOSTILE, 0.0);
    measured.cylinders[0].cap_pressure[100..200].fill(f64::NAN);
    let signals = SIGNALS
        .map(|name| SignalComparison {
            autocorrelation: None,
            input_correlation: None,
            name: name.to_string(),
            normalised_error: error * error,
            fit: 100.0 * (1.0 - error),
            phase_delay_degrees: (name != "arm.velocity").then_some(-1.25),
        })
        .to_vec();
    Comparison { measured, simulated: recording("simulated", error), signals, excitation_frequency: Some(0.48) }
}

fn fit_of(model: &Model, error: f64) -> Fit {
    let mut model = model.clone();
    for parameter in model.parameters_mut() {
        parameter.standard_error = Some(parameter.value.abs() * 0.02);
    }
    made_up_fit(model, 1e-4, error)
}

fn candidate(name: &str, gain: f64, accepted: bool, tied: bool) -> Candidate {
    let physics = effects::find(name).unwrap();
    let site = model().free_sites(physics)[0];
    let extended = model().with_effect(physics, site).unwrap();
    let place = if site == Site::PumpLine { "pump" } else { "arm" };
    Candidate {
        physics,
        site,
        place: place.into(),
        fit: fit_of(&extended, 1e-3),
        validation: fit_of(&extended, 1e-2 * (-0.5 * gain).exp()),
        evidence: Evidence { gain, significance: 9.0 },
        inclusion: Inclusion { gains: 1.0, is_first: 0.97 },
        identification_gain: gain,
        accepted,
        tied_with_first: tied,
    }
}

fn diagnosis(verdict: Verdict, candidates: Vec<Candidate>) -> Diagnosis {
    let share = |equation: &str, share| Share {
        equation: equation.into(),
        regime: "valve closed",
        share_of_residual: share,
        share_of_time: 0.2,
    };
    Diagnosis {
        verdict,
        nominal: fit_of(&model(), 1e-2),
        nominal_validation: fit_of(&model(), 1e-2),
        chain: candidates.first().cloned().into_iter().collect(),
        candidates,
        rejected: vec![candidate("hose_loss", -0.01, false, false)],
        unpromising: Vec::new(),
        failed: Vec::new(),
        map: vec![share("arm.cap_continuity", 0.7), share("arm.motion", 0.3)],
        construction: None,
        adequacy: (verdict == Verdict::Adequate).then_some(Adequacy::Noise),
        too_coarse: false,
        unexplained: (verdict == Verdict::Unexplained).then(|| Unexplained {
            equation: "arm.motion".into(),
            variable: "position",
            share_of_residual: 0.6,
            curve: vec![[-0.1, 20.0, 2.0], [0.0, f64::NAN, 1.0], [0.1, -30.0, 2.5]],
            unit: "N m",
        }),
    }
}

fn refinement() -> Refinement {
    let found = candidate("valve_dead_zone", 2.0, true, false);
    let step = |added: Option<&str>, fit: Fit, error| Step {
        added: added.map(str::to_string),
        fit,
        comparisons: vec![comparison(error)],
    };
    let mut last = found.fit.model.clone();
    last.history.push(excavator_model::HistoryEntry {
        when: "2025-01-01T00:00:00Z".into(),
        what: "added valve_dead_zone@arm".into(),
        recordings: vec![HOSTILE.into()],
        validation_error_before: Some(0.04),
        validation_error_after: None,
    });
    Refinement {
        given_model: model(),
        given: vec![comparison(0.4)],
        steps: vec![
            step(None, fit_of(&model(), 1e-2), 0.2),
            step(Some("valve_dead_zone@arm"), found.fit.clone(), 0.01),
        ],
        model: last,
        reason: Reason::Found(Box::new(diagnosis(Verdict::MissingEffect, vec![found]))),
    }
}

fn named_to_no_avail() -> NamedVerdict {
    NamedVerdict { verdict: Verdict::Unexplained, evidence: Evidence { gain: -0.1, significance: -2.0 }, helps: false }
}

/// Every opened element is closed in order, nothing is loaded, and user text is escaped.
fn assert_sound(page: &str) {
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>"));
    assert!(!page.contains("http://") && !page.contains("https://"), "a page must not point to the network");
    assert!(!page.contains(HOSTILE) && !page.contains("<b>bag"), "text of recordings must be escaped");
    assert!(!page.contains("NaN<") && !page.contains("NaN,") && !page.contains("inf<") && !page.contains("\"NaN"));
    let void = ["meta", "link", "br", "!DOCTYPE"];
    let mut open: Vec<String> = Vec::new();
    let mut rest = page;
    while let Some(start) = rest.find('<') {
        rest = &rest[start..];
        let end = rest.find('>').unwrap();
        let tag = &rest[1..end];
        let name: String = tag.trim_start_matches('/').chars().take_while(|c| !c.is_whitespace()).collect();
        rest = &rest[end + 1..];
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(closed));
        } else if !void.contains(&name.as_str()) {
            if name == "script" || name == "style" {
                rest = &rest[rest.find(&format!("</{name}>")).unwrap()..];
            }
            open.push(name);
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

/// The data of all plots over time.
fn plots(page: &str) -> Vec<serde_json::Value> {
    page.split("<script type=\"application/json\">")
        .skip(1)
        .map(|part| serde_json::from_str(part.split("</script>").next().unwrap()).unwrap())
        .collect()
}

#[test]
fn comparison_has_every_signal_and_its_error() {
    let page = comparison_page(&model(), &[comparison(0.1), comparison(0.2)]);
    assert_sound(&page);
    assert!(SIGNALS.iter().all(|signal| page.contains(signal)));
    let plots = plots(&page);
    assert_eq!(plots.len(), 2 * 2 * SIGNALS.len());
    for plot in &plots {
        let samples = plot["time"].as_array().unwrap().len();
        assert!(samples > 100 && samples <= 2050, "{samples}");
        for series in plot["series"].as_array().unwrap() {
            assert_eq!(series["values"].as_array().unwrap().len(), samples);
        }
    }
    let gap = plots.iter().find(|plot| plot["label"] == "cap pressure").unwrap();
    assert!(gap["series"][0]["values"].as_array().unwrap().iter().any(serde_json::Value::is_null));
    assert!(page.contains("valve opening (mm²)") && page.contains("error (MPa)"));
}

#[test]
fn pages_without_data_are_sound() {
    assert_sound(&comparison_page(&model(), &[]));
    let mut empty = comparison(0.1);
    empty.measured = Recording::unmeasured(HOSTILE, vec![], &["arm"]);
    empty.simulated = empty.measured.clone();
    assert_sound(&comparison_page(&model(), &[empty.clone()]));
    empty.signals.clear();
    assert_sound(&comparison_page(&model(), &[empty]));
    let mut nothing = refinement();
    (nothing.given, nothing.reason) = (Vec::new(), Reason::Named(named_to_no_avail()));
    nothing.steps.truncate(1);
    nothing.steps[0].comparisons.clear();
    assert_sound(&refinement_page(&nothing));
    nothing.steps.clear();
    assert_sound(&refinement_page(&nothing));
}

#[test]
fn verdicts_name_effect_and_place_and_admit_ties() {
    let sentence = |diagnosis: &Diagnosis| verdict_sentence(&model(), diagnosis);
    let named = diagnosis(Verdict::MissingEffect, vec![candidate("valve_dead_zone", 2.0, true, false)]);
    assert_eq!(
        sentence(&named),
        "Missing in zx30u-arm: valve dead zone at the arm valve section. With it the squared error on recordings it was \
         not fitted to becomes 7.39 times smaller."
    );
    let mut both = named.clone();
    both.chain.push(candidate("hose_loss", 5.0, true, false));
    assert!(sentence(&both).ends_with(
        "becomes 7.39 times smaller. Beyond it: hose loss at the arm cylinder, with which it becomes 148 times smaller."
    ));
    let tied = diagnosis(
        Verdict::MissingEffect,
        vec![candidate("valve_dead_zone", 2.0, true, true), candidate("relief_valve", 1.9, true, true)],
    );
    assert!(sentence(&tied).contains("valve dead zone at the arm valve section or relief valve at the pump line: these recordings cannot tell the two apart"));
    assert!(sentence(&diagnosis(Verdict::Adequate, vec![])).starts_with("Nothing is missing"));
    let mut in_moments = diagnosis(Verdict::Adequate, vec![]);
    for (worst, is_told) in [(1e3, true), (1.2, false)] {
        // Noise of 0.1 mm in all of 40 blocks but one.
        let squares = |block: usize| if block == 7 { worst * 1e-7 } else { 1e-7 };
        let blocks: Vec<Vec<(f64, usize)>> = (0..40).map(|block| vec![(squares(block), 10)]).collect();
        let total: f64 = blocks.iter().map(|block| block[0].0).sum();
        in_moments.nominal_validation = Fit { block_errors: blocks, ..fit_of(&model(), (total / 400.0).sqrt()) };
        assert_eq!(sentence(&in_moments).contains("but for a few moments"), is_told, "{}", sentence(&in_moments));
    }
    let left = sentence(&diagnosis(Verdict::Unexplained, vec![]));
    assert!(left.contains("none of the effects in the catalogue"), "{left}");
    assert!(left.contains("force balance of the arm does not close") && left.contains("piston position"), "{left}");
    assert!(!left.contains("by hand"), "{left}");
    let mut spring = diagnosis(Verdict::Unexplained, vec![]);
    spring.construction = Some(candidate("joint_spring", 2.0, true, false));
    let left = sentence(&spring);
    assert!(
        left.contains("With a joint spring at the arm cylinder the squared error would become 7.39 times smaller"),
        "{left}"
    );
    assert!(left.ends_with("add joint_spring@arm by hand."), "{left}");
    spring.candidates =
        vec![candidate("displacement_sensor_offset", 2.0, true, true), candidate("joint_spring", 2.0, true, true)];
    let level = sentence(&spring);
    assert!(
        level.contains("whether that is displacement sensor offset at the arm cylinder or how the machine is built"),
        "{level}"
    );
    assert!(level.ends_with("add joint_spring@arm by hand."), "{level}");
}

fn missing() -> MissingPower {
    MissingPower {
        cylinder: Some("arm".into()),
        equation: "arm.motion".into(),
        regime: Regime::ClosingStroke,
        mean: -3.0,
        size: 4.0,
        peak: -9.0,
        band: 1.0,
        share_of_flow: 0.1,
        sentence: "On closing strokes, up to 9 W go missing.".into(),
    }
}

#[test]
fn diagnosis_shows_evidence_cards_and_what_is_left() {
    let first = candidate("valve_dead_zone", 2.0, true, true);
    let page = diagnosis_page(
        &model(),
        &diagnosis(Verdict::MissingEffect, vec![first, candidate("valve_leakage", 1.95, true, true)]),
        &[comparison(0.2)],
        &[(HOSTILE.into(), vec![missing()])],
    );
    assert_sound(&page);
    for text in [
        "9 W go missing",
        "valve_dead_zone",
        "valve_leakage",
        "hose_loss",
        "not told apart",
        "arm.cap_continuity",
        "valve closed",
    ] {
        assert!(page.contains(text), "{text}");
    }
    let experiment = effects::find("valve_dead_zone").unwrap().card().experiment;
    assert!(page.contains(experiment) && page.contains("arm.dead_zone_positive"));
    let page = diagnosis_page(&model(), &diagnosis(Verdict::Unexplained, vec![]), &[], &[]);
    assert_sound(&page);
    assert!(page.contains("piston position (mm)") && page.contains("residual (N m)"));
    assert_sound(&diagnosis_page(&model(), &diagnosis(Verdict::Adequate, vec![]), &[comparison(0.0)], &[]));
}

/// Gives the last effect of a model a value that a fit found.
fn found_value(model: &mut Model, value: f64) {
    let parameter = &mut model.effects.last_mut().unwrap().parameters[0];
    (parameter.value, parameter.standard_error) = (value, Some(1e-9));
}

#[test]
fn what_is_fitted_along_is_told_once_it_is_known() {
    let mut found = diagnosis(Verdict::Adequate, vec![]);
    assert!(!verdict_sentence(&model(), &found).contains("spool sensor"));
    let lead = effects::find("spool_sensor_lead").unwrap();
    let mut known = found.nominal.model.with_effect(lead, Site::Cylinder(0)).unwrap();
    found_value(&mut known, -4.5e-4);
    found.nominal.model = known.clone();
    let sentence = verdict_sentence(&model(), &found);
    assert!(
        sentence.contains("The spool sensor is not read together") && sentence.contains("0.45 ms after"),
        "{sentence}"
    );
    let offset = effects::find("spool_sensor_offset").unwrap();
    found.nominal.model = known.with_effect(offset, Site::Cylinder(0)).unwrap();
    found_value(&mut found.nominal.model, 7e-8);
    let both = verdict_sentence(&model(), &found);
    assert!(both.contains("0.45 ms after") && both.contains("does not read zero where its valve is closed"), "{both}");
    assert!(both.contains("+0.070 mm2"), "{both}");
    let reversal = effects::find("friction_reversal").unwrap();
    found.nominal.model = known.with_effect(reversal, Site::Cylinder(0)).unwrap();
    found_value(&mut found.nominal.model, 2.14e-3);
    let sentence = verdict_sentence(&model(), &found);
    assert!(
        sentence.contains("Friction turns round over another speed") && sentence.contains("2.1 mm/s"),
        "{sentence}"
    );
    let corner = effects::find("friction_corner").unwrap();
    found.nominal.model = known.with_effect(corner, Site::Cylinder(0)).unwrap();
    found_value(&mut found.nominal.model, -1.2);
    let sentence = verdict_sentence(&model(), &found);
    assert!(sentence.contains("turns another corner than the usual one (that of the arm a softer one)"), "{sentence}");
    let plain = built_in("zx30u-arm").unwrap();
    let is_along = |family| matches!(family, Family::Recording | Family::Rounding);
    for physics in effects::CATALOGUE.iter().copied().filter(|physics| is_along(physics.card().family)) {
        found.nominal.model = plain.with_effect(physics, Site::Cylinder(0)).unwrap();
        let start = found.nominal.model.effects.last().unwrap().parameters[0].value;
        found_value(&mut found.nominal.model, 2.0 * start + 1.0);
        let sentence = verdict_sentence(&plain, &found);
        assert!(sentence.contains("taken into account"), "{}: {sentence}", physics.card().name);
    }
    // What only stood in for what was missing is not told.
    found.nominal.model.effects.last_mut().unwrap().parameters[0].standard_error = Some(1e9);
    assert!(!verdict_sentence(&plain, &found).contains("taken into account"));
    found.nominal.model = known.clone();
    // Whoever says so in the model needs no telling.
    assert!(!verdict_sentence(&known, &found).contains("spool sensor"));
}

#[test]
fn refinement_tells_the_story() {
    let page = refinement_page(&refinement());
    assert_sound(&page);
    for text in ["as given", "refitted", "+ valve dead zone, arm", "added valve_dead_zone@arm", "Evidence"] {
        assert!(page.contains(text), "{text}");
    }
    assert!(SIGNALS.iter().all(|signal| page.contains(signal)));
    assert_eq!(plots(&page).len(), 2 * SIGNALS.len());
    assert_eq!(plots(&page)[0]["series"].as_array().unwrap().len(), 3);
    assert!(page.len() < 3_000_000);
}

#[test]
fn a_refined_model_tells_what_was_fitted_along_since_the_given_one() {
    let mut refinement = refinement();
    assert!(!refinement_page(&refinement).contains("fitted along"));
    let Reason::Found(found) = &mut refinement.reason else { unreachable!() };
    let reversal = effects::find("friction_reversal").unwrap();
    for model in [&mut refinement.model, &mut found.chain.last_mut().unwrap().fit.model] {
        *model = model.with_effect(reversal, Site::Cylinder(0)).unwrap();
        found_value(model, 2.14e-3);
    }
    let page = refinement_page(&refinement);
    assert!(page.contains("Friction turns round over another speed than the usual 1 mm/s"));
    assert_eq!(page.matches("fitted along").count(), 1);
}
