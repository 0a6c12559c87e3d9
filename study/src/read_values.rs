//! Writes values that were read from measurements into a model.

use excavator_identification::characterisation::Estimate;
use excavator_model::effects::Site;
use excavator_model::{Model, ModelEffect, ModelError};

/// Standard errors from zero above which a value counts as real.
const CLEAR: f64 = 3.0;

/// Share of the full input below which a dead zone or a play does not matter.
pub(crate) const LEAST_SHARE: f64 = 0.003;

/// Whether a value is clear of zero, and larger than `least`.
pub(crate) fn is_clear(one: Estimate, least: f64) -> bool {
    one.value.abs() > (CLEAR * one.error).max(least)
}

/// The effect of this name, which is added if the model does not have it; `None` if no catalogue has it.
pub(crate) fn effect_of<'m>(
    model: &'m mut Model,
    effect: &str,
    site: Site,
) -> Result<Option<&'m mut ModelEffect>, ModelError> {
    if !model.has(effect, site)
        && let Ok(physics) = model.catalogue.find(effect)
    {
        *model = model.with_effect(&physics, site)?;
    }
    Ok(model.effects.iter_mut().find(|one| one.is(effect, site)))
}

/// Sets the first parameters of an effect; `None` leaves one as it is.
pub(crate) fn put(
    model: &mut Model,
    effect: &str,
    site: Site,
    values: &[Option<f64>],
    source: &str,
) -> Result<(), ModelError> {
    let own = effect_of(model, effect, site)?;
    for (parameter, value) in own.into_iter().flat_map(|one| &mut one.parameters).zip(values) {
        if let Some(value) = value {
            parameter.value = *value;
            parameter.source = source.to_string();
            parameter.standard_error = None;
            parameter.margin_95 = None;
        }
    }
    Ok(())
}
