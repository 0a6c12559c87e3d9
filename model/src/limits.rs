//! Limits of what a fit may make of numbers that a data sheet gives.

use std::sync::Arc;

use crate::effects::{Family, Kind};
use crate::{Model, Parameter};

/// Factor by which a fitted inertia or bulk modulus may differ from the given one. A mass that nobody knows is estimated from the
/// force of the cylinder, and machines differ by more than ten in it.
const FACTOR: f64 = 30.0;

impl Model {
    /// The model with narrower limits of its inertias and bulk moduli: a factor of 30 around the given values, within what real
    /// machines have. Recordings in which nothing accelerates do not show a mass, and a fit without limits ends at grams.
    #[must_use]
    pub fn with_limits_around_given(mut self) -> Model {
        let machine = self.machine.clone();
        for effect in &mut self.effects {
            let (physics, site) = (effect.physics.clone(), effect.site);
            if physics.card().family != Family::Base {
                continue;
            }
            for parameter in effect.parameters.iter_mut().filter(|parameter| parameter.has_limits_around_given()) {
                let plausible = physics.plausible(&machine, site, &parameter.card.name);
                let [least, most] = plausible.unwrap_or([parameter.card.minimum, parameter.card.maximum]);
                let value = parameter.value;
                let mut card = (*parameter.card).clone();
                card.minimum = card.minimum.max(value / FACTOR).max(least).min(value);
                card.maximum = card.maximum.min(value * FACTOR).min(most).max(value);
                parameter.card = Arc::new(card);
            }
        }
        self
    }
}

impl Parameter {
    /// Whether it is an inertia or a bulk modulus that a fit may change: it is positive and known roughly.
    pub fn has_limits_around_given(&self) -> bool {
        !self.known && self.card.kind != Kind::Shape && self.card.minimum > 0.0 && self.value > 0.0
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::document::built_in;

    #[test]
    fn inertia_and_bulk_modulus_stay_near_the_data_sheet() {
        let model = built_in("zx30u-arm").unwrap().with_limits_around_given();
        let limits = |name: &str| {
            let names = model.parameter_names();
            let index = names.iter().position(|known| known == name).unwrap();
            let parameter = model.parameters().nth(index).unwrap().1;
            (parameter.card.minimum, parameter.card.maximum, parameter.value)
        };
        let (least, most, given) = limits("arm.inertia");
        assert!((least * 30.0 / given - 1.0).abs() < 1e-12 && (most / 30.0 / given - 1.0).abs() < 1e-12);
        let (least, most, _) = limits("arm.bulk_modulus");
        assert_eq!((least, most), (5e7, 4e9));
        assert_eq!(limits("arm.coulomb_friction").0, 0.0);
        // A second time changes nothing, also from other values.
        let mut moved = model.clone();
        moved.parameters_mut().for_each(|parameter| parameter.value *= 2.0);
        let again = moved.with_limits_around_given();
        let inertia = again.parameters().find(|(_, parameter)| parameter.card.name == "inertia").unwrap().1;
        assert!((inertia.card.maximum / 30.0 / given - 1.0).abs() < 1e-12);
    }
}
