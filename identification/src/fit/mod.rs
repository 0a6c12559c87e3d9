//! Output-error fit: simulates, compares with the measurement and improves the parameters.

mod covariance;
mod error;
mod instruments;
mod linear_refit;
mod linearised;
#[cfg(test)]
pub(crate) mod made_up;
mod normal_equations;
mod normalised_error;
mod nuisances;
mod output_error;
mod prediction;
mod priors;
mod problem;
mod profile;
mod reading_rows;
mod segments;
mod settings;
mod step;
mod trial;
mod watch;

pub use error::FitError;
pub use instruments::{Instrument, instruments};
pub(crate) use linear_refit::LinearRefit;
#[cfg(test)]
pub(crate) use linear_refit::Remainder;
pub(crate) use linearised::Linearised;
pub use normalised_error::normalised_error;
pub use nuisances::{Simplified, is_nuisance, nuisances_shown, simplified, with_nuisances, with_nuisances_of};
pub use output_error::{Fit, evaluate, fit, fit_watched};
pub(crate) use prediction::fit_predicted;
pub use prediction::{Prediction, predict};
pub(crate) use priors::ParameterPriors;
pub use profile::{ProfileInterval, profile};
pub use segments::{Segment, SegmentedRecording};
pub use settings::{FitSettings, InitialStates};
pub(crate) use step::scales;
pub use watch::Watch;
