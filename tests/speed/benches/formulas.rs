//! What a formula costs beside the same effect in Rust, and how long a large catalogue takes to read.
//!
//! Targets: the right-hand side with a formula at most 2.5 times as long as with the built-in effect, a thousand formulas within 100 ms.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

#[path = "../../../model/tests/it/common/mod.rs"]
mod common;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use excavator_model::Model;
use excavator_model::document::{built_in, parse_catalogue};
use excavator_model::effects::Catalogue;
use excavator_model::equations::{Inputs, System};
use excavator_model::simulation::Linearisation;

/// Built-in effects and the same as formulas.
const TWINS: [(&str, &str); 4] = [
    ("hose_loss", "load_damping"),
    ("stribeck_friction", "own_stribeck_friction"),
    ("valve_dead_zone", "own_valve_dead_zone"),
    ("valve_gain_curve", "own_valve_gain_curve"),
];

fn with(effect: &str) -> Model {
    let base = built_in("zx30u-arm").unwrap();
    let physics = common::catalogue().find(effect).unwrap();
    common::with_typical(&base, &physics, base.free_sites(&physics)[0])
}

fn formulas(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("formulas");
    for (known, own) in TWINS {
        for name in [known, own] {
            let model = with(name);
            let system = System::new(&model);
            let (mut state, parameters) = (common::at_rest(&system), model.parameter_values());
            state[system.layout().rate(0)] = 0.1;
            let mut inputs = Inputs::zero(1);
            inputs.orifice_area[0] = 4e-5;
            let (mut workspace, mut rates) = (system.workspace(), vec![0.0; state.len()]);
            group.bench_function(format!("rates, {known} as {name}"), |b| {
                b.iter(|| system.rates(&mut workspace, &parameters, black_box(&state), &inputs, &mut rates));
            });
            let mut linearisation = Linearisation::new(&system, &model.unknown_parameters());
            group.bench_function(format!("linearisation, {known} as {name}"), |b| {
                b.iter(|| linearisation.evaluate(&system, &parameters, black_box(&state), &inputs));
            });
        }
    }
    let thousand: String = (0..1000)
        .map(|number| {
            format!(
                "[[formula]]\nname = \"law_{number}\"\nacts_on = \"piston_force\"\n\
                 formula = \"-k*abs(s)^1.5/reach^1.5*tanh(v/slip)*(1 + {number}*exp(-abs(p_cap - p_rod)/press))\"\n\
                 parameters.k = {{ unit = \"N\", start = [100.0] }}\nparameters.reach = {{ unit = \"m\", start = [0.1] }}\n\
                 parameters.slip = {{ unit = \"m/s\", start = [0.01] }}\nparameters.press = {{ unit = \"Pa\", start = [1e6] }}\n"
            )
        })
        .collect();
    group.bench_function("reading a thousand formulas", |b| {
        b.iter(|| parse_catalogue("thousand.toml", &thousand, &Catalogue::built_in()).unwrap());
    });
    group.finish();
}

criterion_group!(benches, formulas);
criterion_main!(benches);
