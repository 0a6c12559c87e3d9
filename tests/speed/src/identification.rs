//! The identification of a model's parameters, beside sparse regression on differences.

use excavator_blind::cases::{Case, Sort, Wish};
use excavator_blind::instruments::Instruments;
use excavator_blind::scoring::make;
use excavator_identification::regression::{WeakFormSettings, weak_form};
use excavator_model::document::built_in;
use serde_json::json;

use crate::clock::best_of;
use crate::figures::{Group, Run};
use crate::peers::Peers;

/// Seed of the machine, the first of its sort.
const SEED: u64 = 91;
const REPETITIONS: usize = 5;

/// Parameters of the cap side that both sides determine, by the names on the page and in the model.
const COMPARED: [(&str, &str); 2] = [("bulk modulus", "arm.bulk_modulus"), ("flow gain", "arm.flow_gain_cap")];

/// 38 s of one machine from which nothing is hidden.
///
/// # Errors
/// In words, where the recording cannot be made or identified.
pub fn identification(peers: &Peers) -> Result<Group, String> {
    let model = built_in("zx30u-arm").map_err(|error| error.to_string())?;
    let mut case = Case::draw(SEED, 0, &Wish { sort: Some(Sort::Nothing), ..Wish::default() });
    let recording = make(&mut case, &Instruments::default()).map_err(|error| error.to_string())?.identification;
    let (seconds, regression) = best_of(REPETITIONS, || weak_form(&model, &[&recording], &WeakFormSettings::default()));
    let regression = regression.map_err(|error| error.to_string())?;
    let named = case.plant.base.named();
    let truth = |name: &str| named.iter().find(|(other, _)| *other == name).map_or(f64::NAN, |(_, value)| *value);
    let errors = COMPARED.map(|(words, name)| {
        let found = regression.model.value_of(name).unwrap_or(f64::NAN);
        format!("{words} {:+.1} %", 100.0 * (found / truth(name) - 1.0))
    });
    let chambers = model.machine.cylinders[0].chambers.ok_or("the arm has no chambers")?;
    let cylinder = &recording.cylinders[0];
    let order = json!({
        "columns": {
            "time": recording.time,
            "displacement": cylinder.displacement,
            "cap": cylinder.cap_pressure,
            "pump": recording.pump_pressure,
            "tank": recording.tank_pressure,
            "area": cylinder.orifice_area,
        },
        "piston_area": chambers.cap_area,
        "volume_at_middle": chambers.cap_dead_volume + chambers.cap_area * model.machine.cylinders[0].stroke / 2.0,
        "truth": COMPARED.map(|(words, name)| (words, truth(name))).into_iter().collect::<std::collections::BTreeMap<_, _>>(),
    });
    let parameters = regression.fitted.len();
    Ok(Group {
        name: "Identifying parameters from 38 s at 500 Hz".into(),
        what: format!(
            "A machine of the blind benchmark with nothing hidden. Our weak form determines {parameters} parameters of three \
             equations with their covariance; PySINDy gets the cap side's equation and determines three, with the best of four smoothing windows."
        ),
        result: "error against the truth".into(),
        runs: vec![
            Run::timed("excavator-identification, weak form", seconds, errors.join(", ")),
            peers.run("PySINDy, smoothed differences", "pysindy", &order),
        ],
    })
}
