//! Regression on the equations themselves: the paper's least squares, and the weak form with instruments.
//!
//! Every equation has the form `sum of c(t) x^(n)(t) = rest(t)`: storage (inertia, compliance, piston area) times a
//! derivative of a measured quantity equals forces or flows. The model's effects provide `c` and `rest` and their
//! derivatives by each parameter, so that a new effect needs no code here.

mod equation;
mod error;
mod flow_rows;
mod information;
mod least_squares;
mod observation;
mod printed_rows;
mod robust_covariance;
mod seen;
mod sensor_noise;
mod simulated;
mod solution;
mod weak_covariance;
mod weak_form;
mod weak_residuals;
mod weak_row;
mod weak_rows;
mod weak_settings;
mod weak_solution;
mod weak_terms;
mod window;

pub use equation::{Equation, EquationKind, Sensor, Term, equations};
pub use error::RegressionError;
pub(crate) use flow_rows::{FlowGround, FlowRows};
pub(crate) use information::Gauge;
pub use least_squares::least_squares;
pub(crate) use observation::slope_noise;
pub use observation::{Observation, observe, observe_guided};
pub(crate) use seen::Ground;
pub use solution::{ConditionNumber, EquationGauge, Regression};
pub(crate) use weak_form::weak_form_on;
pub use weak_form::{weak_form, weak_form_watched};
pub use weak_residuals::{WeakResidual, weak_residuals};
pub use weak_settings::WeakFormSettings;
pub(crate) use weak_terms::{WeakTerms, situations_along, weak_terms};
