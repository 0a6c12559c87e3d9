//! Whole trajectories: the state at every sample, with steps that may span several samples.
//!
//! Where inputs run straight over a few samples, one step of the integrator carries the state over all of them, and the
//! samples in between come from the cubic through both ends and their rates. That is of the order of the integrator
//! itself. Rates of a stiff pressure tell more of its distance from equilibrium than of its course over the step; so
//! what they say about curvature goes through the step's own linearly implicit operator, which leaves slow components as
//! they are and takes out the fast ones.

use super::integrator::{GAMMA, Integrator};
use super::{InputSignals, SimulationError};

/// Samples that one step may span. The largest step is 5 ms; at more than 1.6 kHz other costs prevail.
const MOST_SAMPLES: usize = 8;

/// How much smaller than a single sample's the error of a long step has to be: many small steps are more exact than
/// their tolerance says, because the largest step hardly ever is at its limit; long ones are not.
const STRICTER: f64 = 4.0;

/// How far from straight, in units of the tolerance, a state's course may be in the middle of a long step. The curvature
/// of an arm's own oscillation comes to about one; where a chamber leaves cavitation or a piston an end stop, the course
/// has a corner that no cubic follows.
const MOST_BEND: f64 = 5.0;

/// Cubic course of a state over one step.
#[derive(Debug)]
struct Course {
    start: Vec<f64>,
    start_rates: Vec<f64>,
    /// What the rates at both ends add to the secant over the step, in units of the state.
    bend: [Vec<f64>; 2],
    between: Vec<f64>,
}

impl Integrator<'_, '_> {
    /// Carries `state` from the first sample of `signals` to the last and calls `visit` with every sample's number and
    /// state. Steps are as long as tolerances and the straightness of the inputs allow ([`InputSignals::is_straight`]).
    ///
    /// # Errors
    /// [`SimulationError`] when the solution cannot be carried on.
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

    /// One step from sample `index` to sample `end`; whether it was exact enough. If not, `state` is left as it was.
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
