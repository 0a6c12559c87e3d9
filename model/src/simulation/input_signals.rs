//! The inputs of a simulation as functions of time.

use super::coarse_inputs::{bend, interval_means, nearest_lines};
use super::imposed_motion::imposed_signals;
use super::spool_estimate::spool_estimate;
use crate::effects::Site;
use crate::equations::{ImposedState, Inputs, USUAL_OIL_TEMPERATURE};
use crate::machine::{Growth, Size, Supply};
use crate::recording::{CylinderSignals, Recording, is_measured, standard_deviation, without_holes};
use crate::{Imposed, Model, SignalError};

/// Interpolation of an input between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines: right for a measured quantity.
    Linear,
    /// Held until the next sample: right for a command.
    Hold,
}

/// Negligible deviation from a straight line, m²: a two-hundredth of the noise of a good spool sensor.
const STRAIGHT_AREA: f64 = 1e-9;
/// The same for the rate of an opening, m²/s: it changes the opening by [`STRAIGHT_AREA`] in a millisecond of lead.
const STRAIGHT_RATE: f64 = 1e-6;
/// The same for rod forces, N: a three-hundredth of a load cell's noise.
const STRAIGHT_FORCE: f64 = 0.03;
/// The same for tank and supply pressure, Pa: a tenth of the noise of a good sensor.
const STRAIGHT_PRESSURE: f64 = 200.0;
/// The same for the pump's flow, m³/s: a few millionths of the flow of a small excavator.
const STRAIGHT_FLOW: f64 = 2e-9;

/// The same for the oil temperature, °C: viscosity changes by a thousandth.
const STRAIGHT_TEMPERATURE: f64 = 0.03;

/// Permitted deviation of a line, as a fraction of an opening's spread. If two valves nearly close the pump's path to the tank, a
/// thousandth of an opening is a hundredth of a pressure.
const MOST_MISSED: f64 = 5e-4;
/// The same for a held opening, whose mean passes the same oil: only jumps exceed it.
const MOST_MISSED_HELD: f64 = 0.1;

/// Inputs of a model on the clock of a recording, without holes: straight lines bridge gaps of single signals.
#[derive(Debug, Clone)]
pub struct InputSignals {
    /// Sample times, s.
    pub time: Vec<f64>,
    orifice_area: Vec<(Interpolation, Vec<f64>)>,
    /// Rate of the opening between each sample and the next, m²/s, if an effect reads it.
    orifice_rate: Vec<Option<Vec<f64>>>,
    rod_force: Vec<Vec<f64>>,
    imposed: Vec<Option<ImposedState<Vec<f64>>>>,
    supply_pressure: Vec<f64>,
    tank_pressure: Vec<f64>,
    pump_flow: Vec<f64>,
    oil_temperature: Vec<f64>,
    /// Size of the machine: a small deviation on one machine is large on a smaller one.
    size: Size,
}

impl InputSignals {
    /// The inputs that `model` needs, from a recording. The spool opening is the measured one if there is a sensor, otherwise the
    /// command. Tank pressure and pump flow default to the machine's constants. The oil temperature is needed only if an effect of
    /// the model reads it.
    ///
    /// # Errors
    /// [`SignalError::MissingInput`], [`SignalError::Recording`].
    pub fn from_recording(model: &Model, recording: &Recording) -> Result<Self, SignalError> {
        let machine = &model.machine;
        let missing = |signal: String| SignalError::MissingInput {
            source_name: recording.source.clone(),
            signal,
            machine: machine.name.clone(),
        };
        let samples = recording.len();
        let mut orifice_area = Vec::new();
        let mut rod_force = Vec::new();
        let mut imposed = Vec::new();
        for cylinder in &machine.cylinders {
            let signals = recording.cylinder(&cylinder.name)?;
            if cylinder.chambers.is_some() {
                let area = orifice_input(signals, &recording.time)
                    .ok_or_else(|| missing(format!("{}.orifice_area (nor a command)", cylinder.name)))?;
                orifice_area.push(area);
                rod_force.push(vec![0.0; samples]);
                imposed.push(if model.imposed == Imposed::Nothing {
                    None
                } else {
                    imposed_signals(cylinder, signals, &recording.time)
                });
            } else {
                let mut force = without_holes(&recording.time, &signals.rod_force)
                    .ok_or_else(|| missing(format!("{}.rod_force", cylinder.name)))?;
                let motion = cylinder.imposed_motion.map(|constants| {
                    let motion = imposed_signals(cylinder, signals, &recording.time)
                        .ok_or_else(|| missing(format!("{}.displacement", cylinder.name)))?;
                    for ((force, &cap), &rod) in force.iter_mut().zip(&motion.cap_pressure).zip(&motion.rod_pressure) {
                        *force += constants.pressure_force(cap, rod);
                    }
                    Ok::<_, SignalError>(motion)
                });
                imposed.push(motion.transpose()?);
                rod_force.push(force);
                orifice_area.push((Interpolation::Linear, vec![0.0; samples]));
            }
        }
        let orifice_rate = orifice_area
            .iter()
            .enumerate()
            .map(|(cylinder, (interpolation, values))| {
                // A held command is used as it is, because its true time of action is unknown.
                (*interpolation == Interpolation::Linear && reads_input_rate(model, cylinder))
                    .then(|| secants(&recording.time, values))
            })
            .collect();
        let or_constant = |signal: &[f64], constant: f64| {
            without_holes(&recording.time, signal).unwrap_or_else(|| vec![constant; samples])
        };
        let supply_pressure = match machine.supply {
            Supply::PressureSource(source) => or_constant(&recording.pump_pressure, source.pressure),
            Supply::PumpLine(_) if model.imposed == Imposed::Everything => or_constant(&recording.pump_pressure, 0.0),
            Supply::PumpLine(_) | Supply::None => vec![0.0; samples],
        };
        let oil_temperature = if model.reads_temperature() {
            let measured = without_holes(&recording.time, &recording.oil_temperature);
            smoothed(&measured.ok_or_else(|| missing("oil_temperature".to_string()))?)
        } else {
            vec![USUAL_OIL_TEMPERATURE; samples]
        };
        Ok(InputSignals {
            orifice_area,
            orifice_rate,
            rod_force,
            imposed,
            supply_pressure,
            oil_temperature,
            tank_pressure: smoothed(&or_constant(&recording.tank_pressure, machine.supply.tank_pressure())),
            pump_flow: or_constant(&recording.pump_flow, machine.supply.pump_flow()),
            time: recording.time.clone(),
            size: machine.size(),
        })
    }

    /// The inputs at the samples `kept`: straight lines nearest to the full ones, means for held inputs.
    #[must_use]
    pub fn at(&self, kept: &[usize]) -> Self {
        let lines = |values: &[f64]| nearest_lines(&self.time, values, kept);
        let thin = |(interpolation, values): &(Interpolation, Vec<f64>)| match interpolation {
            Interpolation::Linear => (*interpolation, lines(values)),
            Interpolation::Hold => (*interpolation, interval_means(values, kept)),
        };
        let time: Vec<f64> = kept.iter().map(|&sample| self.time[sample]).collect();
        let orifice_area: Vec<_> = self.orifice_area.iter().map(thin).collect();
        let orifice_rate = self
            .orifice_rate
            .iter()
            .zip(&orifice_area)
            .map(|(rate, (_, values))| rate.as_ref().map(|_| secants(&time, values)))
            .collect();
        InputSignals {
            time,
            size: self.size,
            orifice_area,
            orifice_rate,
            rod_force: self.rod_force.iter().map(|values| lines(values)).collect(),
            imposed: self
                .imposed
                .iter()
                .map(|motion| motion.as_ref().map(|motion| motion.each(|v| lines(v))))
                .collect(),
            supply_pressure: lines(&self.supply_pressure),
            tank_pressure: lines(&self.tank_pressure),
            pump_flow: lines(&self.pump_flow),
            oil_temperature: lines(&self.oil_temperature),
        }
    }

    /// The samples that a simulation needs: every `stride`-th, and all samples between two of these if an opening deviates from
    /// the line between them by more than a fraction of its own spread.
    pub fn needed_samples(&self, stride: usize) -> Vec<usize> {
        let stride = stride.max(1);
        let spreads: Vec<f64> = self.orifice_area.iter().map(|(_, values)| standard_deviation(values)).collect();
        let is_bent = |first: usize, last: usize| {
            self.orifice_area.iter().zip(&spreads).any(|((interpolation, values), spread)| {
                let most = match interpolation {
                    Interpolation::Linear => MOST_MISSED,
                    Interpolation::Hold => MOST_MISSED_HELD,
                };
                bend(&self.time[first..=last], &values[first..=last]) > most * spread
            })
        };
        let mut needed = vec![];
        for first in (0..self.len()).step_by(stride) {
            needed.push(first);
            let last = first + stride;
            if stride > 1 && last < self.len() && is_bent(first, last) {
                needed.extend(first + 1..last);
            }
        }
        needed
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Opening of one cylinder's valve at each sample, m².
    pub fn orifice_area(&self, cylinder: usize) -> &[f64] {
        &self.orifice_area[cylinder].1
    }

    /// Sets the opening of one cylinder's valve at one sample, m²: for interactive simulations.
    pub fn set_orifice_area(&mut self, cylinder: usize, sample: usize, area: f64) {
        self.orifice_area[cylinder].1[sample] = area;
    }

    /// Puts readings, wherever there are any, in the place of the estimates of opening and tank pressure that they were averaged to:
    /// for regressions on the signals as they were measured.
    #[must_use]
    pub fn with_readings(mut self, model: &Model, recording: &Recording) -> Self {
        let put = |estimate: &mut [f64], readings: &[f64]| {
            for (estimate, &reading) in estimate.iter_mut().zip(readings).filter(|(_, reading)| reading.is_finite()) {
                *estimate = reading;
            }
        };
        for ((_, opening), cylinder) in self.orifice_area.iter_mut().zip(&model.machine.cylinders) {
            if let Ok(signals) = recording.cylinder(&cylinder.name) {
                put(opening, &signals.orifice_area);
            }
        }
        put(&mut self.tank_pressure, &recording.tank_pressure);
        self
    }

    /// Supply pressure at each sample, Pa; zero if the pump line's pressure is a state of the model.
    pub fn supply_pressure(&self) -> &[f64] {
        &self.supply_pressure
    }

    /// Tank pressure at each sample, Pa.
    pub fn tank_pressure(&self) -> &[f64] {
        &self.tank_pressure
    }

    /// Whether all inputs are straight from sample `first` to sample `last`: lines within a small fraction of the resolution of
    /// good sensors, held inputs without any change. An imposed motion never counts as straight: its acceleration acts as a
    /// force, so every sample of it matters.
    pub fn is_straight(&self, first: usize, last: usize) -> bool {
        let (start, duration) = (self.time[first], self.time[last] - self.time[first]);
        let straight_rate = STRAIGHT_RATE * self.size.factor(Growth::OPENING) / self.size.time();
        let near_line = |values: &[f64], most: f64| {
            let slope = (values[last] - values[first]) / duration;
            (first + 1..last)
                .all(|index| (values[index] - values[first] - slope * (self.time[index] - start)).abs() <= most)
        };
        self.orifice_area.iter().all(|(interpolation, values)| match interpolation {
            // A change of sign opens another edge of the valve.
            Interpolation::Linear => {
                near_line(values, STRAIGHT_AREA * self.size.factor(Growth::OPENING))
                    && !changes_sign(&values[first..=last])
            }
            Interpolation::Hold => values[first + 1..last].iter().all(|&value| value == values[first]),
        }) && self.orifice_rate.iter().flatten().all(|rates| {
            // Includes the previous interval, whose rate counts at the first sample.
            rates[first.saturating_sub(1)..=last].iter().all(|rate| (rate - rates[first]).abs() <= straight_rate)
        }) && self.imposed.iter().all(Option::is_none)
            && self.rod_force.iter().all(|values| near_line(values, STRAIGHT_FORCE * self.size.factor(Growth::FORCE)))
            && near_line(&self.supply_pressure, STRAIGHT_PRESSURE)
            && near_line(&self.tank_pressure, STRAIGHT_PRESSURE)
            && near_line(&self.pump_flow, STRAIGHT_FLOW * self.size.factor(Growth::FLOW))
            && near_line(&self.oil_temperature, STRAIGHT_TEMPERATURE)
    }

    /// Inputs at the first sample.
    pub fn at_start(&self) -> Inputs<f64> {
        let mut inputs = Inputs::zero(self.orifice_area.len());
        self.between(0, 0.0, &mut inputs);
        inputs
    }

    /// Inputs at `fraction` (0 to 1) of the way from sample `index` to the next, into `inputs`.
    pub fn between(&self, index: usize, fraction: f64, inputs: &mut Inputs<f64>) {
        let next = (index + 1).min(self.time.len().saturating_sub(1));
        // Exactly the next sample's value at the end, so that an integrator can detect that there is no jump.
        let line = |values: &[f64]| {
            if fraction < 1.0 { values[index] + fraction * (values[next] - values[index]) } else { values[next] }
        };
        for (slot, (interpolation, values)) in inputs.orifice_area.iter_mut().zip(&self.orifice_area) {
            *slot = match interpolation {
                Interpolation::Linear => line(values),
                Interpolation::Hold => values[index],
            };
        }
        for (slot, rates) in inputs.orifice_rates.iter_mut().zip(&self.orifice_rate) {
            if let Some(rates) = rates {
                let [before, here, after] =
                    [index.saturating_sub(1), index, next.min(rates.len() - 1)].map(|i| rates[i]);
                let between =
                    |start: f64, end: f64| if fraction < 1.0 { start + fraction * (end - start) } else { end };
                *slot = [between(before, here), between(here, after)];
            }
        }
        for (slot, values) in inputs.rod_force.iter_mut().zip(&self.rod_force) {
            *slot = line(values);
        }
        for (slot, motion) in inputs.imposed.iter_mut().zip(&self.imposed) {
            if let Some(motion) = motion {
                *slot = motion.each(|values| line(values));
            }
        }
        inputs.time = line(&self.time);
        inputs.supply_pressure = line(&self.supply_pressure);
        inputs.tank_pressure = line(&self.tank_pressure);
        inputs.pump_flow = line(&self.pump_flow);
        inputs.oil_temperature = line(&self.oil_temperature);
    }
}

fn changes_sign(values: &[f64]) -> bool {
    values.iter().any(|&value| value > 0.0) && values.iter().any(|&value| value < 0.0)
}

fn reads_input_rate(model: &Model, cylinder: usize) -> bool {
    model.effects.iter().any(|effect| effect.site == Site::Cylinder(cylinder) && effect.physics.reads_input_rate())
}

/// Rates between neighbouring samples, with the last one repeated to match the number of samples.
fn secants(time: &[f64], values: &[f64]) -> Vec<f64> {
    let mut rates: Vec<f64> =
        time.windows(2).zip(values.windows(2)).map(|(t, v)| (v[1] - v[0]) / (t[1] - t[0])).collect();
    rates.push(rates.last().copied().unwrap_or(0.0));
    rates
}

/// Interpolation and values of the opening: the spool estimate if there is a sensor, otherwise the command; `None` without
/// either.
fn orifice_input(signals: &CylinderSignals, time: &[f64]) -> Option<(Interpolation, Vec<f64>)> {
    if is_measured(&signals.orifice_area) {
        return without_holes(time, &signals.orifice_area).map(|measured| {
            let spool = spool_estimate(time, &measured, &command_or_closed(&signals.orifice_command));
            (Interpolation::Linear, spool)
        });
    }
    is_measured(&signals.orifice_command).then(|| (Interpolation::Hold, command_or_closed(&signals.orifice_command)))
}

/// Commanded openings, m². Before the first command the valve counts as closed.
fn command_or_closed(command: &[f64]) -> Vec<f64> {
    command.iter().map(|&area| if area.is_finite() { area } else { 0.0 }).collect()
}

/// Half width of the mean over tank pressure, in samples. The tank line is short and open, so its pressure changes slowly, while
/// its sensor's noise would enter every flow to tank at small pressure drops.
const TANK_HALF_WIDTH: usize = 10;

fn smoothed(values: &[f64]) -> Vec<f64> {
    let mut sums = Vec::with_capacity(values.len() + 1);
    let mut sum = 0.0;
    sums.push(sum);
    for value in values {
        sum += value;
        sums.push(sum);
    }
    (0..values.len())
        .map(|index| {
            let half = TANK_HALF_WIDTH.min(index).min(values.len() - 1 - index);
            (sums[index + half + 1] - sums[index - half]) / (2 * half + 1) as f64
        })
        .collect()
}
