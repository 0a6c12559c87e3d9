//! Selects stretches one after the other while a recording is read.

use excavator_model::Model;
use excavator_model::recording::Recording;
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::joined;
use crate::regression::{Gauge, RegressionError};

/// Limits for the kept part of a recording, on a machine of the reference size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelectionSettings {
    /// Length of a stretch, s: two shooting segments of a fit.
    pub stretch: f64,
    /// Largest number of kept stretches. Twelve are a minute and a half, which a fit processes in a few seconds. For
    /// eight minutes of which a fifth moves far, the interval of the damping is 1.6 to 3.2 times as wide as with the
    /// whole recording.
    pub most: usize,
}

impl Default for SelectionSettings {
    fn default() -> Self {
        SelectionSettings { stretch: 8.0, most: 12 }
    }
}

/// A running selection, updated with each block of the recording.
pub struct Selection<'m> {
    model: &'m Model,
    settings: SelectionSettings,
    gauge: Option<Gauge<'m>>,
    kept: Vec<Stretch>,
    /// Information of all stretches so far.
    all: DMatrix<f64>,
    offered: usize,
    /// Timestamp of the first sample, ns.
    start: Option<i64>,
    /// Duration of all offered blocks, s.
    duration: f64,
}

struct Stretch {
    recording: Recording,
    information: DMatrix<f64>,
}

/// The selected stretches.
#[derive(Debug, Clone)]
#[must_use]
pub struct Chosen {
    /// The stretches as one recording with gaps in its sample times.
    pub recording: Recording,
    /// Start of each stretch, s after the first offered sample.
    pub starts: Vec<f64>,
    /// Length of a stretch, s.
    pub stretch: f64,
    /// Duration of all offered blocks, s.
    pub duration: f64,
    /// Factor by which the intervals of the parameters, as a geometric mean, would be wider with as many random
    /// stretches. `None` if no equation has all of its signals: then nothing tells one stretch from another, and the kept ones are
    /// spread over the recording.
    pub gain: Option<f64>,
}

impl<'m> Selection<'m> {
    /// A selection for fits of `model`.
    pub fn new(model: &'m Model, settings: SelectionSettings) -> Self {
        let (gauge, kept, all) = (None, Vec::new(), DMatrix::zeros(0, 0));
        Selection { model, settings, gauge, kept, all, offered: 0, start: None, duration: 0.0 }
    }

    /// Processes the next block of the recording.
    ///
    /// # Errors
    /// [`RegressionError`] if it lacks a cylinder of the model, or all of its stretches lack inputs.
    pub fn offer(&mut self, block: &Recording) -> Result<(), RegressionError> {
        self.start.get_or_insert(block.start_nanoseconds);
        self.duration += block.recorded_time();
        if self.gauge.is_none() {
            let gauge = Gauge::new(self.model, block)?;
            self.all = DMatrix::zeros(gauge.parameters(), gauge.parameters());
            self.gauge = Some(gauge);
        }
        let Some(gauge) = &self.gauge else { return Ok(()) };
        let results: Vec<Result<Stretch, RegressionError>> = stretches(block, self.length())
            .par_iter()
            .map(|[from, to]| {
                let recording = block.part(*from, *to);
                let information = gauge.information(&recording)?;
                Ok(Stretch { recording, information })
            })
            .collect();
        let mut failure = None;
        let mut taken = 0;
        for result in results {
            match result {
                Ok(stretch) => {
                    taken += 1;
                    self.consider(stretch);
                }
                Err(error) => failure = Some(error),
            }
        }
        // A hole in the inputs only loses its stretch. Inputs that are always missing are an error.
        failure.filter(|_| taken == 0).map_or(Ok(()), Err)
    }

    fn length(&self) -> f64 {
        self.settings.stretch * self.model.machine.size().time()
    }

    /// Adds a stretch. If there are too many, drops the one whose removal leaves the most information.
    fn consider(&mut self, stretch: Stretch) {
        self.all += &stretch.information;
        self.offered += 1;
        self.kept.push(stretch);
        if self.kept.len() <= self.settings.most {
            return;
        }
        let total = self.kept_information();
        let without = |kept: &Stretch| log_determinant(&total - &kept.information);
        let least = if self.is_blind() {
            // The one whose neighbours are closest to each other, so that the others stay spread.
            let start = |number: usize| self.kept[number].recording.start_nanoseconds;
            (1..self.kept.len() - 1)
                .min_by_key(|&number| start(number + 1) - start(number - 1))
                .or(Some(self.settings.most))
        } else {
            let each = self.kept.iter().map(without).enumerate();
            each.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(number, _)| number)
        };
        if let Some(number) = least {
            self.kept.remove(number);
        }
    }

    /// Whether no stretch so far tells anything about a parameter.
    pub fn is_blind(&self) -> bool {
        self.all.iter().all(|information| *information == 0.0)
    }

    fn kept_information(&self) -> DMatrix<f64> {
        self.kept.iter().fold(DMatrix::zeros(self.all.nrows(), self.all.ncols()), |sum, kept| sum + &kept.information)
    }

    /// Returns the selected stretches, with `source` as the name of the recording.
    pub fn finish(self, source: &str) -> Chosen {
        let is_blind = self.is_blind();
        let parameters = self.all.nrows().max(1) as f64;
        let share = self.kept.len() as f64 / self.offered.max(1) as f64;
        let ratio = log_determinant(self.kept_information()) - log_determinant(&self.all * share);
        let stretch = self.length();
        let start = self.start.unwrap_or(0);
        let mut parts: Vec<Recording> = self.kept.into_iter().map(|kept| kept.recording).collect();
        parts.sort_by_key(|part| part.start_nanoseconds);
        Chosen {
            recording: joined(source, &parts),
            starts: parts.iter().map(|part| (part.start_nanoseconds - start) as f64 * 1e-9).collect(),
            stretch,
            duration: self.duration,
            gain: (!is_blind).then(|| (ratio / (2.0 * parameters)).exp()),
        }
    }
}

/// Start and end of each stretch of about this length, s. None crosses a gap between pieces.
fn stretches(block: &Recording, length: f64) -> Vec<[f64; 2]> {
    let mut stretches = Vec::new();
    for piece in block.pieces().into_iter().filter(|piece| piece.len() >= FEWEST_SAMPLES) {
        let (begin, end) = (block.time[piece.start], block.time[piece.end - 1]);
        let count = ((end - begin) / length).round().max(1.0);
        let border = |number: usize| begin + number as f64 * (end - begin) / count;
        stretches.extend((0..count as usize).map(|number| [border(number), border(number + 1)]));
    }
    stretches
}

/// Fewer samples contain no window of the weak form.
const FEWEST_SAMPLES: usize = 8;

/// Logarithm of the determinant of this information (in units of the parameters' sizes) plus a prior of one size for
/// each parameter. Without the prior a parameter that no stretch shows would make all stretches equal.
fn log_determinant(mut information: DMatrix<f64>) -> f64 {
    for number in 0..information.nrows() {
        information[(number, number)] += 1.0;
    }
    // Rounding can make differences of sums negative. They then count as no information.
    information
        .cholesky()
        .map_or(f64::NEG_INFINITY, |factor| 2.0 * factor.l().diagonal().iter().map(|root| root.ln()).sum::<f64>())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;
    use excavator_model::simulation::{Tolerances, simulate_from_rest};

    /// `seconds` of the arm at 250 Hz, at rest except for one fast stretch and one slow one.
    fn mostly_at_rest(model: &Model, seconds: u32) -> Recording {
        let time: Vec<f64> = (0..seconds * 250).map(|index| f64::from(index) * 4e-3).collect();
        let mut recording = Recording::unmeasured("day", time, &["arm"]);
        recording.tank_pressure.fill(3e5);
        recording.pump_flow.fill(3.8e-4);
        let area = |t: &f64| match *t {
            t if (40.0..48.0).contains(&t) => 6e-5 * (6.3 * t).sin(),
            t if (64.0..72.0).contains(&t) => 2e-5 * (1.6 * t).sin(),
            _ => 0.0,
        };
        recording.cylinders[0].orifice_area = recording.time.iter().map(area).collect();
        let mut run = simulate_from_rest(model, &recording, &[0.0], Tolerances::default()).unwrap();
        // Two alternating steps of a converter are sufficient noise.
        let add = |column: &mut Vec<f64>, size: f64| {
            column
                .iter_mut()
                .enumerate()
                .for_each(|(index, value)| *value += size * [1.0, -1.0, -1.0, 1.0, 1.0][index * 7 % 5]);
        };
        add(&mut run.cylinders[0].displacement, 5e-5);
        add(&mut run.cylinders[0].cap_pressure, 2e3);
        add(&mut run.cylinders[0].rod_pressure, 2e3);
        add(&mut run.pump_pressure, 2e3);
        run
    }

    #[test]
    fn the_stretches_that_tell_most_are_kept() {
        let model = built_in("zx30u-arm").unwrap();
        let recording = mostly_at_rest(&model, 160);
        let mut selection = Selection::new(&model, SelectionSettings { stretch: 8.0, most: 2 });
        for block in 0..4 {
            let from = 40.0 * f64::from(block);
            selection.offer(&recording.part(from, from + 40.0 - 1e-6)).unwrap();
            assert!(selection.kept.len() <= 2);
        }
        let chosen = selection.finish("day");
        // The arm first sinks slowly, which shows leaks. The fast stretch follows.
        assert_eq!(chosen.starts, [0.0, 40.0]);
        assert!(
            (chosen.duration - 160.0).abs() < 0.1 && chosen.gain > Some(1.5),
            "{} {:?}",
            chosen.duration,
            chosen.gain
        );
        let parts = chosen.recording.pieces();
        assert_eq!(parts.len(), 2);
        // Samples and their times are those of the recording.
        let first = recording.time.partition_point(|time| *time < 40.0);
        let own = chosen.recording.cylinders[0].cap_pressure[parts[1].start + 7];
        assert_eq!(own, recording.cylinders[0].cap_pressure[first + 7]);
        assert!((chosen.recording.time[parts[1].start] - 40.0).abs() < 1e-6);
    }

    #[test]
    fn without_a_complete_equation_the_stretches_are_spread() {
        let model = built_in("zx30u-arm").unwrap();
        let mut recording = mostly_at_rest(&model, 160);
        let signals = &mut recording.cylinders[0];
        signals.cap_pressure.fill(f64::NAN);
        signals.rod_pressure.fill(f64::NAN);
        recording.pump_pressure.fill(f64::NAN);
        let mut selection = Selection::new(&model, SelectionSettings { stretch: 8.0, most: 4 });
        selection.offer(&recording).unwrap();
        assert!(selection.is_blind());
        let chosen = selection.finish("day");
        assert_eq!(chosen.gain, None);
        let gaps: Vec<f64> = chosen.starts.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(chosen.starts[0] == 0.0 && gaps.iter().all(|gap| (24.0..90.0).contains(gap)), "{:?}", chosen.starts);
    }
}
