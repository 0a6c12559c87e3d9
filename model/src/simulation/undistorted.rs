//! Recovers true values from instrument readings.

use crate::Model;
use crate::equations::{Channel, Distortion, System};
use crate::recording::{Recording, cubic};

/// The recording as ideal instruments would have made it, without the model's sensor effects. Offsets are subtracted.
/// Delayed signals are moved forward on the clock by their delay, with a cubic between samples, and end earlier by that
/// time (`NaN`). Inputs stay unchanged. A model without sensor effects changes nothing.
///
/// For equations that take measurements as inputs. [`Distortion::truth`] gives the dependence of the true values on the
/// sensor effects' parameters.
#[must_use]
pub fn undistorted(model: &Model, recording: &Recording) -> Recording {
    let mut corrected = recording.clone();
    let system = System::new(model);
    let instruments = system.own_instruments();
    if instruments.are_true() {
        return corrected;
    }
    for channel in Channel::all(system.layout()) {
        let Distortion { offset, delay } = instruments.of(channel);
        let Some(values) = channel.signal_mut(&model.machine, &mut corrected) else { continue };
        if delay != 0.0 {
            let reported = std::mem::take(values);
            *values = recording.time.iter().map(|&time| cubic(&recording.time, &reported, time + delay)).collect();
        }
        if offset != 0.0 {
            values.iter_mut().for_each(|value| *value -= offset);
        }
    }
    corrected
}
