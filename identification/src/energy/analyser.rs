//! Analyses a recording of any length, block by block.

use std::collections::VecDeque;

use excavator_model::equations::System;
use excavator_model::machine::Supply;
use excavator_model::recording::{CylinderSignals, Recording, is_measured};
use excavator_model::simulation::{InputSignals, simulate};
use excavator_model::{Model, SignalError};
use rayon::prelude::*;

use super::analysis::{EnergyAnalysis, WindowPoint};
use super::block::{Block, books_of, measured, simulated_books};
use super::cycle::{Cycles, period};
use super::judgement::Judge;
use super::noise::{NoiseStudy, study_noise};
use super::windows::{Window, windows};
use super::{Books, ByOpening, EnergyError, EnergySettings, Place, Totals, Traces};
use crate::validation::dominant_frequency;

/// Number of blocks that are processed in parallel.
const AT_ONCE: usize = 4;
/// Time from the start that is searched for the excitation frequency, s.
const SEARCHED: f64 = 40.0;
/// Number of windows kept for a plot; beyond it, every other one is dropped.
const MOST_WINDOWS: usize = 40_000;

/// Takes a recording block by block; see [`analyse`] for a recording in memory.
#[derive(Debug)]
pub struct Analyser<'m> {
    model: &'m Model,
    system: System<'m>,
    settings: EnergySettings,
    source: String,
    start_nanoseconds: Option<i64>,
    samples: usize,
    last_time: f64,
    gaps: usize,
    /// Received samples that are still needed; the clock is that of the whole recording.
    buffer: Recording,
    /// Number of the buffer's first sample.
    first_sample: usize,
    /// Time up to which blocks have been cut, s.
    cut: f64,
    blocks: usize,
    stride: usize,
    head: Option<Recording>,
    /// Dominant excitation frequency of the head, Hz.
    frequency: Option<f64>,
    waiting: VecDeque<Block>,
    places: Vec<Place>,
    judge: Judge,
    totals: Totals,
    by_opening: Vec<ByOpening>,
    cycles: Option<Cycles>,
    windows: Vec<WindowPoint>,
    window_stride: usize,
    windows_seen: usize,
    traces: Traces,
    accounted: bool,
}

struct Done {
    block: Block,
    books: Books,
    windows: Vec<Window>,
    noise: Option<NoiseStudy>,
}

impl<'m> Analyser<'m> {
    /// An analyser without data.
    pub fn new(model: &'m Model, settings: EnergySettings) -> Self {
        let settings = settings.for_size(&model.machine.size());
        let places = Place::all(model);
        let with_cylinder = places.iter().map(|&place| (place, place.cylinder(model))).collect();
        Analyser {
            model,
            system: System::new(model),
            settings,
            source: String::new(),
            start_nanoseconds: None,
            samples: 0,
            last_time: f64::NEG_INFINITY,
            gaps: 0,
            buffer: Recording::default(),
            first_sample: 0,
            cut: 0.0,
            blocks: 0,
            stride: 1,
            head: None,
            frequency: None,
            waiting: VecDeque::new(),
            judge: Judge::new(with_cylinder, settings),
            places,
            totals: Totals::new(model),
            by_opening: ByOpening::all(model),
            cycles: None,
            windows: Vec::new(),
            window_stride: 1,
            windows_seen: 0,
            traces: Traces::new(model),
            accounted: false,
        }
    }

    /// Adds the next block, whose timestamps continue the previous ones. Samples that are not later than the previous ones are
    /// skipped.
    ///
    /// # Errors
    /// [`EnergyError::Signal`] and [`EnergyError::NotMeasured`] if the block lacks a signal that the model needs.
    pub fn push(&mut self, block: &Recording) -> Result<(), EnergyError> {
        if self.start_nanoseconds.is_none() {
            self.source.clone_from(&block.source);
            self.check(block)?;
        }
        let start = *self.start_nanoseconds.get_or_insert(block.start_nanoseconds);
        let offset = (block.start_nanoseconds - start) as f64 * 1e-9;
        let first = block.time.partition_point(|&t| t + offset <= self.last_time);
        if first == block.len() {
            return Ok(());
        }
        let mut block = slice(block, first..block.len());
        block.time.iter_mut().for_each(|t| *t += offset);
        let mut previous = if self.samples == 0 { block.time[0] } else { self.last_time };
        for &time in &block.time {
            self.gaps += usize::from(time - previous > self.settings.gap);
            previous = time;
        }
        self.samples += block.len();
        self.last_time = previous;
        append(&mut self.buffer, block);
        if self.head.is_none() && self.last_time < self.settings.head {
            return Ok(());
        }
        self.begin();
        self.cut_blocks(false);
        if self.waiting.len() >= AT_ONCE { self.work() } else { Ok(()) }
    }

    /// Finishes and returns the analysis.
    ///
    /// # Errors
    /// As [`Analyser::push`], and [`EnergyError::TooShort`] or [`EnergyError::TooSlow`] if the recording does not allow a slope
    /// to be computed.
    pub fn finish(mut self) -> Result<EnergyAnalysis, EnergyError> {
        self.begin();
        self.cut_blocks(true);
        self.work()?;
        let margin = self.margin();
        let first = self.traces.cylinders.first().and_then(|trace| trace.time.first());
        if !self.accounted || first.is_none() {
            let interval = self.head.as_ref().map_or(f64::NAN, Recording::sample_interval);
            let found = (self.samples, self.last_time.max(0.0));
            return Err(EnergyError::of_nothing(self.source, found, interval, self.settings.half_width, 2.0 * margin));
        }
        let simulation_failed = self.simulate_head();
        if let Some(frequency) = self.frequency {
            self.traces.measure_phases(frequency);
        }
        let parameters_have_errors = self
            .model
            .parameters()
            .any(|(_, p)| p.standard_error.is_some_and(|error| error.is_finite() && error > 0.0));
        Ok(EnergyAnalysis {
            source: self.source,
            samples: self.samples,
            duration: self.last_time,
            gaps: self.gaps,
            totals: self.totals,
            by_opening: self.by_opening,
            cycle: self.cycles.and_then(Cycles::finish),
            places: self.judge.finish(),
            windows: self.windows,
            traces: self.traces,
            simulation_failed,
            parameters_have_errors,
        })
    }

    /// Checks for the signals that the energy needs.
    fn check(&self, block: &Recording) -> Result<(), EnergyError> {
        let missing = |signal: String| EnergyError::NotMeasured { source_name: block.source.clone(), signal };
        for cylinder in &self.model.machine.cylinders {
            let own = block.cylinder(&cylinder.name).map_err(SignalError::from)?;
            if !is_measured(&own.displacement) && !is_measured(&own.joint_angle) {
                return Err(missing(format!("{}.displacement (nor joint_angle)", cylinder.name)));
            }
            if cylinder.chambers.is_some() {
                for (name, signal) in [("cap_pressure", &own.cap_pressure), ("rod_pressure", &own.rod_pressure)] {
                    if !is_measured(signal) {
                        return Err(missing(format!("{}.{name}", cylinder.name)));
                    }
                }
            }
        }
        if self.model.machine.supply != Supply::None && !is_measured(&block.pump_pressure) {
            return Err(missing("pump_pressure".into()));
        }
        Ok(())
    }

    /// Extra time that a block needs on each side, s.
    fn margin(&self) -> f64 {
        self.settings.window_half_width + self.settings.motion_half_width + self.settings.half_width
    }

    /// Derives from the head what the whole recording needs: stride, excitation frequency and cycle.
    fn begin(&mut self) {
        if self.head.is_some() || self.buffer.is_empty() {
            return;
        }
        let end = self.buffer.time.partition_point(|&t| t <= self.settings.head);
        let head = slice(&self.buffer, 0..end.max(1));
        // Five entries per half width. Parabolas of that width pass less, but a chamber that boils starts within a few milliseconds,
        // and so does the power of its vapour.
        let per_half_width = self.settings.half_width / head.sample_interval();
        self.stride = (per_half_width / 5.0 + 1e-6).floor().max(1.0) as usize;
        let (period, frequency) = excitation(self.model, &head);
        self.frequency = frequency;
        self.cycles = period.map(|period| Cycles::new(self.model, period));
        self.head = Some(head);
    }

    /// Cuts the received samples into blocks; with `all`, also the remainder.
    fn cut_blocks(&mut self, all: bool) {
        let margin = self.margin();
        loop {
            let mut end = self.cut + self.settings.block;
            if end + margin > self.last_time {
                if !all || self.cut > self.last_time {
                    break;
                }
                end = self.last_time + margin;
            }
            // Skips empty blocks up to the next sample: a clock that was set forward may leave a gap of years.
            let next = self.buffer.time.get(self.buffer.time.partition_point(|&t| t < self.cut - margin));
            let empty = next.map_or(0.0, |next| ((next - margin - self.cut) / self.settings.block).floor());
            if empty > 1.0 {
                self.cut += empty * self.settings.block;
                continue;
            }
            let studied = self.cut < self.settings.head || self.blocks.is_multiple_of(self.settings.blocks_per_draw);
            let time = &self.buffer.time;
            let first = time.partition_point(|&t| t < self.cut - margin);
            let last = time.partition_point(|&t| t <= end + margin);
            let mut from = first;
            for index in first..last {
                let ends = index + 1 == last || time[index + 1] - time[index] > self.settings.gap;
                if ends {
                    self.waiting.push_back(Block {
                        recording: slice(&self.buffer, from..index + 1),
                        start: time[from],
                        first_sample: self.first_sample + from,
                        stride: self.stride,
                        own: (self.cut, end),
                        quick: self.cut >= self.settings.head,
                        with_noise: studied,
                    });
                    from = index + 1;
                }
            }
            self.cut = end;
            self.blocks += 1;
        }
        let needless = self.buffer.time.partition_point(|&t| t < self.cut - margin);
        for column in self.buffer.columns_mut() {
            column.drain(..needless);
        }
        self.first_sample += needless;
    }

    fn work(&mut self) -> Result<(), EnergyError> {
        let waiting: Vec<Block> = self.waiting.drain(..).collect();
        let (system, places, settings) = (&self.system, &self.places, &self.settings);
        let parameters = self.model.parameter_values();
        let done = waiting
            .into_par_iter()
            .map(|block| {
                let entries = measured(system, &block, settings)?;
                let books = books_of(system, &parameters, &entries);
                let study = || study_noise(system, &block, &entries, &books, places, settings);
                let noise = block.with_noise.then(study).transpose()?;
                let windows = windows(system.model(), &books, places, block.own, settings);
                Ok(Done { block, books, windows, noise })
            })
            .collect::<Result<Vec<Done>, SignalError>>()?;
        done.iter().for_each(|done| self.account(done));
        Ok(())
    }

    fn account(&mut self, done: &Done) {
        let (books, own) = (&done.books, done.block.own);
        let first = books.time.partition_point(|&t| t < own.0);
        let end = books.time.partition_point(|&t| t < own.1).min(books.len().saturating_sub(1));
        for entry in first..end {
            if books.time[entry + 1] - books.time[entry] > self.settings.gap {
                continue;
            }
            self.accounted = true;
            self.totals.add(books, entry);
            self.by_opening.iter_mut().for_each(|one| one.add(books, entry));
            if let Some(cycles) = &mut self.cycles {
                cycles.add(books, entry);
            }
        }
        let noises = done.noise.as_ref().map(|study| study.windows.as_slice());
        if let Some(noises) = noises {
            self.judge.learn(noises);
        }
        for (index, window) in done.windows.iter().enumerate() {
            let judged = self.judge.judge(window, noises.and_then(|noises| noises.get(index)));
            if self.windows_seen.is_multiple_of(self.window_stride) {
                self.windows.push(WindowPoint { time: window.time, residuals: judged.residuals, bands: judged.bands });
            }
            self.windows_seen += 1;
            if self.windows.len() > MOST_WINDOWS {
                let mut number = 0;
                self.windows.retain(|_| {
                    number += 1;
                    number % 2 == 1
                });
                self.window_stride *= 2;
            }
        }
        if own.0 < self.settings.head {
            let draws = done.noise.as_ref().map_or(&[][..], |study| &study.draws);
            self.traces.add(books, draws, (own.0, own.1.min(self.settings.head)), &self.settings);
        }
    }

    /// Simulates the head; returns the reason if that fails.
    fn simulate_head(&mut self) -> Option<String> {
        let head = self.head.as_ref()?;
        let simulated = match simulate(self.model, head) {
            Ok(simulated) => simulated,
            Err(error) => return Some(error.to_string()),
        };
        let block = Block {
            recording: head.clone(),
            start: 0.0,
            first_sample: 0,
            stride: self.stride,
            own: (0.0, self.settings.head),
            quick: false,
            with_noise: false,
        };
        match simulated_books(&self.system, &block, &simulated) {
            Ok(books) => {
                self.traces.add_simulation(&books);
                None
            }
            Err(error) => Some(error.to_string()),
        }
    }
}

/// Analyses a recording in memory.
///
/// # Errors
/// As [`Analyser::push`] and [`Analyser::finish`].
pub fn analyse(model: &Model, recording: &Recording, settings: EnergySettings) -> Result<EnergyAnalysis, EnergyError> {
    let mut analyser = Analyser::new(model, settings);
    analyser.push(recording)?;
    analyser.finish()
}

/// Period (s) of the valve that moves most, or of the force, and its dominant frequency (Hz).
fn excitation(model: &Model, head: &Recording) -> (Option<f64>, Option<f64>) {
    let Ok(signals) = InputSignals::from_recording(model, head) else { return (None, None) };
    let size = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    let strongest = if model.machine.has_chambers() {
        let all = (0..model.machine.cylinders.len()).map(|cylinder| signals.orifice_area(cylinder));
        all.max_by(|a, b| size(a).total_cmp(&size(b)))
    } else {
        head.cylinders.first().map(|cylinder| cylinder.rod_force.as_slice())
    };
    // The frequency search assumes a machine of the reference size.
    let unit = model.machine.size().time();
    // The time of the search is quadratic in the length of its data.
    let end = head.time.partition_point(|&t| t <= SEARCHED * unit);
    let time: Vec<f64> = head.time[..end].iter().map(|time| time / unit).collect();
    let frequency = strongest.and_then(|values| Some(dominant_frequency(&time, &values[..end])? / unit));
    let found = strongest.zip(frequency).and_then(|(values, frequency)| period(&head.time, values, frequency));
    (found, frequency)
}

/// Samples of a range; the times of a block start at zero.
fn slice(recording: &Recording, range: std::ops::Range<usize>) -> Recording {
    let part = |column: &[f64]| column[range.clone()].to_vec();
    let cylinders = recording.cylinders.iter().map(|cylinder| {
        let mut own = CylinderSignals { name: cylinder.name.clone(), ..CylinderSignals::default() };
        for (to, (_, from)) in own.columns_mut().into_iter().zip(cylinder.signals()) {
            *to = part(from);
        }
        own
    });
    let start = recording.time.get(range.start).copied().unwrap_or(0.0);
    Recording {
        source: recording.source.clone(),
        start_nanoseconds: recording.start_nanoseconds,
        time: recording.time[range.clone()].iter().map(|t| t - start).collect(),
        cylinders: cylinders.collect(),
        pump_pressure: part(&recording.pump_pressure),
        tank_pressure: part(&recording.tank_pressure),
        pump_flow: part(&recording.pump_flow),
        oil_temperature: part(&recording.oil_temperature),
    }
}

/// Appends samples; a cylinder that only one of the two has is unmeasured in the other.
fn append(buffer: &mut Recording, block: Recording) {
    if buffer.cylinders.is_empty() && buffer.is_empty() {
        *buffer = block;
        return;
    }
    let (before, after) = (buffer.len(), block.len());
    let mut block = block;
    for cylinder in &buffer.cylinders {
        if !block.cylinders.iter().any(|own| own.name == cylinder.name) {
            block.cylinders.push(CylinderSignals::unmeasured(&cylinder.name, after));
        }
    }
    for cylinder in &block.cylinders {
        if !buffer.cylinders.iter().any(|own| own.name == cylinder.name) {
            buffer.cylinders.push(CylinderSignals::unmeasured(&cylinder.name, before));
        }
    }
    block.cylinders.sort_by_key(|own| buffer.cylinders.iter().position(|cylinder| cylinder.name == own.name));
    for (to, from) in buffer.columns_mut().into_iter().zip(block.columns_mut()) {
        to.append(from);
    }
}
