//! Finds readings that no instruments make: the copies, placeholders and made-up numbers of gateways and simulators.

use excavator_model::recording::standard_deviation;

use super::unit::Dimension;

/// A signal, or a name of formulas, on the clock of the recording.
pub(super) struct Readings<'r> {
    /// `boom.cap_pressure`, `boom_up_pilot_pressure`.
    pub label: String,
    /// What it measures; `None` if unknown.
    pub dimension: Option<Dimension>,
    /// SI.
    pub values: &'r [f64],
}

/// Fewest moments at which two signals are compared.
const FEWEST: usize = 50;
/// Share of moments without pressure on one side or the other, from which pressures are one-sided.
const ONE_SIDED: f64 = 0.98;
/// Share of moments at which each side must have pressure for it.
const EACH_SIDE: f64 = 0.02;
/// A pressure below this is none, Pa: less than a bar of return pressure is in every chamber.
const NO_PRESSURE: f64 = 1e3;
/// Deviation of a proportion, as a share of the smaller signal's spread, that is left to rounding.
const ROUNDING: f64 = 0.01;
/// Least range of a signal that may be in proportion to another one, as a multiple of the rounding of both.
const LEAST_RANGE: f64 = 4.0;

/// What is odd about the signals, one line each.
pub(super) fn traps(all: &[Readings<'_>]) -> Vec<String> {
    let moving: Vec<&Readings> = all.iter().filter(|one| moves(one.values)).collect();
    let mut lines = Vec::new();
    for (index, first) in moving.iter().enumerate() {
        for second in moving[index + 1..].iter().filter(|second| second.dimension == first.dimension) {
            if is_copy(first.values, second.values) {
                lines.push(format!(
                    "{} and {} are the same numbers all the time: one is a copy of the other, so at most one was measured",
                    first.label, second.label
                ));
            }
        }
    }
    for first in &moving {
        let side = first.label.strip_suffix(".cap_pressure");
        let other = side.and_then(|name| moving.iter().find(|one| one.label == format!("{name}.rod_pressure")));
        if let (Some(name), Some(other)) = (side, other)
            && are_one_sided(first.values, other.values)
        {
            lines.push(format!(
                "{name}: only one of cap_pressure and rod_pressure is above zero at a time, as of a force divided by an area; chambers of a \
                 machine both have pressure"
            ));
        }
    }
    for pilot in moving.iter().filter(|one| one.label.contains("pilot")) {
        let main = moving.iter().filter(|one| one.dimension == pilot.dimension && one.label.contains('.'));
        if let Some((main, ratio)) = main.filter_map(|main| Some((main, proportion(main.values, pilot.values)?))).next()
        {
            lines.push(format!(
                "{} is {ratio:.3} of {} all the time: it was computed from it, and tells nothing of the valve",
                pilot.label, main.label
            ));
        }
    }
    // A machine at rest is constant everywhere.
    if moving.len() * 2 >= all.len() {
        for still in all.iter().filter(|one| is_placeholder(one)) {
            let value = still.values.iter().copied().find(|value| value.is_finite()).unwrap_or(f64::NAN);
            lines.push(format!("{} is {value} all the time, while others move: a placeholder", still.label));
        }
    }
    lines
}

fn pairs<'v>(first: &'v [f64], second: &'v [f64]) -> impl Iterator<Item = (f64, f64)> + 'v {
    first.iter().copied().zip(second.iter().copied()).filter(|(first, second)| first.is_finite() && second.is_finite())
}

fn moves(values: &[f64]) -> bool {
    let mut finite = values.iter().filter(|value| value.is_finite());
    let first = finite.next();
    finite.any(|value| Some(value) != first)
}

fn is_copy(first: &[f64], second: &[f64]) -> bool {
    pairs(first, second).count() >= FEWEST && pairs(first, second).all(|(first, second)| first == second)
}

fn are_one_sided(cap: &[f64], rod: &[f64]) -> bool {
    let count =
        |holds: &dyn Fn(f64, f64) -> bool| pairs(cap, rod).filter(|(cap, rod)| holds(*cap, *rod)).count() as f64;
    let all = count(&|_, _| true);
    all >= FEWEST as f64
        && count(&|cap, rod| cap.min(rod) < NO_PRESSURE) >= ONE_SIDED * all
        && count(&|cap, _| cap > NO_PRESSURE) >= EACH_SIDE * all
        && count(&|_, rod| rod > NO_PRESSURE) >= EACH_SIDE * all
}

/// The factor from one signal to another that follows it within rounding; `None` if it does not.
fn proportion(main: &[f64], pilot: &[f64]) -> Option<f64> {
    let (mut mixed, mut square, mut count) = (0.0, 0.0, 0);
    for (main, pilot) in pairs(main, pilot) {
        (mixed, square, count) = (mixed + main * pilot, square + main * main, count + 1);
    }
    let ratio = mixed / square;
    if count < FEWEST || !ratio.is_finite() || ratio.abs() < 1e-6 {
        return None;
    }
    let steps = 0.5 * (step(pilot) + ratio.abs() * step(main));
    let spread = standard_deviation(pilot);
    let most = steps + ROUNDING * spread;
    let (low, high) = pairs(main, pilot)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (_, pilot)| (low.min(pilot), high.max(pilot)));
    // Within its rounding, a signal that hardly moves is in proportion to any other.
    (high - low > LEAST_RANGE * steps && pairs(main, pilot).all(|(main, pilot)| (pilot - ratio * main).abs() <= most))
        .then_some(ratio)
}

/// Step of a converter: the smallest difference of two values, if most values occur several times.
fn step(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let all = sorted.len();
    sorted.dedup_by(|next, before| *next - *before <= 1e-9 * before.abs().max(1.0));
    if sorted.len() * 2 > all {
        return 0.0;
    }
    sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min)
}

/// Only chambers are never at a constant pressure while the machine moves: an open tank is, and so are the pilots of an idle axis.
fn is_placeholder(one: &Readings<'_>) -> bool {
    [".cap_pressure", ".rod_pressure"].iter().any(|end| one.label.ends_with(end))
        && one.values.iter().filter(|value| value.is_finite()).count() >= FEWEST
        && !moves(one.values)
}
