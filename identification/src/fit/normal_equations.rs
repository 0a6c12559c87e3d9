//! Normal equations of one segment with its initial state eliminated.

use excavator_model::equations::{Channel, System};
use excavator_model::machine::{Growth, Mechanism};
use excavator_model::simulation::{Integrator, Observer, Sensitivity, SimulationError, Tolerances};
use nalgebra::{DMatrix, DVector};

use super::reading_rows::ReadingRows;
use super::{InitialStates, Instrument, Segment, SegmentedRecording};

/// Sums over one segment, for parameters and its own initial state.
#[derive(Debug, Clone)]
pub(super) struct SegmentSums {
    /// J' J of the parameters after eliminating the initial state.
    pub information: DMatrix<f64>,
    /// J' r of the parameters after eliminating the initial state.
    pub gradient: DVector<f64>,
    /// Sum of squared errors of each instrument, in its unit.
    pub squared_errors: Vec<f64>,
    /// Number of readings of each instrument.
    pub counts: Vec<usize>,
    /// J' r of each block of the segment, after eliminating the initial state. They sum to the gradient.
    pub block_gradients: Vec<DVector<f64>>,
    /// Sum of squared errors and number of readings of each instrument in each block.
    pub block_errors: Vec<Vec<(f64, usize)>>,
    /// Penalty that keeps the initial state near where it was measured.
    pub prior_loss: f64,
    state_information: DMatrix<f64>,
    cross_information: DMatrix<f64>,
    state_gradient: DVector<f64>,
}

/// Sums over one segment, kept separately by instrument, so that instruments can be reweighted without another
/// simulation. Errors are in units of each instrument's noise; the initial state is still among the columns.
#[derive(Debug, Clone)]
pub(super) struct RawSums {
    fitted: usize,
    information: Vec<DMatrix<f64>>,
    /// By block, then by instrument.
    blocks: Vec<Vec<DVector<f64>>>,
    prior_information: DVector<f64>,
    prior_gradient: DVector<f64>,
    squared_errors: Vec<f64>,
    counts: Vec<usize>,
    block_errors: Vec<Vec<(f64, usize)>>,
    prior_loss: f64,
}

/// Length of the blocks whose gradients are taken as independent in standard errors, s. It is longer than any
/// correlation of an arm's errors except drift, and short enough for many blocks. Like all times here, it is for a
/// machine of the reference size.
pub(super) const BLOCK_DURATION: f64 = 0.5;

/// Readings this soon after the start of a segment are not compared, s. A delayed instrument would report what happened
/// before the start, which the simulation does not know. They are left out for every model, so that all models are
/// judged on the same readings.
const SETTLING: f64 = 0.03;

/// Factor on the spread of initial states that are as measured: small beside any state, and large beside rounding.
const HELD: f64 = 1e-5;

/// How far an initial state may be from the estimate from the first samples. Where states are fitted, the prior is weak: it only
/// decides where nothing is measured.
#[derive(Debug, Clone)]
pub(super) struct InitialStatePrior {
    /// Standard deviation of each state.
    pub spread: Vec<f64>,
}

impl InitialStatePrior {
    pub fn of(system: &System<'_>, initial_states: InitialStates) -> Self {
        let layout = system.layout();
        let machine = &system.model().machine;
        let size = machine.size();
        // Angles do not scale with the size of the machine.
        let [joint_spread, rate_spread] = match machine.mechanism {
            Mechanism::LinearLoad => [0.01 * size.factor(Growth::LENGTH), 0.5 * size.speed],
            _ => [0.01, 0.5 / size.time()],
        };
        let mut spread = vec![2e5; layout.len];
        for joint in 0..layout.joints {
            spread[layout.joint(joint)] = joint_spread;
            spread[layout.rate(joint)] = rate_spread;
        }
        for (state, scale) in system.state_scales() {
            spread[state] = 0.1 * scale;
        }
        if initial_states == InitialStates::Measured {
            spread.iter_mut().for_each(|spread| *spread *= HELD);
        }
        InitialStatePrior { spread }
    }
}

/// Data that all segments of a fit share.
pub(super) struct Shared<'a, 'm> {
    pub system: &'a System<'m>,
    pub parameters: &'a [f64],
    /// Indices of the parameters that are fitted.
    pub fitted: &'a [usize],
    /// Scale of each fitted parameter. Sums are for `parameter / scale`.
    pub scales: &'a [f64],
    pub instruments: &'a [Instrument],
    pub prior: &'a InitialStatePrior,
    pub tolerances: Tolerances,
}

impl Shared<'_, '_> {
    /// Simulates a segment and sums its normal equations. The prior is centred on the state `anchor`.
    pub fn sums(
        &self,
        recording: &SegmentedRecording,
        segment: &Segment,
        anchor: &[f64],
    ) -> Result<RawSums, SimulationError> {
        let states = segment.state.len();
        let fitted = self.fitted.len();
        let columns = fitted + states;
        let mut integrator = Integrator::new(self.system, self.parameters, self.fitted, self.tolerances);
        let mut sensitivity = Sensitivity::at_start(self.system, self.fitted);
        let channels: Vec<Channel> = self.instruments.iter().map(|instrument| instrument.channel).collect();
        let mut observer = Observer::new(self.system, self.parameters, self.fitted, &channels);
        let mut state = segment.state.clone();
        let mut information = vec![DMatrix::<f64>::zeros(columns, columns); self.instruments.len()];
        let mut squared_errors = vec![0.0; self.instruments.len()];
        let mut counts = vec![0; self.instruments.len()];
        let signals: Vec<&[f64]> = self
            .instruments
            .iter()
            .map(|instrument| recording.recording.signal(&instrument.name).unwrap_or(&[]))
            .collect();
        let scales: Vec<f64> = self.scales.iter().copied().chain(std::iter::repeat_n(1.0, states)).collect();
        let mut rows: Vec<ReadingRows> = self.instruments.iter().map(|_| ReadingRows::new(columns)).collect();
        let mut blocks: Vec<Vec<DVector<f64>>> = Vec::new();
        let mut block_errors: Vec<Vec<(f64, usize)>> = Vec::new();
        let start = recording.recording.time[segment.first];
        let time_scale = self.system.model().machine.size().time();
        let (block_duration, settling) = (BLOCK_DURATION * time_scale, SETTLING * time_scale);
        for index in segment.first..=segment.last {
            let block = ((recording.recording.time[index] - start) / block_duration) as usize;
            if block >= blocks.len() {
                add_rows(&mut rows, &mut information, &mut blocks);
                while blocks.len() <= block {
                    blocks.push(vec![DVector::zeros(columns); self.instruments.len()]);
                    block_errors.push(vec![(0.0, 0); self.instruments.len()]);
                }
            }
            let is_compared = recording.compared[index] && recording.recording.time[index] >= start + settling;
            if is_compared || observer.looks_back() {
                observer.observe(&recording.inputs, index, &state, Some(&sensitivity));
            }
            for (number, instrument) in self.instruments.iter().enumerate().filter(|_| is_compared) {
                let measured = signals[number].get(index).copied().unwrap_or(f64::NAN);
                if !measured.is_finite() {
                    continue;
                }
                let error = measured - observer.readings()[number];
                squared_errors[number] += error * error;
                counts[number] += 1;
                block_errors[block][number].0 += error * error;
                block_errors[block][number].1 += 1;
                let weight = 1.0 / instrument.noise;
                let slopes = observer.gradients().row(number);
                let scaled = slopes.iter().zip(&scales).map(|(slope, scale)| slope * scale * weight);
                rows[number].push(scaled, error * weight);
                if rows[number].is_full() {
                    rows[number].add_to(&mut information[number], &mut blocks[block][number]);
                }
            }
            if index < segment.last {
                integrator.advance(&recording.inputs, index, &mut state, Some(&mut sensitivity))?;
            }
        }
        add_rows(&mut rows, &mut information, &mut blocks);
        let mut prior_loss = 0.0;
        let mut prior_information = DVector::zeros(states);
        let mut prior_gradient = DVector::zeros(states);
        for index in 0..states {
            let inverse = 1.0 / (self.prior.spread[index] * self.prior.spread[index]);
            let away = anchor[index] - segment.state[index];
            prior_information[index] = inverse;
            prior_gradient[index] = away * inverse;
            prior_loss += away * away * inverse;
        }
        Ok(RawSums {
            fitted,
            information,
            blocks,
            prior_information,
            prior_gradient,
            squared_errors,
            counts,
            block_errors,
            prior_loss,
        })
    }
}

/// Adds the rows gathered by the instruments to the sums, and their gradients to the last block.
fn add_rows(rows: &mut [ReadingRows], information: &mut [DMatrix<f64>], blocks: &mut [Vec<DVector<f64>>]) {
    let Some(block) = blocks.last_mut() else { return };
    for ((rows, information), gradient) in rows.iter_mut().zip(information).zip(block) {
        rows.add_to(information, gradient);
    }
}

impl RawSums {
    /// Sum of squared errors of each instrument, in its unit.
    pub fn squared_errors(&self) -> &[f64] {
        &self.squared_errors
    }

    /// Number of readings of each instrument.
    pub fn counts(&self) -> &[usize] {
        &self.counts
    }

    /// Adds each instrument's squared errors, in its unit, as predicted after these steps for readings that are linear
    /// in the scaled parameters and the initial state.
    pub fn add_predicted(
        &self,
        parameter_step: &DVector<f64>,
        state_step: &DVector<f64>,
        noise: &[f64],
        squares: &mut [f64],
    ) {
        let (fitted, states) = (self.fitted, state_step.len());
        let mut step = DVector::zeros(fitted + states);
        step.rows_mut(0, fitted).copy_from(parameter_step);
        step.rows_mut(fitted, states).copy_from(state_step);
        for (number, slot) in squares.iter_mut().enumerate() {
            let gradient: f64 = self.blocks.iter().map(|block| block[number].dot(&step)).sum();
            let curvature = step.dot(&(&self.information[number] * &step));
            *slot += self.squared_errors[number] + noise[number] * noise[number] * (curvature - 2.0 * gradient);
        }
    }

    /// The sums with each instrument's contribution multiplied by its factor and the initial state eliminated.
    pub fn weighed(&self, factors: &[f64]) -> SegmentSums {
        let (fitted, states) = (self.fitted, self.prior_gradient.len());
        let mut information = DMatrix::zeros(fitted + states, fitted + states);
        for (own, factor) in self.information.iter().zip(factors) {
            information += own * *factor;
        }
        let blocks: Vec<DVector<f64>> = self
            .blocks
            .iter()
            .map(|block| {
                let mut sum = DVector::zeros(fitted + states);
                for (own, factor) in block.iter().zip(factors) {
                    sum += own * *factor;
                }
                sum
            })
            .collect();
        let mut gradient = DVector::zeros(fitted + states);
        for block in &blocks {
            gradient += block;
        }
        for index in 0..states {
            information[(fitted + index, fitted + index)] += self.prior_information[index];
            gradient[fitted + index] += self.prior_gradient[index];
        }
        let mut sums = SegmentSums::eliminate(fitted, &information, &gradient, &blocks, self.prior_loss);
        sums.squared_errors.clone_from(&self.squared_errors);
        sums.counts.clone_from(&self.counts);
        sums.block_errors.clone_from(&self.block_errors);
        sums
    }
}

impl SegmentSums {
    /// Sums without readings, for prior knowledge.
    pub fn without_readings(
        information: DMatrix<f64>,
        gradient: DVector<f64>,
        block_gradients: Vec<DVector<f64>>,
        prior_loss: f64,
        instruments: usize,
    ) -> Self {
        let fitted = gradient.len();
        SegmentSums {
            information,
            gradient,
            squared_errors: vec![0.0; instruments],
            counts: vec![0; instruments],
            block_gradients,
            block_errors: Vec::new(),
            prior_loss,
            state_information: DMatrix::zeros(0, 0),
            cross_information: DMatrix::zeros(0, fitted),
            state_gradient: DVector::zeros(0),
        }
    }

    fn eliminate(
        fitted: usize,
        information: &DMatrix<f64>,
        gradient: &DVector<f64>,
        blocks: &[DVector<f64>],
        prior_loss: f64,
    ) -> Self {
        let states = gradient.len() - fitted;
        let state_information = information.view((fitted, fitted), (states, states)).into_owned();
        let cross_information = information.view((fitted, 0), (states, fitted)).into_owned();
        let state_gradient = gradient.rows(fitted, states).into_owned();
        let mut sums = SegmentSums {
            information: information.view((0, 0), (fitted, fitted)).into_owned(),
            gradient: gradient.rows(0, fitted).into_owned(),
            squared_errors: Vec::new(),
            counts: Vec::new(),
            block_errors: Vec::new(),
            block_gradients: blocks.iter().map(|block| block.rows(0, fitted).into_owned()).collect(),
            prior_loss,
            state_information,
            cross_information,
            state_gradient,
        };
        if let Some(factor) = sums.state_information.clone().cholesky() {
            sums.information -= sums.cross_information.transpose() * factor.solve(&sums.cross_information);
            sums.gradient -= sums.cross_information.transpose() * factor.solve(&sums.state_gradient);
            for (reduced, block) in sums.block_gradients.iter_mut().zip(blocks) {
                let states = block.rows(fitted, states).into_owned();
                *reduced -= sums.cross_information.transpose() * factor.solve(&states);
            }
        }
        sums
    }

    /// The change of the initial state for a change of the (scaled) parameters, damped by `damping`.
    pub fn state_step(&self, parameter_step: &DVector<f64>, damping: f64) -> DVector<f64> {
        let right = &self.state_gradient - &self.cross_information * parameter_step;
        let mut matrix = self.state_information.clone();
        for index in 0..matrix.nrows() {
            matrix[(index, index)] *= 1.0 + damping;
        }
        matrix.cholesky().map_or_else(|| DVector::zeros(right.len()), |factor| factor.solve(&right))
    }
}
