//! Settings of a fit.

use excavator_model::machine::Size;

/// Settings of an output-error fit, on a machine of [`Size::REFERENCE`]. A fit scales them to the time scale of its
/// machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitSettings {
    /// Length of one shooting segment, s. It is long enough for slow effects (leakage, drift) to show in the
    /// displacement. It is short enough that a wrong model, which is what the fit has to assess, cannot diverge far
    /// from the data.
    pub segment_duration: f64,
    /// Whether the initial states of segments are unknowns of the fit.
    pub initial_states: InitialStates,
    /// Samples per second that are compared. Faster recordings are thinned to about this rate, except where a valve
    /// moves too fast for it. Model errors are slower than that, and the computation time is proportional to the rate.
    pub sample_rate: f64,
    /// A fit whose loss (see [`crate::fit::Fit::loss`]) is still above this after four steps is abandoned.
    pub give_up_above: f64,
    /// Largest number of Gauss-Newton steps.
    pub maximum_steps: usize,
    /// The fit ends when a step improves the loss by less than this fraction.
    pub least_improvement: f64,
}

/// Initial states of segments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InitialStates {
    /// Fitted to the readings: the fit does not depend on the noise of the first ones.
    Fitted,
    /// As measured: the fit sees the error that a simulation from there has.
    Measured,
}

impl FitSettings {
    /// Length of a shooting segment on a machine of this size, s.
    pub(crate) fn segment_duration_for(&self, size: &Size) -> f64 {
        self.segment_duration * size.time()
    }

    /// Samples per second that are compared on a machine of this size.
    pub(crate) fn sample_rate_for(&self, size: &Size) -> f64 {
        self.sample_rate / size.time()
    }
}

impl Default for FitSettings {
    fn default() -> Self {
        FitSettings {
            segment_duration: 4.0,
            initial_states: InitialStates::Fitted,
            sample_rate: 170.0,
            give_up_above: f64::INFINITY,
            maximum_steps: 15,
            least_improvement: 1e-3,
        }
    }
}
