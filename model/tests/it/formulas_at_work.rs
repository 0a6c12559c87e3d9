//! Formulas in a simulation.

use crate::common;
use excavator_model::Model;
use excavator_model::document::{built_in, parse_catalogue};
use excavator_model::effects::Catalogue;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};

/// The arm with a law in each of these rows, its coefficient `k` of this unit and value.
fn with(base: &Model, rows: &[&str], formula: &str, k: (&str, f64)) -> Model {
    let (unit, value) = k;
    let one = |row: &&str| {
        format!(
            "[[formula]]\nname = \"own_{row}\"\nacts_on = \"{row}\"\nformula = \"{formula}\"\n\
             [formula.parameters]\nk = {{ unit = \"{unit}\", minimum = 0.0, start = [{value:e}] }}\n"
        )
    };
    let text: String = rows.iter().map(one).collect();
    let catalogue = parse_catalogue("own.toml", &text, &Catalogue::built_in()).unwrap();
    rows.iter().fold(base.clone(), |model, row| {
        let law = catalogue.find(&format!("own_{row}")).unwrap();
        let mut model = model.with_effect(&law, model.free_sites(&law)[0]).unwrap();
        model.effects.last_mut().unwrap().parameters[0].value = value;
        model
    })
}

fn run(model: &Model) -> Recording {
    simulate_from_rest(model, &common::tour(model), &[0.0], Tolerances::default()).unwrap()
}

/// Largest difference of two courses of the cap pressure, over its largest value.
fn difference(one: &Recording, other: &Recording) -> f64 {
    let (one, other) = (one.signal("arm.cap_pressure").unwrap(), other.signal("arm.cap_pressure").unwrap());
    let size = one.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
    one.iter().zip(other).fold(0.0_f64, |off, (a, b)| off.max((a - b).abs())) / size
}

#[test]
fn both_edges_together_are_the_opening() {
    let base = built_in("zx30u-arm").unwrap();
    let law = |rows: &[&str]| run(&with(&base, rows, "u*(1 - k)", ("-", 0.2)));
    let both = law(&["supply_opening", "return_opening"]);
    assert!(difference(&both, &law(&["opening"])) < 1e-9);
    for one in ["supply_opening", "return_opening"] {
        assert!(difference(&both, &law(&[one])) > 1e-3, "{one}");
    }
}

#[test]
fn a_change_of_the_opening_reaches_the_edges_wherever_it_stands() {
    let base = built_in("zx30u-arm").unwrap();
    let opening = |model: &Model| with(model, &["opening"], "u*(1 - k)", ("-", 0.2));
    let back = |model: &Model| with(model, &["return_opening"], "u/sqrt(1 + k*u^2)", ("1/m4", 6e7));
    assert!(difference(&run(&back(&opening(&base))), &run(&opening(&back(&base)))) < 1e-9);
}

#[test]
fn a_power_of_what_is_zero_at_the_start_does_not_stop_a_simulation() {
    let base = built_in("zx30u-arm").unwrap();
    for (row, formula, k) in [
        ("pump_leak", "k*max(p_pump - p_pump, 0)^1.5 + k*max(p_pump, 0)^1.5", ("m3/(s Pa^1.5)", 1e-14)),
        ("piston_force", "-k*sign(v)*abs(v)^0.5", ("N s^0.5/m^0.5", 500.0)),
        ("piston_force", "-k*sign(v)*sqrt(abs(v))", ("N s^0.5/m^0.5", 500.0)),
    ] {
        let model = with(&base, &[row], formula, k);
        assert!(difference(&run(&model), &run(&base)) > 1e-4, "{formula}");
    }
}
