//! Parameters from recordings.

use excavator_identification::fit::{
    FitSettings, ProfileInterval, fit, profile, simplified, with_nuisances, with_nuisances_of,
};
use excavator_identification::regression::{
    ConditionNumber, EquationGauge, Regression, RegressionError, WeakFormSettings, least_squares, weak_form,
};
use excavator_model::effects::Family;
use excavator_model::recording::Recording;
use excavator_model::{HistoryEntry, Model, Parameter};

use crate::WorkError;
use crate::numbers::number;

/// How parameters are identified.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// Weak form of the equations with instruments from the simulated model: not biased by sensor noise.
    #[default]
    WeakForm,
    /// Ordinary least squares on smoothed differences; biased by noise.
    LeastSquares,
    /// Weak form, then simulated outputs fitted to the measured ones.
    OutputError,
}

impl Method {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Method::WeakForm => "weak form with instruments",
            Method::LeastSquares => "least squares",
            Method::OutputError => "output error",
        }
    }
}

/// Identified parameters.
#[derive(Debug, Clone)]
pub struct Identified {
    /// The model with the identified values.
    pub model: Model,
    /// Indices of the identified parameters.
    pub fitted: Vec<usize>,
    /// Of each group of equations.
    pub conditions: Vec<ConditionNumber>,
    /// Rows of the regression.
    pub rows: usize,
    /// What each equation leaves.
    pub equations: Vec<EquationGauge>,
    /// Parameters without a value, with the reason.
    pub not_identified: Vec<(usize, String)>,
    /// Of parameters whose standard errors say little.
    pub profiles: Vec<ProfileInterval>,
}

/// Identifies the unknown parameters of a model.
///
/// # Errors
/// [`WorkError::Regression`], [`WorkError::Fit`].
pub fn identify(model: &Model, recordings: &[&Recording], method: Method) -> Result<Identified, WorkError> {
    let regression = match method {
        Method::LeastSquares => Some(least_squares(model, recordings)?),
        Method::WeakForm => Some(in_weak_form(model, recordings)?),
        // Where the equations lack signals the given values are the start.
        Method::OutputError => in_weak_form(model, recordings).ok(),
    };
    let mut result = match regression {
        Some(regression) => Identified {
            model: regression.model,
            fitted: regression.fitted,
            conditions: regression.condition_numbers,
            rows: regression.rows,
            equations: regression.equations,
            not_identified: regression.not_identified,
            profiles: Vec::new(),
        },
        None => Identified {
            model: model.clone(),
            fitted: Vec::new(),
            conditions: Vec::new(),
            rows: 0,
            equations: Vec::new(),
            not_identified: Vec::new(),
            profiles: Vec::new(),
        },
    };
    if method == Method::OutputError {
        let settings = FitSettings { sample_rate: f64::INFINITY, ..FitSettings::default() };
        let fitted = fit(&with_nuisances(&result.model, recordings), recordings, &settings)?;
        let fitted = simplified(model, &fitted, recordings, &settings)?;
        result.profiles = fitted
            .undetermined()
            .into_iter()
            .map(|index| profile(&fitted, recordings, &FitSettings::default(), index))
            .collect::<Result<_, _>>()?;
        result.model = fitted.model;
        result.fitted = fitted.fitted;
        result.not_identified.clear();
    }
    Ok(result)
}

fn in_weak_form(model: &Model, recordings: &[&Recording]) -> Result<Regression, RegressionError> {
    let extended = with_nuisances_of(model, &[Family::Recording], recordings);
    Ok(weak_form(&extended, recordings, &WeakFormSettings::default())?.simplified(model))
}

/// Notes in the model what was done.
pub fn note(result: &mut Identified, method: Method, recordings: &[&Recording]) {
    result.model.history.push(HistoryEntry {
        when: jiff::Timestamp::now().to_string(),
        what: format!("parameters identified ({})", method.words()),
        recordings: recordings.iter().map(|recording| recording.source.clone()).collect(),
        validation_error_before: None,
        validation_error_after: None,
    });
}

/// How many parameters were identified, how well, and what the equations leave.
pub fn summary(result: &Identified) -> String {
    let machine = &result.model.machine.name;
    let asked = result.fitted.len() + result.not_identified.len();
    let names = result.model.parameter_names();
    let share = |(index, parameter): (usize, &Parameter)| {
        let margin = parameter.margin_95.filter(|margin| margin.is_finite() && parameter.value != 0.0)?;
        Some((margin / parameter.value.abs(), names[index].as_str()))
    };
    let parameters = result.model.parameters().map(|(_, parameter)| parameter).enumerate();
    let fitted = parameters.filter(|(index, _)| result.fitted.contains(index));
    let widest = fitted.filter_map(share).max_by(|a, b| a.0.total_cmp(&b.0));
    let mut text = format!("Identified {} of {asked} unknown parameters of {machine}.", result.fitted.len());
    if let Some((share, name)) = widest {
        text += &format!(" The widest 95 % interval is that of {name}: ± {:.1} % of its value.", 100.0 * share);
    }
    let known = result.equations.iter().filter(|gauge| gauge.chi_squared_per_row.is_finite());
    if let Some(worst) = known.max_by(|a, b| a.chi_squared_per_row.total_cmp(&b.chi_squared_per_row)) {
        text += &format!(
            " The largest residual is that of {}: {} times the variance of sensor noise.",
            worst.equation,
            number(worst.chi_squared_per_row)
        );
    }
    text
}

/// What the recordings say of a parameter that they hardly show.
pub fn profile_sentence(profile: &ProfileInterval, model: &Model) -> String {
    let names = model.parameter_names();
    let unit = model.parameters().nth(profile.index).map_or("", |(_, parameter)| &*parameter.card.unit);
    let name = &names[profile.index];
    let mut text = match (profile.lower, profile.upper) {
        (None, None) => format!("{name} is not identifiable from these recordings: every possible value fits as well"),
        (Some(lower), None) => {
            format!("{name} is at least {} {unit} (95 %); every larger value fits as well", number(lower))
        }
        (None, Some(upper)) => {
            format!("{name} is at most {} {unit} (95 %); every smaller value fits as well", number(upper))
        }
        (Some(lower), Some(upper)) => {
            format!("{name} is between {} and {} {unit} (95 %, profile likelihood)", number(lower), number(upper))
        }
    };
    if let Some((other, correlation)) = profile.companion {
        text += &format!("; when it is moved, {} takes its place (correlation {correlation:.2})", names[other]);
    }
    text
}
