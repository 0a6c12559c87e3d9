//! The best estimate of where a spool really was.

use super::servo_follower::servo_follower;
use super::spool_memory::remembered;
use crate::recording::{denoised, denoised_towards_zero, noise_level, resolution};

/// Spool position (m²) from its sensor and from the command that moved it, without holes; a command that never moves says nothing.
///
/// A spool follows its command through a servo; a lag of first order with a delay, gain and offset, fitted to the
/// recording, explains most of the motion without any noise. What it leaves is denoised and added back where it is beyond
/// doubt, so that nothing the sensor saw beyond its noise is lost: with a perfect servo the result is noiseless, with none
/// it is the denoised measurement. Doubtful values would do harm: a valve with play of a few noise levels ends where its
/// spool came last, and every little wave of the estimate about a resting spool would take it along.
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
    // A poor servo model would add corners of its own; then the sensor alone is the better witness.
    if noise_level(&rest) > 1.2 * noise {
        return denoised(measured);
    }
    let half_a_step = 0.5 * resolution(measured);
    denoised_towards_zero(&rest, half_a_step).iter().zip(&follower).map(|(rest, follower)| rest + follower).collect()
}
