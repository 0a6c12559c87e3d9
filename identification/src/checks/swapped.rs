//! Chamber pressures that stand for each other.
//!
//! What a piston displaces has gone through its valve: `A |v| = C |u| sqrt(dp)` on both sides and in both directions
//! (\[A\] Eq. 3), but for leakage and the oil's compression. With one gain per side fitted, the right pressures leave
//! little of it unexplained; swapped ones put the load's side where it is not.

use excavator_model::machine::Chambers;
use excavator_model::recording::{CylinderSignals, Recording, is_measured};

use super::opening::{largest, open_one_way};

/// Time over which flows are averaged, s: longer than oil needs to be compressed, shorter than a stroke.
const WINDOW: f64 = 0.1;

/// Fewest windows that say something.
const FEWEST: usize = 20;

/// The given pressures must leave so many times more unexplained. What machines have that this knows not (check valves, a
/// pump line that is not measured at the valve) hits both alike.
const CLEARLY: f64 = 4.0;

/// And at least this share: where the given ones explain most of it, nothing is wrong.
const MUCH: f64 = 0.1;

/// Squares of the piston's flow that are not explained, as a share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shares {
    /// With the pressures as they are.
    pub given: f64,
    /// With the pressures exchanged.
    pub swapped: f64,
}

/// The shares, where they say that the two pressures are swapped.
pub(super) fn swapped_chambers(
    recording: &Recording,
    signals: &CylinderSignals,
    opening: &[f64],
    chambers: &Chambers,
    time_scale: f64,
) -> Option<Shares> {
    let needed = [&signals.displacement, &signals.cap_pressure, &signals.rod_pressure, &recording.pump_pressure];
    if !needed.into_iter().all(|signal| is_measured(signal)) || !is_measured(opening) {
        return None;
    }
    let shares = shares(recording, signals, opening, chambers, time_scale)?;
    (shares.given > MUCH && shares.given > CLEARLY * shares.swapped).then_some(shares)
}

fn shares(
    recording: &Recording,
    signals: &CylinderSignals,
    opening: &[f64],
    chambers: &Chambers,
    time_scale: f64,
) -> Option<Shares> {
    let time = &recording.time;
    let window = WINDOW * time_scale;
    let largest = largest(opening);
    let mut sides = [[Side::default(); 2]; 2];
    let (mut first, mut windows) = (0, 0usize);
    while let Some(&start) = time.get(first) {
        let last = time.partition_point(|&t| t < start + window);
        let Some(&end) = time.get(last) else { break };
        let range = first..last;
        first = last;
        let open = &opening[range.clone()];
        let velocity = (signals.displacement[last] - signals.displacement[range.start]) / (end - start);
        if !open_one_way(open, largest) || !velocity.is_finite() {
            continue;
        }
        windows += 1;
        for (assignment, sides) in sides.iter_mut().enumerate() {
            let (mut cap, mut rod) = (0.0, 0.0);
            for index in range.clone() {
                let pressures = [signals.cap_pressure[index], signals.rod_pressure[index]];
                let (at_cap, at_rod) = (pressures[assignment], pressures[1 - assignment]);
                let tank =
                    if recording.tank_pressure[index].is_finite() { recording.tank_pressure[index] } else { 0.0 };
                let root = |drop: f64| drop.max(0.0).sqrt() * opening[index].abs() / range.len() as f64;
                let pump = recording.pump_pressure[index];
                let extending = opening[index] > 0.0;
                cap += root(if extending { pump - at_cap } else { at_cap - tank });
                rod += root(if extending { at_rod - tank } else { pump - at_rod });
            }
            // The way the valve lets it; a load that moves the piston the other way is not explained by it.
            let along = if open.first().is_some_and(|&area| area > 0.0) { velocity } else { -velocity };
            sides[0].add(chambers.cap_area * along, cap);
            sides[1].add(chambers.rod_area * along, rod);
        }
    }
    let share = |sides: &[Side; 2]| {
        let all: f64 = sides.iter().map(|side| side.flow).sum();
        sides.iter().map(Side::unexplained).sum::<f64>() / all
    };
    let shares = Shares { given: share(&sides[0]), swapped: share(&sides[1]) };
    (windows >= FEWEST && shares.given.is_finite() && shares.swapped.is_finite()).then_some(shares)
}

/// Sums for one side of the piston.
#[derive(Debug, Clone, Copy, Default)]
struct Side {
    flow: f64,
    product: f64,
    root: f64,
}

impl Side {
    /// A window's flow (m³/s) and opening times square root of pressure drop (m² sqrt(Pa)).
    fn add(&mut self, flow: f64, root: f64) {
        if flow.is_finite() && root.is_finite() {
            self.flow += flow * flow;
            self.product += flow * root;
            self.root += root * root;
        }
    }

    /// Squares that no gain explains; a gain below zero is none.
    fn unexplained(&self) -> f64 {
        if self.root > 0.0 { self.flow - self.product.max(0.0).powi(2) / self.root } else { self.flow }
    }
}
