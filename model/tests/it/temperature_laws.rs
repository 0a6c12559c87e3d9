//! What the oil temperature does to damping, leakage, friction of seals and bulk modulus.

use crate::common;
use crate::common::Random;
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Site};
use excavator_model::energy::ledger;
use excavator_model::equations::{Inputs, Rows, System};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};

/// The arm with an effect of the temperature at a place, and what it falls by per kelvin.
fn with(model: &Model, effect: &str, site: Site, fall: f64) -> Model {
    let mut model = model.with_effect(&Catalogue::built_in().find(effect).unwrap(), site).unwrap();
    model.effects.last_mut().unwrap().parameters[0].value = fall;
    model
}

fn rows(model: &Model, state: &[f64], inputs: &Inputs<f64>) -> Rows<f64> {
    let system = System::new(model);
    let mut workspace = system.workspace();
    system.rates(&mut workspace, &model.parameter_values(), state, inputs, &mut vec![0.0; state.len()]);
    workspace.rows
}

fn leaky_arm() -> Model {
    let arm = built_in("zx30u-arm").unwrap();
    let arm = arm.with_effect(&Catalogue::built_in().find("valve_leakage").unwrap(), Site::Cylinder(0)).unwrap();
    ["stribeck_friction", "pressure_dependent_friction", "asymmetric_friction"].iter().fold(arm, |arm, name| {
        let mut arm = arm.with_effect(&Catalogue::built_in().find(name).unwrap(), Site::Cylinder(0)).unwrap();
        arm.effects.last_mut().unwrap().parameters[0].value =
            if *name == "pressure_dependent_friction" { 4e-5 } else { 90.0 };
        arm
    })
}

/// Effects whose coefficients grow and fall with the temperature, and how one of `fall` per kelvin changes them at `temperature`.
struct Changed {
    effect: &'static str,
    site: Site,
    fall: f64,
    names: &'static [&'static str],
    factor: fn(fall: f64, temperature: f64) -> f64,
}

fn viscosity(fall: f64, temperature: f64) -> f64 {
    (-fall * (temperature - 40.0) * 135.0 / (temperature + 95.0)).exp()
}

const ARM: Site = Site::Cylinder(0);

const DAMPING: &[&str] = &["arm.viscous_damping"];
const LEAKAGES: &[&str] = &[
    "arm.internal_leakage",
    "arm.external_leakage_cap",
    "arm.external_leakage_rod",
    "arm.valve_leakage_pump_cap",
    "arm.valve_leakage_cap_tank",
    "arm.valve_leakage_pump_rod",
    "arm.valve_leakage_rod_tank",
];
const FRICTION: &[&str] =
    &["arm.coulomb_friction", "arm.stribeck_force", "arm.pressure_friction", "arm.extension_friction_change"];

fn changed() -> [Changed; 4] {
    let seals = |fall: f64, temperature: f64| (-fall * (temperature - 40.0)).exp();
    [
        Changed { effect: "viscosity_temperature", site: ARM, fall: 0.046, names: DAMPING, factor: viscosity },
        Changed { effect: "seal_friction_temperature", site: ARM, fall: 0.03, names: FRICTION, factor: seals },
        Changed {
            effect: "bulk_modulus_temperature",
            site: ARM,
            fall: 0.005,
            names: &["arm.bulk_modulus"],
            factor: seals,
        },
        Changed {
            effect: "bulk_modulus_temperature",
            site: Site::PumpLine,
            fall: 0.005,
            names: &["pump.bulk_modulus"],
            factor: seals,
        },
    ]
}

/// At any temperature, a law of the temperature is the machine with the coefficients that belong to this temperature.
#[test]
fn each_law_scales_the_coefficients_of_others() {
    let arm = leaky_arm();
    let mut random = Random(61);
    for case in changed() {
        let lawful = with(&arm, case.effect, case.site, case.fall);
        for _ in 0..20 {
            let state = common::random_state(&System::new(&arm), &mut random);
            let inputs = common::random_inputs(&arm.machine, &mut random);
            let mut by_hand = arm.clone();
            let names = by_hand.parameter_names();
            let mut scale = |name: &str, factor: f64| {
                let index = names.iter().position(|one| one == name).unwrap();
                by_hand.parameters_mut().nth(index).unwrap().value *= factor;
            };
            let factor = (case.factor)(case.fall, inputs.oil_temperature);
            case.names.iter().for_each(|name| scale(name, factor));
            if case.names == DAMPING {
                LEAKAGES.iter().for_each(|name| scale(name, 1.0 / factor));
            }
            let (found, wanted) = (rows(&lawful, &state, &inputs), rows(&by_hand, &state, &inputs));
            let pairs = [
                (found.piston_force[0], wanted.piston_force[0]),
                (found.cap_flow[0], wanted.cap_flow[0]),
                (found.rod_flow[0], wanted.rod_flow[0]),
                (found.cap_compliance[0], wanted.cap_compliance[0]),
                (found.rod_compliance[0], wanted.rod_compliance[0]),
                (found.pump_compliance, wanted.pump_compliance),
                (found.pump_flow, wanted.pump_flow),
            ];
            for (found, wanted) in pairs {
                assert!((found - wanted).abs() <= 1e-12 * wanted.abs(), "{}: {found} {wanted}", case.effect);
            }
            let powers = [&lawful, &by_hand].map(|model| {
                let book = ledger(&System::new(model), &model.parameter_values(), &state, &inputs);
                let stored = book.cylinders[0].cap_internal + book.cylinders[0].rod_internal + book.pump_line;
                [book.effects.iter().map(|one| one.total()).sum::<f64>(), stored]
            });
            for (found, wanted) in powers[0].iter().zip(powers[1]) {
                assert!((found - wanted).abs() <= 1e-9 * wanted.abs(), "{}: {found} J, {wanted} J", case.effect);
            }
        }
    }
}

/// One parameter describes an ISO VG 46 oil with a viscosity index of 100 from 0 °C to 100 °C.
#[test]
fn the_viscosity_is_that_of_data_sheets() {
    for (temperature, viscosity_of_oil, accuracy) in [(0.0, 600.0, 0.1), (40.0, 46.0, 1e-9), (100.0, 6.8, 0.03)] {
        let found = 46.0 * viscosity(0.046, temperature);
        assert!((found / viscosity_of_oil - 1.0_f64).abs() < accuracy, "{temperature} °C: {found} mm²/s");
    }
    // Oil below its pour point stays as it is there.
    let arm = with(&built_in("zx30u-arm").unwrap(), "viscosity_temperature", ARM, 0.046);
    let state = common::at_rest(&System::new(&arm));
    let at = |temperature: f64| {
        let inputs = Inputs { oil_temperature: temperature, ..Inputs::zero(1) };
        rows(&arm, &state, &inputs).piston_force[0]
    };
    assert!(at(-200.0).is_finite() && at(-200.0) == at(-60.0));
}

/// The same strokes with cold and with warm oil: a simulation reads the temperature of the recording.
#[test]
fn a_simulation_is_slower_with_cold_oil() {
    let arm = with(&built_in("zx30u-arm").unwrap(), "viscosity_temperature", ARM, 0.046);
    let travel = |temperature: f64| {
        let time: Vec<f64> = (0..400).map(|sample| f64::from(sample) * 5e-3).collect();
        let mut recording = Recording::unmeasured("stroke", time, &["arm"]);
        recording.cylinders[0].orifice_area.fill(4e-5);
        recording.pump_flow.fill(3.8e-4);
        recording.tank_pressure.fill(1e5);
        recording.oil_temperature.fill(temperature);
        let seen = simulate_from_rest(&arm, &recording, &[-0.1], Tolerances::default()).unwrap();
        let position = &seen.cylinders[0].displacement;
        position[399] - position[0]
    };
    let [cold, warm] = [0.0, 60.0].map(travel);
    assert!(cold < 0.97 * warm && cold > 0.0, "{cold} m, {warm} m");
    let unmeasured = Recording::unmeasured("stroke", vec![0.0, 0.1], &["arm"]);
    let mut commanded = unmeasured.clone();
    commanded.cylinders[0].orifice_area.fill(0.0);
    let error = simulate_from_rest(&arm, &commanded, &[0.0], Tolerances::default()).unwrap_err();
    assert!(error.to_string().contains("oil_temperature"), "{error}");
}
