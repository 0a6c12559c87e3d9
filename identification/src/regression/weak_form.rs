//! Weak-form regression with instruments from the simulated model.
//!
//! Each equation is multiplied by test functions and integrated by parts, so that no measurement is differentiated
//! (conservation form for chambers). Residuals are linearised in the parameters, which is exact for linear coefficients
//! and a Gauss-Newton step for shape parameters. Instruments are the same regressors on the simulated state, whose errors
//! have nothing to do with sensor noise, so that noise in regressors does not bias the result (`docs/methods.md`).

use excavator_model::Model;
use excavator_model::effects::Kind;
use excavator_model::equations::System;
use excavator_model::machine::Linkage;
use excavator_model::recording::{Recording, noise_level};
use excavator_model::simulation::{Integrator, Tolerances, observed};
use nalgebra::{DMatrix, DVector};

use super::equation::{EquationKind, equations};
use super::solution::{ConditionNumber, condition_numbers};
use super::weak_row::{SensorNoise, weak_row};
use super::window::windows;
use super::{EquationGauge, Regression, RegressionError, observe};
use crate::fit::{FitSettings, SegmentedRecording, standard_deviation};

/// Settings of the weak form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeakFormSettings {
    /// Half width of a test function, s. With instruments the noise in short windows does no harm, while long ones
    /// average the fast transients that tell inertia and compressibility from friction and flow: on measured and
    /// simulated recordings 0.03 s gave the smallest errors of 0.02 s to 0.15 s.
    pub half_width: f64,
    /// Fewest samples in half a window; widens windows of slow recordings, whose quadrature would be coarse.
    pub least_half_width_samples: f64,
    /// Distance between test functions as a fraction of the half width; closer ones add rows but no information.
    pub step_fraction: f64,
    /// Windows of motion equations in which the piston is slower than this, m/s, are left out: there the sign of the
    /// estimated velocity is noise, and dry friction makes a regressor of it.
    pub velocity_guard: f64,
    /// Rounds; the first has no instruments, the others those of the model that the round before found.
    pub rounds: usize,
    /// Whether standard errors and condition numbers are wanted; they cost more than the values.
    pub with_errors: bool,
}

impl Default for WeakFormSettings {
    fn default() -> Self {
        WeakFormSettings {
            half_width: 0.03,
            least_half_width_samples: 12.0,
            step_fraction: 0.25,
            velocity_guard: 1e-3,
            rounds: 3,
            with_errors: true,
        }
    }
}

impl WeakFormSettings {
    /// Half width and step of the windows for these recordings, s.
    fn widths(&self, recordings: &[&Recording]) -> (f64, f64) {
        let slowest = recordings.iter().map(|recording| recording.sample_interval()).fold(0.0, f64::max);
        let half_width = self.half_width.max(self.least_half_width_samples * slowest);
        (half_width, half_width * self.step_fraction)
    }
}

/// One row, divided by what sensor noise puts into its residual.
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

/// Identifies the unknown parameters of `model` from `recordings`, starting from its values.
///
/// # Errors
/// [`RegressionError`].
pub fn weak_form(
    model: &Model,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
) -> Result<Regression, RegressionError> {
    let unknown = model.unknown_parameters();
    let mut model = model.clone();
    let mut result = None;
    for round in 0..settings.rounds.max(1) {
        let rows = rows(&model, recordings, settings, &unknown, round > 0)?;
        let last = round + 1 == settings.rounds.max(1);
        let solution = solve(&model, recordings, settings, &unknown, &rows, settings.with_errors && last)?;
        model = solution.model.clone();
        result = Some(solution);
    }
    result.ok_or(RegressionError::TooFewRows {
        source_name: sources(recordings),
        rows: 0,
        parameters: unknown.len(),
        needed: 1,
    })
}

pub(super) fn sources(recordings: &[&Recording]) -> String {
    recordings.iter().map(|recording| recording.source.as_str()).collect::<Vec<_>>().join(", ")
}

/// The recording as the model would have produced it, simulated piece by piece, and the states of effects along it.
fn simulated(model: &Model, recording: &Recording) -> Result<(Recording, Vec<Vec<f64>>), RegressionError> {
    let system = System::new(model);
    let segmented = SegmentedRecording::new(model, recording, FitSettings::default().segment_duration, f64::INFINITY)?;
    let mut copy = recording.clone();
    let own_states: usize = model.effects.iter().map(|effect| effect.physics.states()).sum();
    let mut effect_states = vec![vec![f64::NAN; own_states]; recording.len()];
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &[], Tolerances::default());
    for segment in &segmented.segments {
        let mut state = segment.state.clone();
        for index in segment.first..=segment.last {
            observed(&system, &state, index, &mut copy);
            if let Some(slot) = effect_states.get_mut(index) {
                slot.copy_from_slice(&state[state.len() - own_states..]);
            }
            if index < segment.last && integrator.advance(&segmented.inputs, index, &mut state, None).is_err() {
                // The rest of the segment stays as measured: worse instruments, but still valid rows.
                break;
            }
        }
    }
    Ok((copy, effect_states))
}

fn sensor_noise(recording: &Recording, model: &Model) -> Result<SensorNoise, RegressionError> {
    // A noiseless (simulated) signal would weigh its rows infinitely; rounding alone is of this size.
    let level = |signal: &[f64]| noise_level(signal).max(1e-6 * standard_deviation(signal)).max(1e-15);
    let mut noise = SensorNoise {
        displacement: vec![],
        pressures: vec![],
        spool: vec![],
        pump_pressure: level(&recording.pump_pressure),
    };
    for cylinder in &model.machine.cylinders {
        let signals = recording.cylinder(&cylinder.name).map_err(excavator_model::SignalError::from)?;
        let lever = cylinder.linkage.lever(cylinder.linkage.joint(0.0)).abs();
        let from_angle = level(&signals.joint_angle) * lever;
        let measured = signals.displacement.iter().any(|value| value.is_finite());
        noise.displacement.push(if measured { level(&signals.displacement) } else { from_angle });
        noise.pressures.push([level(&signals.cap_pressure), level(&signals.rod_pressure)]);
        noise.spool.push(level(&signals.orifice_area));
    }
    Ok(noise)
}

pub(super) fn rows(
    model: &Model,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
    unknown: &[usize],
    with_instruments: bool,
) -> Result<Vec<Row>, RegressionError> {
    let system = System::new(model);
    let linkages: Vec<Linkage> = model.machine.cylinders.iter().map(|cylinder| cylinder.linkage).collect();
    let (half_width, step) = settings.widths(recordings);
    let mut rows = Vec::new();
    for (number, recording) in recordings.iter().enumerate() {
        let noise = sensor_noise(recording, model)?;
        let observation = observe(model, recording)?;
        let (simulation, effect_states) = simulated(model, recording)?;
        let measured = equations(&system, &observation, &effect_states, unknown);
        let instruments = if with_instruments {
            let observation = observe(model, &simulation)?;
            let equations = equations(&system, &observation, &effect_states, unknown);
            Some((observation, equations))
        } else {
            None
        };
        for window in windows(&recording.time, recording.sample_interval(), half_width, step) {
            for (index, equation) in measured.iter().enumerate() {
                if let EquationKind::Motion(cylinder) = equation.kind {
                    let inside = window.first..window.first + window.weights.len();
                    let speeds = &observation.cylinders[cylinder].velocity[inside];
                    if speeds.iter().any(|speed| speed.is_nan() || speed.abs() <= settings.velocity_guard) {
                        continue;
                    }
                }
                let row =
                    |equation, observation| weak_row(equation, &window, observation, &noise, &linkages, unknown.len());
                let Some(row_measured) = row(equation, &observation) else { continue };
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

fn solve(
    model: &Model,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
    unknown: &[usize],
    rows: &[Row],
    with_errors: bool,
) -> Result<Regression, RegressionError> {
    let cards: Vec<_> = model.parameters().map(|(_, parameter)| parameter.card).collect();
    let values = model.parameter_values();
    // Regression is on coefficients: one over the parameter where rows are linear in that.
    let slope_to_coefficient = |index: usize| match cards[index].kind {
        Kind::Reciprocal => -values[index] * values[index],
        Kind::Linear | Kind::Shape => 1.0,
    };
    let seen: Vec<usize> =
        (0..unknown.len()).filter(|&column| rows.iter().any(|row| row.regressors[column] != 0.0)).collect();
    let names = model.parameter_names();
    if seen.is_empty() {
        return Err(RegressionError::NoEquation {
            source_name: sources(recordings),
            machine: model.machine.name.clone(),
            missing: "check which of displacement, pressures, opening and force are measured, and that the arm moves"
                .into(),
        });
    }
    let (half_width, step_width) = settings.widths(recordings);
    let independent = rows.len() as f64 * step_width / (2.0 * half_width);
    if independent < seen.len() as f64 * 2.0 {
        return Err(RegressionError::TooFewRows {
            source_name: sources(recordings),
            rows: rows.len(),
            parameters: seen.len(),
            needed: (seen.len() as f64 * 4.0 * half_width / step_width) as usize,
        });
    }

    let mut kinds: Vec<EquationKind> = rows.iter().map(|row| row.kind).collect();
    kinds.sort();
    kinds.dedup();
    let gauges = gauges(model, &kinds, rows);
    // An equation that is met worse than noise explains is weighed by how well it is met.
    let trust = |kind: EquationKind| {
        let position = kinds.iter().position(|candidate| *candidate == kind).unwrap_or(0);
        1.0 / gauges[position].chi_squared_per_row.max(1.0).sqrt()
    };

    let mut regressors = DMatrix::zeros(rows.len(), seen.len());
    let mut instruments = DMatrix::zeros(rows.len(), seen.len());
    let mut residuals = DVector::zeros(rows.len());
    for (number, row) in rows.iter().enumerate() {
        let trust = trust(row.kind);
        residuals[number] = row.residual * trust;
        for (column, &index) in seen.iter().enumerate() {
            let factor = slope_to_coefficient(unknown[index]) * trust;
            regressors[(number, column)] = row.regressors[index] * factor;
            instruments[(number, column)] = row.instruments[index] * factor;
        }
    }
    let lengths: Vec<f64> = regressors.column_iter().map(|column| column.norm()).collect();
    for (column, &length) in lengths.iter().enumerate() {
        regressors.column_mut(column).scale_mut(1.0 / length);
        let own = instruments.column(column).norm();
        instruments.column_mut(column).scale_mut(if own > 0.0 { 1.0 / own } else { 0.0 });
    }
    let matrix = instruments.transpose() * &regressors;
    let svd = matrix.clone().svd(true, true);
    if svd.singular_values.min() < 1e-9 * svd.singular_values.max() {
        let weakest = svd.singular_values.imin();
        let involved = svd.v_t.as_ref().map_or(Vec::new(), |v_t| {
            let row = v_t.row(weakest);
            let largest = row.amax();
            (0..seen.len()).filter(|&c| row[c].abs() > 0.3 * largest).map(|c| names[unknown[seen[c]]].clone()).collect()
        });
        return Err(RegressionError::NotIdentifiable { source_name: sources(recordings), names: involved });
    }
    let Some(inverse) = matrix.try_inverse() else {
        let names = seen.iter().map(|&index| names[unknown[index]].clone()).collect();
        return Err(RegressionError::NotIdentifiable { source_name: sources(recordings), names });
    };
    let step = -(&inverse * (instruments.transpose() * &residuals));
    let remaining = &residuals + &regressors * &step;

    let mut improved = model.clone();
    let mut new_values = values.clone();
    for (column, &index) in seen.iter().enumerate() {
        let parameter = unknown[index];
        let card = cards[parameter];
        let change = step[column] / lengths[column];
        new_values[parameter] = match card.kind {
            Kind::Reciprocal => {
                let coefficient = (1.0 / values[parameter] + change).max(1.0 / card.maximum);
                1.0 / coefficient
            }
            Kind::Linear => values[parameter] + change,
            Kind::Shape => (values[parameter] + change).clamp(card.minimum, card.maximum),
        };
    }
    improved.set_parameter_values(&new_values);

    let meat = if with_errors {
        let scores = scores(rows, &instruments, &remaining);
        long_run_covariance(&scores, seen.len(), CORRELATION_REACH.max(4.0 * half_width))
    } else {
        DMatrix::from_element(seen.len(), seen.len(), f64::NAN)
    };
    let correction = independent / (independent - seen.len() as f64).max(1.0);
    let coefficient_covariance = &inverse * meat * inverse.transpose() * correction;
    let mut covariance = DMatrix::zeros(seen.len(), seen.len());
    let to_parameter = |column: usize| {
        let parameter = unknown[seen[column]];
        let slope = match cards[parameter].kind {
            Kind::Reciprocal => -new_values[parameter] * new_values[parameter],
            Kind::Linear | Kind::Shape => 1.0,
        };
        slope / lengths[column]
    };
    for row in 0..seen.len() {
        for column in 0..seen.len() {
            covariance[(row, column)] =
                coefficient_covariance[(row, column)] * to_parameter(row) * to_parameter(column);
        }
    }
    for (index, parameter) in improved.parameters_mut().enumerate() {
        if let Some(column) = seen.iter().position(|&s| unknown[s] == index) {
            let variance = covariance[(column, column)];
            parameter.standard_error = variance.is_finite().then(|| variance.max(0.0).sqrt());
            parameter.source = "identified".into();
        }
    }
    let not_identified = (0..unknown.len())
        .filter(|index| !seen.contains(index))
        .map(|index| {
            (unknown[index], "no equation that contains it has all its signals measured, with motion".to_string())
        })
        .collect();
    Ok(Regression {
        model: improved,
        fitted: seen.iter().map(|&index| unknown[index]).collect(),
        covariance,
        condition_numbers: if with_errors {
            group_conditions(rows, &seen, |index| slope_to_coefficient(unknown[index]))
        } else {
            Vec::new()
        },
        rows: rows.len(),
        equations: gauges,
        not_identified,
    })
}

fn gauges(model: &Model, kinds: &[EquationKind], rows: &[Row]) -> Vec<EquationGauge> {
    kinds
        .iter()
        .map(|&kind| {
            let own: Vec<&Row> = rows.iter().filter(|row| row.kind == kind).collect();
            let count = own.len() as f64;
            EquationGauge {
                equation: kind.name(model),
                chi_squared_per_row: own.iter().map(|row| row.residual * row.residual).sum::<f64>() / count,
                relative_residual: (own.iter().map(|row| row.relative * row.relative).sum::<f64>() / count).sqrt(),
                rows: own.len(),
            }
        })
        .collect()
}

/// Condition numbers of the mechanical and the hydraulic regressors, as \[A\] Section 3.2 reports them.
fn group_conditions(rows: &[Row], seen: &[usize], factor: impl Fn(usize) -> f64) -> Vec<ConditionNumber> {
    type Belongs = fn(&EquationKind) -> bool;
    let groups: [(&'static str, Belongs); 2] = [
        ("mechanical", |kind| matches!(kind, EquationKind::Motion(_))),
        ("hydraulic", |kind| !matches!(kind, EquationKind::Motion(_))),
    ];
    groups
        .into_iter()
        .filter_map(|(group, belongs)| {
            let own: Vec<&Row> = rows.iter().filter(|row| belongs(&row.kind)).collect();
            let columns: Vec<usize> =
                seen.iter().copied().filter(|&c| own.iter().any(|row| row.regressors[c] != 0.0)).collect();
            if own.is_empty() || columns.is_empty() {
                return None;
            }
            let matrix = DMatrix::from_fn(own.len(), columns.len(), |r, c| {
                own[r].regressors[columns[c]] * own[r].noise * factor(columns[c])
            });
            let (unscaled, scaled) = condition_numbers(&matrix);
            Some(ConditionNumber { group, unscaled, scaled })
        })
        .collect()
}

/// Sums of instrument times residual over the rows of one window, with recording and centre.
fn scores(rows: &[Row], instruments: &DMatrix<f64>, residuals: &DVector<f64>) -> Vec<(usize, f64, DVector<f64>)> {
    let mut scores: Vec<(usize, f64, DVector<f64>)> = Vec::new();
    for (number, row) in rows.iter().enumerate() {
        let score = instruments.row(number).transpose() * residuals[number];
        match scores.last_mut() {
            Some((recording, centre, sum)) if *recording == row.recording && *centre == row.centre => *sum += score,
            _ => scores.push((row.recording, row.centre, score)),
        }
    }
    scores
}

/// Over how long residuals may stay correlated, s: errors of the spool estimate last up to half a second.
const CORRELATION_REACH: f64 = 0.5;

/// Covariance of the sum of scores that are correlated over up to `reach` s (Newey and West 1987, Bartlett weights).
fn long_run_covariance(scores: &[(usize, f64, DVector<f64>)], order: usize, reach: f64) -> DMatrix<f64> {
    let mut sum = DMatrix::zeros(order, order);
    for (number, (recording, centre, score)) in scores.iter().enumerate() {
        sum += score * score.transpose();
        for (other_recording, other_centre, other) in &scores[number + 1..] {
            let distance = other_centre - centre;
            if other_recording != recording || distance >= reach {
                break;
            }
            let product = score * other.transpose() * (1.0 - distance / reach);
            sum += &product + product.transpose();
        }
    }
    sum
}

/// Residual of one equation in one window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeakResidual {
    /// Which equation.
    pub kind: EquationKind,
    /// Sample in the middle of the window.
    pub sample: usize,
    /// Residual in units of what sensor noise explains.
    pub in_noise_units: f64,
    /// Mean residual over the window, N m (N) or m³/s.
    pub mean: f64,
}

/// Residuals of all equations of `model` along a recording, its parameters as they are.
///
/// # Errors
/// [`RegressionError`] when the recording lacks inputs.
pub fn weak_residuals(
    model: &Model,
    recording: &Recording,
    settings: &WeakFormSettings,
) -> Result<Vec<WeakResidual>, RegressionError> {
    let rows = rows(model, &[recording], settings, &[], false)?;
    let (half_width, _) = settings.widths(&[recording]);
    // Integral of the test function (1 - x²)^4 over [-1, 1].
    const BUMP_AREA: f64 = 256.0 / 315.0;
    let residuals = rows.iter().map(|row| WeakResidual {
        kind: row.kind,
        sample: recording.time.partition_point(|&t| t < row.centre).min(recording.len() - 1),
        in_noise_units: row.residual,
        mean: row.residual * row.noise / (BUMP_AREA * half_width),
    });
    Ok(residuals.collect())
}
