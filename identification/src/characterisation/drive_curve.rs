//! Flow of a drive against its input, from steady stretches: null, dead zone and gain of a valve; losses of a pump.

use excavator_model::Model;
use excavator_model::effects::Site;
use excavator_model::machine::Drive;
use nalgebra::{Matrix2, Vector2};
use serde::Serialize;

use super::estimate::Estimate;
use super::refusal::Refusal;
use super::static_valve::{FlowReading, StaticEdge, StaticValve, valve_curve};
use super::stretches::{Steady, different, steady};
use super::track::Track;

/// What steady stretches tell of the drive of a cylinder.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DriveCurve {
    /// A valve. Gains count flow into the chamber that drives, per input and root of the pressure drop over its edge.
    Valve(StaticValve),
    /// A pump of its own, in a closed circuit.
    Pump(PumpLosses),
}

/// Losses of a pump that drives a cylinder: `A+ v = share q - leakage (p+ - p-)`, with the flow q without losses.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PumpLosses {
    /// Flow over flow without losses, at no pressure.
    pub share: Estimate,
    /// Leakage between both sides, m³/(s Pa): of the pump and past the seals of the piston.
    pub leakage: Estimate,
    /// Range of the measured flow through the leakage path, as shares of the flow without losses.
    pub lost: [f64; 2],
    /// Number of steady stretches.
    pub stretches: usize,
}

/// Stretches needed, and the number of different inputs among them.
const NEEDED: (usize, usize) = (6, 4);

/// Inputs closer to each other than this share of the largest count as the same.
const SAME_INPUT: f64 = 0.02;

/// The curve of one cylinder's drive.
///
/// # Errors
/// [`Refusal`].
pub fn drive_curve(model: &Model, cylinder: usize, tracks: &[Track]) -> Result<DriveCurve, Refusal> {
    let constants = &model.machine.cylinders[cylinder];
    let no_valve = || Refusal::NoValve { cylinder: constants.name.clone() };
    let drive = constants.chambers.map(|chambers| chambers.drive).ok_or_else(no_valve)?;
    let stretches: Vec<(&Track, Steady)> =
        tracks.iter().flat_map(|track| steady(track).into_iter().map(move |stretch| (track, stretch))).collect();
    let largest = stretches.iter().map(|(_, one)| one.opening.value.abs()).fold(0.0_f64, f64::max);
    let levels = different(stretches.iter().map(|(_, one)| one.opening.value), SAME_INPUT * largest);
    let too_few = || Refusal::TooFewLevels {
        found: stretches.len(),
        levels,
        needed: NEEDED.0,
        needed_levels: NEEDED.1,
    };
    if stretches.len() < NEEDED.0 || levels < NEEDED.1 {
        return Err(too_few());
    }
    match drive {
        Drive::Pump { .. } => pump_losses(&stretches).map(DriveCurve::Pump).ok_or_else(too_few),
        Drive::Valve { .. } => {
            let margin = model.effects.iter().find(|effect| effect.is("pressure_compensation", Site::Cylinder(cylinder)));
            let margin = margin.and_then(|effect| effect.parameters.first()).map(|parameter| parameter.value);
            let readings: Vec<FlowReading> =
                stretches.iter().filter_map(|(track, stretch)| reading(track, stretch, margin)).collect();
            if readings.is_empty() {
                return Err(Refusal::MissingSignal {
                    source_name: stretches[0].0.source.clone(),
                    signal: "pump_pressure".to_string(),
                    needed_for: "gives the pressure drop of the edge that drives",
                });
            }
            valve_curve(&readings).map(DriveCurve::Valve).map_err(|error| Refusal::Curve(error.to_string()))
        }
    }
}

/// Flow into the chamber that drives, and the drop over its edge: that of a compensator, if the valve has one.
fn reading(track: &Track, stretch: &Steady, margin: Option<f64>) -> Option<FlowReading> {
    let [cap, rod, pump, _] = stretch.pressures;
    let extends = stretch.speed.value > 0.0;
    let (area, chamber) = if extends { (track.areas.0, cap) } else { (track.areas.1, rod) };
    let measured = pump - chamber;
    let drop = match margin {
        Some(margin) if measured.is_finite() => measured.min(margin),
        Some(margin) => margin,
        None => measured,
    };
    let reading = FlowReading { input: stretch.opening.value, flow: area * stretch.speed.value, pressure_drop: drop };
    (drop.is_finite() && drop > 0.0 && reading.input.is_finite()).then_some(reading)
}

/// Least squares over the stretches, each with the error of its speed; the spread of their residuals is taken into account.
fn pump_losses(stretches: &[(&Track, Steady)]) -> Option<PumpLosses> {
    let rows: Vec<(Vector2<f64>, f64)> = stretches
        .iter()
        .map(|(track, one)| {
            let [cap, rod, ..] = one.pressures;
            (Vector2::new(one.opening.value, -(cap - rod)), track.areas.0 * one.speed.value)
        })
        .filter(|(row, flow)| row.iter().all(|value| value.is_finite()) && flow.is_finite())
        .collect();
    // Columns of length one: flows and pressures differ by ten powers of ten.
    let length = |index: usize| rows.iter().map(|(row, _)| row[index] * row[index]).sum::<f64>().sqrt();
    let lengths = Vector2::new(length(0), length(1));
    let scaled: Vec<(Vector2<f64>, f64)> =
        rows.iter().map(|(row, flow)| (row.component_div(&lengths), *flow)).collect();
    let normal: Matrix2<f64> = scaled.iter().map(|(row, _)| row * row.transpose()).sum();
    let inverse = normal.try_inverse()?;
    let solution = inverse * scaled.iter().map(|(row, flow)| row * *flow).sum::<Vector2<f64>>();
    let scatter: Matrix2<f64> =
        scaled.iter().map(|(row, flow)| row * row.transpose() * (flow - row.dot(&solution)).powi(2)).sum();
    let freedom = rows.len() as f64 / (rows.len() as f64 - 2.0).max(1.0);
    let covariance = inverse * scatter * inverse * freedom;
    let estimate = |index: usize| Estimate {
        value: solution[index] / lengths[index],
        error: covariance[(index, index)].max(0.0).sqrt() / lengths[index],
    };
    let (share, leakage) = (estimate(0), estimate(1));
    let lost = rows.iter().filter(|(row, _)| row[0].abs() > 0.0).map(|(row, _)| (leakage.value * row[1] / row[0]).abs());
    let lost = lost.fold([f64::INFINITY, 0.0_f64], |[least, most], one| [least.min(one), most.max(one)]);
    share.value.is_finite().then_some(PumpLosses { share, leakage, lost, stretches: rows.len() })
}

impl DriveCurve {
    /// The valve's null, if there is a valve.
    pub fn null(&self) -> Option<Estimate> {
        match self {
            DriveCurve::Valve(valve) => Some(valve.null),
            DriveCurve::Pump(_) => None,
        }
    }

    /// The sides of the valve, above the null and below.
    pub fn sides(&self) -> [Option<StaticEdge>; 2] {
        match self {
            DriveCurve::Valve(valve) => valve.sides,
            DriveCurve::Pump(_) => [None, None],
        }
    }
}
