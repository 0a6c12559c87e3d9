//! What the catalogue says about its effects.

use crate::common;
use std::collections::HashSet;

use excavator_model::effects::{
    Catalogue, Corner, Family, Needs, Prior, PriorScale, RecordingScales, Site, Spread, Start,
};

#[test]
fn every_card_says_something() {
    for effect in &Catalogue::built_in() {
        let card = effect.card();
        let texts = [
            card.summary.clone(),
            card.equation.clone(),
            card.source.clone(),
            card.shows.clone(),
            card.experiment.clone(),
            card.energy.clone(),
        ];
        for text in texts {
            assert!(text.trim().len() > 5, "{}: \"{text}\"", card.name);
            assert!(!text.contains("  "), "{}: \"{text}\" has holes", card.name);
        }
        assert!(card.name.chars().all(|c| c.is_ascii_lowercase() || c == '_'), "{}", card.name);
    }
}

#[test]
fn effect_names_are_unique_and_found() {
    let catalogue = Catalogue::built_in();
    let names: HashSet<&str> = catalogue.iter().map(|effect| &*effect.card().name).collect();
    assert_eq!(names.len(), catalogue.iter().count());
    for name in names {
        assert_eq!(catalogue.find(name).unwrap().card().name, name);
    }
}

#[test]
fn a_misspelt_effect_gets_a_suggestion() {
    let error = Catalogue::built_in().find("stribek_friction").unwrap_err();
    assert_eq!(error.suggestion.as_deref(), Some("stribeck_friction"));
    assert!(error.to_string().contains("stribeck_friction"));
    assert_eq!(Catalogue::built_in().find("zzz").unwrap_err().suggestion, None);
}

#[test]
fn every_effect_of_the_contract_that_is_listed_acts_somewhere() {
    for effect in &Catalogue::built_in() {
        let somewhere = common::machines().iter().any(|model| {
            !model.free_sites(effect).is_empty() || model.effects.iter().any(|e| e.name() == effect.card().name)
        });
        assert!(somewhere, "{}", effect.card().name);
    }
    for family in
        [Family::Base, Family::Recording, Family::Rounding, Family::Construction, Family::Loss, Family::Candidate]
    {
        assert!(Catalogue::built_in().iter().any(|effect| effect.card().family == family), "{family:?}");
    }
}

#[test]
fn parameters_are_complete_and_start_within_their_bounds() {
    for (model, index) in common::every_effect_everywhere() {
        let effect = &model.effects[index];
        let name = common::label(&model, index);
        for parameter in &effect.parameters {
            let card = &parameter.card;
            for text in [&card.name, &card.symbol, &card.unit, &card.meaning] {
                assert!(!text.trim().is_empty(), "{name} {}", card.name);
            }
            assert!(card.minimum < card.maximum, "{name} {}", card.name);
            let bounds = card.minimum..=card.maximum;
            assert!(bounds.contains(&card.typical), "{name} {}", card.name);
            assert!(bounds.contains(&parameter.value), "{name} {}", card.name);
            match &card.start {
                Start::Known(_) => {}
                Start::At(values) => {
                    assert!(!values.is_empty(), "{name} {}", card.name);
                    assert!(values.iter().all(|value| bounds.contains(value)), "{name} {}", card.name);
                }
                Start::PumpPressureQuantiles(quantiles) => {
                    assert!(!quantiles.is_empty(), "{name} {}", card.name);
                    assert!(quantiles.iter().all(|quantile| (0.0..=1.0).contains(quantile)), "{name} {}", card.name);
                }
                Start::WorstStretchBegin | Start::WorstStretchDuration => assert_eq!(card.unit, "s"),
            }
        }
    }
}

/// Names in the first column of the contract's table, several of them in a row where they belong together.
#[test]
fn the_catalogue_has_every_effect_of_the_contract() {
    let Some(text) = common::contract("effects.md") else { return };
    let rows = text.lines().filter(|line| line.starts_with("| ") && !line.contains("**"));
    let names: Vec<&str> = rows
        .filter_map(|line| line.split('|').nth(1))
        .flat_map(|cell| cell.split(','))
        .map(str::trim)
        .filter(|name| *name != "effect")
        .collect();
    assert!(names.len() >= 28, "the table is not where it was: {names:?}");
    for name in names {
        assert!(Catalogue::built_in().find(name).is_ok(), "{name} is in the contract but not in the catalogue");
    }
}

/// `arm.inertia`, `pump.bulk_modulus`: files and reports find parameters by these names.
#[test]
fn parameter_names_are_unique_with_every_effect_present() {
    for model in common::machines() {
        let mut all = model.clone();
        for physics in &Catalogue::built_in() {
            for site in model.free_sites(physics) {
                all = common::with_typical(&all, physics, site);
            }
        }
        let names = all.parameter_names();
        let unique: HashSet<&String> = names.iter().collect();
        assert_eq!(unique.len(), names.len(), "{names:?}");
        for (name, value) in names.iter().zip(all.parameter_values()) {
            assert_eq!(all.value_of(name), Some(value));
        }
    }
}

#[test]
fn effects_that_need_oil_do_not_go_where_there_is_none() {
    let emps = excavator_model::document::built_in("emps").unwrap();
    for name in ["orifice_flow", "internal_leakage", "entrained_air", "cavitation", "oil_compressibility"] {
        let error = emps.with_effect(&Catalogue::built_in().find(name).unwrap(), Site::Cylinder(0)).unwrap_err();
        assert!(error.to_string().contains("no chambers"), "{error}");
    }
}

/// What good sensors may be off by is no answer to what is missing; anything larger is, as is every effect that has no such limit.
#[test]
fn sizes_that_say_nothing_are_no_name() {
    let site = Site::Cylinder(0);
    let mut model =
        common::machines()[0].with_effect(&Catalogue::built_in().find("opening_scale").unwrap(), site).unwrap();
    for (scale, worth) in [(0.0067, false), (-0.0067, false), (0.02, true), (-0.02, true)] {
        model.effects.last_mut().unwrap().parameters[0].value = scale;
        assert_eq!(model.effects.last().unwrap().is_practically_significant(), worth, "{scale}");
    }
    let mut stribeck =
        common::machines()[0].with_effect(&Catalogue::built_in().find("stribeck_friction").unwrap(), site).unwrap();
    for (speed, worth) in [(0.001, false), (0.01, true)] {
        stribeck.effects.last_mut().unwrap().parameters[1].value = speed;
        assert_eq!(stribeck.effects.last().unwrap().is_practically_significant(), worth, "{speed} m/s");
    }
    let small =
        common::machines()[0].with_effect(&Catalogue::built_in().find("valve_dead_zone").unwrap(), site).unwrap();
    assert!(small.effects.last().unwrap().is_practically_significant());
}

/// What is estimated beside every model needs a prior; what a machine is has none, so that nothing is put in beforehand.
#[test]
fn nuisance_parameters_alone_have_priors() {
    let scales = RecordingScales { sample_interval_s: 2e-3, largest_opening_m2: 1e-4 };
    for (model, index) in common::every_effect_everywhere() {
        let (effect, name) = (&model.effects[index], common::label(&model, index));
        let is_nuisance = matches!(effect.physics.card().family, Family::Recording | Family::Rounding);
        for parameter in &effect.parameters {
            assert_eq!(parameter.card.prior.is_some(), is_nuisance, "{name} {}", parameter.card.name);
            let Some(prior) = parameter.card.prior else { continue };
            let Start::At(starts) = &parameter.card.start else { panic!("{name}: no centre") };
            let centre = &starts[0];
            assert_eq!(prior.standardised(*centre, *centre, &scales), 0.0, "{name}");
            let above = match prior.scale {
                PriorScale::Linear => centre + prior.standard_deviation(&scales),
                PriorScale::Logarithmic => centre * prior.standard_deviation(&scales),
            };
            assert!((prior.standardised(above, *centre, &scales) - 1.0).abs() < 1e-12, "{name}");
            assert!(above > *centre && above < parameter.card.maximum, "{name}: {above}");
        }
    }
}

#[test]
fn spreads_follow_the_recordings() {
    let lead = Catalogue::built_in().find("spool_sensor_lead").unwrap();
    let lead = &lead.parameters(&common::machines()[0].machine, Site::Cylinder(0))[0];
    let spread = |sample_interval_s: f64| {
        lead.prior.unwrap().standard_deviation(&RecordingScales { sample_interval_s, largest_opening_m2: 1e-4 })
    };
    assert_eq!(spread(2e-4), 6.5e-4);
    assert!((spread(6e-3) - 2e-3).abs() < 1e-15);
    let prior =
        Prior { spread: Spread::OfLargestOpening { part: 2.5e-3 }, scale: PriorScale::Linear, range: [-2.0, 2.0] };
    let scales = RecordingScales { sample_interval_s: 1.0, largest_opening_m2: 8e-5 };
    assert!((prior.standard_deviation(&scales) - 2e-7).abs() < 1e-20);
    let [lowest, highest] = prior.bounds(1e-7, &scales);
    assert!((lowest + 3e-7).abs() < 1e-20 && (highest - 5e-7).abs() < 1e-20, "{lowest} {highest}");
    let reversal = Catalogue::built_in().find("friction_reversal").unwrap();
    let reversal = &reversal.parameters(&common::machines()[0].machine, Site::Cylinder(0))[0];
    let [slowest, fastest] = reversal.prior.unwrap().bounds(1e-3, &scales);
    assert!((slowest / 2e-4 - 1.0).abs() < 0.01 && (fastest / 6e-3 - 1.0).abs() < 0.01, "{slowest} {fastest}");
}

/// Every corner that an effect rounds is the corner of some effect, and rounding has no corner of its own.
#[test]
fn what_is_rounded_is_there() {
    let mut rounded = HashSet::new();
    for effect in &Catalogue::built_in() {
        let card = effect.card();
        assert_eq!(effect.rounds().is_some(), card.family == Family::Rounding, "{}", card.name);
        rounded.extend(effect.rounds().map(|corner| format!("{corner:?}")));
    }
    assert_eq!(rounded.len(), 3);
    let arm = &common::machines()[0];
    let site = Site::Cylinder(0);
    assert!(arm.has_corner(Corner::OrificeFlow, site) && !arm.has_corner(Corner::OrificeFlow, Site::PumpLine));
    let mut smooth = arm.clone();
    smooth.effects.retain(|effect| effect.corner() != Some(Corner::Friction));
    assert!(!smooth.has_corner(Corner::Friction, site));
    let mut rough = smooth.with_effect(&Catalogue::built_in().find("stribeck_friction").unwrap(), site).unwrap();
    assert!(rough.has_corner(Corner::Friction, site));
    rough.effects.last_mut().unwrap().parameters[0].value = 0.0;
    assert!(!rough.has_corner(Corner::Friction, site), "a friction of zero has no corner");
}

/// Where the motion is imposed, pressures are measured and no oil flows.
#[test]
fn an_imposed_motion_can_have_what_needs_pressures() {
    let needs = |name: &str| Catalogue::built_in().find(name).unwrap().card().needs;
    assert_eq!(needs("pressure_dependent_friction"), Needs::Pressures);
    assert_eq!([needs("coulomb_friction"), needs("sensor_delay")], [Needs::Nothing; 2]);
    assert_eq!([needs("orifice_flow"), needs("pump_drive")], [Needs::Valve, Needs::Pump]);
    assert_eq!([needs("cavitation"), needs("pressure_sensor_offset")], [Needs::Oil; 2]);
}

#[test]
fn one_effect_can_act_on_the_whole_machine() {
    let delay = Catalogue::built_in().find("sensor_delay").unwrap();
    let arm = &common::machines()[0];
    assert_eq!(arm.free_sites(&delay), [Site::Cylinder(0), Site::PumpLine, Site::Machine]);
    // Each place by itself covers the machine already.
    assert_eq!(arm.parse_addition("sensor_delay").unwrap().len(), 2);
    let (physics, site) = arm.parse_addition("sensor_delay@machine").unwrap().remove(0);
    let late = arm.with_effect(&physics, site).unwrap();
    let names = late.parameter_names();
    assert_eq!(names[names.len() - 2..], ["machine.displacement_delay", "machine.pressure_delay"]);
    assert!(late.free_sites(&delay).is_empty(), "every place is late already");
    let one_place = arm.with_effect(&delay, Site::Cylinder(0)).unwrap();
    assert_eq!(one_place.free_sites(&delay), [Site::PumpLine]);

    // A load driven by a measured force is one place, and has no pressures.
    let load = excavator_model::document::built_in("emps").unwrap();
    assert_eq!(load.free_sites(&delay), [Site::Cylinder(0)]);
    assert_eq!(load.with_effect(&delay, Site::Machine).unwrap().effects.last().unwrap().parameters.len(), 1);

    for name in ["coulomb_friction", "valve_lag", "pump_leakage", "pressure_sensor_offset"] {
        let effect = Catalogue::built_in().find(name).unwrap();
        assert!(!arm.free_sites(&effect).contains(&Site::Machine), "{name}");
        let error = arm.with_effect(&effect, Site::Machine).unwrap_err().to_string();
        assert!(error.contains("\"machine\"") && error.contains("EFFECT@"), "{error}");
    }
    let error = arm.parse_addition("sensor_delay@tower").unwrap_err().to_string();
    assert!(error.contains("pump and machine"), "{error}");
}
