//! Readings that no machine can have: they are not measured.

use excavator_model::Model;
use excavator_model::machine::Cylinder;
use excavator_model::recording::Recording;

use super::check::{FULL_COMMANDS, HIGHEST_PRESSURE, LARGEST_FLOW, LARGEST_FORCE, STROKES};
use super::remarks::Remark;

/// Lowest reading of a pressure, Pa (gauge): vacuum is -0.1 MPa, the rest is for the error of a sensor.
const LOWEST_PRESSURE: f64 = -1e6;

/// Temperatures of oil that flows, °C, with some room for the error of a sensor.
const TEMPERATURES: [f64; 2] = [-80.0, 300.0];

/// Largest share of the readings that single faults explain. More are a wrong unit, which a check refuses.
const LARGEST_SHARE: f64 = 0.3;

/// Makes readings that are impossible for the machine not measured (`NaN`), and returns a remark for each such signal. A signal of
/// which most readings are impossible stays: its unit is wrong, and [`super::check`] refuses it.
pub fn remove_impossible(model: &Model, recording: &mut Recording) -> Vec<Remark> {
    let mut found = Vec::new();
    let machine = &model.machine;
    for signals in &mut recording.cylinders {
        let Some(cylinder) = machine.cylinders.iter().find(|cylinder| cylinder.name == signals.name) else { continue };
        let name = |signal: &str| format!("{}.{signal}", cylinder.name);
        let travel = travel(cylinder);
        found.extend(remove(name("displacement"), &mut signals.displacement, "m", [-travel, travel]));
        found.extend(remove(name("rod_force"), &mut signals.rod_force, "N", [-LARGEST_FORCE, LARGEST_FORCE]));
        let pressures = [("cap_pressure", &mut signals.cap_pressure), ("rod_pressure", &mut signals.rod_pressure)];
        for (signal, pressure) in pressures {
            found.extend(remove(name(signal), pressure, "Pa", [LOWEST_PRESSURE, HIGHEST_PRESSURE]));
        }
        let Some(chambers) = &cylinder.chambers else { continue };
        let (most, unit) = (FULL_COMMANDS * chambers.full_command(), chambers.drive.command_unit().text());
        found.extend(remove(name("orifice_area"), &mut signals.orifice_area, unit, [-most, most]));
        found.extend(remove(name("orifice_command"), &mut signals.orifice_command, unit, [-most, most]));
    }
    let pressures = [LOWEST_PRESSURE, HIGHEST_PRESSURE];
    found.extend(remove("pump_pressure".to_string(), &mut recording.pump_pressure, "Pa", pressures));
    found.extend(remove("tank_pressure".to_string(), &mut recording.tank_pressure, "Pa", pressures));
    found.extend(remove("pump_flow".to_string(), &mut recording.pump_flow, "m3/s", [-LARGEST_FLOW, LARGEST_FLOW]));
    found.extend(remove("oil_temperature".to_string(), &mut recording.oil_temperature, "degC", TEMPERATURES));
    found
}

/// Distance from mid-stroke that no piston reaches, m, whatever the zero of its sensor.
fn travel(cylinder: &Cylinder) -> f64 {
    STROKES * cylinder.stroke
}

fn remove(signal: String, values: &mut [f64], unit: &'static str, [least, most]: [f64; 2]) -> Option<Remark> {
    let is_impossible = |value: f64| value.is_finite() && !(least..=most).contains(&value);
    let measured = values.iter().filter(|value| value.is_finite()).count();
    let impossible = values.iter().copied().filter(|value| is_impossible(*value));
    let count = impossible.clone().count();
    let worst = impossible.max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
    if count as f64 > LARGEST_SHARE * measured as f64 {
        return None;
    }
    let samples = values.len();
    values.iter_mut().filter(|value| is_impossible(**value)).for_each(|value| *value = f64::NAN);
    Some(Remark::Impossible { signal, count, samples, worst, unit })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;

    use super::*;

    #[test]
    fn single_impossible_readings_are_not_measured_and_a_wrong_unit_stays() {
        let model = built_in("zx30u-arm").unwrap();
        let mut recording = Recording::unmeasured("bag", (0..100).map(f64::from).collect(), &["arm"]);
        let arm = &mut recording.cylinders[0];
        arm.displacement.fill(0.1);
        arm.displacement[7] = -999.0;
        arm.cap_pressure.fill(1e6);
        arm.cap_pressure[8] = -9.99e7;
        arm.rod_pressure.fill(5e9);
        let found = remove_impossible(&model, &mut recording);
        let arm = &recording.cylinders[0];
        let holes = |values: &[f64]| values.iter().filter(|value| value.is_nan()).count();
        assert_eq!([&arm.displacement, &arm.cap_pressure, &arm.rod_pressure].map(|values| holes(values)), [1, 1, 0]);
        assert!(arm.displacement[7].is_nan() && arm.cap_pressure[8].is_nan());
        let told: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[0].starts_with("arm.displacement: 1 of 100 readings are beyond anything possible"), "{told:?}");
    }
}
