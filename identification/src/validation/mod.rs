//! Measures the error of a model against a measurement.

mod arx;
mod baselines;
mod compare;
mod measures;
mod motion_phase;
mod phase;
mod residual_test;
mod runs;
mod wrong_unit;

pub use baselines::{Baseline, Baselines};
pub use compare::{Comparison, SignalComparison, compare, errors_of, mean_error, mean_error_of, measured_velocity};
pub use measures::{ErrorSums, normalised_mean_squared_error};
pub use motion_phase::{MotionPhase, PhaseShare, motion_phases, phase_shares};
pub use phase::{dominant_frequency, phase_delay_degrees};
pub use residual_test::{Correlation, autocorrelation, input_correlation};
pub use runs::{Repeat, compare_runs};
pub use wrong_unit::WrongUnit;
