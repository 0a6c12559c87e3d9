//! Detects swapped chamber pressures.
//!
//! The oil that a piston displaces has passed its valve: `A |v| = C |u| sqrt(dp)` on both sides and in both directions (\[A\] Eq.
//! 3), except for leakage and compression of the oil. With one fitted gain per side, the right pressures leave little of the flow
//! unexplained; swapped ones put the load on the wrong side.

use excavator_model::machine::Chambers;
use excavator_model::recording::{CylinderSignals, Recording, is_measured};

use super::opening::{largest, open_one_way};

/// Time over which flows are averaged, s: longer than the compression of oil takes, shorter than a stroke.
pub(super) const WINDOW: f64 = 0.1;

/// Fewest windows for a result.
const FEWEST: usize = 20;

/// Factor by which the given pressures must leave more unexplained than the swapped ones. Effects that this check ignores (check
/// valves, a pump line that is not measured at the valve) affect both alike.
pub(super) const CLEARLY: f64 = 4.0;

/// The given pressures must also leave at least this share: if they explain most of the flow, nothing is wrong.
pub(super) const MUCH: f64 = 0.1;

/// Unexplained squares of the piston's flow, as a share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shares {
    /// With the pressures as they are.
    pub given: f64,
    /// With the pressures exchanged.
    pub swapped: f64,
}

/// The shares, if they show that the two pressures are swapped.
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
            // In the direction that the valve allows. Motion driven the other way by the load is not explained by the valve.
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
    /// Adds a window's flow (m³/s) and opening times square root of pressure drop (m² sqrt(Pa)).
    fn add(&mut self, flow: f64, root: f64) {
        if flow.is_finite() && root.is_finite() {
            self.flow += flow * flow;
            self.product += flow * root;
            self.root += root * root;
        }
    }

    /// Squares that no gain explains; negative gains are excluded.
    fn unexplained(&self) -> f64 {
        if self.root > 0.0 { self.flow - self.product.max(0.0).powi(2) / self.root } else { self.flow }
    }
}
