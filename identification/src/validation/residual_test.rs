//! Tests whether the error of a model is correlated with its own past or with the machine's input.
//!
//! The error of a complete model is sensor noise: white, and not correlated with the input. These are the two classical
//! tests of residuals (Ljung, *System Identification*, Section 16.6). The bound of the second holds for coloured
//! errors.

use statrs::distribution::{ContinuousCDF, Normal};

/// A correlation at the lag where it is largest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correlation {
    /// Correlation coefficient, -1 to 1.
    pub value: f64,
    /// Delay of the error after the signal that it is correlated with, s.
    pub lag: f64,
    /// Magnitude that chance alone exceeds at any lag in one of a hundred recordings.
    pub bound: f64,
}

impl Correlation {
    /// Whether it is larger than chance explains.
    pub fn is_significant(&self) -> bool {
        self.value.abs() > self.bound
    }
}

/// Longest lag, s. After it an arm no longer depends on its input, except for drift.
const LONGEST_LAG: f64 = 2.0;
/// Errors are first averaged over this time, s. Nothing in a machine's error is faster, and averaging reduces noise.
const BIN: f64 = 0.02;
/// Probability that a recording of noise is called correlated at some lag.
const FALSE_ALARMS: f64 = 0.01;
/// Smallest number of bins for a test.
const FEWEST: usize = 100;

/// Correlation of an error with its own past; lags from one bin on. Returns `None` if the recording is too short, or if
/// there is no error.
pub fn autocorrelation(time: &[f64], error: &[f64]) -> Option<Correlation> {
    let binned = centred(&binned(time, error))?;
    let lags = longest(binned.len());
    let own = correlations(&binned, &binned, lags);
    let bound = deviations(lags) / (binned.len() as f64).sqrt();
    largest(&own[1..], 1, bound)
}

/// Correlation of an error with the input at the same time or before. Returns `None` if the recording is too short, if
/// there is no error, or if the input does not change.
pub fn input_correlation(time: &[f64], error: &[f64], input: &[f64]) -> Option<Correlation> {
    let (error, input) = (centred(&binned(time, error))?, centred(&binned(time, input))?);
    let lags = longest(error.len());
    // Bartlett: the variance of a correlation between two independent signals is the sum of the products of their own
    // correlations over their length; errors that are not white correlate with any signal by chance.
    let (own, of_input) = (correlations(&error, &error, lags), correlations(&input, &input, lags));
    let products: f64 = own.iter().zip(&of_input).skip(1).map(|(a, b)| 2.0 * a * b).sum();
    let bound = deviations(lags) * ((1.0 + products).max(1.0) / error.len() as f64).sqrt();
    largest(&correlations(&input, &error, lags), 0, bound)
}

fn longest(bins: usize) -> usize {
    ((LONGEST_LAG / BIN) as usize).min(bins / 4)
}

/// Number of standard deviations that normal noise exceeds at any of the lags with probability [`FALSE_ALARMS`]
/// (Bonferroni).
fn deviations(lags: usize) -> f64 {
    Normal::standard().inverse_cdf(1.0 - FALSE_ALARMS / (2.0 * (lags as f64 + 1.0)))
}

fn largest(correlations: &[f64], first_lag: usize, bound: f64) -> Option<Correlation> {
    let (index, &value) = correlations.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    Some(Correlation { value, lag: (index + first_lag) as f64 * BIN, bound })
}

/// Means over bins; `NaN` for a bin without a finite sample.
fn binned(time: &[f64], signal: &[f64]) -> Vec<f64> {
    let (Some(&start), Some(&end)) = (time.first(), time.last()) else { return Vec::new() };
    // A faulty clock may span more bins than there are samples.
    let bins = (((end - start) / BIN) as usize + 1).min(time.len());
    let (mut sums, mut counts) = (vec![0.0; bins], vec![0.0; bins]);
    for (t, value) in time.iter().zip(signal).filter(|(_, value)| value.is_finite()) {
        let bin = ((t - start) / BIN) as usize;
        if let (Some(sum), Some(count)) = (sums.get_mut(bin), counts.get_mut(bin)) {
            *sum += value;
            *count += 1.0;
        }
    }
    sums.iter().zip(&counts).map(|(sum, count)| sum / count).collect()
}

/// Subtracts the mean and divides by the norm. Gaps are zero.
fn centred(signal: &[f64]) -> Option<Vec<f64>> {
    let known = || signal.iter().filter(|value| value.is_finite());
    let count = known().count();
    if count < FEWEST {
        return None;
    }
    let mean = known().sum::<f64>() / count as f64;
    let size = known().map(|value| (value - mean).powi(2)).sum::<f64>().sqrt();
    // A signal that varies only by rounding counts as constant.
    let varies = size > 1e-12 * (mean.abs() * (count as f64).sqrt()).max(f64::MIN_POSITIVE);
    varies.then(|| signal.iter().map(|value| if value.is_finite() { (value - mean) / size } else { 0.0 }).collect())
}

/// Correlation of `later` with `earlier` at lags of 0 to `lags` bins.
fn correlations(earlier: &[f64], later: &[f64], lags: usize) -> Vec<f64> {
    (0..=lags).map(|lag| earlier.iter().zip(later.iter().skip(lag)).map(|(a, b)| a * b).sum()).collect()
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    const SAMPLES: usize = 10_000;

    fn clock() -> Vec<f64> {
        (0..SAMPLES).map(|index| index as f64 * 2e-3).collect()
    }

    fn noise(seed: u64) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        (0..SAMPLES).map(|_| StandardNormal.sample(&mut random)).collect()
    }

    /// Noise with a correlation time of 0.2 s.
    fn slow_noise(seed: u64) -> Vec<f64> {
        let mut level = 0.0;
        let remember = |step| {
            level = 0.99 * level + step;
            level
        };
        noise(seed).into_iter().map(remember).collect()
    }

    #[test]
    fn noise_is_called_correlated_in_one_of_a_hundred_at_most() {
        let time = clock();
        let swing: Vec<f64> = time.iter().map(|t| (3.0 * t).sin() + (7.7 * t).sin()).collect();
        let is_found = |found: Option<Correlation>| usize::from(found.is_some_and(|found| found.is_significant()));
        let (mut own, mut white, mut slow) = (0, 0, 0);
        for seed in 0..100 {
            own += is_found(autocorrelation(&time, &noise(seed)));
            white += is_found(input_correlation(&time, &noise(seed), &swing));
            slow += is_found(input_correlation(&time, &slow_noise(seed), &slow_noise(seed + 1000)));
        }
        assert!(own <= 1 && white <= 1 && slow <= 3, "{own} {white} {slow}");
    }

    #[test]
    fn what_an_error_has_of_its_input_is_found_with_its_lag() {
        let time = clock();
        let input = slow_noise(1);
        let delayed = 150; // samples of 2 ms
        let error: Vec<f64> = noise(2)
            .iter()
            .enumerate()
            .map(|(index, noise)| noise + if index >= delayed { 0.3 * input[index - delayed] } else { 0.0 })
            .collect();
        let found = input_correlation(&time, &error, &input);
        assert!(found.is_some_and(|found| found.is_significant() && (found.lag - 0.3).abs() < 0.03), "{found:?}");
    }

    #[test]
    fn an_error_that_remembers_is_not_white() {
        let found = autocorrelation(&clock(), &slow_noise(3));
        assert!(found.is_some_and(|found| found.is_significant() && found.value > 0.5), "{found:?}");
    }

    #[test]
    fn nothing_is_said_of_too_little() {
        let time = clock();
        assert_eq!(autocorrelation(&time[..400], &noise(1)[..400]), None);
        assert_eq!(autocorrelation(&time, &vec![f64::NAN; SAMPLES]), None);
        assert_eq!(input_correlation(&time, &noise(1), &vec![3.0; SAMPLES]), None);
        assert_eq!(autocorrelation(&[], &[]), None);
    }
}
