//! What a fit minimises: recordings cut into segments, simulated side by side.

use excavator_model::Model;
use excavator_model::effects::ParameterCard;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use excavator_model::simulation::Tolerances;
use rayon::prelude::*;

use super::normal_equations::{BLOCK_DURATION, InitialStatePrior, RawSums, SegmentSums, Shared};
use super::{FitError, FitSettings, Instrument, SegmentedRecording, instruments, scales};

/// A model, recordings, and which parameters are free.
pub(super) struct Problem<'s, 'm> {
    system: &'s System<'m>,
    prior: InitialStatePrior,
    /// States that the prior is centred on, by recording and segment.
    anchors: Vec<Vec<Vec<f64>>>,
    /// The recordings, each segment with the state that it was measured to start from.
    pub segmented: Vec<SegmentedRecording>,
    /// What is compared.
    pub instruments: Vec<Instrument>,
    /// Noise of each instrument, in its unit.
    pub noise: Vec<f64>,
    /// Indices of the free parameters, in the model's order.
    pub fitted: Vec<usize>,
    /// Scale of each free parameter, in its unit.
    pub scales: Vec<f64>,
    /// Card of every parameter of the model.
    pub cards: Vec<&'static ParameterCard>,
}

impl<'s, 'm> Problem<'s, 'm> {
    /// # Errors
    /// [`FitError`] when the recordings lack inputs, outputs or length.
    pub fn new(
        model: &Model,
        system: &'s System<'m>,
        recordings: &[&Recording],
        settings: &FitSettings,
        fitted: Vec<usize>,
    ) -> Result<Self, FitError> {
        let instruments = instruments(system, recordings);
        if instruments.is_empty() {
            return Err(FitError::NothingMeasured { machine: model.machine.name.clone() });
        }
        let segmented = recordings
            .iter()
            .map(|recording| SegmentedRecording::new(model, recording, settings.segment_duration, settings.sample_rate))
            .collect::<Result<Vec<_>, _>>()?;
        if segmented.iter().all(|recording| recording.segments.is_empty()) {
            return Err(FitError::TooShort);
        }
        let anchors = segmented
            .iter()
            .map(|recording| recording.segments.iter().map(|segment| segment.state.clone()).collect())
            .collect();
        let cards: Vec<_> = model.parameters().map(|(_, parameter)| parameter.card).collect();
        let scales = scales(model, &fitted);
        let noise = instruments.iter().map(|instrument| instrument.noise).collect();
        let prior = InitialStatePrior::of(system);
        Ok(Problem { system, prior, anchors, segmented, instruments, noise, fitted, scales, cards })
    }

    /// Normal equations of every segment with these parameter values, each segment started from its state in
    /// `segmented`.
    ///
    /// # Errors
    /// [`FitError::Simulation`] when a segment cannot be simulated.
    pub fn sums_at(&self, values: &[f64], segmented: &[SegmentedRecording]) -> Result<Vec<RawSums>, FitError> {
        let shared = Shared {
            system: self.system,
            parameters: values,
            fitted: &self.fitted,
            scales: &self.scales,
            instruments: &self.instruments,
            prior: &self.prior,
            tolerances: Tolerances::default(),
        };
        let jobs: Vec<(usize, usize)> = segmented
            .iter()
            .enumerate()
            .flat_map(|(r, recording)| (0..recording.segments.len()).map(move |s| (r, s)))
            .collect();
        jobs.par_iter()
            .map(|&(r, s)| Ok(shared.sums(&segmented[r], &segmented[r].segments[s], &self.anchors[r][s])?))
            .collect()
    }

    /// Recording and begin (s after its first sample) of each block of `sums`, which are of all segments in order.
    pub fn block_places(&self, sums: &[SegmentSums]) -> Vec<(usize, f64)> {
        let segments = self.segmented.iter().enumerate().flat_map(|(number, recording)| {
            let time = &recording.recording.time;
            recording.segments.iter().map(move |segment| (number, time[segment.first] - time[0]))
        });
        let blocks = segments.zip(sums).flat_map(|((recording, begin), sums)| {
            (0..sums.block_errors.len()).map(move |block| (recording, begin + block as f64 * BLOCK_DURATION))
        });
        blocks.collect()
    }

    /// Sums with each instrument's errors divided by its weight, initial states eliminated.
    pub fn weighed(&self, raw: &[RawSums], weights: &[f64]) -> Vec<SegmentSums> {
        let factors: Vec<f64> =
            self.noise.iter().zip(weights).map(|(noise, weight)| (noise / weight).powi(2)).collect();
        raw.iter().map(|segment| segment.weighed(&factors)).collect()
    }
}
