//! Rivals: models that are to be separated.

use excavator_model::Model;
use excavator_model::effects::{AnyEffect, Site};

use super::DesignError;
use crate::search::Addition;

/// One explanation: the model with one more effect, or unchanged.
#[derive(Debug, Clone)]
pub struct Rival {
    /// `EFFECT@PLACE`, or `none`.
    pub name: String,
    /// The effect and its place; `None` for the unchanged model.
    pub addition: Option<Addition>,
    /// The model including the effect.
    pub model: Model,
}

/// Name of the rival that adds nothing.
const NONE: &str = "none";

impl Rival {
    /// The rivals that a user names: each `EFFECT` at every place where it can act, `EFFECT@PLACE` at one, `none` for the
    /// unchanged model. Effects have their typical size.
    ///
    /// # Errors
    /// [`DesignError::Model`], [`DesignError::Twice`].
    pub fn named(model: &Model, names: &[String]) -> Result<Vec<Rival>, DesignError> {
        let mut rivals: Vec<Rival> = Vec::new();
        for name in names {
            let more = if name == NONE {
                vec![Rival { name: NONE.into(), addition: None, model: model.clone() }]
            } else {
                let additions = model.parse_addition(name)?;
                additions
                    .into_iter()
                    .map(|(physics, site)| Rival::with(model, physics, site))
                    .collect::<Result<_, DesignError>>()?
            };
            for rival in more {
                if rivals.iter().any(|other| other.name == rival.name) {
                    return Err(DesignError::Twice { rival: rival.name });
                }
                rivals.push(rival);
            }
        }
        Ok(rivals)
    }

    fn with(model: &Model, physics: AnyEffect, site: Site) -> Result<Rival, DesignError> {
        let mut extended = model.with_effect(&physics, site)?;
        if let Some(added) = extended.effects.last_mut() {
            for parameter in added.parameters.iter_mut().filter(|parameter| !parameter.known) {
                parameter.value = parameter.card.typical.clamp(parameter.card.minimum, parameter.card.maximum);
            }
        }
        let addition = Addition { physics, site };
        Ok(Rival { name: addition.name(model), addition: Some(addition), model: extended })
    }

    /// Sets parameters by their contract names, if they are unknowns of the rival.
    pub fn set(&mut self, values: &[(String, f64)]) {
        let names = self.model.parameter_names();
        for (parameter, name) in self.model.parameters_mut().zip(&names) {
            if !parameter.known
                && let Some((_, value)) = values.iter().find(|(wanted, _)| wanted == name)
            {
                parameter.value = *value;
            }
        }
    }

    /// The model without the addition, with the current parameters.
    pub(super) fn base(&self) -> Model {
        let mut base = self.model.clone();
        if self.addition.is_some() {
            base.effects.pop();
        }
        base
    }
}

/// Cylinders that manoeuvres may use: those with a rival's effect, or all if an effect is elsewhere.
pub(super) fn cylinders(model: &Model, sites: &[Option<Site>]) -> Vec<usize> {
    let all: Vec<usize> = (0..model.machine.cylinders.len()).collect();
    let mut wanted = Vec::new();
    for site in sites {
        match site {
            Some(Site::Cylinder(cylinder)) => wanted.push(*cylinder),
            Some(Site::PumpLine | Site::Machine) => return all,
            None => {}
        }
    }
    wanted.sort_unstable();
    wanted.dedup();
    if wanted.is_empty() { all } else { wanted }
}
