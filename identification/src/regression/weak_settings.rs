//! Settings of the weak form.

use excavator_model::Model;
use excavator_model::recording::Recording;

/// Settings of the weak form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeakFormSettings {
    /// Half width of a test function, s. With instruments the noise in short windows does no harm. Long windows average
    /// out the fast transients that separate inertia and compressibility from friction and flow. On measured and
    /// simulated recordings 0.03 s gave the smallest errors of 0.02 s to 0.15 s.
    pub half_width: f64,
    /// Smallest number of samples in half a window. It widens windows of slow recordings, whose quadrature would be
    /// coarse.
    pub least_half_width_samples: f64,
    /// Distance between test functions as a fraction of the half width. Closer ones add rows but no information.
    pub step_fraction: f64,
    /// Windows of motion equations in which the piston is slower than this, m/s, are left out. The sign of the
    /// estimated velocity is noise there, and it is the regressor of dry friction.
    pub velocity_guard: f64,
    /// Number of rounds. The first has no instruments. The others use those of the model from the previous round.
    pub rounds: usize,
    /// Whether standard errors and condition numbers are computed. They cost more than the values.
    pub with_errors: bool,
    /// Whether a parameter with an impossible result (a friction below zero) is held at the nearest possible value
    /// while the others are identified again. The start of a search does not need this second solution.
    pub hold_at_bounds: bool,
}

impl Default for WeakFormSettings {
    fn default() -> Self {
        WeakFormSettings {
            half_width: 0.03,
            least_half_width_samples: 12.0,
            step_fraction: 0.25,
            velocity_guard: 1e-3,
            rounds: 3,
            with_errors: true,
            hold_at_bounds: true,
        }
    }
}

impl WeakFormSettings {
    /// Half width and step of the windows for these recordings, s.
    pub(super) fn widths(&self, model: &Model, recordings: &[&Recording]) -> (f64, f64) {
        let slowest = recordings.iter().map(|recording| recording.sample_interval()).fold(0.0, f64::max);
        let half_width = (self.half_width * model.machine.size().time()).max(self.least_half_width_samples * slowest);
        (half_width, half_width * self.step_fraction)
    }
}
