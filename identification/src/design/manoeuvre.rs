//! The library of manoeuvres.

use excavator_model::machine::Machine;
use excavator_model::simulation::Segment;

/// A manoeuvre of one cylinder, with all other valves closed.
#[derive(Debug, Clone, PartialEq)]
pub struct Manoeuvre {
    /// Description for display.
    pub name: String,
    /// Effects that it makes visible.
    pub shows: &'static str,
    /// Index of the cylinder.
    pub cylinder: usize,
    /// Where it begins, as a share of the distance from mid-stroke (0) to the end of the allowed stroke (-1, 1).
    pub place: f64,
    /// The commands, in order.
    pub segments: Vec<Segment>,
}

impl Manoeuvre {
    /// Length in s.
    pub fn duration(&self) -> f64 {
        self.segments.iter().map(Segment::duration).sum()
    }
}

/// Time at rest before each manoeuvre, s. Pressures settle, and all manoeuvres start from the same state.
const BEFORE: f64 = 0.5;

/// Every manoeuvre of the library for every cylinder in `wanted` that has a valve. Amplitudes are shares of the valve's largest
/// opening and never exceed it.
///
/// Contents and purpose:
/// - *closed valve* at three places: any remaining motion or drift is leakage, load, or the instrument itself;
/// - *slow ramps* through closed: flow against opening near zero, on the way up and on the way down (overlap, play);
/// - *small trapezoids* about closed, and *waits at closed after a stroke from either side*: play leaves the valve open by a part
///   of its width, with a sign that depends on the side; overlap does not;
/// - *steps* and *small reversals about an open valve*: play acts at any mean opening, overlap only about zero;
/// - *creeps*: friction at low speed, and an open centre that is barely closed;
/// - *sines, sweeps, trapezoids* of several sizes and frequencies: inertia, lags, losses with the square of the speed;
/// - *pushes* towards the ends of the allowed stroke and at full opening: cushions, high pump pressure, relief.
pub fn library(machine: &Machine, wanted: &[usize]) -> Vec<Manoeuvre> {
    wanted
        .iter()
        .filter_map(|&cylinder| {
            let chambers = machine.cylinders.get(cylinder)?.chambers?;
            Some(of_cylinder(cylinder, chambers.full_command()))
        })
        .flatten()
        .collect()
}

/// A moderate sine, which keeps the base parameters identifiable from the profile alone.
pub(super) fn general(machine: &Machine, cylinder: usize) -> Option<Manoeuvre> {
    let full = machine.cylinders.get(cylinder)?.chambers?.full_command();
    let sine = Segment::Sine { duration: 6.0, amplitude: 0.5 * full, frequency: 0.5 };
    Some(build(cylinder, "moderate sine".into(), "the machine's own parameters", 0.0, vec![sine]))
}

fn build(cylinder: usize, name: String, shows: &'static str, place: f64, mut segments: Vec<Segment>) -> Manoeuvre {
    segments.insert(0, closed(BEFORE));
    segments.push(closed(BEFORE));
    Manoeuvre { name, shows, cylinder, place, segments }
}

fn closed(duration: f64) -> Segment {
    Segment::Hold { duration, area: 0.0 }
}

fn trapezoid(duration: f64, amplitude: f64, ramp: f64) -> Segment {
    Segment::Trapezoid { duration, amplitude, ramp }
}

fn triangle(duration: f64, amplitude: f64) -> Segment {
    trapezoid(duration, amplitude, duration / 2.0)
}

/// A trapezoid in one direction and the same back, each followed by a pause at closed.
fn there_and_back(duration: f64, amplitude: f64, ramp: f64, pause: f64) -> Vec<Segment> {
    vec![trapezoid(duration, amplitude, ramp), closed(pause), trapezoid(duration, -amplitude, ramp), closed(pause)]
}

fn hold(duration: f64, area: f64) -> Segment {
    Segment::Hold { duration, area }
}

fn of_cylinder(cylinder: usize, full: f64) -> Vec<Manoeuvre> {
    let mut all = Vec::new();
    let mut add = |name: String, shows: &'static str, place: f64, segments: Vec<Segment>| {
        all.push(build(cylinder, name, shows, place, segments));
    };
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    for place in [-0.7, 0.0, 0.7] {
        add(format!("closed valve at {place:+.1} of the way"), "leakage, load, offsets", place, vec![closed(4.0)]);
    }
    for share in [0.1, 0.2, 0.35] {
        let a = share * full;
        let ramps = vec![triangle(1.6, a), triangle(1.6, -a), triangle(1.6, a), triangle(1.6, -a)];
        add(format!("slow ramps to {}", percent(share)), "overlap, play", 0.0, ramps);
    }
    for share in [0.06, 0.12, 0.25] {
        let a = share * full;
        let small = there_and_back(1.0, a, 0.2, 0.4);
        add(format!("small trapezoids of {}", percent(share)), "overlap", 0.0, [small.clone(), small].concat());
    }
    for share in [0.3, 0.7] {
        let a = share * full;
        let waits = there_and_back(1.0, a, 0.15, 1.5);
        add(format!("waits at closed after {} from either side", percent(share)), "play, leakage", 0.0, waits);
    }
    for share in [0.25, 0.5, 0.9] {
        let a = share * full;
        let steps = vec![hold(0.7, a), closed(0.5), hold(0.7, -a), closed(0.5)];
        add(format!("steps to {}", percent(share)), "lag, compressibility, delays", 0.0, steps);
    }
    for share in [0.35, 0.7, -0.35, -0.7] {
        let a = share * full;
        let ways = (0..4).flat_map(|_| [hold(0.25, a), hold(0.25, 0.7 * a)]).collect();
        // Starts on the far side, so that the travel stays inside the limits.
        let place = -0.6 * share.signum();
        add(format!("reversals about an opening of {}", percent(0.85 * share)), "play away from closed", place, ways);
    }
    for share in [0.08, 0.15, 0.3] {
        let a = share * full;
        let creep = vec![trapezoid(2.5, a, 0.3), closed(0.3), trapezoid(2.5, -a, 0.3)];
        add(format!("creeps at {}", percent(share)), "friction at low speed, open centre", 0.0, creep);
    }
    for (share, frequency, duration) in [
        (0.25, 0.2, 5.0),
        (0.5, 0.2, 5.0),
        (0.15, 0.5, 4.0),
        (0.35, 0.5, 4.0),
        (0.7, 0.5, 4.0),
        (0.25, 1.0, 4.0),
        (0.6, 1.0, 4.0),
        (0.95, 1.0, 4.0),
        (0.2, 2.5, 2.8),
        (0.5, 2.5, 2.8),
        (0.9, 2.5, 2.8),
        (0.5, 5.0, 2.0),
    ] {
        let sine = Segment::Sine { duration, amplitude: share * full, frequency };
        add(format!("sine of {} at {frequency} Hz", percent(share)), "inertia, damping, flow gains", 0.0, vec![sine]);
    }
    for share in [0.3, 0.8] {
        let sweep = Segment::Sweep { duration: 5.0, amplitude: share * full, from_frequency: 0.5, to_frequency: 4.0 };
        add(format!("sweep of {}", percent(share)), "lags, delays, compressibility", 0.0, vec![sweep]);
    }
    for share in [0.4, 0.7, 1.0] {
        let a = share * full;
        let strokes = there_and_back(1.6, a, 0.15, 0.5);
        add(format!("strokes at {}", percent(share)), "gains, losses with the square of the speed", 0.0, strokes);
    }
    for (place, side) in [(0.8, 1.0), (-0.8, -1.0)] {
        for share in [0.4, 1.0] {
            let a = side * share * full;
            let push = there_and_back(0.8, a, 0.1, 0.4);
            let end = if side > 0.0 { "extended" } else { "retracted" };
            add(format!("pushes at {} near the {end} end", percent(share)), "cushions, relief", place, push);
        }
    }
    all
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;
    use excavator_model::simulation::Profile;

    #[test]
    fn no_command_is_beyond_the_valve_and_all_can_be_written() {
        let machine = built_in("zx30u").unwrap().machine;
        let all = library(&machine, &[0, 1]);
        assert!(all.len() > 60);
        for manoeuvre in &all {
            let full = machine.cylinders[manoeuvre.cylinder].chambers.unwrap().full_command();
            let profile = Profile { cylinder: "arm".into(), segments: manoeuvre.segments.clone() };
            profile.check().unwrap();
            let most = (0..10_000).map(|k| profile.area(f64::from(k) * 0.001).abs()).fold(0.0, f64::max);
            assert!(most <= full * (1.0 + 1e-12), "{}: {most}", manoeuvre.name);
            assert!((3.0..9.0).contains(&manoeuvre.duration()), "{}: {} s", manoeuvre.name, manoeuvre.duration());
        }
    }

    #[test]
    fn a_drive_without_a_valve_has_no_manoeuvre() {
        assert!(library(&built_in("emps").unwrap().machine, &[0]).is_empty());
    }
}
