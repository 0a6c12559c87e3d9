//! A piston that moves although its valve is closed.

use excavator_model::Model;
use excavator_model::effects::Site;
use excavator_model::machine::{Chambers, Drive};
use excavator_model::recording::{Recording, noise_level};

use super::Remark;
use super::opening::largest;

/// Opening that counts as closed, as a share of the largest: below any intentional overlap.
const CLOSED: f64 = 0.02;

/// Time after closing for which a piston may still move, s on a machine of the reference size: the lag of a spool.
const RUN_OUT: f64 = 0.5;

/// Travel with a closed valve that is reported, as a share of the usual travel, and mean speed, as a share of the largest in the
/// recording. A load that sinks through leakage is slower.
const LEAST_TRAVEL: f64 = 0.02;
const LEAST_SPEED: f64 = 0.1;

/// Speed at which a piston counts as standing, as a share of the largest.
const STANDS: f64 = 0.02;

/// Time over which speeds are taken, s on a machine of the reference size.
const SPEED_TIME: f64 = 0.2;

/// Whether the piston of a cylinder moves while the input of its valve is at its null.
pub(super) fn moves_while_closed(
    model: &Model,
    recording: &Recording,
    cylinder: usize,
    input: &[f64],
) -> Option<Remark> {
    let constants = &model.machine.cylinders[cylinder];
    let chambers: &Chambers = constants.chambers.as_ref()?;
    if !matches!(chambers.drive, Drive::Valve { .. }) {
        return None;
    }
    let displacement = &recording.cylinder(&constants.name).ok()?.displacement;
    let null = model.effects.iter().find(|effect| effect.is("valve_null", Site::Cylinder(cylinder)));
    let null = null.and_then(|effect| effect.parameters.first()).map_or(0.0, |parameter| parameter.value);
    let opening: Vec<f64> = input.iter().map(|input| input - null).collect();
    let limit = CLOSED * largest(&opening);
    let unit = model.machine.size().time();
    let speeds = speeds(&recording.time, displacement, SPEED_TIME * unit);
    let fastest = speeds.iter().copied().filter(|speed| speed.is_finite()).map(f64::abs).fold(0.0, f64::max);
    let is_closed = |sample: usize| opening[sample].abs() <= limit;
    let mut travelled = 0.0;
    let mut first = None;
    for (sample, speed) in speeds.iter().enumerate() {
        if !is_closed(sample) {
            first = None;
            continue;
        }
        let begin = *first.get_or_insert(recording.time[sample]) + RUN_OUT * unit;
        if recording.time[sample] > begin && speed.abs() > LEAST_SPEED * fastest {
            travelled += speed.abs() * (recording.time[sample] - recording.time[sample - 1]);
        }
    }
    let least = (LEAST_TRAVEL * constants.usual_travel()).max(20.0 * noise_level(displacement));
    if limit == 0.0 || travelled < least {
        return None;
    }
    let mut standing: Vec<f64> = (0..input.len())
        .filter(|&at| speeds[at].abs() < STANDS * fastest && input[at].is_finite())
        .map(|at| input[at])
        .collect();
    let middle = standing.len() / 2;
    let stands_at = (!standing.is_empty()).then(|| *standing.select_nth_unstable_by(middle, f64::total_cmp).1);
    let (factor, unit) = chambers.drive.command_unit().for_people();
    Some(Remark::MovesWhileClosed {
        cylinder: constants.name.clone(),
        travel: 1e3 * travelled,
        closed: factor * null,
        stands_at: stands_at.map_or(f64::NAN, |input| factor * input),
        unit,
    })
}

/// Speed over this time before each sample, m/s; `NaN` where the recording pauses.
fn speeds(time: &[f64], displacement: &[f64], over: f64) -> Vec<f64> {
    let mut before = 0;
    (0..time.len())
        .map(|now| {
            while time[now] - time[before] > over {
                before += 1;
            }
            let passed = time[now] - time[before];
            if passed > 0.5 * over { (displacement[now] - displacement[before]) / passed } else { f64::NAN }
        })
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

    /// 20 s of an arm whose valve moves it with 50 mm/s per 1e-5 m² beyond `null`.
    fn run(null: f64) -> Recording {
        let time: Vec<f64> = (0..4000).map(|k| 5e-3 * f64::from(k)).collect();
        let mut recording = Recording::unmeasured("run", time.clone(), &["arm"]);
        let signals = &mut recording.cylinders[0];
        let input = |t: f64| if t % 4.0 < 2.0 { 0.0 } else { 2e-5 * if t % 8.0 < 4.0 { 1.0 } else { -1.0 } };
        let mut position = 0.0;
        for (sample, &t) in time.iter().enumerate() {
            position += 5e-3 * 0.05 * (input(t) - null) / 1e-5 * if (input(t) - null).abs() < 2e-6 { 0.0 } else { 1.0 };
            signals.displacement[sample] = position;
            signals.orifice_area[sample] = input(t);
        }
        recording
    }

    #[test]
    fn motion_at_the_null_of_the_input_is_reported_with_the_input_at_which_it_stands() {
        let model = built_in("zx30u-arm").unwrap();
        let found = |run: &Recording| moves_while_closed(&model, run, 0, &run.cylinders[0].orifice_area);
        assert_eq!(found(&run(0.0)), None);
        let shifted = run(2e-5);
        let Some(Remark::MovesWhileClosed { travel, stands_at, closed, unit, .. }) = found(&shifted) else {
            unreachable!("{:?}", found(&shifted))
        };
        assert!((600.0..1100.0).contains(&travel) && (stands_at - 20.0).abs() < 0.1, "{travel} {stands_at}");
        assert_eq!((closed, unit), (0.0, "mm2"));
    }
}
