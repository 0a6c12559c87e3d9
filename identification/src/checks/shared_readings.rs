//! Finds readings that two recordings share.

use std::collections::HashMap;

use excavator_model::recording::Recording;

/// Readings shared by recordings that should be independent.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{} % of the readings of {validation} are also in {identification}; fitted data cannot serve as evidence; give another recording, or another part of \
     this one (BAG@FROM..TO)", share.round()
)]
pub struct SharedReadings {
    /// The recording that is fitted.
    pub identification: String,
    /// The recording that should validate the fit.
    pub validation: String,
    /// Share of its readings that are also in the fitted recording, %.
    pub share: f64,
}

/// Two recordings of one role that are mostly the same.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{} % of the readings of {later} are also in {earlier}: they would count twice; give each recording once", share.round())]
pub struct GivenTwice {
    /// The recording that was given first.
    pub earlier: String,
    /// The recording that repeats it.
    pub later: String,
    /// Share of its readings that are also in the earlier one, %.
    pub share: f64,
}

/// Share of the readings, %, above which sharing is reported. Fewer can be a stray repetition.
const SOME: f64 = 5.0;

/// Share of the readings, %, from which a recording is no evidence of its own: more than half of it is another one.
const MOST: f64 = 50.0;

impl SharedReadings {
    /// Whether so much is shared that the recording is no evidence of its own.
    pub fn is_most(&self) -> bool {
        self.share >= MOST
    }
}

/// Readings that both have must be this many, and this share of them must follow each other in the same order. Single readings of a
/// coarse converter are also equal by chance, but then in any order, or with many others between them if a motion was repeated.
const NEEDED: usize = 20;
const IN_ORDER: f64 = 0.9;
const SIDE_BY_SIDE: f64 = 0.4;

/// Finds readings of the validation recordings that also occur in the fitted ones.
pub fn shared_readings(identification: &[&Recording], validation: &[&Recording]) -> Vec<SharedReadings> {
    let fitted: Vec<(&str, HashMap<Vec<u64>, usize>)> =
        identification.iter().map(|recording| (recording.source.as_str(), single_readings(recording))).collect();
    let judging = validation.iter().map(|recording| (recording.source.as_str(), single_readings(recording)));
    judging
        .flat_map(|(validation, own)| {
            fitted.iter().filter_map(move |(identification, fitted)| {
                Some(SharedReadings {
                    identification: (*identification).to_string(),
                    validation: validation.to_string(),
                    share: share(&own, fitted)?,
                })
            })
        })
        .collect()
}

/// The first recording that repeats an earlier one of the same role.
pub fn repeated(recordings: &[&Recording]) -> Option<GivenTwice> {
    if recordings.len() < 2 {
        return None;
    }
    let all: Vec<HashMap<Vec<u64>, usize>> = recordings.iter().map(|recording| single_readings(recording)).collect();
    let mut pairs = (1..all.len()).flat_map(|later| (0..later).map(move |earlier| (earlier, later)));
    pairs.find_map(|(earlier, later)| {
        let share = share(&all[later], &all[earlier]).filter(|share| *share >= MOST)?;
        let name = |number: usize| recordings[number].source.clone();
        Some(GivenTwice { earlier: name(earlier), later: name(later), share })
    })
}

/// Share of these readings, %, that the fitted recording has in the same order; `None` if hardly any.
fn share(own: &HashMap<Vec<u64>, usize>, fitted: &HashMap<Vec<u64>, usize>) -> Option<f64> {
    let mut common: Vec<(usize, usize)> =
        own.iter().filter_map(|(reading, &at)| Some((at, *fitted.get(reading)?))).collect();
    common.sort_unstable();
    let in_order = common.windows(2).filter(|pair| pair[0].1 < pair[1].1).count();
    let share = 100.0 * common.len() as f64 / own.len().max(1) as f64;
    let (first, last) = (common.first()?.0, common.last()?.0);
    let between = own.values().filter(|&&at| (first..=last).contains(&at)).count();
    let is_same = common.len() >= NEEDED
        && in_order as f64 >= IN_ORDER * (common.len() - 1) as f64
        && common.len() as f64 >= SIDE_BY_SIDE * between as f64;
    (share > SOME && is_same).then_some(share)
}

/// All measured values at a moment, bit for bit, with the number of the moment, where they occur once in the recording: noise makes a
/// moment of motion unique. A machine at rest and a converter at its end repeat themselves, which says nothing about another recording.
fn single_readings(recording: &Recording) -> HashMap<Vec<u64>, usize> {
    let signals: Vec<&[f64]> = recording
        .cylinders
        .iter()
        .flat_map(|cylinder| {
            [
                &cylinder.displacement[..],
                &cylinder.joint_angle,
                &cylinder.cap_pressure,
                &cylinder.rod_pressure,
                &cylinder.orifice_area,
                &cylinder.rod_force,
            ]
        })
        .chain([&recording.pump_pressure[..]])
        .collect();
    let mut moments: HashMap<Vec<u64>, Option<usize>> = HashMap::new();
    for index in 0..recording.len() {
        let values = signals.iter().map(|signal| signal.get(index).copied().unwrap_or(f64::NAN));
        let moment = values.map(|value| if value.is_finite() { value.to_bits() } else { u64::MAX }).collect();
        moments.entry(moment).and_modify(|first| *first = None).or_insert(Some(index));
    }
    moments.into_iter().filter_map(|(moment, index)| Some((moment, index?))).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// A cylinder that moves for `moving` samples and then stands for 2000, behind a converter with steps of this size.
    fn run(seed: u32, moving: usize, step: f64) -> Recording {
        let time: Vec<f64> = (0..moving + 2000).map(|index| 1e-3 * index as f64).collect();
        let mut recording = Recording::unmeasured("run", time, &["load"]);
        let mut state = seed;
        let mut noise = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24) - 0.5
        };
        let signals = &mut recording.cylinders[0];
        for index in 0..moving + 2000 {
            let position = 1e-4 * index.min(moving) as f64 * (1.0 + 1e-3 * f64::from(seed));
            signals.displacement[index] = ((position + 1e-5 * noise()) / step).round() * step;
            signals.cap_pressure[index] = ((2e6 + 2e3 * noise()) / 1e3).round() * 1e3;
            signals.rod_pressure[index] = ((1e6 + 2e3 * noise()) / 1e3).round() * 1e3;
        }
        recording
    }

    #[test]
    fn a_machine_at_rest_and_a_converter_at_its_end_are_not_shared() {
        for step in [1e-7, 1e-5, 1e-4] {
            let (first, second) = (run(1, 400, step), run(2, 500, step));
            assert_eq!(shared_readings(&[&first], &[&second]), [], "steps of {step} m");
        }
        let (mut first, mut second) = (run(3, 2000, 1e-7), run(4, 2000, 1e-7));
        for recording in [&mut first, &mut second] {
            recording.cylinders[0].displacement.iter_mut().for_each(|value| *value = value.min(0.02));
        }
        assert_eq!(shared_readings(&[&first], &[&second]), []);
    }

    #[test]
    fn the_same_run_and_parts_of_it_are_shared() {
        for step in [1e-7, 1e-5] {
            let whole = run(1, 3000, step);
            let found = shared_readings(&[&whole], &[&whole]);
            assert!(found.len() == 1 && found[0].share > 99.0 && found[0].is_most(), "{found:?}");
            let twice = repeated(&[&run(2, 3000, step), &whole, &whole]).unwrap().to_string();
            assert!(twice.contains("100 % of the readings of run are also in run"), "{twice}");
            assert!(repeated(&[&run(2, 3000, step), &whole]).is_none());
            // A part that overlaps by a third, at half the rate.
            let part = whole.at(&(1000..2500).step_by(2).collect::<Vec<_>>());
            let fitted = whole.at(&(0..2000).collect::<Vec<_>>());
            let found = shared_readings(&[&fitted], &[&part]);
            assert!(found.len() == 1 && (50.0..80.0).contains(&found[0].share), "{found:?}");
        }
    }
}
