//! The period of the work cycle, and energies per period.

use excavator_model::Model;

use super::analysis::Cycle;
use super::{Books, Totals};

/// Smallest correlation of the command with itself one period later that counts as repetition.
const LEAST_CORRELATION: f64 = 0.9;
/// Fewest periods for a mean.
const FEWEST_CYCLES: f64 = 3.0;

/// Period (s) of a signal whose dominant frequency is about `frequency` (Hz); `None` if it does not repeat.
pub(super) fn period(time: &[f64], signal: &[f64], frequency: f64) -> Option<f64> {
    let duration = time.last()? - time.first()?;
    // The spectrum resolves the frequency to about half of the reciprocal of its duration; correlation is more accurate.
    let (best, correlation) = (-40..=40)
        .map(|step| frequency * (1.0 + f64::from(step) * 1e-3))
        .filter(|frequency| *frequency > 0.0)
        .map(|frequency| (1.0 / frequency, repetition(time, signal, 1.0 / frequency)))
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    (correlation >= LEAST_CORRELATION && duration >= FEWEST_CYCLES * best).then_some(best)
}

/// Correlation of a signal with itself `lag` seconds later.
fn repetition(time: &[f64], signal: &[f64], lag: f64) -> f64 {
    let stride = (time.len() / 4000).max(1);
    let (mut product, mut now, mut then) = (0.0, 0.0, 0.0);
    let mut next = 0;
    for index in (0..time.len()).step_by(stride) {
        while next < time.len() && time[next] < time[index] + lag {
            next += 1;
        }
        let (Some(&later), value) = (signal.get(next), signal[index]) else { break };
        if later.is_finite() && value.is_finite() {
            product += value * later;
            now += value * value;
            then += later * later;
        }
    }
    product / (now * then).sqrt().max(f64::MIN_POSITIVE)
}

/// Sums energies cycle by cycle.
#[derive(Debug)]
pub(super) struct Cycles {
    period: f64,
    model_totals: Totals,
    current: Option<(i64, Totals)>,
    count: usize,
    mean: Vec<f64>,
    squares: Vec<f64>,
}

/// Share of a cycle in gaps above which the cycle is skipped.
const LARGEST_GAP: f64 = 0.05;

impl Cycles {
    /// Cycles of `period` seconds from the start of the recording.
    pub fn new(model: &Model, period: f64) -> Self {
        let mut model_totals = Totals::new(model);
        let numbers = model_totals.numbers_mut().len();
        Cycles { period, model_totals, current: None, count: 0, mean: vec![0.0; numbers], squares: vec![0.0; numbers] }
    }

    /// Adds the time between an entry and the next one.
    pub fn add(&mut self, books: &Books, entry: usize) {
        let number = (books.time[entry] / self.period).floor() as i64;
        if self.current.as_ref().is_none_or(|(current, _)| *current != number) {
            self.close();
            self.current = Some((number, self.model_totals.clone()));
        }
        if let Some((_, totals)) = &mut self.current {
            totals.add(books, entry);
            for (blank, own) in self.model_totals.effects.iter_mut().zip(&totals.effects) {
                blank.has_power = own.has_power;
            }
        }
    }

    fn close(&mut self) {
        let Some((_, mut totals)) = self.current.take() else { return };
        if (totals.duration / self.period - 1.0).abs() > LARGEST_GAP {
            return;
        }
        self.count += 1;
        let count = self.count as f64;
        for ((value, mean), squares) in totals.numbers_mut().into_iter().zip(&mut self.mean).zip(&mut self.squares) {
            let before = *value - *mean;
            *mean += before / count;
            *squares += before * (*value - *mean);
        }
    }

    /// Means and standard deviations over the whole cycles.
    pub fn finish(mut self) -> Option<Cycle> {
        self.close();
        if self.count < 2 {
            return None;
        }
        let (mut mean, mut deviation) = (self.model_totals.clone(), self.model_totals.clone());
        for (slot, value) in mean.numbers_mut().into_iter().zip(&self.mean) {
            *slot = *value;
        }
        for (slot, squares) in deviation.numbers_mut().into_iter().zip(&self.squares) {
            *slot = (squares / (self.count - 1) as f64).sqrt();
        }
        Some(Cycle { period: self.period, count: self.count, mean, deviation })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_repeats_and_a_sweep_does_not() {
        let time: Vec<f64> = (0..20_000).map(|k| f64::from(k) * 1e-3).collect();
        let sine: Vec<f64> = time.iter().map(|t| (std::f64::consts::TAU * 0.731 * t).sin()).collect();
        let found = period(&time, &sine, 0.725).unwrap_or(f64::NAN);
        assert!((found * 0.731 - 1.0).abs() < 2e-3, "{found}");
        let sweep: Vec<f64> = time.iter().map(|t| (std::f64::consts::TAU * (0.3 + 0.05 * t) * t).sin()).collect();
        assert_eq!(period(&time, &sweep, 0.8), None);
    }
}
