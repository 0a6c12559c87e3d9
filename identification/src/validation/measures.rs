//! Measures of fit (\[A\] Section 4.2, \[B\] Table I).

/// Noise alone may have this normalised mean squared error at most in a signal that tells a model's error: in a signal with more,
/// which hardly changes or which was derived from a noisy one, the error is that of the instrument.
const MOST_NOISE: f64 = 0.1;

/// Sums over the samples that a measurement and its simulation both have. Sums of several recordings can be joined, so that a measure
/// does not depend on how a measurement was cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorSums {
    /// Number of samples.
    count: f64,
    /// Mean of the measurement.
    mean: f64,
    /// Sum of squared distances of the measurement from its mean.
    spread: f64,
    /// Sum of squared errors.
    squares: f64,
    /// Sum of squared sensor noise; `NaN` if it is not known.
    noise: f64,
}

impl ErrorSums {
    /// The sums of a measurement with this noise (standard deviation, in its unit; `NaN` if not known) and its simulation.
    pub fn of(measured: &[f64], simulated: &[f64], noise: f64) -> Self {
        let pairs = || measured.iter().zip(simulated).filter(|(m, s)| m.is_finite() && s.is_finite());
        let count = pairs().count() as f64;
        let mean = pairs().map(|(m, _)| m).sum::<f64>() / count;
        ErrorSums {
            count,
            mean,
            spread: pairs().map(|(m, _)| (m - mean).powi(2)).sum(),
            squares: pairs().map(|(m, s)| (m - s).powi(2)).sum(),
            noise: count * noise * noise,
        }
    }

    /// The sums over all samples of several recordings.
    pub fn joined(parts: impl Iterator<Item = ErrorSums>) -> Self {
        let nothing = ErrorSums { count: 0.0, mean: 0.0, spread: 0.0, squares: 0.0, noise: 0.0 };
        parts.filter(|part| part.count > 0.0).fold(nothing, |sum, part| {
            let count = sum.count + part.count;
            let distance = part.mean - sum.mean;
            ErrorSums {
                count,
                mean: sum.mean + distance * part.count / count,
                // Chan, Golub, LeVeque 1983: without the difference of two large sums.
                spread: sum.spread + part.spread + distance * distance * sum.count * part.count / count,
                squares: sum.squares + part.squares,
                noise: sum.noise + part.noise,
            }
        })
    }

    /// Normalised mean squared error `sum (y - yhat)² / sum (y - mean y)²`; `NaN` if there is no sample or the measurement never
    /// changes.
    pub fn normalised(&self) -> f64 {
        if self.spread > 0.0 { self.squares / self.spread } else { f64::NAN }
    }

    /// Root mean squared error, in the unit of the signal; `NaN` if there is no sample.
    pub fn root_mean_square(&self) -> f64 {
        (self.squares / self.count).sqrt()
    }

    /// `FIT = 100 (1 - ||y - yhat|| / ||y - mean y||)`, %.
    pub fn fit_percent(&self) -> f64 {
        100.0 * (1.0 - self.normalised().sqrt())
    }

    /// Normalised mean squared error of sensor noise alone, a lower bound for any model in the long run; `NaN` if it is not known.
    pub fn normalised_noise(&self) -> f64 {
        if self.spread > 0.0 { self.noise / self.spread } else { f64::NAN }
    }

    /// Whether the signal changes by so much more than its noise that the error is the model's.
    pub fn tells(&self) -> bool {
        let noise = self.normalised_noise();
        self.spread > 0.0 && (noise.is_nan() || noise <= MOST_NOISE)
    }
}

/// Normalised mean squared error over samples where both are finite, as [`ErrorSums::normalised`].
pub fn normalised_mean_squared_error(measured: &[f64], simulated: &[f64]) -> f64 {
    ErrorSums::of(measured, simulated, f64::NAN).normalised()
}

/// Mean normalised error of the signals that tell it, or of all that change if none does; `NaN` if none changes.
pub fn mean_normalised(signals: &[ErrorSums]) -> f64 {
    let errors = |counts: fn(&ErrorSums) -> bool| -> Vec<f64> {
        signals.iter().filter(|one| counts(one)).map(ErrorSums::normalised).filter(|error| !error.is_nan()).collect()
    };
    let told = errors(ErrorSums::tells);
    let used = if told.is_empty() { errors(|_| true) } else { told };
    used.iter().sum::<f64>() / used.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_joined_are_the_whole() {
        let measured: Vec<f64> = (0..1000).map(|k| (0.01 * f64::from(k)).sin() + 0.3).collect();
        let simulated: Vec<f64> = (0..1000).map(|k| (0.01 * f64::from(k) - 0.1).sin() + 0.3).collect();
        let whole = ErrorSums::of(&measured, &simulated, 1e-3);
        for length in [7, 100, 333] {
            let parts = measured.chunks(length).zip(simulated.chunks(length));
            let joined = ErrorSums::joined(parts.map(|(m, s)| ErrorSums::of(m, s, 1e-3)));
            assert!((joined.normalised() / whole.normalised() - 1.0).abs() < 1e-12);
            assert!((joined.root_mean_square() / whole.root_mean_square() - 1.0).abs() < 1e-12);
            assert!((joined.normalised_noise() / whole.normalised_noise() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_signal_of_noise_stays_out_of_the_mean() {
        let wave: Vec<f64> = (0..1000).map(|k| (0.1 * f64::from(k)).sin()).collect();
        let still = vec![0.0; 1000];
        let ripple: Vec<f64> = (0..1000).map(|k| 1e-3 * (f64::from(k * k % 17) - 8.0)).collect();
        let good = ErrorSums::of(&wave, &wave.iter().map(|w| 0.9 * w).collect::<Vec<_>>(), 1e-3);
        let noisy = ErrorSums::of(&ripple, &wave, 5e-3);
        let constant = ErrorSums::of(&still, &wave, 0.0);
        assert!(good.tells() && !noisy.tells() && !constant.tells());
        assert!((mean_normalised(&[good, noisy, constant]) - 0.01).abs() < 1e-4);
        assert_eq!(mean_normalised(&[noisy, constant]), noisy.normalised());
        assert!(mean_normalised(&[constant]).is_nan());
    }
}
