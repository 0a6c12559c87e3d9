//! The weak form of a model, prepared for terms that it does not have.
//!
//! A term enters an equation through a row: a force, a flow, an opening. The sensitivity of an equation to one unit in
//! a row follows from the model, sample by sample. It is the regressor of a probe, an effect that adds a constant to a
//! row. The regressor of any term is then the product of the probe's regressor and the term's value, so that a thousand
//! terms cost little more than their evaluation.

use excavator_model::Model;
use excavator_model::equations::{Inputs, Situation, System};
use excavator_model::machine::Linkage;
use excavator_model::recording::Recording;
use excavator_model::simulation::undistorted;
use nalgebra::DMatrix;

use super::equation::{Equation, EquationKind, equations};
use super::sensor_noise::sensor_noise;
use super::simulated::simulated;
use super::weak_row::weak_row;
use super::weak_rows::moves;
use super::window::{Window, windows};
use super::{Observation, RegressionError, WeakFormSettings, observe_guided};

/// Rows of the weak form along some recordings, and the data for the regressors of further terms.
pub(crate) struct WeakTerms<'m> {
    /// Equation of each row.
    pub kinds: Vec<EquationKind>,
    /// Residual of each row, in units of its standard deviation from sensor noise.
    pub residuals: Vec<f64>,
    /// Its derivative by each unknown parameter of the model, except those of the probes.
    pub regressors: DMatrix<f64>,
    /// All quantities that a term may use, by recording and by sample.
    pub situations: Vec<Vec<Situation<'m, f64>>>,
    /// Share of the rows that are independent: neighbouring windows overlap.
    pub independent: f64,
    places: Vec<Place>,
    windows: Vec<Vec<Window>>,
    /// For each recording and each equation, in the order of the first: its sensitivity to one unit of each probe, by
    /// sample.
    gains: Vec<Vec<Vec<Vec<f64>>>>,
}

/// Origin of a row.
struct Place {
    recording: usize,
    window: usize,
    equation: usize,
    scale: f64,
}

/// The weak form of `probed`. Its last `probes` effects are probes: each has one parameter, which is zero, for the
/// value that it adds to its row.
///
/// # Errors
/// [`RegressionError`] if a recording lacks inputs.
pub(crate) fn weak_terms<'m>(
    probed: &'m Model,
    probes: usize,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
) -> Result<WeakTerms<'m>, RegressionError> {
    let system = System::new(probed);
    let linkages: Vec<Linkage> = probed.machine.cylinders.iter().map(|cylinder| cylinder.linkage).collect();
    let parameters = probed.parameter_values().len();
    let mut unknown = probed.unknown_parameters();
    unknown.retain(|&index| index < parameters - probes);
    let own = unknown.len();
    unknown.extend(parameters - probes..parameters);
    let (half_width, step) = settings.widths(probed, recordings);
    let mut terms = WeakTerms {
        kinds: Vec::new(),
        residuals: Vec::new(),
        regressors: DMatrix::zeros(0, own),
        situations: Vec::new(),
        independent: step / (2.0 * half_width),
        places: Vec::new(),
        windows: Vec::new(),
        gains: Vec::new(),
    };
    let mut regressors: Vec<f64> = Vec::new();
    for (number, recording) in recordings.iter().enumerate() {
        let noise = sensor_noise(recording, probed)?;
        let truth = undistorted(probed, recording);
        let simulation = simulated(probed, recording, &truth)?;
        let observation = observe_guided(probed, &truth, &simulation.recording)?;
        let mut measured = equations(&system, &observation, &simulation.effect_states, &unknown);
        let windows = windows(&recording.time, recording.sample_interval(), half_width, step);
        for (place, window) in windows.iter().enumerate() {
            for (index, equation) in measured.iter().enumerate() {
                if !moves(equation.kind, window, &observation, settings.velocity_guard) {
                    continue;
                }
                let Some(row) = weak_row(equation, window, &observation, &noise, &linkages, unknown.len()) else {
                    continue;
                };
                let scale = 1.0 / row.noise;
                terms.kinds.push(equation.kind);
                terms.residuals.push(row.residual * scale);
                regressors.extend(row.regressors.iter().take(own).map(|slope| slope * scale));
                terms.places.push(Place { recording: number, window: place, equation: index, scale });
            }
        }
        let gains = |equation: &mut Equation| equation.rest_by_parameter.split_off(own);
        terms.gains.push(measured.iter_mut().map(gains).collect());
        terms.situations.push(situations(&system, &observation, &simulation.effect_states));
        terms.windows.push(windows);
    }
    terms.regressors = DMatrix::from_row_slice(terms.kinds.len(), own, &regressors);
    Ok(terms)
}

/// The situation that effects of `model` act in, at each sample of a recording.
///
/// # Errors
/// [`RegressionError`] if the recording lacks inputs.
pub(crate) fn situations_along<'m>(
    model: &'m Model,
    recording: &Recording,
) -> Result<Vec<Situation<'m, f64>>, RegressionError> {
    let truth = undistorted(model, recording);
    let simulation = simulated(model, recording, &truth)?;
    let observation = observe_guided(model, &truth, &simulation.recording)?;
    Ok(situations(&System::new(model), &observation, &simulation.effect_states))
}

fn situations<'m>(
    system: &System<'m>,
    observation: &Observation,
    effect_states: &[Vec<f64>],
) -> Vec<Situation<'m, f64>> {
    let (model, layout) = (system.model(), system.layout());
    let parameters = model.parameter_values();
    let mut workspace = system.workspace::<f64>();
    let mut inputs = Inputs::<f64>::zero(layout.joints);
    let (mut state, mut rates) = (vec![0.0; layout.len], vec![0.0; layout.len]);
    let mut all = Vec::with_capacity(observation.time.len());
    for sample in 0..observation.time.len() {
        observation.inputs.between(sample, 0.0, &mut inputs);
        observation.set_state(system, sample, effect_states.get(sample), &mut state);
        system.rates(&mut workspace, &parameters, &state, &inputs, &mut rates);
        all.push(workspace.situation.clone());
    }
    all
}

/// Share of the rows in which a term may be unknown, as a velocity is at both ends of a recording.
const MOST_UNKNOWN: f64 = 0.02;

impl WeakTerms<'_> {
    /// The regressor of a term in the row of probe number `probe`. `values` are those of the term, by recording and by
    /// sample. Returns `None` if the term cannot be evaluated in many rows that depend on it.
    pub fn regressor(&self, probe: usize, values: &[Vec<f64>]) -> Option<Vec<f64>> {
        let row = |place: &Place| {
            let gains = &self.gains[place.recording][place.equation][probe];
            if gains.is_empty() {
                return 0.0;
            }
            let window = &self.windows[place.recording][place.window];
            let samples = window.first..window.first + window.weights.len();
            let products = gains[samples.clone()].iter().zip(&values[place.recording][samples]);
            let sum: f64 =
                window.weights.iter().zip(products).map(|([weight, ..], (gain, value))| weight * gain * value).sum();
            -place.scale * sum
        };
        let mut column: Vec<f64> = self.places.iter().map(row).collect();
        let unknown = column.iter().filter(|value| !value.is_finite()).count();
        column.iter_mut().filter(|value| !value.is_finite()).for_each(|value| *value = 0.0);
        (unknown as f64 <= MOST_UNKNOWN * column.len() as f64).then_some(column)
    }
}
