//! Tests whole pages, made from a simulation instead of a recording.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use excavator_identification::decision::{Kind, Policy, Reason, Standing, Verdict};
use excavator_identification::diagnosis::{Diagnosis, NamedVerdict, Share, Unexplained};
use excavator_identification::energy::{MissingPower, Regime};
use excavator_identification::fit::{Fit, Instrument};
use excavator_identification::refinement::{Reason as Cause, Refinement, Step};
use excavator_identification::search::{Addition, Trial, score, scores_of_given};
use excavator_identification::validation::{Baselines, Comparison, ErrorSums, SignalComparison};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Family, Site};
use excavator_model::equations::Channel;
use excavator_model::recording::Recording;
use nalgebra::DMatrix;

use super::{comparison_page, diagnosis_page, refinement_page, verdict_sentence};

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
            error: ErrorSums::of(&[-1.0, 1.0], &[-1.0 - error, 1.0 + error], 0.0),
            unit: "Pa",
            phases: Vec::new(),
            phase_delay_degrees: (name != "arm.velocity").then_some(-1.25),
        })
        .to_vec();
    Comparison {
        measured,
        simulated: recording("simulated", error),
        signals,
        excitation_frequency: Some(0.48),
        machine: model().machine,
    }
}

fn fit_of(model: &Model, error: f64) -> Fit {
    let mut model = model.clone();
    for parameter in model.parameters_mut() {
        parameter.standard_error = Some(parameter.value.abs() * 0.02);
    }
    // One displacement with a sensor noise of 0.1 mm.
    let instrument =
        Instrument { name: "load.displacement".into(), unit: "m", channel: Channel::Displacement(0), noise: 1e-4 };
    Fit {
        model,
        fitted: Vec::new(),
        covariance: DMatrix::zeros(0, 0),
        inflation: Vec::new(),
        instruments: vec![instrument],
        errors: vec![error],
        block_errors: Vec::new(),
        block_places: Vec::new(),
        steps: 0,
        converged: true,
    }
}

/// A trial with these effects. Its squared error is `e^-improvement` times that of the given model.
fn trial(names: &[&str], improvement: f64) -> Trial {
    let mut extended = model();
    let mut additions = Vec::new();
    for name in names {
        let physics = Catalogue::built_in().find(name).unwrap();
        let site = extended.free_sites(&physics)[0];
        extended = extended.with_effect(&physics, site).unwrap();
        additions.push(Addition { physics, site });
    }
    let validation = fit_of(&extended, 1e-2 * (-0.5 * improvement).exp());
    Trial { additions, fit: fit_of(&extended, 1e-3), validation, seconds: 0.0, error: None }
}

/// A diagnosis whose hypotheses are the given model and then `trials`. `set` holds their numbers, from 1.
fn diagnosis(kind: Kind, trials: Vec<Trial>, set: &[usize], reasons: Vec<Reason>) -> Diagnosis {
    let share = |equation: &str, share| Share {
        equation: equation.into(),
        regime: "valve closed".into(),
        share_of_residual: share,
        share_of_time: 0.2,
    };
    let given = trial(&[], 0.0);
    let recording = recording("bag", 0.0);
    let mut scores = scores_of_given(&given, &model(), &[&recording], &[&recording]);
    scores.hypotheses.extend(trials.iter().map(|trial| score(trial, &given.fit.model, &model(), &[&recording])));
    let standing = |trial: &Trial| Standing {
        log_error_ratio: trial.validation.loss(),
        improvement: given.validation.loss() - trial.validation.loss(),
        identification_improvement: 1.0,
        significance: 9.0,
        is_admissible: trial.validation.loss() + 0.1 < given.validation.loss(),
        set_p_value: None,
        is_first: 0.97,
    };
    let standings = std::iter::once(&given).chain(&trials).map(standing).collect();
    let with_error = |trial: Trial| {
        let error = Some(0.1 * (trial.validation.loss() - given.validation.loss()).exp());
        Trial { error, ..trial }
    };
    Diagnosis {
        policy: Policy::default(),
        verdict: Verdict { kind, best: set.first().copied().unwrap_or(0), set: set.to_vec(), reasons, standings },
        scores,
        trials: std::iter::once(given.clone()).chain(trials).map(with_error).collect(),
        unpromising: Vec::new(),
        failed: Vec::new(),
        map: vec![share("arm.cap_continuity", 0.7), share("arm.motion", 0.3)],
        remainders: Vec::new(),
        unexplained: (kind == Kind::Unexplained).then(|| Unexplained {
            equation: "arm.motion".into(),
            variable: "position".into(),
            share_of_residual: 0.6,
            follows_variable: true,
            differs_in_form: false,
            curve: vec![[-0.1, 20.0, 2.0], [0.0, f64::NAN, 1.0], [0.1, -30.0, 2.5]],
            unit: "N m".into(),
        }),
        lost_messages: Vec::new(),
    }
}

fn adequate(reason: Reason) -> Diagnosis {
    diagnosis(Kind::Adequate, Vec::new(), &[], vec![reason])
}

const NOISE: Reason = Reason::WithinNoise { log_error_ratio: 0.0, limit: 0.2 };

/// A dead zone, and a hose loss that is not an answer.
fn dead_zone() -> Vec<Trial> {
    vec![trial(&["valve_dead_zone"], 2.0), trial(&["hose_loss"], -0.01)]
}

fn refinement() -> Refinement {
    let found = trial(&["valve_dead_zone"], 2.0);
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
        reason: Cause::Found(Box::new(diagnosis(Kind::MissingEffect, vec![found], &[1], Vec::new()))),
    }
}

fn named_to_no_avail() -> NamedVerdict {
    NamedVerdict { kind: Kind::Unexplained, improvement: -0.1, helps: false }
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
        .filter(|shown: &serde_json::Value| shown.get("series").is_some())
        .collect()
}

#[test]
fn the_machine_moves_as_measured_and_as_simulated() {
    let page = comparison_page(&model(), &[comparison(0.1)], &[], &[]);
    let (_, after) = page.split_once("<div class=\"machine\"><script type=\"application/json\">").unwrap();
    let shown: serde_json::Value = serde_json::from_str(after.split("</script>").next().unwrap()).unwrap();
    let joint = &shown["joints"][0];
    let samples = shown["time"].as_array().unwrap().len();
    assert!(samples > 1 && joint["name"].as_str().unwrap().ends_with("_joint"));
    assert_eq!(joint["reference"].as_array().unwrap().len(), samples);
    assert_eq!(joint["models"][0].as_array().unwrap().len(), samples);
    assert!(shown["robot"].as_str().unwrap().contains("<robot"));
    // A motion that is an input of the model cannot deviate.
    let mut imposed = comparison(0.1);
    imposed.signals.retain(|signal| !signal.name.ends_with("displacement") && !signal.name.ends_with("joint_angle"));
    assert!(!comparison_page(&model(), &[imposed], &[], &[]).contains("<div class=\"machine\">"));
}

#[test]
fn comparison_has_every_signal_and_its_error() {
    let page = comparison_page(&model(), &[comparison(0.1), comparison(0.2)], &[], &[]);
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
    // Plots are reachable by keyboard and have a description. Pictures have a description too.
    let reachable = r#"<div class="time-plot" tabindex="0" role="application""#;
    assert_eq!(page.matches(reachable).count(), plots.len());
    assert!(page.contains(r#"aria-label="Arm cap pressure error over time: measured − model""#));
    assert_eq!(page.matches("<svg ").count(), page.matches(r#"role="img"><title>"#).count());
    assert!(page.contains(r##"<nav aria-label="Contents"><a href="#measures">"##));
    assert!(page.contains(r#"<style class="dark" media="screen and (prefers-color-scheme: dark)">"#));
}

#[test]
fn pages_without_data_are_sound() {
    assert_sound(&comparison_page(&model(), &[], &[], &[]));
    let mut empty = comparison(0.1);
    empty.measured = Recording::unmeasured(HOSTILE, vec![], &["arm"]);
    empty.simulated = empty.measured.clone();
    let none = Baselines { signals: Vec::new(), held: 1.0 };
    assert_sound(&comparison_page(&model(), &[empty.clone()], std::slice::from_ref(&none), &[]));
    empty.signals.clear();
    assert_sound(&comparison_page(&model(), &[empty], &[none], &[]));
    let mut nothing = refinement();
    (nothing.given, nothing.reason) = (Vec::new(), Cause::Named(named_to_no_avail()));
    nothing.steps.truncate(1);
    nothing.steps[0].comparisons.clear();
    assert_sound(&refinement_page(&nothing));
    nothing.steps.clear();
    assert_sound(&refinement_page(&nothing));
}

fn sentence(diagnosis: &Diagnosis) -> String {
    verdict_sentence(&model(), diagnosis)
}

#[test]
fn a_missing_effect_is_named_with_its_place_and_what_it_brings() {
    let named = diagnosis(Kind::MissingEffect, dead_zone(), &[1], Vec::new());
    assert_eq!(
        sentence(&named),
        "Missing in zx30u-arm: valve dead zone at the arm valve section. With it the mean NMSE on recordings that were not fitted falls \
         from 0.100 to 0.0135 (7.39 times smaller)."
    );
    let mut trials = dead_zone();
    trials.push(trial(&["valve_dead_zone", "hose_loss"], 5.0));
    let both = sentence(&diagnosis(Kind::MissingEffect, trials, &[3], Vec::new()));
    assert!(both.contains("valve dead zone at the arm valve section and hose loss at the arm cylinder."), "{both}");
    assert!(
        both.ends_with(
            "With all of them the mean NMSE on recordings that were not fitted falls from 0.100 to 0.000674 (148 times smaller)."
        )
    );
}

#[test]
fn effects_that_cannot_be_told_apart_are_all_named() {
    let trials = vec![trial(&["valve_dead_zone"], 2.0), trial(&["relief_valve"], 1.9)];
    let tied = sentence(&diagnosis(Kind::MissingEffect, trials, &[1, 2], Vec::new()));
    assert!(tied.contains("valve dead zone at the arm valve section or relief valve at the pump line."), "{tied}");
    assert!(tied.contains("cannot tell the alternatives apart"), "{tied}");
}

#[test]
fn an_adequate_model_says_why() {
    assert!(sentence(&adequate(NOISE)).starts_with("Nothing is missing"));
    let mut in_moments = adequate(NOISE);
    in_moments.verdict.reasons.push(Reason::ExceptMoments { share_of_time: 0.04 });
    assert!(sentence(&in_moments).contains("In 4.0 % of the time"), "{}", sentence(&in_moments));
    let small = adequate(Reason::SmallError { relative_error: 1e-4, limit: 1.5e-4 });
    assert!(sentence(&small).contains("too small to act on"));
    let inputs = adequate(Reason::WithinInputs { log_error_ratio: 0.1, limit: 0.2 });
    assert!(sentence(&inputs).contains("noise and sampling of the inputs"));
}

#[test]
fn what_is_unexplained_says_what_is_known_of_it() {
    let nothing = Reason::NothingHelps { log_error_ratio: 2.0 };
    let left = sentence(&diagnosis(Kind::Unexplained, Vec::new(), &[], vec![nothing]));
    assert!(left.contains("no effect of the catalogue explains it"), "{left}");
    assert!(left.contains("force balance of the arm; 60 % of it follows the piston position"), "{left}");
    let partly = |after| Reason::PartlyExplained { before: 2.0, after, limit: 0.1 };
    let elsewhere = diagnosis(Kind::Unexplained, dead_zone(), &[1], vec![partly(0.4)]);
    assert!(sentence(&elsewhere).contains("20 % of the misfit remains"), "{}", sentence(&elsewhere));
    assert!(!sentence(&elsewhere).contains("mostly"), "{}", sentence(&elsewhere));
    let mut in_its_own = elsewhere;
    in_its_own.unexplained.iter_mut().for_each(|left| left.differs_in_form = true);
    let mostly = sentence(&in_its_own);
    assert!(mostly.contains("mostly valve dead zone at the arm valve section"), "{mostly}");
    assert!(mostly.contains("in a form that differs"), "{mostly}");
    let half = sentence(&diagnosis(Kind::Unexplained, dead_zone(), &[1], vec![partly(1.0)]));
    assert!(half.contains("With valve dead zone at the arm valve section the mean NMSE"), "{half}");
}

#[test]
fn a_structural_alternative_is_told_with_the_command_that_adds_it() {
    let trials = vec![trial(&["displacement_sensor_offset"], 2.0), trial(&["joint_spring"], 2.0)];
    let level = Reason::StructuralAlternative { hypothesis: 2, is_preferred: false };
    let left = sentence(&diagnosis(Kind::Unexplained, trials, &[1], vec![level]));
    assert!(
        left.contains("displacement sensor offset at the arm cylinder from a structural property of the machine"),
        "{left}"
    );
    assert!(
        left.contains(
            "With joint spring at the arm cylinder the mean NMSE falls from 0.100 to 0.0135 (7.39 times smaller)"
        ),
        "{left}"
    );
    assert!(left.ends_with("`excavator refine --add joint_spring@arm`."), "{left}");
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
    let mut trials = dead_zone();
    trials.push(trial(&["valve_leakage"], 1.95));
    let page = diagnosis_page(
        &model(),
        &diagnosis(Kind::MissingEffect, trials, &[1, 3], Vec::new()),
        &[comparison(0.2)],
        &[(HOSTILE.into(), vec![missing()])],
    );
    assert_sound(&page);
    for text in [
        "9 W go missing",
        "valve_dead_zone",
        "valve_leakage",
        "hose_loss",
        ">tied<",
        "arm.cap_continuity",
        "valve closed",
    ] {
        assert!(page.contains(text), "{text}");
    }
    let experiment = Catalogue::built_in().find("valve_dead_zone").unwrap().card().experiment.clone();
    assert!(page.contains(&*experiment) && page.contains("arm.dead_zone_positive"));
    let page = diagnosis_page(&model(), &diagnosis(Kind::Unexplained, Vec::new(), &[], Vec::new()), &[], &[]);
    assert_sound(&page);
    assert!(page.contains("piston position (mm)") && page.contains("residual (N m)"));
    assert_sound(&diagnosis_page(&model(), &adequate(NOISE), &[comparison(0.0)], &[]));
}

/// Sets the value of a model's last effect as if a fit had found it.
fn found_value(model: &mut Model, value: f64) {
    let parameter = &mut model.effects.last_mut().unwrap().parameters[0];
    (parameter.value, parameter.standard_error) = (value, Some(1e-9));
}

#[test]
fn nuisances_are_told_once_they_are_known() {
    let mut found = adequate(NOISE);
    assert!(!verdict_sentence(&model(), &found).contains("spool sensor"));
    let lead = Catalogue::built_in().find("spool_sensor_lead").unwrap();
    let mut known = found.trials[0].fit.model.with_effect(&lead, Site::Cylinder(0)).unwrap();
    found_value(&mut known, -4.5e-4);
    found.trials[0].fit.model = known.clone();
    let sentence = verdict_sentence(&model(), &found);
    assert!(
        sentence.contains("The spool sensor is sampled at a different time") && sentence.contains("0.45 ms later"),
        "{sentence}"
    );
    let offset = Catalogue::built_in().find("spool_sensor_offset").unwrap();
    found.trials[0].fit.model = known.with_effect(&offset, Site::Cylinder(0)).unwrap();
    found_value(&mut found.trials[0].fit.model, 7e-8);
    let both = verdict_sentence(&model(), &found);
    assert!(both.contains("0.45 ms later") && both.contains("does not read zero where its valve is closed"), "{both}");
    assert!(both.contains("reads 0.070 mm2 there"), "{both}");
    let reversal = Catalogue::built_in().find("friction_reversal").unwrap();
    found.trials[0].fit.model = known.with_effect(&reversal, Site::Cylinder(0)).unwrap();
    found_value(&mut found.trials[0].fit.model, 2.14e-3);
    let sentence = verdict_sentence(&model(), &found);
    assert!(
        sentence.contains("regularisation velocity of friction differs") && sentence.contains("2.1 mm/s"),
        "{sentence}"
    );
    let corner = Catalogue::built_in().find("friction_corner").unwrap();
    found.trials[0].fit.model = known.with_effect(&corner, Site::Cylinder(0)).unwrap();
    found_value(&mut found.trials[0].fit.model, -1.2);
    let sentence = verdict_sentence(&model(), &found);
    assert!(sentence.contains("has another sharpness than the default (arm: softer)"), "{sentence}");
    let plain = built_in("zx30u-arm").unwrap();
    let is_along = |family| matches!(family, Family::Recording | Family::Rounding);
    for physics in Catalogue::built_in().iter().filter(|physics| is_along(physics.card().family)) {
        found.trials[0].fit.model = plain.with_effect(physics, Site::Cylinder(0)).unwrap();
        let start = found.trials[0].fit.model.effects.last().unwrap().parameters[0].value;
        found_value(&mut found.trials[0].fit.model, 2.0 * start + 1.0);
        let sentence = verdict_sentence(&plain, &found);
        assert!(sentence.contains("takes this into account"), "{}: {sentence}", physics.card().name);
    }
    // A nuisance that only compensated for the missing effect is not reported.
    found.trials[0].fit.model.effects.last_mut().unwrap().parameters[0].standard_error = Some(1e9);
    assert!(!verdict_sentence(&plain, &found).contains("takes this into account"));
    found.trials[0].fit.model = known.clone();
    // A nuisance that the given model already has is not reported.
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
fn a_refined_model_tells_the_nuisances_since_the_given_one() {
    let mut refinement = refinement();
    assert!(!refinement_page(&refinement).contains("nuisance<"));
    let Cause::Found(found) = &mut refinement.reason else { unreachable!() };
    let reversal = Catalogue::built_in().find("friction_reversal").unwrap();
    for model in [&mut refinement.model, &mut found.trials.last_mut().unwrap().fit.model] {
        *model = model.with_effect(&reversal, Site::Cylinder(0)).unwrap();
        found_value(model, 2.14e-3);
    }
    let page = refinement_page(&refinement);
    assert!(page.contains("The regularisation velocity of friction differs"));
    assert_eq!(page.matches("nuisance<").count(), 1);
}
