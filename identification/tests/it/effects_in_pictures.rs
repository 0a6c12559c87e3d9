//! An effect taken out of the model that has it: what the equations lack is the effect, along the variable it depends on.

use crate::common::swing;
use excavator_identification::diagnosis::{Contribution, Drawn, contribution};
use excavator_identification::fit::{FitSettings, evaluate};
use excavator_identification::search::{Addition, Trial};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Site};

/// The paper's arm with one more effect.
fn machine(name: &str, values: &[f64]) -> Model {
    let mut model = built_in("zx30u-arm")
        .unwrap()
        .with_effect(&Catalogue::built_in().find(name).unwrap(), Site::Cylinder(0))
        .unwrap();
    for (parameter, value) in model.effects.last_mut().unwrap().parameters.iter_mut().zip(values) {
        parameter.value = *value;
    }
    model
}

fn shown(name: &'static str, values: &[f64], found: &[f64]) -> Option<Contribution> {
    let recording = swing(&machine(name, values));
    let model = machine(name, found);
    let fit = evaluate(&model, &[&recording], &FitSettings::default()).unwrap();
    let addition = Addition { physics: Catalogue::built_in().find(name).unwrap(), site: Site::Cylinder(0) };
    let trial = Trial { additions: vec![addition.clone()], validation: fit.clone(), fit, seconds: 0.0, error: None };
    contribution(&trial, &addition, &[&recording]).unwrap()
}

/// Largest distance of the data from the effect, as a part of the effect's size.
fn distance(shown: &Contribution) -> f64 {
    let size = shown.bins.iter().map(|bin| bin.effect.abs()).fold(0.0, f64::max);
    shown.bins.iter().map(|bin| (bin.lacking - bin.effect).abs()).fold(0.0, f64::max) / size
}

#[test]
fn friction_shows_against_speed_in_the_force_balance() {
    let stribeck = [800.0, 0.02];
    let shown = shown("stribeck_friction", &stribeck, &stribeck).unwrap();
    assert_eq!((shown.equation.as_str(), shown.variable, shown.unit), ("arm.motion", "speed", "N m"));
    assert!(distance(&shown) < 0.1, "{}: {shown:#?}", distance(&shown));
    // With it, all friction: viscous and Coulomb friction of the nominal model are under the effect.
    assert_eq!(shown.drawn, Drawn::Friction);
    assert!(shown.bins.iter().filter(|bin| bin.at.abs() > 0.01).all(|bin| bin.nominal * bin.at > 0.0), "{shown:#?}");
    // The upturn near zero: against the motion, gone at speed.
    assert!(shown.bins.iter().all(|bin| bin.effect * bin.at > 0.0));
    let largest = shown.bins.iter().max_by(|a, b| a.effect.abs().total_cmp(&b.effect.abs())).unwrap();
    let fastest = shown.bins.iter().max_by(|a, b| a.at.abs().total_cmp(&b.at.abs())).unwrap();
    assert!(largest.at.abs() < stribeck[1] && fastest.effect.abs() < 0.05 * largest.effect.abs(), "{shown:#?}");
}

#[test]
fn a_dead_zone_shows_against_the_opening_in_an_oil_balance() {
    let zone = [8e-6, 8e-6];
    let shown = shown("valve_dead_zone", &zone, &zone).unwrap();
    assert!(shown.equation.ends_with("continuity") && shown.variable == "command", "{shown:?}");
    assert!(distance(&shown) < 0.1, "{}: {shown:#?}", distance(&shown));
    // As a textbook has it: no opening inside the zone, and outside the command less the zone.
    assert_eq!((shown.drawn, shown.unit), (Drawn::Opening, "m2"));
    for bin in shown.bins.iter().filter(|bin| bin.at.abs() > 3.0 * zone[0]) {
        let opening = bin.nominal + bin.lacking;
        assert!((opening.abs() - (bin.at.abs() - zone[0])).abs() < 0.3 * zone[0], "{opening} at {}", bin.at);
    }
}

#[test]
fn data_that_ask_for_more_leave_the_line() {
    let shown = shown("stribeck_friction", &[800.0, 0.02], &[400.0, 0.02]).unwrap();
    assert!(distance(&shown) > 0.5, "{}: {shown:#?}", distance(&shown));
}

#[test]
fn an_effect_that_does_nothing_has_no_picture() {
    assert_eq!(shown("stribeck_friction", &[0.0, 0.02], &[0.0, 0.02]), None);
}
