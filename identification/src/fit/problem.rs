//! The minimisation problem of a fit: recordings are cut into segments, which are simulated in parallel.

use std::sync::Arc;

use excavator_model::Model;
use excavator_model::effects::ParameterCard;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use excavator_model::simulation::Tolerances;
use rayon::prelude::*;

use super::normal_equations::{BLOCK_DURATION, InitialStatePrior, RawSums, SegmentSums, Shared};
use super::priors::ParameterPriors;
use super::step::{LONGEST_SHIFT, scales};
use super::{FitError, FitSettings, Instrument, Segment, SegmentedRecording, instruments};

/// A model, recordings and the choice of free parameters.
pub(super) struct Problem<'s, 'm> {
    system: &'s System<'m>,
    prior: InitialStatePrior,
    recordings: Vec<SegmentedRecording>,
    /// Index of the recording of each segment.
    owners: Vec<usize>,
    /// Segments of all recordings in order, each with its measured initial state, on which the prior is centred.
    pub segments: Vec<Segment>,
    /// The compared instruments.
    pub instruments: Vec<Instrument>,
    /// Noise of each instrument, in its unit.
    pub noise: Vec<f64>,
    /// Indices of the free parameters, in the model's order.
    pub fitted: Vec<usize>,
    /// Scale of each free parameter, in its unit.
    pub scales: Vec<f64>,
    /// Card of every parameter of the model.
    pub cards: Vec<Arc<ParameterCard>>,
    /// Priors of nuisance parameters.
    pub priors: ParameterPriors,
}

impl<'s, 'm> Problem<'s, 'm> {
    /// # Errors
    /// [`FitError`] if the recordings lack inputs or outputs or are too short.
    pub fn new(
        model: &Model,
        system: &'s System<'m>,
        recordings: &[&Recording],
        settings: &FitSettings,
        fitted: Vec<usize>,
    ) -> Result<Self, FitError> {
        let instruments = instruments(system, recordings);
        let priors = ParameterPriors::of(model, &fitted, recordings, instruments.len());
        if instruments.is_empty() {
            return Err(FitError::NothingMeasured { machine: model.machine.name.clone() });
        }
        let size = model.machine.size();
        let (duration, rate) = (settings.segment_duration_for(&size), settings.sample_rate_for(&size));
        let recordings = recordings
            .iter()
            .map(|recording| SegmentedRecording::new(model, recording, duration, rate))
            .collect::<Result<Vec<_>, _>>()?;
        let each = recordings.iter().enumerate();
        let (owners, segments): (Vec<usize>, Vec<Segment>) = each
            .flat_map(|(owner, recording)| recording.segments.iter().map(move |segment| (owner, segment.clone())))
            .unzip();
        if segments.is_empty() {
            return Err(FitError::TooShort);
        }
        let cards: Vec<_> = model.parameters().map(|(_, parameter)| parameter.card.clone()).collect();
        let scales = scales(model, &fitted);
        let noise = instruments.iter().map(|instrument| instrument.noise).collect();
        let prior = InitialStatePrior::of(system, settings.initial_states);
        Ok(Problem { system, prior, recordings, owners, segments, instruments, noise, fitted, scales, cards, priors })
    }

    /// Normal equations of every segment at these parameter values. Each starts from its state in `segments`.
    ///
    /// # Errors
    /// [`FitError::Simulation`] if a segment cannot be simulated.
    pub fn sums_at(&self, values: &[f64], segments: &[Segment]) -> Result<Vec<RawSums>, FitError> {
        self.each_at(values, segments).into_iter().collect()
    }

    /// Like [`Problem::sums_at`], with one result per segment.
    pub fn each_at(&self, values: &[f64], segments: &[Segment]) -> Vec<Result<RawSums, FitError>> {
        let each = segments.par_iter().enumerate();
        each.map(|(number, segment)| self.sums_of(values, number, segment, true)).collect()
    }

    /// Normal equations of segment `number`, started from the state of `segment`: for the parameters and that state, or
    /// for the state alone.
    ///
    /// # Errors
    /// [`FitError::Simulation`] if it cannot be simulated.
    pub fn sums_of(
        &self,
        values: &[f64],
        number: usize,
        segment: &Segment,
        with_parameters: bool,
    ) -> Result<RawSums, FitError> {
        let (fitted, scales): (&[usize], &[f64]) =
            if with_parameters { (&self.fitted, &self.scales) } else { (&[], &[]) };
        let shared = Shared {
            system: self.system,
            parameters: values,
            fitted,
            scales,
            instruments: &self.instruments,
            prior: &self.prior,
            tolerances: Tolerances::default(),
        };
        Ok(shared.sums(&self.recordings[self.owners[number]], segment, &self.segments[number].state)?)
    }

    /// Largest step of the edges of a time window, s.
    pub fn longest_shift(&self) -> f64 {
        LONGEST_SHIFT * self.system.model().machine.size().time()
    }

    /// Recording and start (s after its first sample) of each block of `sums`, which hold all segments in order.
    pub fn block_places(&self, sums: &[SegmentSums]) -> Vec<(usize, f64)> {
        let duration = BLOCK_DURATION * self.system.model().machine.size().time();
        let segments = self.owners.iter().zip(&self.segments).map(|(&owner, segment)| {
            let time = &self.recordings[owner].recording.time;
            (owner, time[segment.first] - time[0])
        });
        let blocks = segments.zip(sums).flat_map(|((recording, begin), sums)| {
            (0..sums.block_errors.len()).map(move |block| (recording, begin + block as f64 * duration))
        });
        blocks.collect()
    }

    /// [`Problem::weighed`] sums of all segments, then those of the priors at these parameter values.
    pub fn weighed_with_priors(&self, raw: &[RawSums], weights: &[f64], values: &[f64]) -> Vec<SegmentSums> {
        let mut sums = self.weighed(raw, weights);
        sums.push(self.priors.sums(values, &self.scales));
        sums
    }

    /// Sums with each instrument's errors divided by its weight, initial states eliminated.
    pub fn weighed(&self, raw: &[RawSums], weights: &[f64]) -> Vec<SegmentSums> {
        let factors: Vec<f64> =
            self.noise.iter().zip(weights).map(|(noise, weight)| (noise / weight).powi(2)).collect();
        raw.iter().map(|segment| segment.weighed(&factors)).collect()
    }
}
