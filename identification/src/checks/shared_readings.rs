//! Finds readings that two recordings share.

use std::collections::HashSet;

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

/// Share of the readings, %, above which sharing is reported: a resting signal behind a coarse converter repeats values at times.
const SOME: f64 = 5.0;

/// Finds readings of the validation recordings that also occur in the fitted ones.
pub fn shared_readings(identification: &[&Recording], validation: &[&Recording]) -> Vec<SharedReadings> {
    let fitted: Vec<(&str, HashSet<Vec<u64>>)> =
        identification.iter().map(|recording| (recording.source.as_str(), readings(recording).collect())).collect();
    let pairs = validation.iter().flat_map(|recording| fitted.iter().map(move |fitted| (recording, fitted)));
    pairs
        .filter_map(|(recording, (source, fitted))| {
            let all = readings(recording).count();
            let same = readings(recording).filter(|reading| fitted.contains(reading)).count();
            let share = 100.0 * same as f64 / all.max(1) as f64;
            (share > SOME).then(|| SharedReadings {
                identification: (*source).to_string(),
                validation: recording.source.clone(),
                share,
            })
        })
        .collect()
}

/// All measured values at each moment of motion, bit for bit: noise makes every moment unique. A moment at which every reading
/// repeats the previous one is skipped.
fn readings(recording: &Recording) -> impl Iterator<Item = Vec<u64>> {
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
    let moment = move |index: usize| -> Vec<u64> {
        let values = signals.iter().map(|signal| signal.get(index).copied().unwrap_or(f64::NAN));
        values.map(|value| if value.is_finite() { value.to_bits() } else { u64::MAX }).collect()
    };
    (1..recording.len()).filter_map(move |index| {
        let now = moment(index);
        (now != moment(index - 1)).then_some(now)
    })
}
