//! Readings that two recordings have in common.

use std::collections::HashSet;

use excavator_model::recording::Recording;

/// Readings that recordings which should be apart have in common.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{} % of the readings of {validation} are also in {identification}; fitted data cannot serve as evidence; give another recording, or another part of \
     this one (BAG@FROM..TO)", share.round()
)]
pub struct SharedReadings {
    /// The recording that is fitted.
    pub identification: String,
    /// The recording that should judge the fit.
    pub validation: String,
    /// Readings of the latter that are in the former too, %.
    pub share: f64,
}

/// Share of the readings, %, that is worth a word: what rests behind a coarse converter reads the same now and then.
const SOME: f64 = 5.0;

/// Whether readings of the recordings that judge are in those that are fitted.
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

/// All that was measured at each moment while anything moved, to the last bit: noise makes every moment its own. A moment at which
/// everything reads as it did before says nothing.
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
