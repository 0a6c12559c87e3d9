//! Settings of an energy analysis.

use excavator_model::machine::Size;

/// Settings of an energy analysis for a machine of [`Size::REFERENCE`]; an analysis scales them to the time of its machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergySettings {
    /// Half width of the parabola through pressures, and of the slope of the energy, s. As in the live monitor, an arm's energy,
    /// which changes within 50 ms at the fastest, keeps 97 % of its amplitude.
    pub half_width: f64,
    /// Half width of the parabola through displacements, whose slope is the velocity, s. It is twice as wide, because a slope is
    /// noisier than a value and pistons move more slowly than pressures.
    pub motion_half_width: f64,
    /// Half width of the windows in which the ledger is judged, s: shorter than a stroke, so that a window belongs to
    /// one regime.
    pub window_half_width: f64,
    /// Standard deviations of sensor noise that the root mean square of missing power must exceed to be reported.
    pub significance: f64,
    /// The same for the standard errors of the parameters. It is smaller than for noise, because the standard errors of an
    /// identification already include the error that its model does not explain.
    pub parameter_significance: f64,
    /// Share of the power through a place below which missing power is not reported, regardless of noise: sensor clocks and
    /// signal slopes are no more accurate.
    pub tolerance: f64,
    /// Number of repeats with added sensor noise. Near tank pressure, few repeats reach the steep part of the square root: six
    /// repeats judged windows of 4 s as not closed twelve times as often as twelve did.
    pub draws: usize,
    /// Time from the start that is simulated, plotted, and searched for a period, s. A longer free-running simulation drifts away
    /// and does not determine a phase.
    pub head: f64,
    /// Length of the blocks in which a long recording is processed, s.
    pub block: f64,
    /// After the head, only one in this many blocks is repeated with added noise; the others reuse its effect.
    pub blocks_per_draw: usize,
    /// Time without a sample that counts as a gap, s.
    pub gap: f64,
    /// Seed of the added noise.
    pub seed: u64,
}

impl EnergySettings {
    /// The same for a machine of this size.
    pub(crate) fn for_size(self, size: &Size) -> Self {
        let time = size.time();
        EnergySettings {
            half_width: self.half_width * time,
            motion_half_width: self.motion_half_width * time,
            window_half_width: self.window_half_width * time,
            head: self.head * time,
            block: self.block * time,
            gap: self.gap * time,
            ..self
        }
    }
}

impl Default for EnergySettings {
    fn default() -> Self {
        EnergySettings {
            half_width: 0.01,
            motion_half_width: 0.02,
            window_half_width: 0.2,
            significance: 2.0,
            parameter_significance: 1.5,
            tolerance: 0.01,
            draws: 12,
            head: 120.0,
            block: 20.0,
            blocks_per_draw: 64,
            gap: 0.05,
            seed: 1,
        }
    }
}
