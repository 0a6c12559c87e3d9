//! How a fit is done.

use excavator_model::machine::Size;

/// Settings of an output-error fit, on a machine of [`Size::REFERENCE`]; a fit stretches them to the time of its machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitSettings {
    /// Length of one shooting segment, s. Long enough that slow effects (leakage, drift) show as displacement, short
    /// enough that a wrong model cannot run away from the data: a wrong model is what we want to look at.
    pub segment_duration: f64,
    /// Samples per second that are compared; faster recordings are thinned to about this. Errors of a model are slower
    /// than that, and thinning saves time in proportion. Not where a valve moves too fast for it.
    pub sample_rate: f64,
    /// A fit whose loss (see [`crate::fit::Fit::loss`]) is still above this after four steps is given up.
    pub give_up_above: f64,
    /// Most Gauss-Newton steps.
    pub maximum_steps: usize,
    /// A step that improves the loss by less than this fraction ends the fit.
    pub least_improvement: f64,
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
            sample_rate: 170.0,
            give_up_above: f64::INFINITY,
            maximum_steps: 15,
            least_improvement: 1e-3,
        }
    }
}
