//! A friction that turns round over another speed than the equations' 1 mm/s: found when outputs are fitted, and no error of the
//! friction force.

use std::cell::RefCell;
use std::ops::ControlFlow;

use crate::common::{measure, off_the_data_sheet};
use excavator_identification::diagnosis::DiagnosisSettings;
use excavator_identification::fit::{FitSettings, Simplified, fit, fit_watched, with_nuisances};
use excavator_identification::refinement::{Additions, refine};
use excavator_identification::search::Addition;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Site};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use excavator_model::{Model, ModelEffect};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// A machine whose friction turns round over `reversal_speed`, m/s.
fn machine(reversal_speed: f64) -> Model {
    let mut model = off_the_data_sheet("zx30u-arm", 0.1);
    let mut effect =
        ModelEffect::new(&Catalogue::built_in().find("friction_reversal").unwrap(), &model.machine, Site::Cylinder(0))
            .unwrap();
    effect.parameters[0].value = reversal_speed;
    model.effects.push(effect);
    model
}

/// Twelve seconds of it at 500 Hz, slow and fast, with many reversals.
fn recorded(model: &Model) -> Recording {
    let time: Vec<f64> = (0..6000).map(|index| f64::from(index) / 500.0).collect();
    let mut recording = Recording::unmeasured("machine", time, &["arm"]);
    recording.tank_pressure.fill(6e5);
    recording.pump_flow.fill(3.8e-4);
    let openings = recording.time.iter().map(|&t| 2.5e-5 * (4.1 * t).sin() + 1.5e-5 * (9.7 * t).sin());
    recording.cylinders[0].orifice_area = openings.collect();
    let mut seen = simulate_from_rest(model, &recording, &[0.05], Tolerances::default().scaled(0.05)).unwrap();
    measure(&mut ChaCha8Rng::seed_from_u64(5), &mut seen);
    seen
}

fn error_of_the_friction(found: &Model, truth: &Model) -> f64 {
    let [found, truth] = [found, truth].map(|model| model.value_of("arm.coulomb_friction").unwrap());
    (found / truth - 1.0).abs()
}

#[test]
fn a_slow_reversal_is_found_and_bends_no_friction_force() {
    let truth = machine(3e-3);
    let recording = recorded(&truth);
    let (given, settings) = (built_in("zx30u-arm").unwrap(), FitSettings::default());
    let told = RefCell::new(Vec::new());
    let watch = |done: f64| {
        told.borrow_mut().push(done);
        ControlFlow::Continue(())
    };
    let extended = with_nuisances(&given, &[&recording]);
    let fitted = fit_watched(&extended, &[&recording], &settings, &watch).unwrap();
    let along = Simplified::of(&given, &fitted.model).model;
    let plain = fit(&given, &[&recording], &settings).unwrap().model;

    let found = along.value_of("arm.reversal_speed").expect("the reversal is part of the fit");
    assert!((found / 3e-3 - 1.0).abs() < 0.1, "{found:e} m/s, should be 3e-3 m/s");
    let (with, without) = (error_of_the_friction(&along, &truth), error_of_the_friction(&plain, &truth));
    assert!(
        with < 0.01 && without > 5.0 * with,
        "friction {:.2} % off, {:.2} % without",
        100.0 * with,
        100.0 * without
    );
    let told = told.into_inner();
    assert!(told.windows(2).all(|pair| pair[0] <= pair[1]) && told.iter().all(|done| *done <= 1.0), "{told:?}");
}

#[test]
fn a_friction_as_the_equations_have_it_needs_no_other_reversal() {
    let recording = recorded(&machine(1e-3));
    let given = built_in("zx30u-arm").unwrap();
    let fitted = fit(&with_nuisances(&given, &[&recording]), &[&recording], &FitSettings::default()).unwrap();
    let found = Simplified::of(&given, &fitted.model).model;
    fn names(model: &Model) -> Vec<&str> {
        model.effects.iter().map(ModelEffect::name).collect()
    }
    assert_eq!(names(&found), names(&given));
}

/// A friction that a person adds brings its corner along, and the history of the model says so.
#[test]
fn an_added_friction_turns_round_as_the_machine_does() {
    let recording = recorded(&machine(3e-3));
    let mut given = built_in("zx30u-arm").unwrap();
    given.effects.retain(|effect| effect.name() != "coulomb_friction");
    let named = given.parse_addition("coulomb_friction").unwrap().into_iter();
    let additions = Additions::Named(named.map(|(physics, site)| Addition { physics, site }).collect());
    let settings = DiagnosisSettings::default();
    let refined =
        refine(&given, &[&recording], &[&recording], &additions, &settings, "2000-01-01T00:00:00Z", &|_, _| {})
            .unwrap();
    let found = refined.model.value_of("arm.reversal_speed").expect("the reversal is part of the fit");
    assert!((found / 3e-3 - 1.0).abs() < 0.1, "{found:e} m/s, should be 3e-3 m/s");
    let history: Vec<&str> = refined.model.history.iter().map(|entry| entry.what.as_str()).collect();
    assert!(history.iter().any(|what| what.contains("nuisances: friction_reversal@arm")), "{history:?}");
}
