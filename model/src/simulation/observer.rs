//! Instrument readings along a trajectory, with derivatives.

use std::collections::VecDeque;

use nalgebra::DMatrix;

use super::{InputSignals, Sensitivity};
use crate::equations::{Channel, Distortion, Inputs, System, Workspace};
use crate::recording::Recording;
use crate::scalar::{Dual, constant, derivative, variable};

/// Instruments of a simulated model. From the states at successive samples, it computes the reading of each instrument,
/// and its dependence on parameters and initial states.
///
/// A delayed instrument reports the past, so an observer stores the trajectory over the longest delay. Between samples
/// it uses the cubic with the trajectory's values and rates at both ends (Hermite), whose slope is also the derivative
/// with respect to the delay. Sensitivities are interpolated linearly. Before the start of a trajectory, the initial
/// state applies.
#[derive(Debug, Clone)]
pub struct Observer<'m, 's> {
    system: &'s System<'m>,
    parameters: Vec<f64>,
    instruments: Vec<Instrument>,
    longest_delay: f64,
    past: VecDeque<Snapshot>,
    readings: Vec<f64>,
    gradients: DMatrix<f64>,
    workspace: Workspace<'m, f64>,
    inputs: Inputs<f64>,
    rates: Vec<f64>,
}

/// One instrument with the derivatives of its distortion.
#[derive(Debug, Clone)]
struct Instrument {
    channel: Channel,
    distortion: Distortion<f64>,
    /// Column of the sensitivities, derivative of the offset, derivative of the delay; entries that are zero are
    /// omitted.
    slopes: Vec<(usize, f64, f64)>,
}

/// True values at one sample, channel by channel.
#[derive(Debug, Clone)]
struct Snapshot {
    time: f64,
    values: Vec<f64>,
    /// Their time derivatives.
    slopes: Vec<f64>,
    /// Their derivatives with respect to parameters and initial states, channels by columns; empty without
    /// sensitivities.
    gradients: DMatrix<f64>,
}

impl<'m, 's> Observer<'m, 's> {
    /// Instruments of `channels` of a system with these parameter values (in the model's order).
    /// `sensitivity_parameters` are the indices of the parameters that [`Sensitivity`] has columns for; empty if none.
    pub fn new(
        system: &'s System<'m>,
        parameters: &[f64],
        sensitivity_parameters: &[usize],
        channels: &[Channel],
    ) -> Self {
        let plain = system.instruments(parameters);
        let mut instruments: Vec<Instrument> = channels
            .iter()
            .map(|&channel| Instrument { channel, distortion: plain.of(channel), slopes: Vec::new() })
            .collect();
        let mut lifted: Vec<Dual> = parameters.iter().map(|&value| constant(value)).collect();
        for (column, &parameter) in sensitivity_parameters.iter().enumerate() {
            lifted[parameter] = variable(parameters[parameter], 0);
            let dual = system.instruments(&lifted);
            lifted[parameter] = constant(parameters[parameter]);
            for instrument in &mut instruments {
                let Distortion { offset, delay } = dual.of(instrument.channel);
                let (offset, delay) = (derivative(&offset, 0), derivative(&delay, 0));
                if offset != 0.0 || delay != 0.0 {
                    instrument.slopes.push((column, offset, delay));
                }
            }
        }
        Observer {
            system,
            parameters: parameters.to_vec(),
            longest_delay: instruments.iter().map(|instrument| instrument.distortion.delay).fold(0.0, f64::max),
            past: VecDeque::new(),
            readings: vec![f64::NAN; instruments.len()],
            gradients: DMatrix::zeros(instruments.len(), 0),
            workspace: system.workspace(),
            inputs: Inputs::zero(system.layout().joints),
            rates: vec![0.0; system.layout().len],
            instruments,
        }
    }

    /// Instrument readings, in the order of the channels, at the last sample observed.
    pub fn readings(&self) -> &[f64] {
        &self.readings
    }

    /// Derivatives of the readings at the last sample observed: channels by the columns of the sensitivity.
    pub fn gradients(&self) -> &DMatrix<f64> {
        &self.gradients
    }

    /// Whether an instrument is delayed: then samples without a reading must be observed too.
    pub fn looks_back(&self) -> bool {
        self.instruments.iter().any(Instrument::has_delay)
    }

    /// Adds the state at sample `index` of `signals`, and its sensitivity if derivatives are required. Samples of one
    /// trajectory must be in order.
    pub fn observe(
        &mut self,
        signals: &InputSignals,
        index: usize,
        state: &[f64],
        sensitivity: Option<&Sensitivity>,
    ) -> &[f64] {
        let columns = sensitivity.map_or(0, Sensitivity::width);
        if self.gradients.ncols() != columns {
            self.gradients = DMatrix::zeros(self.instruments.len(), columns);
        }
        if self.looks_back() {
            self.remember(signals, index, state, sensitivity);
        }
        for (row, instrument) in self.instruments.iter().enumerate() {
            let Distortion { offset, delay } = instrument.distortion;
            let late = instrument.has_delay() && !self.past.is_empty();
            let slope = if late {
                let (value, slope) = recall(&self.past, row, signals.time[index] - delay, &mut self.gradients);
                self.readings[row] = value + offset;
                slope
            } else {
                self.readings[row] = instrument.channel.value(self.system, state) + offset;
                if let Some(sensitivity) = sensitivity {
                    gradient(self.system, instrument.channel, state, sensitivity, row, &mut self.gradients);
                }
                0.0
            };
            for &(column, by_offset, by_delay) in instrument.slopes.iter().filter(|(column, ..)| *column < columns) {
                self.gradients[(row, column)] += by_offset - slope * by_delay;
            }
        }
        &self.readings
    }

    /// Adds the state at sample `index` and writes the instrument readings to that sample of a recording.
    pub fn record(&mut self, signals: &InputSignals, index: usize, state: &[f64], recording: &mut Recording) {
        self.observe(signals, index, state, None);
        let machine = &self.system.model().machine;
        for (instrument, reading) in self.instruments.iter().zip(&self.readings) {
            if let Some(values) = instrument.channel.signal_mut(machine, recording) {
                values[index] = *reading;
            }
        }
    }

    /// Adds a snapshot and drops those that no instrument needs.
    fn remember(&mut self, signals: &InputSignals, index: usize, state: &[f64], sensitivity: Option<&Sensitivity>) {
        let time = signals.time[index];
        signals.between(index, 0.0, &mut self.inputs);
        self.system.rates(&mut self.workspace, &self.parameters, state, &self.inputs, &mut self.rates);
        let moving: Vec<Dual> =
            state.iter().zip(&self.rates).map(|(&value, &rate)| constant(value) + variable(0.0, 0) * rate).collect();
        let along: Vec<Dual> =
            self.instruments.iter().map(|instrument| instrument.channel.value(self.system, &moving)).collect();
        let mut gradients = DMatrix::zeros(self.instruments.len(), self.gradients.ncols());
        if let Some(sensitivity) = sensitivity {
            for (row, instrument) in self.instruments.iter().enumerate() {
                gradient(self.system, instrument.channel, state, sensitivity, row, &mut gradients);
            }
        }
        while self.past.get(1).is_some_and(|second| second.time <= time - self.longest_delay) {
            self.past.pop_front();
        }
        self.past.push_back(Snapshot {
            time,
            values: along.iter().map(|value| value.re).collect(),
            slopes: along.iter().map(|value| derivative(value, 0)).collect(),
            gradients,
        });
    }
}

impl Instrument {
    /// Whether it has a delay, or would have with another parameter value.
    fn has_delay(&self) -> bool {
        self.distortion.delay != 0.0 || self.slopes.iter().any(|&(_, _, by_delay)| by_delay != 0.0)
    }
}

/// Writes the gradient of a true value to one row of `gradients`.
fn gradient(
    system: &System<'_>,
    channel: Channel,
    state: &[f64],
    sensitivity: &Sensitivity,
    row: usize,
    gradients: &mut DMatrix<f64>,
) {
    let [(a, by_a), (b, by_b)] = channel.gradient(system, state);
    let (of_a, of_b) = (sensitivity.of_state(a), sensitivity.of_state(b));
    gradients.row_mut(row).fill(0.0);
    for (&column, (slope_a, slope_b)) in sensitivity.columns().iter().zip(of_a.iter().zip(of_b)) {
        let mut slope = by_a * slope_a;
        if by_b != 0.0 {
            slope += by_b * slope_b;
        }
        gradients[(row, column)] = slope;
    }
}

/// Value and time derivative of channel `row` at a time in the past; its gradient is written to that row of
/// `gradients`. The past must not be empty.
fn recall(past: &VecDeque<Snapshot>, row: usize, time: f64, gradients: &mut DMatrix<f64>) -> (f64, f64) {
    let after = past.partition_point(|snapshot| snapshot.time <= time);
    if after == 0 {
        gradients.row_mut(row).copy_from(&past[0].gradients.row(row));
        return (past[0].values[row], 0.0);
    }
    let from = &past[after - 1];
    let Some(to) = past.get(after) else {
        // At the present sample, or ahead of it for a negative delay: extrapolates along the rates.
        gradients.row_mut(row).copy_from(&from.gradients.row(row));
        return (from.values[row] + from.slopes[row] * (time - from.time), from.slopes[row]);
    };
    let interval = to.time - from.time;
    let part = (time - from.time) / interval;
    for column in 0..gradients.ncols() {
        let (start, end) = (from.gradients[(row, column)], to.gradients[(row, column)]);
        gradients[(row, column)] = start + part * (end - start);
    }
    let rise = to.values[row] - from.values[row];
    let (start, end) = (from.slopes[row] * interval - rise, rise - to.slopes[row] * interval);
    let bend = start * (1.0 - part) + end * part;
    let value = from.values[row] + part * rise + part * (1.0 - part) * bend;
    let slope = rise + (1.0 - 2.0 * part) * bend + part * (1.0 - part) * (end - start);
    (value, slope / interval)
}
