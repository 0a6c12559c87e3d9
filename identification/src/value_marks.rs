//! Marks identified values that must not be taken as properties of the machine.

use std::fmt;

use excavator_model::effects::Text;
use excavator_model::{Model, ModelEffect, Parameter};

/// Why an identified value must not be taken as a property of the machine.
#[derive(Debug, Clone, PartialEq)]
pub enum ValueMark {
    /// The recordings do not determine it: there is no error of the value, or one that is larger than the value.
    Undetermined,
    /// The search ended at the edge of what is possible.
    AtItsBound,
    /// No machine has such a value.
    Beyond {
        /// Least and largest value of real machines, in `unit`.
        range: [f64; 2],
        /// SI unit.
        unit: Text,
    },
}

impl fmt::Display for ValueMark {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ValueMark::Undetermined => write!(out, "not determined"),
            ValueMark::AtItsBound => write!(out, "at its bound"),
            ValueMark::Beyond { range: [least, most], unit } => {
                write!(out, "no machine has this: {least:.3e} to {most:.3e} {unit}")
            }
        }
    }
}

/// The mark of parameter `index` of a fitted model; none where its value can be believed, or was given.
pub fn value_mark(model: &Model, index: usize) -> Option<ValueMark> {
    let (effect, parameter) = model.parameters().nth(index)?;
    mark(model, &model.effects[effect], parameter)
}

/// Effects of `model` with marked values and the experiment that would determine these, each with the names of the values.
pub fn remedies(model: &Model, fitted: &[usize]) -> Vec<(Vec<String>, Text)> {
    let names = model.parameter_names();
    let mut found: Vec<(usize, Vec<String>)> = Vec::new();
    for (index, (effect, parameter)) in model.parameters().enumerate() {
        if !fitted.contains(&index) || mark(model, &model.effects[effect], parameter).is_none() {
            continue;
        }
        match found.last_mut() {
            Some((last, own)) if *last == effect => own.push(names[index].clone()),
            _ => found.push((effect, vec![names[index].clone()])),
        }
    }
    found.into_iter().map(|(effect, own)| (own, model.effects[effect].physics.card().experiment.clone())).collect()
}

/// [`value_mark`] of a parameter of one of the model's effects.
pub fn mark(model: &Model, effect: &ModelEffect, parameter: &Parameter) -> Option<ValueMark> {
    let card = &parameter.card;
    // Nuisances scatter around zero, and no action follows from them.
    if parameter.known || card.prior.is_some() {
        return None;
    }
    let plausible = effect.physics.plausible(&model.machine, effect.site, &card.name);
    if let Some(range @ [least, most]) = plausible
        && !(least..=most).contains(&parameter.value)
    {
        return Some(ValueMark::Beyond { range, unit: card.unit.clone() });
    }
    let near = |bound: f64| (parameter.value - bound).abs() <= 1e-9 * (card.maximum - card.minimum);
    if near(card.minimum) || near(card.maximum) && !effect.physics.has_natural_maximum(&card.name) {
        return Some(ValueMark::AtItsBound);
    }
    let margin = parameter.margin_95.unwrap_or(f64::INFINITY);
    // A parameter that may have either sign may be zero; one that cannot be zero must differ from it significantly.
    let needs_a_value = card.minimum >= 0.0;
    (!margin.is_finite() || needs_a_value && margin > parameter.value.abs()).then_some(ValueMark::Undetermined)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

    fn marked(name: &str, value: f64, margin: Option<f64>) -> Option<ValueMark> {
        let mut model = built_in("zx30u-arm").unwrap();
        let index = model.parameter_names().iter().position(|known| known == name).unwrap();
        let parameter = model.parameters_mut().nth(index).unwrap();
        (parameter.value, parameter.margin_95) = (value, margin);
        value_mark(&model, index)
    }

    #[test]
    fn only_values_that_mislead_are_marked() {
        assert_eq!(marked("arm.bulk_modulus", 9e8, Some(1e7)), None);
        assert_eq!(marked("arm.coulomb_friction", 0.0, Some(5.0)), Some(ValueMark::AtItsBound));
        assert_eq!(marked("arm.coulomb_friction", 100.0, Some(300.0)), Some(ValueMark::Undetermined));
        assert_eq!(marked("arm.coulomb_friction", 100.0, None), Some(ValueMark::Undetermined));
        assert!(matches!(marked("arm.bulk_modulus", 1e11, Some(2e9)), Some(ValueMark::Beyond { .. })));
        // A moment of gravity may be zero.
        assert_eq!(marked("arm.gravity_moment", 1.0, Some(3.0)), None);
    }

    #[test]
    fn a_remedy_is_the_experiment_of_the_effect() {
        let mut model = built_in("zx30u-arm").unwrap();
        let index = model.parameter_names().iter().position(|name| name == "arm.coulomb_friction").unwrap();
        model.parameters_mut().nth(index).unwrap().value = 0.0;
        let found = remedies(&model, &[index]);
        let [(names, experiment)] = &found[..] else { unreachable!("{found:?}") };
        assert_eq!(names, &["arm.coulomb_friction"]);
        assert!(!experiment.is_empty());
    }
}
