//! Phase delay of the model at the frequency of the excitation.

use std::f64::consts::{PI, TAU};

use excavator_model::recording::closed_gaps;

/// Frequency range of the search for the excitation, Hz: an arm is moved between once in five seconds and ten times a
/// second. Below that, drift dominates.
const FREQUENCY_RANGE: (f64, f64) = (0.2, 10.0);

/// Complex amplitude (cosine, sine part) of a signal at `frequency` Hz under a Hann window, mean removed.
fn amplitude(time: &[f64], signal: &[f64], frequency: f64) -> (f64, f64) {
    let (Some(&start), Some(&end)) = (time.first(), time.last()) else { return (0.0, 0.0) };
    let window = |t: f64| 0.5 - 0.5 * (TAU * (t - start) / (end - start)).cos();
    let samples = || time.iter().zip(signal).filter(|(_, value)| value.is_finite());
    let (weights, sum) = samples().fold((0.0, 0.0), |(weights, sum), (&t, &value)| {
        let weight = window(t);
        (weights + weight, sum + weight * value)
    });
    if weights == 0.0 {
        return (0.0, 0.0);
    }
    let mean = sum / weights;
    samples().fold((0.0, 0.0), |(real, imaginary), (&t, &value)| {
        let angle = TAU * frequency * t;
        let weighted = window(t) * (value - mean) / weights;
        (real + weighted * angle.cos(), imaginary - weighted * angle.sin())
    })
}

/// Frequency in Hz at which `signal` is strongest between 0.2 Hz and 10 Hz. Returns `None` for less than one period of
/// the slowest frequency, or for a signal that does not change.
pub fn dominant_frequency(time: &[f64], signal: &[f64]) -> Option<f64> {
    // The resolution of the frequency grid follows from the duration of the recording without time gaps.
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len().checked_sub(1)? / 2;
    let interval = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let time = &*closed_gaps(time, interval);
    let duration = time.last()? - time.first()?;
    if duration * FREQUENCY_RANGE.0 < 1.0 {
        return None;
    }
    // Fifty samples per second are sufficient up to 10 Hz.
    let stride = ((time.len() as f64 / duration / 50.0) as usize).max(1);
    let thin = |values: &[f64]| values.iter().copied().step_by(stride).collect::<Vec<f64>>();
    let (time, signal) = (thin(time), thin(signal));
    let step = 0.5 / duration;
    let count = ((FREQUENCY_RANGE.1 - FREQUENCY_RANGE.0) / step) as usize;
    let powers: Vec<(f64, f64)> = (0..=count)
        .map(|index| FREQUENCY_RANGE.0 + index as f64 * step)
        .map(|frequency| {
            let (real, imaginary) = amplitude(&time, &signal, frequency);
            (real * real + imaginary * imaginary, frequency)
        })
        .collect();
    // Only a peak inside the range counts. A maximum at the edge of the range belongs to drift outside it.
    let peaks = powers.windows(3).filter(|three| three[1].0 > three[0].0 && three[1].0 >= three[2].0);
    let strongest = peaks.map(|three| three[1]).max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(strongest.1)
}

/// Lag of the simulated signal behind the measured one at `frequency` Hz, in degrees between -180 and 180. Returns
/// `None` if either has no component there.
pub fn phase_delay_degrees(time: &[f64], measured: &[f64], simulated: &[f64], frequency: f64) -> Option<f64> {
    let measured = amplitude(time, measured, frequency);
    let simulated = amplitude(time, simulated, frequency);
    if measured == (0.0, 0.0) || simulated == (0.0, 0.0) {
        return None;
    }
    let mut lag = measured.1.atan2(measured.0) - simulated.1.atan2(simulated.0);
    while lag > PI {
        lag -= TAU;
    }
    while lag < -PI {
        lag += TAU;
    }
    lag.is_finite().then(|| lag.to_degrees())
}
