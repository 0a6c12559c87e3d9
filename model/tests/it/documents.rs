//! Model files: there and back, and what is said when one is wrong.

use crate::common;
use excavator_model::document::{BUILT_IN, DocumentError, built_in, parse, to_text};
use excavator_model::effects::Catalogue;
use excavator_model::{HistoryEntry, Model};

const ARM: &str = include_str!("../../../config/zx30u-arm.toml");

fn assert_same(a: &Model, b: &Model) {
    assert_eq!(a.machine, b.machine);
    assert_eq!(a.history, b.history);
    assert_eq!(a.effects.len(), b.effects.len());
    for (a, b) in a.effects.iter().zip(&b.effects) {
        assert_eq!((a.name(), a.site, &a.parameters), (b.name(), b.site, &b.parameters));
    }
}

#[test]
fn models_survive_writing_and_reading() {
    for (name, _) in BUILT_IN {
        let mut model = built_in(name).unwrap();
        for physics in &common::catalogue() {
            for site in model.free_sites(physics) {
                model = model.with_effect(physics, site).unwrap();
            }
        }
        let mut odd = 0.1;
        for parameter in model.parameters_mut() {
            odd *= 1.0 + f64::EPSILON * 7.0;
            parameter.value *= 1.0 + odd / 3.0;
            parameter.standard_error = Some(odd);
            parameter.source = "measured \"twice\"\nand noted".into();
        }
        model.history.push(HistoryEntry {
            when: "2026-11-21T02:31:27Z".into(),
            what: "added stribeck_friction@arm".into(),
            recordings: vec!["bag one".into()],
            validation_error_before: Some(0.25),
            validation_error_after: None,
        });
        let text = to_text(&model).unwrap();
        let read = parse("written", &text, &Catalogue::built_in()).unwrap();
        assert_same(&model, &read);
        assert_eq!(to_text(&read).unwrap(), text);
    }
}

/// The error of the arm's file with one piece of text replaced, checked to be one line.
fn error_with(from: &str, to: &str) -> DocumentError {
    assert!(ARM.contains(from), "the file no longer has {from}");
    let error = parse("arm.toml", &ARM.replacen(from, to, 1), &Catalogue::built_in()).unwrap_err();
    let text = error.to_string();
    assert!(!text.contains('\n') && text.contains("arm.toml"), "{text}");
    error
}

#[test]
fn a_wrong_unit_is_named() {
    let text = error_with("{ value = 0.6, unit = \"m\"", "{ value = 600.0, unit = \"mm\"").to_string();
    assert!(text.contains("arm.stroke") && text.contains("\"mm\"") && text.contains("\"m\""), "{text}");
    let error = error_with("{ value = 1.4e-11, unit = \"m3/(s Pa)\"", "{ value = 1.4e-11, unit = \"l/min\"");
    assert!(matches!(&error, DocumentError::WrongUnit { quantity, .. } if quantity == "arm.internal_leakage"));
}

#[test]
fn an_unknown_effect_gets_a_suggestion() {
    let text = error_with("effect = \"internal_leakage\"", "effect = \"internal_leakag\"").to_string();
    assert!(text.contains("unknown effect \"internal_leakag\""), "{text}");
    assert!(text.contains("did you mean \"internal_leakage\"?"), "{text}");
}

#[test]
fn a_missing_or_surplus_parameter_is_named() {
    let line = ARM.lines().find(|line| line.starts_with("external_leakage_rod")).unwrap();
    let text = error_with(line, "").to_string();
    assert!(text.contains("external_leakage@arm lacks external_leakage_rod"), "{text}");
    let surplus = format!("{line}\nfoo = {{ value = 1.0, unit = \"m\" }}");
    let text = error_with(line, &surplus).to_string();
    assert!(text.contains("foo") && text.contains("external_leakage_cap"), "{text}");
}

#[test]
fn a_cylinder_too_many_is_refused() {
    let start = ARM.find("[[machine.cylinders]]").unwrap();
    let end = ARM.find("[[effects]]").unwrap();
    let second = ARM[start..end].replace("name = \"arm\"", "name = \"bucket\"");
    let text = error_with("[[effects]]", &format!("{second}[[effects]]")).to_string();
    assert!(text.contains("1 joint(s)") && text.contains("2 cylinder(s)"), "{text}");
}

#[test]
fn impossible_numbers_are_refused() {
    for (from, to, what) in [
        ("{ value = 0.6, unit = \"m\"", "{ value = -0.6, unit = \"m\"", "arm.stroke"),
        ("{ value = 65000000.0", "{ value = 0.0", "pump.bulk_modulus"),
        ("{ value = 1.4e-11", "{ value = nan", "arm.internal_leakage"),
        ("gravity = { value = 9.8", "gravity = { value = -9.8", "gravity"),
        ("tank_pressure = { value = 0.0", "tank_pressure = { value = -2e5", "supply.tank_pressure"),
        (
            "viscous_damping = { value = 13000.0",
            "viscous_damping = { known = true, value = -1.0",
            "arm.viscous_damping",
        ),
    ] {
        let error = error_with(from, to);
        assert!(matches!(&error, DocumentError::Impossible { quantity, .. } if quantity == what), "{error}");
    }
    // What is to be identified is a start only, and may come out of a fit like that.
    let start = ARM.replacen("viscous_damping = { value = 13000.0", "viscous_damping = { value = -1.0", 1);
    assert_eq!(parse("arm.toml", &start, &Catalogue::built_in()).unwrap().value_of("arm.viscous_damping"), Some(-1.0));
    // Table 1 of [A] as printed.
    let text = error_with("mid_stroke_length = { value = 1.1", "mid_stroke_length = { value = 0.28").to_string();
    assert!(text.contains("linkage cannot reach"), "{text}");
}

#[test]
fn what_is_no_model_says_so_in_one_line() {
    for text in ["", "not toml at all [", "[machine]\nname = 3\n"] {
        let error = parse("arm.toml", text, &Catalogue::built_in()).unwrap_err();
        assert!(matches!(error, DocumentError::Syntax { .. }), "{error:?}");
        assert!(!error.to_string().contains('\n'), "{error}");
    }
    error_with("[machine]\n", "[machine]\ncolour = \"orange\"\n");
}

#[test]
fn an_unknown_built_in_gets_a_suggestion() {
    let text = built_in("zx30-arm").unwrap_err().to_string();
    assert!(text.contains("did you mean \"zx30u-arm\"?"), "{text}");
    for (name, _) in BUILT_IN {
        assert!(text.contains(name), "{text} does not list {name}");
    }
}

#[test]
fn effects_twice_or_in_the_wrong_place_are_refused() {
    let text = error_with("effect = \"viscous_damping\"\nat = \"arm\"", "effect = \"viscous_damping\"\nat = \"pump\"");
    assert!(text.to_string().contains("it acts on a cylinder"), "{text}");
    let text = error_with("effect = \"viscous_damping\"\nat = \"arm\"", "effect = \"viscous_damping\"\nat = \"boom\"");
    assert!(text.to_string().contains("\"boom\", which is no cylinder"), "{text}");
    let start = ARM.find("[[effects]]").unwrap();
    let end = start + 1 + ARM[start + 1..].find("[[effects]]").unwrap();
    let text = error_with(&ARM[start..end], &format!("{0}{0}", &ARM[start..end])).to_string();
    assert!(text.contains("already has"), "{text}");
}

#[test]
fn places_beside_cylinders_are_no_names_of_cylinders() {
    for taken in ["pump", "machine"] {
        let text = ARM.replace("name = \"arm\"", &format!("name = \"{taken}\""));
        let error = parse("arm.toml", &text, &Catalogue::built_in()).unwrap_err().to_string();
        assert!(error.contains("is taken"), "{error}");
    }
}
