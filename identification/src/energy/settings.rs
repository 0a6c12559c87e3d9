//! How the energy of a recording is analysed.

use excavator_model::machine::Size;

/// Settings of an energy analysis, on a machine of [`Size::REFERENCE`]; an analysis stretches them to the time of its machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergySettings {
    /// Half width of the parabola through pressures, and of the slope of the energy, s. As in the live monitor: an arm's
    /// energy, which changes within 50 ms at the fastest, passes with 97 % of its amplitude.
    pub half_width: f64,
    /// Half width of the parabola through displacements, whose slope is the velocity, s. Twice as wide, since a slope is
    /// noisier than a value and pistons move more slowly than pressures.
    pub motion_half_width: f64,
    /// Half width of the windows in which the ledger is judged, s: shorter than a stroke, so that a window belongs to
    /// one regime.
    pub window_half_width: f64,
    /// Standard deviations of sensor noise that the root mean square of missing power must exceed to be told.
    pub significance: f64,
    /// The same for the standard errors of the parameters. Less than for noise: standard errors of an identification
    /// have grown already with what its model does not explain.
    pub parameter_significance: f64,
    /// Missing power below this share of the power that flows through its place is not told, whatever the noise: clocks
    /// of sensors and slopes of signals are no sharper.
    pub tolerance: f64,
    /// Repeats with added sensor noise. Where a pressure is near that of the tank few repeats hit the steep part of the
    /// square root: six called windows of 4 s open twelve times as often as twelve did.
    pub draws: usize,
    /// Time from the start that is simulated, plotted, and searched for a period, s. A simulation that runs free for
    /// longer has drifted away and says nothing of phase.
    pub head: f64,
    /// Length of the blocks that a long recording is worked off in, s.
    pub block: f64,
    /// After the head, only every so many blocks are repeated with added noise; the others take over its effect.
    pub blocks_per_draw: usize,
    /// Time without a sample that separates what comes after from what was before, s.
    pub gap: f64,
    /// Seed of the added noise.
    pub seed: u64,
}

impl EnergySettings {
    /// The same on a machine of this size.
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
