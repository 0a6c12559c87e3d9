//! What formulas mean, and what is refused.

use crate::common;
use std::collections::BTreeMap;

use excavator_model::Model;
use excavator_model::document::{built_in, parse_catalogue};
use excavator_model::effects::{Catalogue, Effect, Kind, Number, Site};
use excavator_model::equations::{Inputs, KnownCylinder, LawStates, Situation, System};
use excavator_model::formula::{FormulaText, Law, ParameterText};
use excavator_model::scalar::{Dual, constant, derivative, variable};
use excavator_model::simulation::{Tolerances, simulate_from_rest};

fn text(acts_on: &str, formula: &str, parameters: &[(&str, &str)]) -> FormulaText {
    let parameter = |unit: &str| ParameterText {
        unit: unit.to_string(),
        minimum: Some(-1e30),
        maximum: Some(1e30),
        start: vec![1.0],
        value: None,
        known: false,
        meaning: String::new(),
    };
    FormulaText {
        name: "law".into(),
        acts_on: acts_on.into(),
        formula: formula.into(),
        summary: String::new(),
        source: String::new(),
        shows: String::new(),
        experiment: String::new(),
        parameters: parameters.iter().map(|(name, unit)| ((*name).to_string(), parameter(unit))).collect(),
        states: BTreeMap::new(),
    }
}

/// Value of a pure number with x = `x`, by a force `x * N` in which N is one newton.
fn value_of(formula: &str, x: f64) -> f64 {
    let law = Law::read(&text("piston_force", &format!("N*({formula})"), &[("N", "N"), ("x", "-")]));
    let law = law.unwrap_or_else(|_| {
        Law::read(&text("piston_force", &format!("N*({formula}) + 0*N*x"), &[("N", "N"), ("x", "-")])).unwrap()
    });
    force(&law, &[1.0, x])
}

fn force<T: Number>(law: &Law, parameters: &[T]) -> T {
    let machine = built_in("zx30u-arm").unwrap().machine;
    let mut now = Situation::<T>::empty(&machine);
    now.pistons[0].velocity = T::from(0.1);
    now.pistons[0].cap_pressure = T::from(5e6);
    now.pistons[0].rod_pressure = T::from(2e6);
    let mut rows = excavator_model::equations::Rows::zero(1);
    T::hooks(law).contribute(Site::Cylinder(0), parameters, &now, &mut rows);
    rows.piston_force[0]
}

#[test]
fn precedence_is_the_usual_one() {
    for (formula, wanted) in [
        ("-2^2", -4.0),
        ("2^3^2", 512.0),
        ("-x^2", -9.0),
        ("(-x)^2", 9.0),
        ("2^-1", 0.5),
        ("-2^-2", -0.25),
        ("2*3+4*5", 26.0),
        ("10-4-3", 3.0),
        ("24/4/3", 2.0),
        ("2*-x", -6.0),
        ("--x", 3.0),
        ("1e-3*1E3", 1.0),
        (".5+1.", 1.5),
        ("2+3*x^2/9", 5.0),
        ("abs(-x)", 3.0),
        ("sqrt(x+1)", 2.0),
        ("root(-x^2-7)", -4.0),
        ("exp(ln(x))", 3.0),
        ("log10(1000)", 3.0),
        ("atan(1)*4", std::f64::consts::PI),
        ("min(x, 2, 7)", 2.0),
        ("max(x, 2, 7)", 7.0),
        ("clamp(x, 0, 1)", 1.0),
        ("step(x)", 1.0),
        ("sign(-x)", -1.0),
        ("smoothstep(x, 2, 4)", 0.5),
        ("table(x, [0, 2, 4], [0, 20, 40])", 30.0),
        ("if(x > 2, 5, 6)", 5.0),
        ("if(x <= 2, 5, 6)", 6.0),
        ("if(x < 0, sqrt(-x), 1)", 1.0),
        ("tanh(x/3)", 1.0_f64.tanh()),
    ] {
        let found = value_of(formula, 3.0);
        assert!((found - wanted).abs() <= 1e-6 * wanted.abs().max(1.0), "{formula} = {found}, not {wanted}");
    }
}

/// Every function against central differences, by its argument.
#[test]
fn derivatives_are_those_of_differences() {
    for formula in [
        "x^2",
        "x^-3",
        "x^0.5",
        "x^2.3",
        "2^x",
        "x^x",
        "abs(x)",
        "sqrt(x)",
        "root(x)",
        "exp(x)",
        "ln(x)",
        "log10(x)",
        "sin(x)",
        "cos(x)",
        "tan(x)",
        "tanh(x)",
        "atan(x)",
        "min(x, 9)",
        "max(x, 9)",
        "clamp(x, 0, 9)",
        "smoothstep(x, 0, 3)",
        "table(x, [0, 1, 5], [1, 4, 2])",
        "if(x > 0.5, x^3, 2)",
        "1/(1 + x)",
        "step((x - 0.7)/50)",
        "sign((x - 0.7)/50)",
    ] {
        for x in [0.7, 1.3, 2.1] {
            let law = Law::read(&text("piston_force", &format!("N*({formula})"), &[("N", "N"), ("x", "-")])).unwrap();
            let dual: Dual = force(&law, &[constant(1.0), variable(x, 0)]);
            let step = 1e-6 * x;
            let difference = (force(&law, &[1.0, x + step]) - force(&law, &[1.0, x - step])) / (2.0 * step);
            let slope = derivative(&dual, 0);
            assert!(
                (slope - difference).abs() < 1e-6 * difference.abs().max(1.0),
                "{formula} at {x}: {slope}, differences {difference}"
            );
        }
    }
}

#[test]
fn variables_are_those_of_the_machine() {
    let law = Law::read(&text("piston_force", "-k*v*abs(p_cap - p_rod)", &[("k", "N s/(m Pa)")])).unwrap();
    assert!((force(&law, &[2.0]) + 2.0 * 0.1 * 3e6).abs() < 1e-6);
    assert_eq!(law.parameters(&built_in("zx30u-arm").unwrap().machine, Site::Cylinder(0))[0].kind, Kind::Linear);
}

/// Linear only where all of them are linear at once.
#[test]
fn what_is_linear_is_seen() {
    for (formula, parameters, wanted) in [
        ("a1*v + b1*v*abs(v)", [("a1", "N s/m"), ("b1", "N s2/m2")], [true, true]),
        ("-a1*tanh(v/b1)", [("a1", "N"), ("b1", "m/s")], [true, false]),
        ("a1*b1*v", [("a1", "N s/m"), ("b1", "-")], [true, false]),
        ("a1/b1", [("a1", "N"), ("b1", "-")], [true, false]),
        ("if(v > 0, a1, -b1)", [("a1", "N"), ("b1", "N")], [true, true]),
    ] {
        let law = Law::read(&text("piston_force", formula, &parameters)).unwrap();
        let cards = law.parameters(&built_in("zx30u-arm").unwrap().machine, Site::Cylinder(0));
        assert_eq!([cards[0].kind == Kind::Linear, cards[1].kind == Kind::Linear], wanted, "{formula}");
    }
}

#[test]
fn what_is_wrong_is_one_line_with_its_place() {
    let newton = [("k", "N")];
    for (acts_on, formula, parameters, says) in [
        ("piston_force", "k*v", &newton[..], "the formula is in W, but piston_force is in N"),
        ("piston_force", "k + v", &newton, "cannot add N and m/s, at column 1"),
        ("piston_force", "k*exp(v)", &newton, "the argument of exp must be a pure number, but is in m/s"),
        ("piston_force", "k*vv", &newton, "unknown name \"vv\""),
        ("piston_force", "k*p_capp", &newton, "did you mean \"p_cap\"?"),
        ("piston_force", "k*sqr(v)", &newton, "did you mean \"sqrt\"?"),
        ("piston_force", "k*(v", &newton, "expected \")\", at column 5"),
        ("piston_force", "k k", &newton, "expected an operator or the end, at column 3"),
        ("piston_force", "k*", &newton, "expected a number, a name"),
        ("piston_force", "k*$", &newton, "'$' is no part of a formula"),
        ("piston_force", "k*1e999", &newton, "not a finite number"),
        ("piston_force", "k*min(v)", &newton, "min takes two arguments or more, not 1"),
        ("piston_force", "k > 0", &newton, "a comparison stands only in if"),
        ("piston_force", "if(k, k, k)", &newton, "expected a comparison"),
        ("piston_force", "if(0 < v < 1, k, k)", &newton, "cannot be chained"),
        ("piston_force", "if(v > k, k, k)", &newton, "cannot compare"),
        ("piston_force", "k*v^s", &newton, "the exponent must be a pure number"),
        ("piston_force", "k*table(v, [1], [1])", &newton, "a table needs at least two knots"),
        ("piston_force", "k*table(v, [1, 1], [1, 2])", &newton, "knots that rise"),
        ("piston_force", "k*a", &newton, "unknown name"),
        ("piston_force", "2", &[], "the formula is in a pure number"),
        ("piston_force", "v*0", &newton, "no formula uses k"),
        ("pump_leak", "k*p_cap", &[("k", "m3/(s Pa)")], "the pump line has no cylinder of its own"),
        ("pump_to_cap", "k*flow_cap", &[("k", "-")], "flow_cap is not known here"),
        ("pistonforce", "k", &newton, "did you mean \"piston_force\"?"),
        ("piston_force", "v1", &[("v1", "bar")], "\"bar\" is unknown"),
        ("piston_force", "sign", &[("sign", "N")], "is a variable or function"),
    ] {
        let error = Law::read(&text(acts_on, formula, parameters)).unwrap_err().to_string();
        assert!(error.contains(says) && !error.contains('\n'), "{formula}: {error}");
        assert!(error.starts_with("formula effect \"law\": "), "{error}");
    }
}

/// Nothing that somebody writes takes long, or brings the program down.
#[test]
fn hostile_formulas_are_refused_at_once() {
    let deep = format!("{}1{}", "(".repeat(2000), ")".repeat(2000));
    let powers = "2^".repeat(1500) + "2";
    let signs = "-".repeat(4000) + "1";
    let sums = "1+".repeat(2000) + "1";
    let long = "1+".repeat(500_000) + "1";
    for formula in [&deep, &powers, &signs, &sums, &long, &"é".to_string(), &"\u{0}".to_string(), &String::new()] {
        let error = Law::read(&text("piston_force", formula, &[])).unwrap_err().to_string();
        assert!(error.len() < 400 && !error.contains('\n'), "{error}");
    }
}

/// Built-in effects and the same as formulas.
const TWINS: [(&str, &str); 7] = [
    ("viscous_damping", "own_viscous_damping"),
    ("coulomb_friction", "own_coulomb_friction"),
    ("stribeck_friction", "own_stribeck_friction"),
    ("internal_leakage", "own_internal_leakage"),
    ("valve_dead_zone", "own_valve_dead_zone"),
    ("valve_gain_curve", "own_valve_gain_curve"),
    ("pump_leakage", "own_pump_leakage"),
];

/// The model with one effect of its typical size in the place of `without`, if that is there.
fn with(base: &Model, without: &str, effect: &str, values: &[f64]) -> Model {
    let mut model = base.clone();
    model.effects.retain(|present| present.name() != without);
    let physics = common::catalogue().find(effect).unwrap();
    let mut model = model.with_effect(&physics, model.free_sites(&physics)[0]).unwrap();
    for (parameter, value) in model.effects.last_mut().unwrap().parameters.iter_mut().zip(values) {
        parameter.value = *value;
    }
    model
}

#[test]
fn a_built_in_effect_written_as_a_formula_moves_the_machine_alike() {
    let base = built_in("zx30u-arm").unwrap();
    let recording = common::tour(&base);
    let run = |model: &Model| simulate_from_rest(model, &recording, &[0.0], Tolerances::default()).unwrap();
    for (known, own) in TWINS {
        let physics = Catalogue::built_in().find(known).unwrap();
        let site = if known == "pump_leakage" { Site::PumpLine } else { Site::Cylinder(0) };
        let cards = physics.parameters(&base.machine, site);
        let values: Vec<f64> = cards.iter().map(|card| card.typical).collect();
        // A map sorts parameters by name; c1 and c2, cap and rod, F and vs come in the same order.
        let first = run(&with(&base, known, known, &values));
        let second = run(&with(&base, known, own, &values));
        for signal in ["arm.displacement", "arm.velocity", "arm.cap_pressure", "arm.rod_pressure", "pump_pressure"] {
            let (one, other) = (first.signal(signal).unwrap(), second.signal(signal).unwrap());
            let size = one.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
            let off = one.iter().zip(other).fold(0.0_f64, |off, (a, b)| off.max((a - b).abs()));
            assert!(off <= 1e-9 * size, "{own}, {signal}: {off:e} of {size:e}");
        }
    }
}

#[test]
fn a_catalogue_file_is_read_and_merged() {
    let file = r#"
        [[formula]]
        name = "load_damping"
        acts_on = "piston_force"
        formula = "-k * v * abs(p_cap - p_rod)"
        [formula.parameters]
        k = { unit = "N s/(m Pa)", minimum = 0.0, maximum = 1.0, start = [1e-3], meaning = "damping per pressure difference" }
    "#;
    let catalogue = parse_catalogue("mine.toml", file, &Catalogue::built_in()).unwrap();
    assert_eq!(catalogue.iter().count(), Catalogue::built_in().iter().count() + 1);
    let law = catalogue.find("load_damping").unwrap();
    assert!(law.card().family.is_candidate());
    // The same once more is the same; another one of its name is not.
    let twice = parse_catalogue("mine.toml", file, &catalogue).unwrap();
    assert_eq!(twice.iter().count(), catalogue.iter().count());
    let other = file.replace("abs(p_cap - p_rod)", "p_cap");
    for (text, says) in [
        (other.as_str(), "there are two effects named \"load_damping\""),
        (&file.replace("load_damping", "hose_loss"), "there are two effects named \"hose_loss\""),
        ("", "it has no [[formula]]"),
        (&file.replace("start = [1e-3]", "start = [2.0]"), "2 is not between minimum 0 and maximum 1"),
        (&file.replace("start = [1e-3], ", ""), "give a start"),
        (&file.replace("summry", ""), ""),
        (&file.replace("acts_on", "acts_at"), "unknown field `acts_at`"),
    ] {
        if says.is_empty() {
            continue;
        }
        let error = parse_catalogue("mine.toml", text, &catalogue).unwrap_err().to_string();
        assert!(error.contains(says) && error.starts_with("mine.toml") && !error.contains('\n'), "{error}");
    }
}

/// A seal that bends at constant speed: its bend nears the reach exponentially.
#[test]
fn memory_follows_measured_signals() {
    let base = built_in("zx30u-arm").unwrap();
    let model = base.with_effect(&common::catalogue().find("bristle_friction").unwrap(), Site::Cylinder(0)).unwrap();
    let system = System::new(&model);
    let parameters = model.parameter_values();
    let (velocity, reach) = (0.02, 4e-4);
    let mut laws = LawStates::new(&system);
    let mut state = vec![0.0; system.layout().len];
    let (bend, _) = system.law_states().next().unwrap();
    let mut bend_at = |time: f64| {
        let joint = model.machine.cylinders[0].linkage.joint(0.0);
        system.set_measured(|_| KnownCylinder { joint, velocity, pressures: [2e6, 2e6] }, 0.0, &mut state);
        laws.follow(&system, &parameters, time, &Inputs::zero(1), &mut state);
        state[bend]
    };
    for sample in 0..200 {
        let time = 2e-3 * f64::from(sample);
        let wanted = reach * (1.0 - (-velocity * time / reach).exp());
        assert!((bend_at(time) - wanted).abs() < 0.03 * reach, "at {time} s");
    }
    // A clock that is set back, and a long gap, begin anew.
    assert_eq!(bend_at(0.1), 0.0);
    assert!(bend_at(0.102) > 0.0);
    assert_eq!(bend_at(9.0), 0.0);
}
