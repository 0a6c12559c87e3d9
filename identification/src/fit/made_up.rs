//! Fits for tests, with chosen errors instead of computed ones.

use excavator_model::Model;
use excavator_model::equations::Channel;
use nalgebra::DMatrix;

use super::{Fit, Instrument};

/// A fit of `model` to one displacement with sensor noise `noise` (m) and root mean square error `error` (m).
pub(crate) fn made_up_fit(model: Model, noise: f64, error: f64) -> Fit {
    Fit {
        model,
        fitted: Vec::new(),
        covariance: DMatrix::zeros(0, 0),
        inflation: Vec::new(),
        instruments: vec![Instrument {
            name: "load.displacement".into(),
            unit: "m",
            channel: Channel::Displacement(0),
            noise,
        }],
        errors: vec![error],
        block_errors: Vec::new(),
        block_places: Vec::new(),
        steps: 0,
        converged: true,
    }
}
