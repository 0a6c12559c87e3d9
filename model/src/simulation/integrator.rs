//! A linearly implicit integrator for stiff equations with sampled inputs.
//!
//! Scheme: Rodas3 (Sandu et al., Atmos. Environ. 31 (1997) 3459), four stages, third order, L-stable, with an embedded
//! second-order solution for the error. Chosen over a general solver because a recording's input has a kink at every sample. A
//! multistep or high-order method restarts there. A Rosenbrock step from sample to sample needs one exact Jacobian, one
//! factorisation and three rates, and it never iterates, so friction, closed valves and zero pressure drops cannot prevent
//! convergence. The program `excavator-speed` compares its speed with the solvers of `diffsol`, and `tests/it/reference_solutions.rs` its
//! results with their stored solutions.

use thiserror::Error;

use super::factors::Factors;
use super::sensitivity::Sensitivity;
use super::{InputSignals, Linearisation};
use crate::equations::{Inputs, System, Workspace};
use crate::machine::{Growth, Machine, Mechanism};

/// Why a simulation stopped early.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The step size fell below the minimum.
    #[error("the simulation of {model} stops at {time:.3} s: step {step:.1e} s is below {minimum:.1e} s; {state}")]
    StepTooSmall {
        /// Machine of the model.
        model: String,
        /// Simulated time, s.
        time: f64,
        /// Last rejected step, s.
        step: f64,
        /// Smallest step allowed, s.
        minimum: f64,
        /// The state there, as text.
        state: String,
    },
    /// The steps are so short that the simulation would take hours.
    #[error(
        "the simulation of {model} crawls at {time:.3} s in steps of {step:.1e} s, with {state}; something is far stiffer there than a machine is: look at volumes, masses and the parameters of what acts there"
    )]
    TooSlow {
        /// Machine of the model.
        model: String,
        /// Simulated time, s.
        time: f64,
        /// Step, s.
        step: f64,
        /// The state there, as text.
        state: String,
    },
    /// The state is no longer a number.
    #[error("the simulation of {model} left all bounds at {time:.3} s, with {state}; check its parameters")]
    NotFinite {
        /// Machine of the model.
        model: String,
        /// Simulated time, s.
        time: f64,
        /// The state there, as text.
        state: String,
    },
}

/// Accuracy of a simulation, on a machine of [`crate::machine::Size::REFERENCE`]; the integrator scales it to its machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Relative error per step. 1e-4, because a step's error decays with the dynamics, and the embedded estimate is of second
    /// order while the solution is of third. Compared with 1e-8, trajectories agree within a hundredth of usual sensor noise.
    pub relative: f64,
    /// Absolute error per step of joint coordinates, rad or m: a hundredth of a good displacement sensor's noise.
    pub joint: f64,
    /// Absolute error per step of joint rates, rad/s or m/s.
    pub rate: f64,
    /// Absolute error per step of pressures, Pa: a tenth of a good sensor's noise.
    pub pressure: f64,
    /// Smallest step, s.
    pub minimum_step: f64,
    /// Largest step, s; also limits steps over gaps of the clock. 5 ms, so that a fit takes two steps for each of its samples.
    /// With 6 ms a fit is a quarter faster, but sensitivities are off by a tenth where an opening depends on a pressure.
    pub maximum_step: f64,
    /// Steps per simulated second above which a simulation counts as too slow. 2e4: a fast machine takes 5e3, including closed
    /// valves and end stops. Unrealistic parameters take millions, and a search that meets them must not wait for hours.
    pub most_steps_per_second: f64,
}

/// Steps allowed at once, independent of the simulated time: shocks need several hundred.
const STEPS_AT_ONCE: f64 = 5e4;

impl Default for Tolerances {
    fn default() -> Self {
        Tolerances {
            relative: 1e-4,
            joint: 5e-7,
            rate: 5e-5,
            pressure: 200.0,
            minimum_step: 1e-9,
            maximum_step: 5e-3,
            most_steps_per_second: 2e4,
        }
    }
}

impl Tolerances {
    /// The same, scaled to the size of a machine. Relative errors and pressures stay the same.
    fn for_machine(self, machine: &Machine) -> Self {
        let time = machine.size().time();
        let is_linear = matches!(machine.mechanism, Mechanism::LinearLoad);
        Tolerances {
            joint: if is_linear { self.joint * machine.size().factor(Growth::LENGTH) } else { self.joint },
            rate: if is_linear { self.rate * machine.size().speed } else { self.rate / time },
            minimum_step: self.minimum_step * time,
            maximum_step: self.maximum_step * time,
            most_steps_per_second: self.most_steps_per_second / time,
            ..self
        }
    }

    /// All tolerances scaled by `factor`.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Tolerances {
            relative: self.relative * factor,
            joint: self.joint * factor,
            rate: self.rate * factor,
            pressure: self.pressure * factor,
            // The number of steps grows more slowly than the inverse of the tolerance.
            most_steps_per_second: self.most_steps_per_second / factor,
            ..self
        }
    }
}

/// Advances a state from sample to sample of its inputs.
#[derive(Debug)]
pub struct Integrator<'m, 's> {
    system: &'s System<'m>,
    parameters: Vec<f64>,
    tolerances: Vec<f64>,
    settings: Tolerances,
    workspace: Workspace<'m, f64>,
    pub(super) linearisation: Linearisation<'m>,
    /// State and inputs of `linearisation`; the state is empty before the first linearisation.
    linearised_at: (Vec<f64>, Inputs<f64>),
    pub(super) inputs: Inputs<f64>,
    pub(super) later_inputs: Inputs<f64>,
    pub(super) factors: Factors,
    drift: Vec<f64>,
    stages: [Vec<f64>; 4],
    pub(super) trial: Vec<f64>,
    trial_rates: Vec<f64>,
    step: f64,
    /// Steps left before the simulation stops as too slow.
    allowance: f64,
    /// Steps accepted and rejected so far, for benchmarks.
    pub steps: (usize, usize),
}

/// Diagonal coefficient of Rodas3.
pub(super) const GAMMA: f64 = 0.5;

impl<'m, 's> Integrator<'m, 's> {
    /// An integrator for `system` with these parameter values (in the model's order). `sensitivity_parameters` are the indices of
    /// parameters for which sensitivities will be computed; empty if none.
    pub fn new(
        system: &'s System<'m>,
        parameters: &[f64],
        sensitivity_parameters: &[usize],
        settings: Tolerances,
    ) -> Self {
        let settings = settings.for_machine(&system.model().machine);
        let layout = system.layout();
        let mut tolerances = vec![settings.pressure; layout.len];
        for joint in 0..layout.joints {
            tolerances[layout.joint(joint)] = settings.joint;
            tolerances[layout.rate(joint)] = settings.rate;
        }
        for (state, scale) in system.state_scales() {
            tolerances[state] = 1e-5 * scale;
        }
        let zeros = vec![0.0; layout.len];
        Integrator {
            system,
            parameters: parameters.to_vec(),
            tolerances,
            settings,
            workspace: system.workspace(),
            linearisation: Linearisation::new(system, sensitivity_parameters),
            linearised_at: (Vec::new(), Inputs::zero(layout.joints)),
            inputs: Inputs::zero(layout.joints),
            later_inputs: Inputs::zero(layout.joints),
            factors: Factors::new(layout.len),
            drift: zeros.clone(),
            stages: [zeros.clone(), zeros.clone(), zeros.clone(), zeros],
            trial: vec![0.0; layout.len],
            trial_rates: vec![0.0; layout.len],
            step: settings.maximum_step,
            allowance: STEPS_AT_ONCE,
            steps: (0, 0),
        }
    }

    /// Advances `state` from sample `index` of `signals` to the next one, and `sensitivity` with it.
    ///
    /// # Errors
    /// [`SimulationError`] if the solution cannot be continued.
    pub fn advance(
        &mut self,
        signals: &InputSignals,
        index: usize,
        state: &mut [f64],
        mut sensitivity: Option<&mut Sensitivity>,
    ) -> Result<(), SimulationError> {
        let interval = signals.time[index + 1] - signals.time[index];
        self.allowance = (self.allowance + interval * self.settings.most_steps_per_second).min(STEPS_AT_ONCE);
        let mut done = 0.0;
        while done < interval {
            let left = interval - done;
            let pieces = (left / self.step.min(self.settings.maximum_step)).ceil().max(1.0);
            let step = if pieces <= 1.0 { left } else { left / pieces };
            signals.between(index, done / interval, &mut self.inputs);
            self.linearise(state);
            let end = if pieces <= 1.0 { 1.0 } else { (done + step) / interval };
            signals.between(index, end, &mut self.later_inputs);
            let error = self.attempt(state, step);
            let time = signals.time[index] + done;
            self.allowance -= 1.0;
            if self.allowance < 0.0 {
                let state = self.system.layout().told(self.system.model(), state);
                let model = self.system.model().machine.name.clone();
                return Err(SimulationError::TooSlow { model, time, step, state });
            }
            if !self.judge(error, step) {
                if self.step < self.settings.minimum_step {
                    return Err(self.give_up(time, state));
                }
                continue;
            }
            if let Some(sensitivity) = sensitivity.as_deref_mut() {
                sensitivity.begin(&self.linearisation);
            }
            state.copy_from_slice(&self.trial);
            if let Some(sensitivity) = sensitivity.as_deref_mut() {
                std::mem::swap(&mut self.inputs, &mut self.later_inputs);
                self.linearise(state);
                sensitivity.finish(&self.linearisation, step);
            }
            done = if pieces <= 1.0 { interval } else { done + step };
        }
        Ok(())
    }

    /// The longest step recommended by the error of the last one, s.
    pub(super) fn next_step(&self) -> f64 {
        self.step.min(self.settings.maximum_step)
    }

    /// Decides whether to accept a step of this length and error (in units of the tolerance), and sets the length of the next
    /// one.
    pub(super) fn judge(&mut self, error: f64, step: f64) -> bool {
        let counts = error <= 1.0;
        if counts {
            self.steps.0 += 1;
            let growth = if error > 0.0 { (0.9 * error.powf(-1.0 / 3.0)).clamp(0.3, 4.0) } else { 4.0 };
            self.step = (step * growth).max(self.settings.minimum_step);
        } else {
            self.steps.1 += 1;
            let factor = if error.is_finite() { (0.9 * error.powf(-1.0 / 3.0)).clamp(0.1, 0.7) } else { 0.1 };
            self.step = step * factor;
        }
        counts
    }

    /// Linearises at `state` and `self.inputs`, unless that was the last point. With sensitivities, the end of a step is the
    /// start of the next one, except where inputs jump or the caller sets a state.
    pub(super) fn linearise(&mut self, state: &[f64]) {
        let (known_state, known_inputs) = &mut self.linearised_at;
        if known_state == state && *known_inputs == self.inputs {
            return;
        }
        self.linearisation.evaluate(self.system, &self.parameters, state, &self.inputs);
        known_state.clear();
        known_state.extend_from_slice(state);
        known_inputs.copy_from(&self.inputs);
    }

    /// One Rodas3 step of length `step` from `state` into `self.trial`; returns the error in units of the tolerance.
    pub(super) fn attempt(&mut self, state: &[f64], step: f64) -> f64 {
        let states = state.len();
        self.factors.factorise(1.0 / (GAMMA * step), 1.0, self.linearisation.by_state.as_slice());
        let factors = &self.factors;

        // Drift of the input over the step, as the secant of the rates: exact if rates are linear in the input.
        self.system.rates(&mut self.workspace, &self.parameters, state, &self.later_inputs, &mut self.trial_rates);
        let rates = &self.linearisation.rates;
        let drift = &mut self.drift;
        for ((drift, late), now) in drift.iter_mut().zip(&self.trial_rates).zip(rates) {
            *drift = late - now;
        }

        let [k1, k2, k3, k4] = &mut self.stages;
        for index in 0..states {
            k1[index] = rates[index] + GAMMA * drift[index];
        }
        factors.solve(k1);
        for index in 0..states {
            k2[index] = rates[index] + 1.5 * drift[index] + 4.0 / step * k1[index];
        }
        factors.solve(k2);
        for index in 0..states {
            self.trial[index] = state[index] + 2.0 * k1[index];
        }
        self.system.rates(
            &mut self.workspace,
            &self.parameters,
            &self.trial,
            &self.later_inputs,
            &mut self.trial_rates,
        );
        for index in 0..states {
            k3[index] = self.trial_rates[index] + (k1[index] - k2[index]) / step;
        }
        factors.solve(k3);
        for index in 0..states {
            self.trial[index] = state[index] + 2.0 * k1[index] + k3[index];
        }
        self.system.rates(
            &mut self.workspace,
            &self.parameters,
            &self.trial,
            &self.later_inputs,
            &mut self.trial_rates,
        );
        for index in 0..states {
            k4[index] = self.trial_rates[index] + (k1[index] - k2[index] - 8.0 / 3.0 * k3[index]) / step;
        }
        factors.solve(k4);
        let mut sum = 0.0;
        for index in 0..states {
            self.trial[index] += k4[index];
            let largest = state[index].abs().max(self.trial[index].abs());
            let error = k4[index] / (self.tolerances[index] + self.settings.relative * largest);
            sum += error * error;
        }
        (sum / states as f64).sqrt()
    }

    /// Error tolerance of one state with this value, in the state's unit.
    pub(super) fn scale(&self, index: usize, value: f64) -> f64 {
        self.tolerances[index] + self.settings.relative * value.abs()
    }

    fn give_up(&self, time: f64, state: &[f64]) -> SimulationError {
        let told = self.system.layout().told(self.system.model(), state);
        let model = self.system.model().machine.name.clone();
        if state.iter().all(|value| value.is_finite()) {
            let (step, minimum) = (self.step, self.settings.minimum_step);
            SimulationError::StepTooSmall { model, time, step, minimum, state: told }
        } else {
            SimulationError::NotFinite { model, time, state: told }
        }
    }
}
