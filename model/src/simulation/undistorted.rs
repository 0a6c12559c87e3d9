//! From what instruments reported back to what was.

use crate::Model;
use crate::equations::{Channel, Distortion, System};
use crate::recording::{Recording, cubic};

/// The recording as true instruments would have made it: what the model's sensor effects add is taken away. Offsets are
/// subtracted; late signals are moved forward on the clock by their delay, with a cubic between samples, and end by that
/// much earlier (`NaN`). Inputs stay as they are. A model without sensor effects changes nothing.
///
/// For equations that are fed with measurements. How the true values depend on the sensor effects' parameters says
/// [`Distortion::truth`].
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
