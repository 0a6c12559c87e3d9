//! Friction that falls as the oil warms: a model with constant parameters is not called adequate, and the right law is named.

use crate::common::{off_the_data_sheet, seen, steered, steering};
use excavator_identification::change::changes;
use excavator_identification::decision::{Kind, Reason};
use excavator_identification::diagnosis::{Diagnosis, DiagnosisSettings, diagnose};
use excavator_identification::fit::FitSettings;
use excavator_model::Model;
use excavator_model::document::{built_in, parse_catalogue};
use excavator_model::effects::{Catalogue, Site};
use excavator_model::recording::Recording;

/// Friction that falls by half for every 14 K.
const LAW: &str = r#"
[[formula]]
name = "cold_friction"
acts_on = "piston_force"
formula = "-k*sign(v)*exp(-b*(temperature - T0))"
parameters.k = { unit = "N", minimum = 0.0, maximum = 1e5, start = [100.0] }
parameters.b = { unit = "1/K", minimum = 0.0, maximum = 1.0, start = [0.02] }
parameters.T0 = { unit = "degC", value = 40.0, known = true }
"#;

fn catalogue() -> Catalogue {
    parse_catalogue("cold.toml", LAW, &Catalogue::built_in()).unwrap()
}

/// The arm with `friction` N of that law at 40 °C, steered by two sines while the oil warms by 40 K.
fn warming(friction: f64, tempo: f64, seed: u64) -> Recording {
    warm_up("cold_friction", &[("k", friction), ("b", 0.05)], tempo, seed)
}

/// The arm with an effect of the temperature, steered by two sines while the oil warms by 40 K.
fn warm_up(law: &str, values: &[(&str, f64)], tempo: f64, seed: u64) -> Recording {
    let machine = Model { catalogue: catalogue(), ..off_the_data_sheet("zx30u-arm", 0.1) };
    let law = machine.catalogue.find(law).unwrap();
    let mut machine = machine.with_effect(&law, Site::Cylinder(0)).unwrap();
    for (name, value) in values {
        machine.effects.last_mut().unwrap().parameters.iter_mut().find(|one| one.card.name == *name).unwrap().value =
            *value;
    }
    let mut recording = steering(tempo, 24.0);
    recording.oil_temperature = recording.time.iter().map(|t| 20.0 + 40.0 * t / 24.0).collect();
    seen(&machine, &recording, seed)
}

fn diagnosed(model: &Model, [fitted, judging]: [Recording; 2]) -> Diagnosis {
    diagnose(model, &[&fitted], &[&judging], &DiagnosisSettings::default(), &|_, _| {}).unwrap()
}

/// Two warm-ups with `friction` N.
fn warm_ups(friction: f64) -> [Recording; 2] {
    [warming(friction, 2.9, 1), warming(friction, 3.4, 2)]
}

/// The same without a sensor for the temperature: no law of the catalogue can follow it.
fn without_temperature(mut recordings: [Recording; 2]) -> [Recording; 2] {
    recordings.iter_mut().for_each(|one| one.oil_temperature.fill(f64::NAN));
    recordings
}

/// Largest fall of friction for which constant parameters leave little more than noise.
const WEAK: f64 = 25.0;

#[test]
fn an_adequate_model_whose_friction_drifts_is_not_called_adequate() {
    let found = diagnosed(&built_in("zx30u-arm").unwrap(), without_temperature(warm_ups(WEAK)));
    assert_eq!(found.verdict.kind, Kind::Unexplained, "{:?}", found.verdict.reasons);
    assert!(matches!(found.verdict.reasons[0], Reason::ParametersDrift { .. }), "{:?}", found.verdict.reasons);
    let first = &found.verdict.differing().unwrap()[0];
    assert_eq!(first.name, "arm.coulomb_friction");
    assert!(first.values[1] < 0.9 * first.values[0], "{:?}", first.values);
}

#[test]
fn a_machine_that_stays_as_it_is_does_not_drift() {
    let found = diagnosed(&built_in("zx30u-arm").unwrap(), warm_ups(0.0));
    assert_eq!(found.verdict.kind, Kind::Adequate, "{:?}", found.verdict.reasons);
}

#[test]
fn a_repair_shows_in_its_parameter_alone() {
    let leaking = |leakage: f64, tempo: f64, seed: u64| {
        let mut machine = off_the_data_sheet("zx30u-arm", 0.1);
        for parameter in machine.parameters_mut().filter(|one| one.card.name == "internal_leakage") {
            parameter.value = leakage;
        }
        steered(&machine, tempo, 24.0, seed)
    };
    // 2.4 l/min and 0.6 l/min at 100 bar.
    let (before, after) = (leaking(4e-12, 2.9, 1), leaking(1e-12, 3.4, 2));
    let found = changes(&built_in("zx30u-arm").unwrap(), &[&before], &[&after], &FitSettings::default()).unwrap();
    let changed: Vec<&str> = found.changed().map(|one| one.name.as_str()).collect();
    assert_eq!(changed, ["arm.internal_leakage"]);
    let leakage = found.changed().next().unwrap();
    for (value, truth) in leakage.values.iter().zip([4e-12, 1e-12]) {
        assert!((value - truth).abs() < 2e-13, "{value} {truth}");
    }
    assert_eq!(found.leaves_more_than_noise(), [false, false]);
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    /// Warm-ups of a machine with a law of the catalogue, diagnosed.
    fn assert_named(law: &str, parameter: &str, fall: f64) {
        let recordings = [(2.9, 1), (3.4, 2)].map(|(tempo, seed)| warm_up(law, &[(parameter, fall)], tempo, seed));
        let found = diagnosed(&built_in("zx30u-arm").unwrap(), recordings);
        let names: Vec<&str> = found.selected().iter().map(|one| one.name()).collect();
        assert_eq!((found.verdict.kind, &names[..]), (Kind::MissingEffect, &[law][..]), "{:?}", found.verdict.reasons);
        let value = found.best().fit.model.value_of(&format!("arm.{parameter}")).unwrap();
        assert!((value / fall - 1.0).abs() < 0.1, "{value}, true {fall}");
    }

    #[test]
    fn seals_that_rub_more_when_they_are_cold_are_named_from_two_warm_ups() {
        assert_named("seal_friction_temperature", "seal_friction_fall", 0.05);
    }

    #[test]
    fn oil_that_is_thicker_when_it_is_cold_is_named_from_two_warm_ups() {
        assert_named("viscosity_temperature", "viscosity_fall", 0.046);
    }

    /// A law of one's own and one of the catalogue that say the same are tied, or either is named: never both.
    #[test]
    fn a_law_of_ones_own_is_named_or_tied_with_the_one_of_the_catalogue() {
        let model = Model { catalogue: catalogue(), ..built_in("zx30u-arm").unwrap() };
        let found = diagnosed(&model, warm_ups(400.0));
        let names: Vec<&str> = found.selected().iter().map(|one| one.name()).collect();
        let laws = ["cold_friction", "seal_friction_temperature"];
        assert!(names.len() == 1 && laws.contains(&names[0]), "{names:?}: {:?}", found.verdict.reasons);
        assert_eq!(found.verdict.kind, Kind::MissingEffect, "{:?}", found.verdict.reasons);
    }
}
