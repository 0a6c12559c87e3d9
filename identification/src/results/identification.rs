//! Result of `identify`.

use std::collections::BTreeMap;

use excavator_model::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Parameter, finite};
use crate::fit;
use crate::identify::{HeldOut, Identified, Method};
use crate::regression::EquationGauge;

/// Parameters identified from recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Identification {
    /// The method that was used.
    pub method: Method,
    /// How well each method predicts the last third of each recording from the rest; absent where one method was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub held_out: Vec<HeldOut>,
    /// The identified parameters, in the model's order.
    pub parameters: Vec<Parameter>,
    /// Condition numbers of the regression by group of equations: `mechanical`, `hydraulic`.
    pub condition_numbers: BTreeMap<String, ConditionNumbers>,
    /// Rows of the regression; 0 where there was none.
    pub rows: usize,
    /// How well each equation is met.
    pub equations: Vec<EquationGauge>,
    /// Parameters that were not identified.
    pub not_identified: Vec<NotIdentified>,
    /// What the recordings say of parameters whose standard errors say little; absent where there is none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub profiles: Vec<ProfileBounds>,
}

/// Condition numbers of a group of equations: ratio of largest to smallest singular value of the regressor matrix.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ConditionNumbers {
    /// Of the matrix in SI units.
    pub unscaled: Option<f64>,
    /// Of the matrix with columns scaled to length one: what matters numerically.
    pub scaled: Option<f64>,
}

/// A parameter that was not identified.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct NotIdentified {
    /// Contract name of the parameter.
    pub name: String,
    /// Why.
    pub reason: String,
}

/// Profile likelihood of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ProfileBounds {
    /// Contract name of the parameter.
    pub name: String,
    /// Lower end of the 95 % interval, in the parameter's unit; `null` where every smaller value fits as well.
    pub lower: Option<f64>,
    /// Upper end, in the parameter's unit; `null` where every larger value fits as well.
    pub upper: Option<f64>,
    /// Whether the recordings bound it on either side.
    pub identifiable: bool,
    /// The parameter that takes its place most when it is moved; `null` where none does.
    pub moves_with: Option<Companion>,
}

/// A parameter that takes the place of another one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Companion {
    /// Contract name of the parameter.
    pub name: String,
    /// Correlation of both, -1 to 1.
    pub correlation: Option<f64>,
}

impl Identification {
    /// Of an identified model.
    pub fn of(found: &Identified) -> Self {
        let model = &found.model;
        let names = model.parameter_names();
        let conditions = found.conditions.iter().map(|one| {
            let numbers = ConditionNumbers { unscaled: finite(one.unscaled), scaled: finite(one.scaled) };
            (one.group.to_string(), numbers)
        });
        let not_identified = found
            .not_identified
            .iter()
            .map(|(index, reason)| NotIdentified { name: names[*index].clone(), reason: reason.clone() });
        Identification {
            method: found.method,
            held_out: found.held_out.clone(),
            parameters: Parameter::of(model, &found.fitted),
            condition_numbers: conditions.collect(),
            rows: found.rows,
            equations: found.equations.clone(),
            not_identified: not_identified.collect(),
            profiles: found.profiles.iter().map(|profile| ProfileBounds::of(profile, model)).collect(),
        }
    }
}

impl ProfileBounds {
    fn of(profile: &fit::ProfileInterval, model: &Model) -> Self {
        let names = model.parameter_names();
        let companion = |(index, correlation): (usize, f64)| Companion {
            name: names[index].clone(),
            correlation: finite(correlation),
        };
        ProfileBounds {
            name: names[profile.index].clone(),
            lower: profile.lower.and_then(finite),
            upper: profile.upper.and_then(finite),
            identifiable: profile.is_identifiable(),
            moves_with: profile.companion.map(companion),
        }
    }
}
