//! Whole trajectories: the state at every sample, with steps that may span several samples.
//!
//! Where inputs are straight over a few samples, one step of the integrator spans all of them. The samples in between
//! come from the cubic through both ends and their rates, which has the order of the integrator itself. The rate of a
//! stiff pressure depends more on its distance from equilibrium than on its course over the step. So the curvature from
//! the rates passes through the step's own linearly implicit operator, which keeps slow components and removes the fast
//! ones.

use super::integrator::{GAMMA, Integrator};
use super::{InputSignals, SimulationError};

/// Samples that one step may span. The largest step is 5 ms; above 1.6 kHz other costs dominate.
const MOST_SAMPLES: usize = 8;

/// Factor by which the error of a long step must be smaller than that of a single sample. Many small steps are more
/// accurate than their tolerance, because even the error of the largest one is rarely at its limit; long ones are not.
const STRICTER: f64 = 4.0;

/// Largest deviation of a state's course from a straight line in the middle of a long step, in units of the tolerance.
/// The curvature of an arm's own oscillation is about one. Where a chamber leaves cavitation or a piston leaves an end
/// stop, the course has a corner that no cubic can follow.
const MOST_BEND: f64 = 5.0;

/// Cubic course of a state over one step.
#[derive(Debug)]
struct Course {
    start: Vec<f64>,
    start_rates: Vec<f64>,
    /// Contribution of the rates at both ends to the course, in addition to the secant over the step, in units of the
    /// state.
    bend: [Vec<f64>; 2],
    between: Vec<f64>,
}

impl Integrator<'_, '_> {
    /// Advances `state` from the first sample of `signals` to the last and calls `visit` with every sample's number and
    /// state. Steps are as long as tolerances and the straightness of the inputs allow ([`InputSignals::is_straight`]).
    ///
    /// # Errors
    /// [`SimulationError`] if the solution cannot be continued.
    pub fn follow(
        &mut self,
        signals: &InputSignals,
        state: &mut [f64],
        mut visit: impl FnMut(usize, &[f64]),
    ) -> Result<(), SimulationError> {
        let zeros = vec![0.0; state.len()];
        let mut course = Course {
            start: zeros.clone(),
            start_rates: zeros.clone(),
            bend: [zeros.clone(), zeros.clone()],
            between: zeros,
        };
        if signals.is_empty() {
            return Ok(());
        }
        visit(0, state);
        let mut index = 0;
        while index + 1 < signals.len() {
            let last = self.straight_end(signals, index);
            let end = if last > index + 1 && self.step_over(signals, index, last, state, &mut course) {
                last
            } else {
                self.advance(signals, index, state, None)?;
                index + 1
            };
            let duration = signals.time[end] - signals.time[index];
            for passed in index + 1..end {
                visit(passed, course.at((signals.time[passed] - signals.time[index]) / duration, state));
            }
            visit(end, state);
            index = end;
        }
        Ok(())
    }

    /// The farthest sample that one step may reach from sample `index`.
    fn straight_end(&self, signals: &InputSignals, index: usize) -> usize {
        let longest = self.next_step();
        let mut end = index + 1;
        while end + 1 < signals.len()
            && end - index < MOST_SAMPLES
            && signals.time[end + 1] - signals.time[index] <= longest
            && signals.is_straight(index, end + 1)
        {
            end += 1;
        }
        end
    }

    /// One step from sample `index` to sample `end`; returns whether it was accurate enough. If not, `state` stays
    /// unchanged.
    fn step_over(
        &mut self,
        signals: &InputSignals,
        index: usize,
        end: usize,
        state: &mut [f64],
        course: &mut Course,
    ) -> bool {
        let step = signals.time[end] - signals.time[index];
        signals.between(index, 0.0, &mut self.inputs);
        self.linearise(state);
        signals.between(end - 1, 1.0, &mut self.later_inputs);
        let error = STRICTER * self.attempt(state, step);
        if !self.judge(error, step) {
            return false;
        }
        course.start.copy_from_slice(state);
        course.start_rates.copy_from_slice(&self.linearisation.rates);
        state.copy_from_slice(&self.trial);
        // The end of this step is the start of the next one, unless an input jumps there.
        std::mem::swap(&mut self.inputs, &mut self.later_inputs);
        self.linearise(state);
        for (bend, rates) in course.bend.iter_mut().zip([&course.start_rates, &self.linearisation.rates]) {
            for (slot, ((rate, now), before)) in bend.iter_mut().zip(rates.iter().zip(&*state).zip(&course.start)) {
                *slot = (step * rate - (now - before)) / (GAMMA * step);
            }
            self.factors.solve(bend);
        }
        let corner = (0..state.len()).any(|index| {
            let bend = (course.bend[0][index] - course.bend[1][index]) / 8.0;
            bend.abs() > MOST_BEND * self.scale(index, state[index])
        });
        if corner {
            state.copy_from_slice(&course.start);
        }
        !corner
    }
}

impl Course {
    /// The state at `fraction` (0 to 1) of the step that ended in `end`.
    fn at(&mut self, fraction: f64, end: &[f64]) -> &[f64] {
        let rest = 1.0 - fraction;
        let [first, last] = &self.bend;
        for (index, slot) in self.between.iter_mut().enumerate() {
            let bend = rest * first[index] - fraction * last[index];
            *slot = rest * self.start[index] + fraction * end[index] + fraction * rest * bend;
        }
        &self.between
    }
}
