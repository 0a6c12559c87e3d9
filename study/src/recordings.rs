//! Prepares recordings for use: checks them against a model, leaves samples out, and selects the most informative
//! stretches of long ones.

use excavator_bags::ReadReport;
use excavator_identification::checks;
use excavator_identification::regression::RegressionError;
use excavator_identification::selection::{Chosen, Selection, SelectionSettings};
use excavator_model::Model;
use excavator_model::formula::Condition;
use excavator_model::machine::{Machine, Supply};
use excavator_model::recording::{Recording, is_measured};
use excavator_model::simulation::input_holes;

use crate::spikes::leave_out_spikes;
use crate::{WorkError, mapped_units};

/// A recording longer than this is long, s of time on a machine of the reference size. A fit of three minutes takes a
/// minute.
pub const LONG: f64 = 180.0;

/// Samples in memory at a time, three minutes at 1 kHz. A recording with more samples is long.
pub const BLOCK: usize = 180_000;

/// Samples in memory at a time for an energy ledger, ten seconds at 1 kHz.
pub const LEDGER_BLOCK: usize = 10_000;

/// Rate that the dynamics of hydraulic machines need, Hz: their oil resonates below 100 Hz, and their valves follow up to 150 Hz.
const USEFUL_RATE: f64 = 250.0;

/// Recordings of at least this many times [`USEFUL_RATE`] are averaged down. Below, too little is gained.
const LEAST_REDUCTION: f64 = 6.0;

/// A recording at a rate that the machine's dynamics need, with a remark if it was averaged down to it. Means of neighbouring samples
/// keep what happens slowly, and have less noise.
pub(crate) fn at_useful_rate(recording: Recording) -> (Recording, Option<String>) {
    let rate = 1.0 / recording.sample_interval();
    if !rate.is_finite() || rate < LEAST_REDUCTION * USEFUL_RATE {
        return (recording, None);
    }
    let count = (rate / USEFUL_RATE).floor() as usize;
    let remark = format!(
        "{:.4} kHz is more than the machine's dynamics need: averaged to {:.0} Hz",
        1e-3 * rate,
        rate / count as f64
    );
    (recording.averaged(count), Some(remark))
}

/// User settings for recordings.
#[derive(Debug, Default, Clone, Copy)]
pub struct Use<'u> {
    /// Names of the checks that are overruled if they refuse a recording.
    pub accept: &'u [String],
    /// Conditions that must hold when a recording is compared with a model, in the formula language.
    pub conditions: &'u [String],
    /// Whether the time that a piston spends at a stop is left out.
    pub leaves_out_stops: bool,
}

/// Whether a recording is reduced to its most informative stretches.
pub fn is_long(samples: usize, duration: f64, model: &Model) -> bool {
    samples > BLOCK || duration > LONG * model.machine.size().time()
}

/// A recording in blocks of `samples` samples, each with its own start.
pub fn blocks(recording: &Recording, samples: usize) -> impl Iterator<Item = Recording> {
    (0..recording.len()).step_by(samples).map(move |first| {
        let wanted: Vec<usize> = (first..recording.len().min(first + samples)).collect();
        let mut block = recording.at(&wanted);
        let start = block.time.first().copied().unwrap_or(0.0);
        block.time.iter_mut().for_each(|time| *time -= start);
        block.start_nanoseconds += (start * 1e9).round() as i64;
        block
    })
}

/// The most informative stretches of a long recording for the parameters of `model`, and the sentence of [`choice`].
/// `None` for a recording that is used whole. A recording that is not mapped is processed block by block, as the
/// program reads it.
///
/// # Errors
/// [`RegressionError`] if the recording lacks inputs.
pub fn most_informative(
    recording: &Recording,
    is_mapped: bool,
    model: &Model,
) -> Result<Option<(Recording, String)>, RegressionError> {
    if !is_long(recording.len(), recording.recorded_time(), model) {
        return Ok(None);
    }
    let mut selection = Selection::new(model, SelectionSettings::default());
    if is_mapped {
        selection.offer(recording)?;
    } else {
        blocks(recording, BLOCK).try_for_each(|block| selection.offer(&block))?;
    }
    if selection.is_blind() {
        // Nothing tells the stretches apart, and all of it is in memory.
        return Ok(None);
    }
    let mut chosen = selection.finish(&recording.source);
    let used = std::mem::take(&mut chosen.recording);
    let sentence = choice(&used, &chosen);
    Ok(Some((used, sentence)))
}

/// Lists the chosen stretches, in a sentence without its full stop.
pub fn choice(used: &Recording, chosen: &Chosen) -> String {
    let starts: Vec<String> = chosen.starts.iter().map(|start| format!("{start:.0}")).collect();
    let (seconds, all, stretch, starts) = (used.recorded_time(), chosen.duration, chosen.stretch, starts.join(", "));
    match chosen.gain {
        Some(gain) => format!(
            "{seconds:.0} of {all:.0} s are used: the most informative stretches of {stretch:.0} s, from {starts} s (stretches at random \
             would give intervals {gain:.1} times as wide)"
        ),
        None => format!(
            "{seconds:.0} of {all:.0} s are used: stretches of {stretch:.0} s spread over the recording, from {starts} s (no equation has \
             all of its signals, so none tells more than another)"
        ),
    }
}

/// Prepares a recording for use and adds messages for the user to `remarks`, where it is called `name`. `report` lists
/// what the map of the recording leaves out.
///
/// # Errors
/// [`WorkError::MappedUnit`] if a signal is mapped in another dimension than the machine has it in, [`WorkError::Check`] if a check
/// refuses the recording, [`WorkError::Condition`] if a condition cannot be parsed.
pub fn checked(
    name: &str,
    recording: Recording,
    report: &ReadReport,
    usage: &Use<'_>,
    model: &Model,
    remarks: &mut Vec<String>,
) -> Result<Recording, WorkError> {
    mapped_units::check(name, &model.machine, &report.mapped)?;
    let mut recording = recording;
    angles_as_displacements(&mut recording, &model.machine);
    remarks.extend(leave_out_spikes(&mut recording).iter().map(|line| format!("{name}: {line}")));
    let (mut recording, reduced) = at_useful_rate(recording);
    remarks.extend(reduced.map(|line| format!("{name}: {line}")));
    leave_pump_pressure_out(model, &mut recording, &report.left_out);
    remarks.extend(checks::remove_impossible(model, &mut recording).iter().map(|found| format!("{name}: {found}")));
    for overruled in checks::check(model, &recording, usage.accept)? {
        remarks.push(format!("accepted: {overruled}"));
    }
    let holes = input_holes(model, &recording);
    if holes.count > 0 {
        remarks.push(format!(
            "{name}: an input is missing for up to {:.2} s, {} time(s); these {:.2} s are left out",
            holes.longest, holes.count, holes.total
        ));
        recording = recording.at(&holes.known);
    }
    remarks.extend(checks::remarks(model, &recording).iter().map(|found| format!("{name}: {found}")));
    let kept = usage.conditions.iter().map(|text| (text, true));
    for (text, keeps) in kept.chain(report.left_out_where.iter().map(|text| (text, false))) {
        let condition = Condition::read(text)
            .map_err(|error| WorkError::Condition { text: text.clone(), error: Box::new(error) })?;
        let left_out = leave_out(model, &mut recording, &condition, keeps);
        let holds = if keeps { "where not" } else { "where" };
        remarks.push(format!("{name}: {:.0} % of the time is left out, {holds} {text}", 100.0 * left_out));
    }
    if usage.leaves_out_stops {
        let kept = between_stops(model, &recording);
        if kept.len() < recording.len() {
            let share = 100.0 * (recording.len() - kept.len()) as f64 / recording.len() as f64;
            remarks.push(format!("{name}: {share:.0} % of the time is left out, where a piston is at a stop"));
            recording = recording.at(&kept);
        }
    }
    Ok(recording)
}

/// Makes joint angles displacements through the geometry, where these are not measured. Each sensor then counts once.
fn angles_as_displacements(recording: &mut Recording, machine: &Machine) {
    for signals in &mut recording.cylinders {
        let Some(cylinder) = machine.cylinders.iter().find(|cylinder| cylinder.name == signals.name) else { continue };
        if is_measured(&signals.displacement) {
            continue;
        }
        for (displacement, angle) in signals.displacement.iter_mut().zip(&mut signals.joint_angle) {
            *displacement = cylinder.linkage.displacement(std::mem::replace(angle, f64::NAN));
        }
    }
}

/// Share of the stroke within which a piston counts as at its stop.
const AT_A_STOP: f64 = 0.01;

/// Samples at which no piston is at a stop.
fn between_stops(model: &Model, recording: &Recording) -> Vec<usize> {
    let is_free = |sample: usize| {
        model.machine.cylinders.iter().all(|cylinder| {
            recording.cylinder(&cylinder.name).map_or(true, |signals| {
                let displacement = signals.displacement[sample];
                !displacement.is_finite() || !cylinder.is_near_an_end(displacement, AT_A_STOP)
            })
        })
    };
    (0..recording.len()).filter(|&sample| is_free(sample)).collect()
}

/// Removes the compared outputs where the condition does not hold or, unless it `keeps`, where it holds. Inputs stay.
/// Returns the share of samples of all cylinders that are left out.
fn leave_out(model: &Model, recording: &mut Recording, condition: &Condition, keeps: bool) -> f64 {
    let mut holds = condition.holds(&model.machine, recording);
    holds.iter_mut().flatten().for_each(|holds| *holds = *holds == keeps);
    let samples = recording.len();
    let left_out = holds.iter().flatten().filter(|holds| !**holds).count();
    for (cylinder, holds) in model.machine.cylinders.iter().zip(&holds) {
        let Some(signals) = recording.cylinders.iter_mut().find(|signals| signals.name == cylinder.name) else {
            continue;
        };
        let outputs: Vec<&mut Vec<f64>> = if cylinder.imposed_motion.is_some() {
            vec![&mut signals.rod_force]
        } else {
            vec![
                &mut signals.displacement,
                &mut signals.joint_angle,
                &mut signals.velocity,
                &mut signals.cap_pressure,
                &mut signals.rod_pressure,
            ]
        };
        for output in outputs {
            output.iter_mut().zip(holds).filter(|(_, holds)| !**holds).for_each(|(value, _)| *value = f64::NAN);
        }
    }
    if matches!(model.machine.supply, Supply::PumpLine(_)) {
        for (sample, value) in recording.pump_pressure.iter_mut().enumerate() {
            if holds.iter().any(|holds| !holds[sample]) {
                *value = f64::NAN;
            }
        }
    }
    left_out as f64 / (samples * holds.len()).max(1) as f64
}

/// Removes the pump pressure between these times, ns, if it is a compared output and not an input.
fn leave_pump_pressure_out(model: &Model, recording: &mut Recording, stretches: &[[i64; 2]]) {
    if !matches!(model.machine.supply, Supply::PumpLine(_)) {
        return;
    }
    let start = recording.start_nanoseconds;
    for (time, pressure) in recording.time.iter().zip(&mut recording.pump_pressure) {
        let moment = start.saturating_add((time * 1e9).round() as i64);
        if stretches.iter().any(|[first, last]| (*first..=*last).contains(&moment)) {
            *pressure = f64::NAN;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;

    use super::*;

    #[test]
    fn angles_become_displacements_and_count_once() {
        let machine = built_in("zx30u").unwrap().machine;
        let mut recording = Recording::unmeasured("bag", vec![0.0, 0.5], &["boom", "arm"]);
        let linkage = machine.cylinders[0].linkage;
        recording.cylinders[0].joint_angle = vec![linkage.joint(-0.1), linkage.joint(0.2)];
        recording.cylinders[1].joint_angle = vec![4.0, 4.1];
        recording.cylinders[1].displacement = vec![0.01, 0.02];
        angles_as_displacements(&mut recording, &machine);
        let [boom, arm] = &recording.cylinders[..] else { unreachable!() };
        assert!((boom.displacement[0] + 0.1).abs() < 1e-12 && (boom.displacement[1] - 0.2).abs() < 1e-12);
        assert!(boom.joint_angle.iter().all(|angle| angle.is_nan()));
        assert_eq!((&arm.joint_angle[..], &arm.displacement[..]), (&[4.0, 4.1][..], &[0.01, 0.02][..]));
    }

    #[test]
    fn blocks_follow_each_other() {
        let mut recording =
            Recording::unmeasured("bag", (0..25).map(|index| f64::from(index) * 0.5).collect(), &["arm"]);
        recording.start_nanoseconds = 7;
        let found: Vec<Recording> = blocks(&recording, 10).collect();
        assert_eq!(found.iter().map(Recording::len).collect::<Vec<_>>(), [10, 10, 5]);
        assert!(found.iter().all(|block| block.time[0] == 0.0));
        assert_eq!(found[2].start_nanoseconds, 10_000_000_007);
        assert_eq!(found[2].time[4], 2.0);
    }
}
