//! Noise of the sensors of a recording.

use excavator_model::Model;
use excavator_model::recording::{Recording, noise_level, standard_deviation};

use super::RegressionError;

/// Standard deviation of each sensor's noise in one recording.
#[derive(Debug, Clone)]
pub(super) struct SensorNoise {
    /// m, per cylinder.
    pub displacement: Vec<f64>,
    /// Pa, per cylinder: cap side, rod side.
    pub pressures: Vec<[f64; 2]>,
    /// m², per cylinder.
    pub spool: Vec<f64>,
    /// Pa.
    pub pump_pressure: f64,
}

/// Noise of the sensors of a recording.
///
/// # Errors
/// [`RegressionError`] if a cylinder is missing.
pub(super) fn sensor_noise(recording: &Recording, model: &Model) -> Result<SensorNoise, RegressionError> {
    // A noiseless (simulated) signal would give its rows infinite weight. Rounding alone is of this size.
    let level = |signal: &[f64]| noise_level(signal).max(1e-6 * standard_deviation(signal)).max(1e-15);
    let mut noise = SensorNoise {
        displacement: vec![],
        pressures: vec![],
        spool: vec![],
        pump_pressure: level(&recording.pump_pressure),
    };
    for cylinder in &model.machine.cylinders {
        let signals = recording.cylinder(&cylinder.name).map_err(excavator_model::SignalError::from)?;
        let lever = cylinder.linkage.lever(cylinder.linkage.joint(0.0)).abs();
        let from_angle = level(&signals.joint_angle) * lever;
        let measured = signals.displacement.iter().any(|value| value.is_finite());
        noise.displacement.push(if measured { level(&signals.displacement) } else { from_angle });
        noise.pressures.push([level(&signals.cap_pressure), level(&signals.rod_pressure)]);
        noise.spool.push(level(&signals.orifice_area));
    }
    Ok(noise)
}
