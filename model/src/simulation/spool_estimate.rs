//! Best estimate of the true spool position.

use super::servo_follower::servo_follower;
use super::spool_memory::remembered;
use crate::recording::{denoised, denoised_towards_zero, noise_level, resolution};

/// Spool position (m²) from its sensor and its command, without holes; a command that never moves is not used.
///
/// A spool follows its command through a servo. A first-order lag with a delay, gain and offset, fitted to the recording,
/// explains most of the motion without any noise. The residual is denoised and added back where it is significant, so that no
/// motion beyond the sensor's noise is lost. With a perfect servo the result is noiseless; without a servo it is the denoised
/// measurement. Insignificant residuals would do harm: the output of a valve with a play of a few noise levels depends on the
/// last spool motion, and every small ripple of the estimate about a resting spool would move it.
pub(super) fn spool_estimate(time: &[f64], measured: &[f64], command: &[f64]) -> Vec<f64> {
    remembered(time, measured, command, || estimate(time, measured, command))
}

fn estimate(time: &[f64], measured: &[f64], command: &[f64]) -> Vec<f64> {
    let noise = noise_level(measured);
    if time.len() < 3 || noise == 0.0 {
        return denoised(measured);
    }
    let Some(follower) = servo_follower(time, measured, command, noise) else { return denoised(measured) };
    let rest: Vec<f64> = measured.iter().zip(&follower).map(|(measured, follower)| measured - follower).collect();
    // A poor servo model would add corners of its own; the sensor alone is then more reliable.
    if noise_level(&rest) > 1.2 * noise {
        return denoised(measured);
    }
    let half_a_step = 0.5 * resolution(measured);
    denoised_towards_zero(&rest, half_a_step).iter().zip(&follower).map(|(rest, follower)| rest + follower).collect()
}
