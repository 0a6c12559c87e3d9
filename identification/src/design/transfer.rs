//! Moves a piston to the place where the next manoeuvre begins.

use excavator_model::simulation::Segment;

use super::ride::Rider;
use super::{DesignError, Violation};

/// Opening during the transfer, share of the largest.
const OPENING: f64 = 0.9;
/// Time for opening and for closing, s.
const RAMP: f64 = 0.2;
/// Longest transfer, s.
const LONGEST: f64 = 8.0;
/// Tolerance of the target, share of the stroke.
const NEAR: f64 = 0.02;
/// Number of bisections of the time: 8 s / 2^9 is 16 ms.
const HALVINGS: usize = 9;

/// Why a transfer is impossible.
pub(super) enum NoWay {
    Violation(Violation),
    Error(DesignError),
}

/// A stroke that brings a cylinder from `state` to `target` (m); empty if it is already there. Displacement grows with the time
/// that a valve stays open, so bisection finds that time.
pub(super) fn transfer(
    rider: &Rider<'_>,
    cylinder: usize,
    state: &[f64],
    target: f64,
    from: f64,
    rate: f64,
) -> Result<Vec<Segment>, NoWay> {
    let own = &rider.system.model().machine.cylinders[cylinder];
    let Some(chambers) = own.chambers else { return Ok(Vec::new()) };
    let start = rider.displacement(cylinder, state);
    let way = target - start;
    if way.abs() <= NEAR * own.stroke {
        return Ok(Vec::new());
    }
    let amplitude = OPENING * chambers.full_command() * way.signum();
    let stroke = |duration: f64| vec![Segment::Trapezoid { duration, amplitude, ramp: RAMP }];
    let goes = |duration: f64| -> Result<f64, DesignError> {
        let ride = rider.run(cylinder, &stroke(duration), state.to_vec(), from, rate)?;
        Ok((rider.displacement(cylinder, &ride.end) - start) * way.signum())
    };
    let (mut low, mut high) = (0.0, LONGEST);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        // A run that cannot be simulated counts as too far.
        let gone = match goes(middle) {
            Ok(gone) => gone,
            Err(DesignError::Simulation(_)) => f64::INFINITY,
            Err(error) => return Err(NoWay::Error(error)),
        };
        if gone < way.abs() { low = middle } else { high = middle }
    }
    if high >= LONGEST {
        return Err(NoWay::Violation(Violation::Unreachable {
            cylinder: own.name.clone(),
            from: start,
            to: target,
            within: LONGEST,
        }));
    }
    // A whole number of samples, so that everything after it stays on the clock.
    Ok(stroke((high * rate).round().max(1.0) / rate))
}
