//! Oddities in a recording that are no reason to refuse it.

use std::collections::BTreeMap;

use excavator_model::Model;
use excavator_model::machine::Cylinder;
use excavator_model::recording::{Recording, has_noise, is_measured, noise_level};

use super::check::usual_size;
use super::moves_closed::moves_while_closed;
use super::opening::{largest, open_one_way};
use super::runs::range;

/// Something odd in a recording, in one line that states what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Remark {
    /// A valve opens further than its full command in the model.
    #[error(
        "{signal} reaches {reached:.2} {unit}, {times:.2} times the full command of {machine}: one of the two is wrong, and effects that \
         depend on it come out wrong"
    )]
    OpensTooFar {
        /// Contract name of the signal.
        signal: String,
        /// Its usual largest magnitude, in the unit.
        reached: f64,
        /// The unit of the valve's input, as displayed.
        unit: &'static str,
        /// Ratio to the full command of the model.
        times: f64,
        /// The machine.
        machine: String,
    },
    /// A spool does not follow its command.
    #[error(
        "{cylinder}: the spool does not follow its command (correlation {correlation:.2} at best): check sign, clock and topic of \
         orifice_command; only orifice_area is used for the flows"
    )]
    CommandNotFollowed {
        /// The cylinder.
        cylinder: String,
        /// Correlation of opening and command at the best delay.
        correlation: f64,
    },
    /// Single readings that are impossible for this machine and were taken as not measured.
    #[error(
        "{signal}: {count} of {samples} readings are beyond anything possible, up to {worst:.3e} {unit}, and were taken as not measured"
    )]
    Impossible {
        /// Contract name of the signal.
        signal: String,
        /// Readings beyond the limit.
        count: usize,
        /// Readings.
        samples: usize,
        /// The reading of largest magnitude.
        worst: f64,
        /// SI unit.
        unit: &'static str,
    },
    /// A piston rests at one place, away from its ends, although its valve is open.
    #[error(
        "{cylinder} is pressed against something at {position:+.1} mm from mid-stroke for {share:.0} % of the time; the stroke in {machine} \
         ends at {end:+.1} mm. If that is its stop, correct the stroke or the sensor's zero; else leave it out (--where)"
    )]
    Pressed {
        /// The cylinder.
        cylinder: String,
        /// Where, mm from mid-stroke.
        position: f64,
        /// Share of the time, %.
        share: f64,
        /// The end of the stroke on that side, mm.
        end: f64,
        /// The machine.
        machine: String,
    },
    /// A piston moves although its valve is closed.
    #[error(
        "{cylinder} moves by {travel:.0} mm while its valve is closed, at {closed:.2} {unit}, and stands at about {stands_at:.2} {unit}: that is \
         its null. `characterise -o` writes the null into a model; or correct the zero of the input in the map"
    )]
    MovesWhileClosed {
        /// The cylinder.
        cylinder: String,
        /// How far, mm.
        travel: f64,
        /// The input of the closed valve, as the model has it, in the unit.
        closed: f64,
        /// The input at which the piston stands, in the unit.
        stands_at: f64,
        /// The unit of the valve's input, as displayed.
        unit: &'static str,
    },
    /// A command that was measured.
    #[error(
        "{cylinder}.orifice_command has noise, so it was measured; map it to orifice_area, which is interpolated between samples, while a command is held"
    )]
    MeasuredCommand {
        /// The cylinder.
        cylinder: String,
    },
    /// A cylinder that is not in the model moves.
    #[error(
        "cylinder {cylinder} moves by {range:.3} m but is not in {machine}; it draws oil and moves the links that it carries; use a model that \
         includes it, or record while it is at rest"
    )]
    OtherCylinderMoves {
        /// The cylinder.
        cylinder: String,
        /// How far it moves, m.
        range: f64,
        /// The machine.
        machine: String,
    },
}

/// Factor over the model's full command above which an opening is reported: sensors have gain errors of their own.
const OPENS_TOO_FAR: f64 = 1.1;

/// Delays between command and spool that are tried, s.
const DELAYS: [f64; 7] = [0.0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5];

/// Correlation above which a command counts as followed. A dead band, a slow valve and a stop leave 0.8 and more.
const FOLLOWS: f64 = 0.5;

/// Smallest travel, m, that counts as motion; it must also exceed 20 times the noise.
const LEAST_TRAVEL: f64 = 0.01;

/// Returns all oddities in `recording`, which has passed [`super::check`].
pub fn remarks(model: &Model, recording: &Recording) -> Vec<Remark> {
    let mut found = Vec::new();
    let machine = &model.machine;
    for (number, cylinder) in machine.cylinders.iter().enumerate() {
        let Ok(signals) = recording.cylinder(&cylinder.name) else { continue };
        if !is_measured(&signals.orifice_area) && has_noise(&signals.orifice_command) {
            found.push(Remark::MeasuredCommand { cylinder: cylinder.name.clone() });
        }
        let name = |signal: &str| format!("{}.{signal}", cylinder.name);
        let Some(chambers) = &cylinder.chambers else { continue };
        let (area, command) = (&signals.orifice_area, &signals.orifice_command);
        let (signal, opening) = if is_measured(area) { ("orifice_area", area) } else { ("orifice_command", command) };
        let reached = usual_size(opening).unwrap_or(0.0);
        let times = reached / chambers.full_command();
        if times > OPENS_TOO_FAR {
            let machine = machine.name.clone();
            let (factor, unit) = chambers.drive.command_unit().for_people();
            found.push(Remark::OpensTooFar { signal: name(signal), reached: factor * reached, unit, times, machine });
        }
        if is_measured(area) && is_measured(command) {
            let correlation = following(&recording.time, command, area);
            if correlation.is_some_and(|correlation| correlation < FOLLOWS) {
                let correlation = correlation.unwrap_or(0.0);
                found.push(Remark::CommandNotFollowed { cylinder: cylinder.name.clone(), correlation });
            }
        }
        found.extend(moves_while_closed(model, recording, number, opening));
        found.extend(pressed(model, cylinder, &signals.displacement, opening));
    }
    for signals in &recording.cylinders {
        let is_modelled = machine.cylinders.iter().any(|cylinder| cylinder.name == signals.name);
        if is_modelled || !is_measured(&signals.displacement) {
            continue;
        }
        let (low, high) = range(&signals.displacement);
        if high - low > LEAST_TRAVEL.max(20.0 * noise_level(&signals.displacement)) {
            let (cylinder, machine) = (signals.name.clone(), machine.name.clone());
            found.push(Remark::OtherCylinderMoves { cylinder, range: high - low, machine });
        }
    }
    found
}

/// Share of the stroke within which a piston counts as resting at one place.
const ONE_PLACE: f64 = 0.002;

/// Share of the recording for which a piston must be pressed before that is reported.
const LEAST_SHARE: f64 = 0.05;

/// Samples over which a piston must not move to count as resting.
const AFTER: usize = 20;

/// Where a piston rests away from its ends while its valve is open; of several places, the one with the longest time.
fn pressed(model: &Model, cylinder: &Cylinder, displacement: &[f64], opening: &[f64]) -> Option<Remark> {
    let (largest, place) = (largest(opening), ONE_PLACE * cylinder.usual_travel());
    let mut places: BTreeMap<(i64, bool), usize> = BTreeMap::new();
    for sample in 0..displacement.len().saturating_sub(AFTER) {
        let (here, later) = (displacement[sample], displacement[sample + AFTER]);
        let is_open = open_one_way(&opening[sample..=sample + AFTER], largest);
        let stands = (later - here).abs() < 0.1 * place && !cylinder.is_at_an_end(here);
        if largest > 0.0 && is_open && stands {
            *places.entry(((here / place).round() as i64, opening[sample] > 0.0)).or_default() += 1;
        }
    }
    let (&(number, is_out), &count) = places.iter().max_by_key(|(_, count)| **count)?;
    let share = count as f64 / displacement.len() as f64;
    (share >= LEAST_SHARE).then(|| Remark::Pressed {
        cylinder: cylinder.name.clone(),
        position: 1e3 * number as f64 * place,
        share: 100.0 * share,
        end: 1e3 * cylinder.ends[usize::from(is_out)],
        machine: model.machine.name.clone(),
    })
}

/// Largest correlation of `follower` with an earlier `leader`, zero if the leader never moves; `None` if the follower rests or
/// too few readings are available.
fn following(time: &[f64], leader: &[f64], follower: &[f64]) -> Option<f64> {
    let (low, high) = range(follower);
    if high - low <= 20.0 * noise_level(follower) {
        return None;
    }
    let held = |at: f64| time.partition_point(|&t| t <= at).checked_sub(1).map(|index| leader[index]);
    let at_delay = |delay: f64| {
        let pairs: Vec<(f64, f64)> = time
            .iter()
            .zip(follower)
            .filter_map(|(&t, &value)| Some((held(t - delay)?, value)))
            .filter(|(told, value)| told.is_finite() && value.is_finite())
            .collect();
        correlation(&pairs)
    };
    DELAYS.into_iter().filter_map(at_delay).max_by(f64::total_cmp)
}

/// Fewest readings for a correlation.
const FEWEST_PAIRS: usize = 100;

fn correlation(pairs: &[(f64, f64)]) -> Option<f64> {
    let count = pairs.len() as f64;
    let mean = |part: fn(&(f64, f64)) -> f64| pairs.iter().map(part).sum::<f64>() / count;
    let (first, second) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let (mut product, mut squares) = (0.0, [0.0; 2]);
    for (one, other) in pairs {
        let (one, other) = (one - first, other - second);
        product += one * other;
        squares = [squares[0] + one * one, squares[1] + other * other];
    }
    let size = (squares[0] * squares[1]).sqrt();
    (pairs.len() >= FEWEST_PAIRS).then_some(if size > 0.0 { product / size } else { 0.0 })
}
