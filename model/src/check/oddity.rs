//! Implausible numbers in a model that parses.

use super::{Trial, oscillations, trial};
use crate::display::pressure_text;
use crate::machine::{Chambers, CommandUnit, Cylinder, Linkage};
use crate::{Model, ModelEffect, Parameter};

/// An implausibility in a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Oddity {
    /// A parameter is outside the range of real machines.
    #[error("{parameter} = {} {unit}: a plausible value lies between {} and {}", shown(*value), shown(*least), shown(*most))]
    Parameter {
        /// Its name with its place: `arm.mass`.
        parameter: String,
        /// Its value.
        value: f64,
        /// Its SI unit.
        unit: String,
        /// Least plausible value.
        least: f64,
        /// Largest plausible value.
        most: f64,
    },
    /// The rod side's piston area is the larger one.
    #[error("{cylinder}: rod_area {rod:e} m2 is larger than cap_area {cap:e} m2; are the two sides swapped?")]
    SidesSwapped {
        /// The cylinder.
        cylinder: String,
        /// Area of the cap side, m².
        cap: f64,
        /// Area of the rod side, m².
        rod: f64,
    },
    /// A dead volume is far larger than the swept volume.
    #[error("{cylinder}: {side}_dead_volume {volume:e} m3 is {times:.0} times what the piston sweeps; is it in m3?")]
    DeadVolume {
        /// The cylinder.
        cylinder: String,
        /// "cap" or "rod".
        side: &'static str,
        /// The volume, m³.
        volume: f64,
        /// Its ratio to the swept volume.
        times: f64,
    },
    /// A valve opening is larger than the piston area.
    #[error("{cylinder}: maximum_orifice_area {area:e} m2 is larger than the piston's {piston:e} m2; is it in m2?")]
    Orifice {
        /// The cylinder.
        cylinder: String,
        /// The orifice area, m².
        area: f64,
        /// Piston area of the cap side, m².
        piston: f64,
    },
    /// The cylinder passes a dead centre within its stroke.
    #[error(
        "{cylinder}: the lever of its linkage shrinks to {lever:.1e} m within the stroke; a dead centre lies there"
    )]
    DeadCentre {
        /// The cylinder.
        cylinder: String,
        /// The least lever, m.
        lever: f64,
    },
    /// No cylinder is that long or that short.
    #[error("{cylinder}: its stroke is {} m, and cylinders have 1 mm to 25 m; check its unit", shown(*stroke))]
    Stroke {
        /// The cylinder.
        cylinder: String,
        /// The stroke, m.
        stroke: f64,
    },
    /// With a fully open valve the piston moves implausibly fast or slowly.
    #[error(
        "{cylinder}: with its valve fully open it moves at {speed:.1e} {unit}; check its largest input and the flow gains"
    )]
    Speed {
        /// The cylinder.
        cylinder: String,
        /// The speed, m/s.
        speed: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// The pressure exceeds the burst pressure of hoses.
    #[error(
        "{cylinder}: with its valve fully open its pressure reaches {}; check areas, mass and supply", pressure_text(*pressure)
    )]
    Pressure {
        /// The cylinder.
        cylinder: String,
        /// The pressure, Pa.
        pressure: f64,
    },
    /// The machine cannot be simulated.
    #[error("{cylinder}: with its valve fully open there is no simulation: {reason}")]
    NoSimulation {
        /// The cylinder.
        cylinder: String,
        /// The reason.
        reason: String,
    },
    /// The rest state at mid-stroke is unstable: an oscillation grows.
    #[error(
        "at rest with closed valves an oscillation of {frequency:.1} Hz grows; a friction or a gain has a wrong sign"
    )]
    Grows {
        /// Its frequency, Hz.
        frequency: f64,
    },
}

/// The rod area may exceed the cap area by this factor: both sides of a symmetric cylinder are measured.
const SYMMETRIC: f64 = 1.02;
/// Largest ratio of dead volume to swept volume: a short cylinder at the end of a long hose has a ratio of ten.
const DEAD_VOLUMES: f64 = 100.0;
/// Below this fraction of the largest lever, a lever is near a dead centre.
const NEAR_DEAD_CENTRE: f64 = 0.02;
/// Plausible piston speeds with an open valve, m/s: from a creeping press to a seismic damper driven by an accumulator.
const SPEEDS: [f64; 2] = [1e-4, 10.0];

/// Motor shaft speed that corresponds to a piston speed of 1 m/s, rad/s.
const MOTOR_SPEED_UNIT: f64 = 100.0;
/// Strokes of cylinders, m: from those of small actuators to those of lock gates and hoists.
const STROKES: std::ops::RangeInclusive<f64> = 1e-3..=25.0;
/// Largest pressure with an open valve, Pa: that of a burst test.
const PRESSURE: f64 = 1.5e8;
/// Damping ratio below which an oscillation grows; rounding errors stay above it.
const GROWS: f64 = -1e-3;

/// Formats a number, with a power of ten only where it saves zeros.
fn shown(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

/// All implausibilities of `model`; empty if there are none.
pub fn oddities(model: &Model) -> Vec<Oddity> {
    let mut found: Vec<Oddity> = Vec::new();
    let parameters = model.effects.iter().flat_map(|effect| effect.parameters.iter().map(move |one| (effect, one)));
    for ((effect, parameter), name) in parameters.zip(model.parameter_names()) {
        found.extend(implausible(model, effect, parameter, &name));
    }
    for (index, cylinder) in model.machine.cylinders.iter().enumerate() {
        if !cylinder.is_motor() && !STROKES.contains(&cylinder.stroke) {
            found.push(Oddity::Stroke { cylinder: cylinder.name.clone(), stroke: cylinder.stroke });
        }
        found.extend(dead_centre(cylinder));
        if let Some(chambers) = &cylinder.chambers {
            found.extend(chambers_of(cylinder, chambers));
        }
        match trial(model, index) {
            Ok(None) => {}
            Ok(Some(trial)) => found.extend(of_trial(cylinder, &trial)),
            Err(error) => {
                found.push(Oddity::NoSimulation { cylinder: cylinder.name.clone(), reason: error.to_string() });
            }
        }
    }
    let growing = oscillations(model).into_iter().find(|oscillation| oscillation.damping < GROWS);
    found.extend(growing.map(|oscillation| Oddity::Grows { frequency: oscillation.frequency }));
    found
}

/// Checks one parameter. Identified and given values are checked alike; for unknown parameters the value is only a search's
/// start.
fn implausible(model: &Model, effect: &ModelEffect, parameter: &Parameter, name: &str) -> Option<Oddity> {
    let card = &parameter.card;
    let plausible = effect.physics.plausible(&model.machine, effect.site, &card.name);
    let [least, most] = plausible.unwrap_or([card.minimum, card.maximum]);
    let odd = parameter.value < least || parameter.value > most;
    odd.then(|| Oddity::Parameter {
        parameter: name.to_string(),
        value: parameter.value,
        unit: card.unit.to_string(),
        least,
        most,
    })
}

fn chambers_of(cylinder: &Cylinder, chambers: &Chambers) -> Vec<Oddity> {
    let mut found = Vec::new();
    if chambers.rod_area > SYMMETRIC * chambers.cap_area {
        found.push(Oddity::SidesSwapped {
            cylinder: cylinder.name.clone(),
            cap: chambers.cap_area,
            rod: chambers.rod_area,
        });
    }
    // A voltage is not an area, and neither is a motor's displacement.
    let is_area = chambers.drive.command_unit() == CommandUnit::SquareMetre && !cylinder.is_motor();
    if is_area && chambers.full_command() > chambers.cap_area {
        found.push(Oddity::Orifice {
            cylinder: cylinder.name.clone(),
            area: chambers.full_command(),
            piston: chambers.cap_area,
        });
    }
    for (side, volume, area) in
        [("cap", chambers.cap_dead_volume, chambers.cap_area), ("rod", chambers.rod_dead_volume, chambers.rod_area)]
    {
        let times = volume / (area * cylinder.stroke);
        if times > DEAD_VOLUMES {
            found.push(Oddity::DeadVolume { cylinder: cylinder.name.clone(), side, volume, times });
        }
    }
    found
}

/// Whether the lever vanishes within the stroke. The lever is the sine of the joint angle over the length, so either its least
/// value is at an end, or the ends lie on both sides of a dead centre.
fn dead_centre(cylinder: &Cylinder) -> Option<Oddity> {
    if !matches!(cylinder.linkage, Linkage::Triangle { .. }) {
        return None;
    }
    let lever = |share: f64| cylinder.linkage.lever(cylinder.linkage.joint(share * cylinder.stroke)).abs();
    let (ends, middle) = ([lever(-0.5), lever(0.5)], lever(0.0));
    let least = ends[0].min(ends[1]);
    (least < NEAR_DEAD_CENTRE * middle.max(ends[0]).max(ends[1]))
        .then(|| Oddity::DeadCentre { cylinder: cylinder.name.clone(), lever: least })
}

fn of_trial(cylinder: &Cylinder, trial: &Trial) -> Vec<Oddity> {
    let name = || cylinder.name.clone();
    let unit = if cylinder.is_motor() { MOTOR_SPEED_UNIT } else { 1.0 };
    let odd_speed = trial.speeds.iter().find(|speed| !(SPEEDS[0]..=SPEEDS[1]).contains(&(*speed / unit)));
    let speed = odd_speed.map(|&speed| Oddity::Speed { cylinder: name(), speed, unit: cylinder.motion_units()[1] });
    let pressure =
        (trial.pressures[1] > PRESSURE).then(|| Oddity::Pressure { cylinder: name(), pressure: trial.pressures[1] });
    speed.into_iter().chain(pressure).collect()
}
