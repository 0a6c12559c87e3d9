//! Resolution of a signal.

/// Fraction of samples that repeat the previous one, from which on the resolution may be coarser than the noise. A converter
/// with a step of a fifth of the noise repeats one sample in twenty, one with a step equal to the noise one in four.
const LEAST_REPEATS: f64 = 0.2;

/// Values that differ by less than this fraction of the largest one count as equal, because of rounding on their way here.
const ROUNDING: f64 = 1e-9;

/// With fewer values than this, a signal is switched, not quantised by a converter.
const FEWEST_VALUES: usize = 20;

/// Tolerance of the distances between values from multiples of a converter's step, as a fraction of the step.
const UNEVEN: f64 = 0.02;

/// Fraction of all distances that must be multiples.
const MOST_SPACINGS: f64 = 0.9;

/// Fraction of changes that must be followed by a different change. A signal made by a program has ramps of equal steps; the
/// steps of a converter are irregular.
const IRREGULAR: f64 = 0.5;

/// Step of the converter that quantised a signal, in the signal's unit, if it limits the resolution. Zero if the noise
/// exceeds a few steps, which hides them, and for signals without steps.
pub fn resolution(signal: &[f64]) -> f64 {
    let repeats = signal.windows(2).filter(|pair| pair[0] == pair[1]).count();
    if (repeats as f64) < LEAST_REPEATS * signal.len() as f64 {
        return 0.0;
    }
    let mut values: Vec<f64> = signal.iter().copied().filter(|value| value.is_finite()).collect();
    values.sort_unstable_by(f64::total_cmp);
    let largest = values.first().map_or(0.0, |low| low.abs()).max(values.last().map_or(0.0, |high| high.abs()));
    values.dedup_by(|next, before| *next - *before <= ROUNDING * largest);
    if values.len() < FEWEST_VALUES {
        return 0.0;
    }
    let spacings: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let step = *spacings.clone().select_nth_unstable_by(spacings.len() / 2, f64::total_cmp).1;
    let even = spacings.iter().filter(|&spacing| (spacing / step - (spacing / step).round()).abs() <= UNEVEN).count();
    let changes = signal.windows(3).filter(|three| (three[1] - three[0]).abs() > 0.5 * step);
    let (mut all, mut irregular) = (0_u32, 0_u32);
    for three in changes {
        all += 1;
        irregular += u32::from((three[2] - 2.0 * three[1] + three[0]).abs() > 0.5 * step);
    }
    let is_converted =
        even as f64 >= MOST_SPACINGS * spacings.len() as f64 && f64::from(irregular) >= IRREGULAR * f64::from(all);
    if is_converted { step } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(samples: usize) -> impl Iterator<Item = f64> {
        (0..samples).map(|sample| 3.0 + (0.01 * sample as f64).sin())
    }

    #[test]
    fn a_converter_shows_its_step() {
        let coarse: Vec<f64> = wave(2000).map(|value| (value / 0.05).round() * 0.05 + 0.007).collect();
        assert!((resolution(&coarse) - 0.05).abs() < 1e-9, "{}", resolution(&coarse));
    }

    #[test]
    fn what_went_through_none_has_none() {
        let fine: Vec<f64> = wave(2000).collect();
        let held: Vec<f64> = (0..2000).map(|sample| fine[sample / 5 * 5]).collect();
        let ramps: Vec<f64> = (0..2000).map(|sample| f64::from(sample % 500).clamp(100.0, 300.0) * 1e-6).collect();
        let steps: Vec<f64> = (0..2000).map(|sample| f64::from(sample / 250 % 2) * 1e-4).collect();
        for signal in [&fine[..], &held, &ramps, &steps, &[], &[1.0], &[2.0; 30], &[f64::NAN; 30]] {
            assert_eq!(resolution(signal), 0.0);
        }
    }
}
