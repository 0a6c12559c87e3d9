//! Fits the flow balances of a model: a bounded Gauss-Newton method with damping on their weak form.

use excavator_model::Model;
use excavator_model::effects::Kind;
use nalgebra::{DMatrix, DVector};

use super::is_of_flows;
use crate::fit::ParameterPriors;
use crate::regression::{EquationKind, FlowGround, FlowRows};

/// A model with the parameters of its flow balances fitted.
#[derive(Debug, Clone)]
pub(super) struct FlowFit {
    pub model: Model,
    /// Mean over the balances of `ln(mean square of the residual / mean square of its noise)`.
    pub misfit: f64,
    unknown: Vec<usize>,
    rows: FlowRows,
}

/// Largest number of steps. Coefficients need one, thresholds a few more.
const STEPS: usize = 12;

/// The fit ends when a step lowers the misfit by less.
const LEAST: f64 = 1e-3;

/// One balance: the numbers of its rows, and the sum of the squares of their noise, m⁶.
struct Balance {
    rows: Vec<usize>,
    noise_squares: f64,
}

/// The balances that are measured. Their noise is that of one model for all models that are compared: it depends on a bulk
/// modulus that another model has otherwise.
pub(super) struct Balances(Vec<Balance>);

impl Balances {
    /// The balances of `ground` with the noise of `model`. Returns `None` if it has none.
    pub fn new(ground: &FlowGround, model: &Model) -> Option<Self> {
        let rows = ground.rows(model, &[]).ok()?;
        let mut kinds: Vec<EquationKind> = rows.kinds.clone();
        kinds.sort();
        kinds.dedup();
        let of = |kind: EquationKind| {
            let own: Vec<usize> = (0..rows.kinds.len()).filter(|&row| rows.kinds[row] == kind).collect();
            let noise_squares = own.iter().map(|&row| rows.noise[row].powi(2)).sum();
            Balance { rows: own, noise_squares }
        };
        (!kinds.is_empty()).then(|| Balances(kinds.into_iter().map(of).collect()))
    }

    fn rows(&self) -> usize {
        self.0.iter().map(|balance| balance.rows.len()).sum()
    }

    fn misfit(&self, residuals: &[f64]) -> f64 {
        self.0.iter().map(|balance| balance.share(residuals).ln()).sum::<f64>() / self.0.len() as f64
    }

    /// The misfit of a model as it is. Returns `None` if it cannot be evaluated.
    pub fn evaluate(&self, ground: &FlowGround, model: &Model) -> Option<f64> {
        let rows = ground.rows(model, &[]).ok().filter(|rows| rows.kinds.len() == self.rows())?;
        Some(self.misfit(&rows.residuals))
    }

    /// Fits the unknown parameters of the flow balances of `model`.
    pub fn fit(&self, ground: &FlowGround, model: &Model) -> Option<FlowFit> {
        let unknown: Vec<usize> = model
            .parameters()
            .enumerate()
            .filter(|(_, (effect, parameter))| !parameter.known && is_of_flows(&model.effects[*effect]))
            .map(|(index, _)| index)
            .collect();
        let at = |model: Model| {
            let rows = ground.rows(&model, &unknown).ok().filter(|rows| rows.kinds.len() == self.rows())?;
            Some(FlowFit { misfit: self.misfit(&rows.residuals), model, unknown: unknown.clone(), rows })
        };
        let mut now = at(model.clone())?;
        let mut damping = 1e-6;
        for _ in 0..STEPS {
            let Some(step) = self.step(&now.model, &now.unknown, &now.rows, damping) else { break };
            match at(step.model).filter(|there| there.misfit < now.misfit) {
                Some(there) => {
                    let is_done = now.misfit - there.misfit < LEAST;
                    now = there;
                    damping = (damping * 0.1_f64).max(1e-9);
                    if is_done {
                        break;
                    }
                }
                None if step.misfit > now.misfit - LEAST => break,
                None => {
                    damping = (damping * 30.0_f64).max(1e-3);
                    if damping > 1e3 {
                        break;
                    }
                }
            }
        }
        Some(now)
    }

    /// One step of `extended`, which has one effect more than `base`: its own derivatives are those at its start, the others
    /// those of the fit of `base`.
    pub fn promise(&self, ground: &FlowGround, base: &FlowFit, extended: &Model) -> Option<Step> {
        let first = base.model.parameters().count();
        let own: Vec<usize> = extended
            .parameters()
            .enumerate()
            .skip(first)
            .filter(|(_, (_, parameter))| !parameter.known)
            .map(|(index, _)| index)
            .collect();
        let mut rows = ground.rows(extended, &own).ok().filter(|rows| rows.kinds.len() == self.rows())?;
        let (before, count) = (&base.rows.regressors, base.unknown.len());
        rows.regressors = DMatrix::from_fn(rows.kinds.len(), count + own.len(), |row, column| {
            if column < count { before[(row, column)] } else { rows.regressors[(row, column - count)] }
        });
        let unknown: Vec<usize> = base.unknown.iter().chain(&own).copied().collect();
        self.step(extended, &unknown, &rows, 1e-6)
    }

    /// A damped step. A parameter that would cross a bound stops there, and the others step again.
    fn step(&self, model: &Model, unknown: &[usize], rows: &FlowRows, damping: f64) -> Option<Step> {
        let bounds = ParameterPriors::of(model, unknown, &[], 0).bounds;
        let values = model.parameter_values();
        let kinds: Vec<Kind> = model.parameters().map(|(_, parameter)| parameter.card.kind).collect();
        // The rows are linear in one over a reciprocal parameter.
        let coefficients: Vec<Coefficient> = unknown
            .iter()
            .map(|&index| Coefficient::new(kinds[index] == Kind::Reciprocal, values[index], bounds[index]))
            .collect();
        let slopes = DVector::from_iterator(unknown.len(), coefficients.iter().map(|one| one.slope));
        let (mut information, mut gradient) =
            (DMatrix::zeros(unknown.len(), unknown.len()), DVector::zeros(unknown.len()));
        for balance in &self.0 {
            let weight = balance.weight(&rows.residuals);
            let matrix = rows.regressors.select_rows(&balance.rows);
            let residuals =
                DVector::from_iterator(balance.rows.len(), balance.rows.iter().map(|&row| rows.residuals[row]));
            information += weight * matrix.tr_mul(&matrix);
            gradient -= weight * matrix.tr_mul(&residuals);
        }
        for (row, &slope) in slopes.iter().enumerate() {
            gradient[row] *= slope;
            for (column, &other) in slopes.iter().enumerate() {
                information[(row, column)] *= slope * other;
            }
        }
        let step = bounded_step(&information, &gradient, &coefficients, damping)?;
        let change = &rows.regressors * step.component_mul(&slopes);
        let residuals: Vec<f64> = rows.residuals.iter().zip(change.iter()).map(|(now, change)| now + change).collect();
        let mut next = values;
        for (column, &index) in unknown.iter().enumerate() {
            next[index] = coefficients[column].value_after(step[column]);
        }
        let mut model = model.clone();
        model.set_parameter_values(&next);
        Some(Step { model, misfit: self.misfit(&residuals) })
    }
}

impl Balance {
    fn share(&self, residuals: &[f64]) -> f64 {
        (self.squares(residuals) / self.noise_squares.max(f64::MIN_POSITIVE)).max(1.0)
    }

    fn squares(&self, residuals: &[f64]) -> f64 {
        self.rows.iter().map(|&row| residuals[row].powi(2)).sum()
    }

    /// Weight of its squares, so that a step lowers the sum of the logarithms.
    fn weight(&self, residuals: &[f64]) -> f64 {
        self.rows.len() as f64 / self.squares(residuals).max(self.noise_squares)
    }
}

/// A step of a fit.
pub(super) struct Step {
    /// The model after it.
    pub model: Model,
    /// The misfit that it promises.
    pub misfit: f64,
}

/// A parameter as the coefficient in which the rows are linear.
struct Coefficient {
    is_reciprocal: bool,
    now: f64,
    /// Derivative of the parameter by the coefficient.
    slope: f64,
    lowest: f64,
    highest: f64,
    bounds: [f64; 2],
}

impl Coefficient {
    fn new(is_reciprocal: bool, value: f64, bounds: [f64; 2]) -> Self {
        let of = |value: f64| if is_reciprocal { 1.0 / value } else { value };
        let ends = bounds.map(of);
        Coefficient {
            is_reciprocal,
            now: of(value),
            slope: if is_reciprocal { -value * value } else { 1.0 },
            lowest: ends[0].min(ends[1]),
            highest: ends[0].max(ends[1]),
            bounds,
        }
    }

    fn value_after(&self, step: f64) -> f64 {
        let coefficient = self.now + step;
        let value = if self.is_reciprocal { 1.0 / coefficient } else { coefficient };
        value.clamp(self.bounds[0], self.bounds[1])
    }
}

fn bounded_step(
    information: &DMatrix<f64>,
    gradient: &DVector<f64>,
    coefficients: &[Coefficient],
    damping: f64,
) -> Option<DVector<f64>> {
    let count = coefficients.len();
    let scales: Vec<f64> = (0..count).map(|column| information[(column, column)].sqrt()).collect();
    let mut free: Vec<usize> = (0..count).filter(|&c| scales[c] > 0.0 && scales[c].is_finite()).collect();
    let mut step = DVector::<f64>::zeros(count);
    loop {
        let mut matrix = DMatrix::from_fn(free.len(), free.len(), |row, column| {
            information[(free[row], free[column])] / (scales[free[row]] * scales[free[column]])
        });
        (0..free.len()).for_each(|c| matrix[(c, c)] += damping + 1e-10);
        let held = |column: usize| -> f64 {
            (0..count).filter(|c| !free.contains(c)).map(|c| information[(column, c)] * step[c]).sum()
        };
        let right = DVector::from_fn(free.len(), |row, _| (gradient[free[row]] - held(free[row])) / scales[free[row]]);
        let solution = matrix.cholesky()?.solve(&right);
        let mut crossed = Vec::new();
        for (position, &column) in free.iter().enumerate() {
            let one = &coefficients[column];
            step[column] = solution[position] / scales[column];
            let wanted = one.now + step[column];
            if wanted < one.lowest || wanted > one.highest {
                step[column] = wanted.clamp(one.lowest, one.highest) - one.now;
                crossed.push(column);
            }
        }
        if crossed.is_empty() || crossed.len() == free.len() {
            return Some(step);
        }
        free.retain(|column| !crossed.contains(column));
    }
}
