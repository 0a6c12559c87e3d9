//! Signals of one cylinder in the form that the procedures need.

use excavator_model::Model;
use excavator_model::effects::Site;
use excavator_model::machine::{Chambers, Size, Supply};
use excavator_model::recording::{Recording, is_measured};

use super::edge::{Edge, Side};
use super::refusal::Refusal;
use crate::energy::Parabola;

/// Half width of the parabolas that smooth and differentiate, s: a tenth of the slowest trapezoid's ramp time, and wide enough
/// that 0.02 mm of displacement noise gives speeds to 0.1 mm/s at 500 Hz.
const HALF_WIDTH: f64 = 0.03;
/// For a slow clock: samples in half a parabola.
const FEWEST_SAMPLES: f64 = 3.0;

/// One cylinder in one recording. `NaN` for unmeasured values, and within half a parabola of the ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// Name of the recording.
    pub source: String,
    /// Cylinder.
    pub cylinder: String,
    /// Known constants of its chambers; `None` where the motion is imposed.
    pub chambers: Option<Chambers>,
    /// Areas of the piston, cap and rod side, m².
    pub areas: (f64, f64),
    /// Stroke, m.
    pub stroke: f64,
    /// Displacements at which the piston meets its stops, m.
    pub ends: [f64; 2],
    /// Size of the cylinder.
    pub size: Size,
    /// Bulk modulus of the model (Pa) and its standard error.
    pub bulk_modulus: Option<(f64, f64)>,
    /// Sample times, s.
    pub time: Vec<f64>,
    /// Half width of the parabolas, s.
    pub half_width: f64,
    /// Opening as measured, or as commanded if there is no sensor, m², from the model's null on. Empty without a valve.
    pub opening: Vec<f64>,
    /// The smoothed opening, m².
    pub smooth_opening: Vec<f64>,
    /// Rate of the opening, m²/s.
    pub opening_rate: Vec<f64>,
    /// Piston displacement as measured, m.
    pub displacement: Vec<f64>,
    /// Piston speed, m/s.
    pub velocity: Vec<f64>,
    /// Cap side pressure, Pa.
    pub cap_pressure: Vec<f64>,
    /// Rod side pressure, Pa.
    pub rod_pressure: Vec<f64>,
    /// Pump or supply pressure, Pa; `NaN` if neither is known.
    pub pump_pressure: Vec<f64>,
    /// Tank pressure, Pa.
    pub tank_pressure: Vec<f64>,
    /// Flow into the cap side through the valve: `A+ v + V+/b dp+/dt` plus known leakage out of the chamber, m³/s.
    pub cap_flow: Vec<f64>,
    /// Flow into the rod side, m³/s.
    pub rod_flow: Vec<f64>,
    /// Force on the rod, N, + = pushes the rod out; empty without a load cell.
    pub rod_force: Vec<f64>,
    /// Internal and external leakages from the model, m³/(s Pa): past the seals, cap side out, rod side out.
    pub seal_leakage: [f64; 3],
}

impl Track {
    /// Signals of `cylinder` in `recording`.
    ///
    /// # Errors
    /// [`Refusal::MissingSignal`] without position, pressures or opening, [`Refusal::NoValve`] for a drive without oil.
    pub fn of(model: &Model, cylinder: usize, recording: &Recording) -> Result<Track, Refusal> {
        recording.validate()?;
        let constants = &model.machine.cylinders[cylinder];
        let name = constants.name.clone();
        let areas = match (constants.chambers, constants.imposed_motion) {
            (Some(chambers), _) => (chambers.cap_area, chambers.rod_area),
            (None, Some(imposed)) => (imposed.cap_area, imposed.rod_area),
            (None, None) => return Err(Refusal::NoValve { cylinder: name }),
        };
        let signals = recording.cylinder(&name)?;
        let missing = |signal: &str, needed_for| Refusal::MissingSignal {
            source_name: recording.source.clone(),
            signal: if signal == "pump_pressure" { signal.into() } else { format!("{name}.{signal}") },
            needed_for,
        };
        let displacement = if is_measured(&signals.displacement) {
            signals.displacement.clone()
        } else if is_measured(&signals.joint_angle) {
            signals.joint_angle.iter().map(|&angle| constants.linkage.displacement(angle)).collect()
        } else {
            return Err(missing("displacement", "gives the flow, area times speed"));
        };
        let (mut cap_pressure, mut rod_pressure) = (signals.cap_pressure.clone(), signals.rod_pressure.clone());
        if constants.imposed_motion.is_some() {
            // As in simulation: a side without a sensor is open to the atmosphere.
            for pressure in [&mut cap_pressure, &mut rod_pressure] {
                if !is_measured(pressure) {
                    pressure.fill(0.0);
                }
            }
        }
        for (values, signal) in [(&cap_pressure, "cap_pressure"), (&rod_pressure, "rod_pressure")] {
            if !is_measured(values) {
                return Err(missing(signal, "gives pressure drops and the piston's force"));
            }
        }
        let opening = match (constants.chambers, is_measured(&signals.orifice_area)) {
            (None, _) => Vec::new(),
            (_, true) => signals.orifice_area.clone(),
            _ if is_measured(&signals.orifice_command) => signals.orifice_command.clone(),
            _ => return Err(missing("orifice_area", "tells when the valve is closed, steady or moving")),
        };
        let samples = recording.len();
        let constant_or = |measured: &[f64], constant: Option<f64>| match constant {
            _ if is_measured(measured) => Some(measured.to_vec()),
            Some(value) => Some(vec![value; samples]),
            None => None,
        };
        let (supply, tank) = match model.machine.supply {
            Supply::PressureSource(source) => (Some(source.pressure), source.tank_pressure),
            Supply::PumpLine(line) => (None, line.tank_pressure),
            Supply::None => (Some(0.0), 0.0),
        };
        let pump_pressure = constant_or(&recording.pump_pressure, supply).unwrap_or_else(|| vec![f64::NAN; samples]);
        let tank_pressure = constant_or(&recording.tank_pressure, Some(tank)).unwrap_or_default();
        // A machine without a load cell records a column of zeros.
        let measured_force = is_measured(&signals.rod_force) && signals.rod_force.iter().any(|&force| force != 0.0);
        let value = |parameter: &str| model.value_of(&format!("{name}.{parameter}"));
        let bulk_modulus = model.parameters().zip(model.parameter_names()).find_map(|((_, parameter), own)| {
            let known = own == format!("{name}.bulk_modulus");
            known.then(|| (parameter.value, parameter.standard_error.unwrap_or(0.0)))
        });
        let null = value("valve_null").unwrap_or(0.0);
        let size = model.machine.size_at(Site::Cylinder(cylinder));
        let mut track = Track {
            source: recording.source.clone(),
            cylinder: name.clone(),
            chambers: constants.chambers,
            areas,
            stroke: constants.stroke,
            ends: constants.ends,
            size,
            bulk_modulus,
            half_width: (HALF_WIDTH * size.time()).max(FEWEST_SAMPLES * recording.sample_interval()),
            time: recording.time.clone(),
            smooth_opening: vec![f64::NAN; opening.len()],
            opening_rate: vec![f64::NAN; opening.len()],
            opening: opening.into_iter().map(|reading| reading - null).collect(),
            displacement,
            velocity: vec![f64::NAN; samples],
            cap_pressure,
            rod_pressure,
            pump_pressure,
            tank_pressure,
            cap_flow: vec![f64::NAN; samples],
            rod_flow: vec![f64::NAN; samples],
            rod_force: if measured_force { signals.rod_force.clone() } else { Vec::new() },
            seal_leakage: ["internal_leakage", "external_leakage_cap", "external_leakage_rod"]
                .map(|parameter| value(parameter).unwrap_or(0.0)),
        };
        track.differentiate();
        Ok(track)
    }

    fn differentiate(&mut self) {
        let mut parabola = Parabola::default();
        for index in 0..self.time.len() {
            if !parabola.set(&self.time, index, self.half_width) {
                continue;
            }
            if !self.opening.is_empty() {
                self.smooth_opening[index] = parabola.value(&self.opening);
                self.opening_rate[index] = parabola.slope(&self.opening);
            }
            let velocity = parabola.slope(&self.displacement);
            self.velocity[index] = velocity;
            let (Some(chambers), compliance) = (self.chambers, self.bulk_modulus.map_or(0.0, |(b, _)| 1.0 / b)) else {
                continue;
            };
            let (cap, rod) = (parabola.value(&self.cap_pressure), parabola.value(&self.rod_pressure));
            let position = self.displacement[index];
            let [past_seals, cap_out, rod_out] = self.seal_leakage;
            let swell = |volume: f64, signal: &[f64]| volume * compliance * parabola.slope(signal);
            self.cap_flow[index] = self.areas.0 * velocity
                + swell(chambers.cap_volume(self.stroke, position), &self.cap_pressure)
                + past_seals * (cap - rod)
                + cap_out * cap;
            self.rod_flow[index] = -self.areas.1 * velocity
                + swell(chambers.rod_volume(self.stroke, position), &self.rod_pressure)
                - past_seals * (cap - rod)
                + rod_out * rod;
        }
    }

    /// Pressure of a chamber, Pa.
    pub fn pressure(&self, side: Side) -> &[f64] {
        match side {
            Side::Cap => &self.cap_pressure,
            Side::Rod => &self.rod_pressure,
        }
    }

    /// Flow through an edge (m³/s) and the pressure drop over it (Pa).
    pub fn through(&self, edge: Edge, index: usize) -> (f64, f64) {
        let into = match edge.side {
            Side::Cap => self.cap_flow[index],
            Side::Rod => self.rod_flow[index],
        };
        let chamber = self.pressure(edge.side)[index];
        (edge.flow(into), edge.pressure_drop(self.pump_pressure[index], chamber, self.tank_pressure[index]))
    }

    /// Largest orifice area, m²; zero without a valve.
    pub fn maximum_opening(&self) -> f64 {
        self.chambers.map_or(0.0, |chambers| chambers.full_command())
    }
}
