//! Designs manoeuvres that separate tied effects, or that determine a parameter which a recording leaves undetermined.
//!
//! Rivals are models that explain the recordings equally well. A library of manoeuvres is simulated with every rival, and
//! manoeuvres that leave the machine's limits are dropped. The rest is ranked by the error that one rival still leaves on
//! another's data after a refit of its own parameters (the T-criterion of Atkinson and Fedorov, Biometrika 62 (1975) 57, by one
//! linearised step), or by the standard error of the parameter asked for (the Ds-criterion with one parameter of interest). The
//! best manoeuvres are joined greedily, with moves between their places, into one profile. A trial run with noisy sensors and
//! real fits then states what to expect, by the rules of a diagnosis.

mod error;
mod limits;
mod manoeuvre;
mod parameter;
mod plan;
mod ride;
mod rival;
mod selection;
mod sensors;
mod separation;
mod settings;
mod transfer;
mod trial_run;

pub use error::DesignError;
pub use limits::{Limits, Violation};
pub use manoeuvre::{Manoeuvre, library};
pub use parameter::{ParameterDesign, determine};
pub use plan::Plan;
pub use rival::Rival;
pub use sensors::Sensors;
pub use separation::{PairSeparation, SeparationDesign, separate};
pub use settings::DesignSettings;
pub use trial_run::TrialRun;
