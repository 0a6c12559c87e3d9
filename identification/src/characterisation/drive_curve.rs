//! Flow of a drive against its input, from steady stretches: null, dead zone and gain of a valve; losses of a pump.

use excavator_model::Model;
use excavator_model::effects::Site;
use excavator_model::machine::Drive;
use nalgebra::{Matrix2, Vector2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::edge::Side;
use super::estimate::Estimate;
use super::refusal::Refusal;
use super::static_valve::{FlowReading, StaticTestError, StaticValve, middle, valve_curve};
use super::stretches::{Steady, different, steady};
use super::track::Track;

/// What steady stretches tell of the drive of a cylinder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum DriveCurve {
    /// A valve.
    Valve(ValveCurve),
    /// A pump of its own, in a closed circuit.
    Pump(PumpLosses),
}

/// A valve: `Q = gain (|u - null| - dead zone) sqrt(drop)` at each chamber.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ValveCurve {
    /// Input at the middle of the closed valve, in its unit.
    pub null: Estimate,
    /// Input beyond the null that moves no oil, extending and retracting.
    pub dead_zones: [Option<Estimate>; 2],
    /// Flow per input and root of the pressure drop of cap and rod side, m³/(s sqrt(Pa)) per unit of the input.
    pub gains: [Option<Estimate>; 2],
    /// Leakage past the seals of the piston, m³/(s Pa); `None` for a compensated valve.
    pub leakage: Option<Estimate>,
    /// Pressure drop that a compensator leaves to the edge that drives, Pa; `None` without a compensator.
    pub compensator_margin: Option<Estimate>,
    /// Lowest pressure that the pump keeps in front of the edges, Pa; `None` where none shows.
    pub standby_pressure: Option<Estimate>,
    /// Number of steady stretches.
    pub stretches: usize,
}

/// Losses of a pump that drives a cylinder: `A+ v = share q - leakage (p+ - p-)`, with the flow q without losses.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
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

/// Drops in both directions that are further apart than this many standard errors are not one compensator's.
const CLEARLY_APART: f64 = 3.0;

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
    let too_few =
        || Refusal::TooFewLevels { found: stretches.len(), levels, needed: NEEDED.0, needed_levels: NEEDED.1 };
    if stretches.len() < NEEDED.0 || levels < NEEDED.1 {
        return Err(too_few());
    }
    match drive {
        Drive::Pump { .. } => pump_losses(&stretches).map(DriveCurve::Pump).ok_or_else(too_few),
        Drive::Valve { .. } => {
            let margin =
                model.effects.iter().find(|effect| effect.is("pressure_compensation", Site::Cylinder(cylinder)));
            let margin = margin.and_then(|effect| effect.parameters.first()).map(|parameter| parameter.value);
            let is_known = stretches.iter().all(|(_, stretch)| stretch.pressures[2].is_finite());
            let curve = match margin {
                None if is_known => with_leakage(&stretches),
                None => {
                    return Err(Refusal::MissingSignal {
                        source_name: stretches[0].0.source.clone(),
                        signal: "pump_pressure".to_string(),
                        needed_for: "gives the pressure drop of the edge that drives",
                    });
                }
                Some(margin) => compensated(&stretches, margin),
            };
            curve.map(DriveCurve::Valve).map_err(|error| Refusal::Curve(error.to_string()))
        }
    }
}

/// A compensated valve. Oil flows in over the compensator's drop, which is the same for all loads, and out over the drop from chamber to
/// tank. Both edges of a chamber have one gain, so the flows out tell the gains and the flows in the compensator's drop. Where the flows out
/// are no lines, `margin` (Pa) is taken for that drop.
fn compensated(stretches: &[(&Track, Steady)], margin: f64) -> Result<ValveCurve, StaticTestError> {
    let of = |flows_in: bool, drop: Option<f64>| -> Vec<FlowReading> {
        stretches.iter().filter_map(|(track, one)| edge_reading(track, one, flows_in, drop)).collect()
    };
    let inflow = valve_curve(&of(true, Some(1.0)))?;
    let outflow = valve_curve(&of(false, None)).map(|valve| valve.sides);
    let ([Some(cap_in), Some(rod_in)], Ok([Some(rod_out), Some(cap_out)])) = (inflow.sides, outflow) else {
        return Ok(of_inflow(&valve_curve(&of(true, Some(margin)))?, stretches.len()));
    };
    let square = |inner: Estimate, outer: Estimate| {
        let value = (inner.value / outer.value).powi(2);
        Estimate { value, error: 2.0 * value * inner.relative_error().hypot(outer.relative_error()) }
    };
    let drops = [square(cap_in.gain, cap_out.gain), square(rod_in.gain, rod_out.gain)];
    let standby = standby_pressure(stretches, drops);
    let margin = match standby {
        Some((retracts, _)) => Some(drops[usize::from(!retracts)]),
        None => Estimate::mean(&drops),
    };
    Ok(ValveCurve {
        gains: [Some(cap_out.gain), Some(rod_out.gain)],
        compensator_margin: margin,
        standby_pressure: standby.map(|(_, pressure)| pressure),
        ..of_inflow(&inflow, stretches.len())
    })
}

/// Pressure that the pump keeps where the load asks for less, Pa, and whether it shows when the rod retracts. It shows as a drop over
/// the edge that is larger in the direction with the lower load: there the sum of drop and load is the standby pressure.
fn standby_pressure(stretches: &[(&Track, Steady)], drops: [Estimate; 2]) -> Option<(bool, Estimate)> {
    let [extending, retracting] = drops;
    let apart = retracting.value - extending.value;
    if apart.abs() < CLEARLY_APART * extending.error.hypot(retracting.error) {
        return None;
    }
    let load = |retracts: bool| {
        let moving = stretches.iter().map(|(_, one)| one).filter(|one| (one.speed.value < 0.0) == retracts);
        let pressures: Vec<f64> = moving.map(|one| one.pressures[usize::from(retracts)]).collect();
        pressures.iter().sum::<f64>() / pressures.len() as f64
    };
    let retracts = apart > 0.0;
    let low = load(retracts);
    let drop = drops[usize::from(retracts)];
    (low < load(!retracts)).then_some((retracts, Estimate { value: drop.value + low, ..drop }))
}

/// What the edges that the pump feeds tell alone.
fn of_inflow(valve: &StaticValve, stretches: usize) -> ValveCurve {
    ValveCurve {
        null: valve.null,
        dead_zones: valve.sides.map(|side| side.map(|edge| edge.dead_zone)),
        gains: valve.sides.map(|side| side.map(|edge| edge.gain)),
        leakage: None,
        compensator_margin: None,
        standby_pressure: None,
        stretches,
    }
}

/// Inputs at which the lines of a chamber meet zero flow, extending and retracting.
fn crossings(valve: &StaticValve) -> [Option<Estimate>; 2] {
    [0, 1].map(|index| {
        let edge = valve.sides[index]?;
        let sign = if index == 0 { 1.0 } else { -1.0 };
        Some(Estimate { value: sign * valve.null.value + edge.dead_zone.value, ..edge.dead_zone })
    })
}

/// A valve whose four edges have known drops. Leakage past the piston shifts the lines of both chambers, by different inputs; since both
/// chambers are closed by one spool, the leakage is the one with which their lines meet zero flow at the same input.
fn with_leakage(stretches: &[(&Track, Steady)]) -> Result<ValveCurve, StaticTestError> {
    let chambers = |leakage: f64| -> Result<[StaticValve; 2], StaticTestError> {
        let of = |side: Side| -> Vec<FlowReading> {
            stretches.iter().filter_map(|(track, one)| chamber_reading(track, one, side, leakage)).collect()
        };
        Ok([valve_curve(&of(Side::Cap))?, valve_curve(&of(Side::Rod))?])
    };
    // The lines shift in proportion to the leakage, nearly: one secant step from a leakage that matters.
    let flow = stretches.iter().map(|(track, one)| track.areas.0 * one.speed.value.abs()).fold(f64::INFINITY, f64::min);
    let pressure = stretches.iter().map(|(_, one)| (one.pressures[0] - one.pressures[1]).abs()).fold(0.0_f64, f64::max);
    let unit = 0.1 * flow / pressure.max(1.0);
    let (plain, shifted) = (chambers(0.0)?, chambers(unit)?);
    let [first, second] = [&plain, &shifted].map(|pair| [crossings(&pair[0]), crossings(&pair[1])]);
    let (mut information, mut downhill) = (0.0, 0.0);
    for index in 0..2 {
        let (Some(cap), Some(rod)) = (first[0][index], first[1][index]) else { continue };
        let (Some(cap_shifted), Some(rod_shifted)) = (second[0][index], second[1][index]) else { continue };
        let apart = cap.value - rod.value;
        let slope = (cap_shifted.value - rod_shifted.value - apart) / unit;
        let weight = 1.0 / (cap.error * cap.error + rod.error * rod.error).max(f64::MIN_POSITIVE);
        information += weight * slope * slope;
        downhill -= weight * slope * apart;
    }
    let leakage = Estimate { value: (downhill / information).max(0.0), error: 1.0 / information.sqrt() };
    let leakage = Some(leakage).filter(|one| one.value.is_finite() && one.error.is_finite());
    let found = chambers(leakage.map_or(0.0, |one| one.value))?;
    let [cap, rod] = [crossings(&found[0]), crossings(&found[1])];
    let uncertain = leakage.map_or(0.0, |one| one.error / unit);
    let closes = [0, 1].map(|index| {
        let both: Vec<Estimate> = [cap[index], rod[index]].into_iter().flatten().collect();
        let mean = Estimate::mean(&both)?;
        let shift = (second[0][index]?.value - first[0][index]?.value) * uncertain;
        Some(Estimate { error: mean.error.hypot(shift), ..mean })
    });
    let null = match closes {
        [Some(above), Some(below)] => middle([above, below]),
        _ => Estimate { value: 0.0, error: f64::INFINITY },
    };
    let zone =
        |index: usize, sign: f64| closes[index].map(|one| Estimate { value: one.value - sign * null.value, ..one });
    let gain = |valve: &StaticValve| {
        let both: Vec<Estimate> = valve.sides.iter().flatten().map(|edge| edge.gain).collect();
        Estimate::mean(&both)
    };
    Ok(ValveCurve {
        null,
        dead_zones: [zone(0, 1.0), zone(1, -1.0)],
        gains: [gain(&found[0]), gain(&found[1])],
        leakage,
        compensator_margin: None,
        standby_pressure: None,
        stretches: stretches.len(),
    })
}

/// Flow through the edge of a chamber with this leakage past the piston, and the drop over it; positive where the rod extends.
fn chamber_reading(track: &Track, stretch: &Steady, side: Side, leakage: f64) -> Option<FlowReading> {
    let [cap, rod, pump, tank] = stretch.pressures;
    let extends = stretch.speed.value > 0.0;
    let (area, drop) = match (side, extends) {
        (Side::Cap, true) => (track.areas.0, pump - cap),
        (Side::Cap, false) => (track.areas.0, cap - tank),
        (Side::Rod, true) => (track.areas.1, rod - tank),
        (Side::Rod, false) => (track.areas.1, pump - rod),
    };
    let flow = area * stretch.speed.value + leakage * (cap - rod);
    let is_usable = drop.is_finite() && drop > 0.0 && (flow > 0.0) == extends;
    is_usable.then_some(FlowReading { input: stretch.opening.value, flow, pressure_drop: drop })
}

/// Flow through the edge that the pump feeds, or through the one to the tank, positive where the rod extends; over this drop, else over the
/// drop from chamber to tank.
fn edge_reading(track: &Track, stretch: &Steady, flows_in: bool, drop: Option<f64>) -> Option<FlowReading> {
    let [cap, rod, _, tank] = stretch.pressures;
    let extends = stretch.speed.value > 0.0;
    let (area, chamber) = if extends == flows_in { (track.areas.0, cap) } else { (track.areas.1, rod) };
    let drop = drop.unwrap_or(chamber - tank);
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
    let lost =
        rows.iter().filter(|(row, _)| row[0].abs() > 0.0).map(|(row, _)| (leakage.value * row[1] / row[0]).abs());
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
}
