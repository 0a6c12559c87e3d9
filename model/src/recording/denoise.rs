//! Removes sensor noise from a signal without blurring its corners.

use super::resolution;

/// Candidate half widths of the window, in samples; below two a parabola does not average.
const HALF_WIDTHS: [usize; 7] = [2, 4, 8, 16, 32, 64, 128];

/// How many standard errors wide the confidence intervals are. The rule's authors recommend 1.5 to 3; of 1, 1.6 and
/// 2.5, 1.6 left the smallest simulation errors on recordings whose true model is known.
const CONFIDENCE: f64 = 1.6;

/// Standard deviation of white noise on a smooth signal, from the median size of second differences, which are nearly free
/// of smooth motion and robust against outliers. It is at least the quantisation error of a coarse converter, uniformly
/// distributed over its step. Zero for fewer than three values or a noiseless signal.
pub fn noise_level(signal: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = signal
        .windows(3)
        .map(|three| (three[2] - 2.0 * three[1] + three[0]).abs())
        .filter(|size| size.is_finite())
        .collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    // Second differences of white noise have variance 1 + 4 + 1; the median size of a normal variable is 0.6745 of its
    // standard deviation.
    (median / (0.6745 * 6.0_f64.sqrt())).max(resolution(signal) / 12.0_f64.sqrt())
}

/// Parabola through the widest symmetric window that the noise allows at each sample: the
/// intersection-of-confidence-intervals rule (Goldenshluger, Nemirovski 1997; Katkovnik 1999) over Savitzky-Golay fits.
/// Windows are wide where the signal is constant or smooth, and narrow at corners. Values must be finite.
///
/// A measured spool opening needs this before it drives a model. The flow has one direction for u > 0 and the other for u <
/// 0, so noise about a closed valve does not average out but acts as a leak from pump to tank through both chambers.
pub fn denoised(signal: &[f64]) -> Vec<f64> {
    with_standard_errors(signal, noise_level(signal)).into_iter().map(|(value, _)| value).collect()
}

/// [`denoised`] for a signal that is zero unless the data contradict it. Each value is shrunk towards zero according to its
/// standard error, with the weights of the non-negative garrote (Breiman 1995). These keep values far beyond their errors
/// and go to zero without a jump. Values below `least` count as zero, however often they are repeated: half a step of a
/// converter does not average out.
///
/// The threshold grows with the number of independent values: the largest of n normal variables hardly ever exceeds `sqrt(2
/// ln n)` (universal threshold, Donoho, Johnstone 1994). A narrow window, as at an outlier, has thousands of others in the
/// signal, a wide one hundreds; and each sample has a choice of windows.
pub fn denoised_towards_zero(signal: &[f64], least: f64) -> Vec<f64> {
    let noise = noise_level(signal);
    let doubt = |error: f64| {
        let values = (signal.len() * HALF_WIDTHS.len()) as f64 * (error / noise).powi(2);
        let errors = (2.0 * values.ln()).max(0.0).sqrt().max(LEAST_DOUBT);
        // Without noise there is no uncertainty.
        if error > 0.0 { (errors * error).max(least) } else { least }
    };
    let kept = |value: f64, doubt: f64| if value.abs() > doubt { value * (1.0 - (doubt / value).powi(2)) } else { 0.0 };
    with_standard_errors(signal, noise).into_iter().map(|(value, error)| kept(value, doubt(error))).collect()
}

/// Standard errors within which a value counts as zero, however few values there are.
const LEAST_DOUBT: f64 = 3.0;

/// Denoised values of a signal with this noise (standard deviation), each with its standard error.
fn with_standard_errors(signal: &[f64], noise: f64) -> Vec<(f64, f64)> {
    if noise == 0.0 {
        return signal.iter().map(|&value| (value, 0.0)).collect();
    }
    let windows: Vec<Window> = HALF_WIDTHS.iter().map(|&half_width| Window::parabola(half_width)).collect();
    (0..signal.len())
        .map(|index| {
            let room = index.min(signal.len() - 1 - index);
            let (mut low, mut high) = (signal[index] - CONFIDENCE * noise, signal[index] + CONFIDENCE * noise);
            let mut estimate = (signal[index], noise);
            for window in windows.iter().take_while(|window| window.half_width() <= room) {
                let value = window.at(signal, index);
                let error = noise * window.standard_error;
                low = low.max(value - CONFIDENCE * error);
                high = high.min(value + CONFIDENCE * error);
                if low > high {
                    break;
                }
                estimate = (value, error);
            }
            estimate
        })
        .collect()
}

/// Weights for which the weighted sum over a symmetric window is the value of the least-squares parabola at the centre.
struct Window {
    /// From the centre outwards; the same on both sides.
    weights: Vec<f64>,
    /// Standard error of the result per unit of noise.
    standard_error: f64,
}

impl Window {
    fn parabola(half_width: usize) -> Self {
        let squares = |power: i32| (1..=half_width).map(|k| 2.0 * (k as f64).powi(power)).sum::<f64>();
        let (count, second, fourth) = ((2 * half_width + 1) as f64, squares(2), squares(4));
        let determinant = count * fourth - second * second;
        let weights: Vec<f64> = (0..=half_width).map(|k| (fourth - second * (k * k) as f64) / determinant).collect();
        // For a projection, the variance of the value at the centre equals the weight of the centre.
        let standard_error = weights[0].sqrt();
        Window { weights, standard_error }
    }

    fn half_width(&self) -> usize {
        self.weights.len() - 1
    }

    fn at(&self, signal: &[f64], index: usize) -> f64 {
        let before = signal[index - self.half_width()..index].iter().rev();
        let after = &signal[index + 1..=index + self.half_width()];
        let sides = self.weights[1..].iter().zip(before.zip(after));
        signal[index] * self.weights[0] + sides.map(|(weight, (before, after))| weight * (before + after)).sum::<f64>()
    }
}
