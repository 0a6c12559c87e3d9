//! Draws the hidden effect and the machine around it from a seed.

use excavator_model::Model;
use excavator_model::document::{DocumentError, built_in};
use excavator_model::effects::{Kind, Site, Text};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::error::VerbError;

/// A machine whose parameters and hidden effect are unknown to the identification.
pub struct Sealed {
    /// The true machine.
    pub truth: Model,
    /// Name of the hidden effect.
    pub effect: &'static str,
    /// The place of the hidden effect.
    pub site: Site,
}

/// Hidden effects and the ranges (uniform, in the parameters' units) from which their strengths are drawn: from clearly visible
/// to strong on this machine.
const HIDDEN: &[(&str, &[(f64, f64)])] = &[
    ("valve_dead_zone", &[(7e-6, 1.4e-5), (7e-6, 1.4e-5)]),
    ("valve_leakage", &[(1e-11, 3e-11), (1e-11, 3e-11), (1e-11, 3e-11), (1e-11, 4e-11)]),
    ("valve_lag", &[(0.02, 0.05)]),
    ("hose_loss", &[(3e5, 7e5)]),
    ("stribeck_friction", &[(5e2, 1e3), (0.008, 0.02)]),
    ("entrained_air", &[(0.02, 0.05)]),
    ("relief_valve", &[(1.1e6, 1.5e6), (5e-10, 2e-9)]),
];

/// Largest relative deviation of the machine's own parameters from the model's: the accuracy of a type sheet.
const PARAMETER_SPREAD: f64 = 0.2;

impl Sealed {
    /// Draws a machine without a hidden effect.
    ///
    /// # Errors
    /// [`DocumentError`] if the built-in model cannot be read.
    pub fn draw_without_effect(generator: &mut ChaCha8Rng) -> Result<Sealed, DocumentError> {
        let mut truth = built_in("zx30u-arm")?;
        for parameter in truth.parameters_mut().filter(|parameter| !parameter.known) {
            parameter.value *= generator.random_range(1.0 - PARAMETER_SPREAD..1.0 + PARAMETER_SPREAD);
        }
        Ok(Sealed { truth, effect: "none", site: Site::PumpLine })
    }

    /// Draws a machine with a hidden effect.
    ///
    /// # Errors
    /// If the built-in model cannot be read or has no place for the effect.
    pub fn draw(generator: &mut ChaCha8Rng) -> Result<Sealed, VerbError> {
        let mut truth = Self::draw_without_effect(generator)?.truth;
        let (effect, ranges) = HIDDEN[generator.random_range(0..HIDDEN.len())];
        let physics = truth.catalogue.find(effect)?;
        let site = truth.free_sites(&physics).first().copied().ok_or_else(|| DocumentError::Inconsistent {
            name: truth.machine.name.clone(),
            reason: format!("{effect} has no place"),
        })?;
        truth = truth.with_effect(&physics, site)?;
        if let Some(hidden) = truth.effects.last_mut() {
            for (parameter, &(low, high)) in hidden.parameters.iter_mut().zip(ranges) {
                parameter.value = generator.random_range(low..high);
            }
        }
        Ok(Sealed { truth, effect, site })
    }

    /// Whether the spool has a sensor: a lag of the valve is visible only against the command.
    pub fn has_spool_sensor(&self) -> bool {
        self.effect != "valve_lag"
    }

    /// Value, name and unit of the hidden effect's parameters, with the identified values.
    pub fn opened(&self, found: &Model) -> Vec<(String, f64, Option<f64>, Text)> {
        let Some(hidden) = self.truth.effects.last() else { return Vec::new() };
        let place = excavator_model::site_name(&self.truth.machine, self.site);
        hidden
            .parameters
            .iter()
            .map(|parameter| {
                let name = format!("{place}.{}", parameter.card.name);
                let value = found.value_of(&name);
                (name, parameter.value, value, parameter.card.unit.clone())
            })
            .collect()
    }

    /// Mean relative error of the machine's own linear parameters in `found`.
    pub fn base_error(&self, found: &Model) -> f64 {
        let names = self.truth.parameter_names();
        let mut errors: Vec<f64> = self
            .truth
            .parameters()
            .zip(&names)
            .filter(|((_, parameter), _)| !parameter.known && parameter.card.kind != Kind::Shape)
            .filter_map(|((_, parameter), name)| Some((found.value_of(name)? / parameter.value - 1.0).abs()))
            .collect();
        errors.sort_by(f64::total_cmp);
        errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN)
    }
}
