//! Builds the rows of the weak form: every equation against every test function, with its instruments.

use excavator_model::Model;
use excavator_model::effects::{Corner, Site};
use excavator_model::equations::System;
use excavator_model::machine::Linkage;
use excavator_model::recording::Recording;
use nalgebra::DVector;

use super::equation::{EquationKind, equations};
use super::seen::Seen;
use super::weak_row::weak_row;
use super::window::{Window, windows};
use super::{Observation, RegressionError, WeakFormSettings, observe};

/// One row, divided by the noise of its residual.
pub(super) struct Row {
    pub kind: EquationKind,
    pub recording: usize,
    pub centre: f64,
    pub residual: f64,
    pub relative: f64,
    pub noise: f64,
    pub regressors: DVector<f64>,
    pub instruments: DVector<f64>,
}

/// The rows of `recordings`; `seen` holds their data for the model.
pub(super) fn rows(
    model: &Model,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
    unknown: &[usize],
    with_instruments: bool,
    seen: &[Seen],
) -> Result<Vec<Row>, RegressionError> {
    let system = System::new(model);
    let linkages: Vec<Linkage> = model.machine.cylinders.iter().map(|cylinder| cylinder.linkage).collect();
    let (half_width, step) = settings.widths(model, recordings);
    let has_stop: Vec<bool> = (0..model.machine.cylinders.len())
        .map(|cylinder| model.has_corner(Corner::EndStop, Site::Cylinder(cylinder)))
        .collect();
    let mut rows = Vec::new();
    for (number, (recording, seen)) in recordings.iter().zip(seen).enumerate() {
        let Seen { noise, observation, simulation } = seen;
        let measured = equations(&system, observation, &simulation.effect_states, unknown);
        let instruments = if with_instruments {
            let observation = observe(model, &simulation.recording)?;
            let equations = equations(&system, &observation, &simulation.effect_states, unknown);
            Some((observation, equations))
        } else {
            None
        };
        for window in windows(&recording.time, recording.sample_interval(), half_width, step) {
            for (index, equation) in measured.iter().enumerate() {
                if !moves(equation.kind, &window, observation, settings.velocity_guard) {
                    continue;
                }
                if let EquationKind::Motion(cylinder) = equation.kind {
                    let inside = window.first..window.first + window.weights.len();
                    let own = &model.machine.cylinders[cylinder];
                    let positions = &observation.cylinders[cylinder].smooth_displacement[inside];
                    if has_stop[cylinder] && positions.iter().any(|position| own.is_at_a_stop(*position)) {
                        continue;
                    }
                }
                let row =
                    |equation, observation| weak_row(equation, &window, observation, noise, &linkages, unknown.len());
                let Some(row_measured) = row(equation, observation) else { continue };
                let instruments = match &instruments {
                    None => row_measured.regressors.clone(),
                    Some((observation, equations)) => match row(&equations[index], observation) {
                        Some(simulated) => simulated.regressors,
                        None => continue,
                    },
                };
                let scale = 1.0 / row_measured.noise;
                rows.push(Row {
                    kind: equation.kind,
                    recording: number,
                    centre: window.centre,
                    residual: row_measured.residual * scale,
                    relative: row_measured.residual / row_measured.size.max(f64::MIN_POSITIVE),
                    noise: row_measured.noise,
                    regressors: row_measured.regressors * scale,
                    instruments: instruments * scale,
                });
            }
        }
    }
    Ok(rows)
}

/// Whether the piston of an equation of motion is known to move throughout a window: near standstill the sign of its velocity is noise.
pub(super) fn moves(kind: EquationKind, window: &Window, observation: &Observation, slowest: f64) -> bool {
    let EquationKind::Motion(cylinder) = kind else { return true };
    let speeds = &observation.cylinders[cylinder].velocity[window.first..window.first + window.weights.len()];
    speeds.iter().all(|speed| speed.abs() > slowest)
}
