//! Motion phases of a piston. A model can be right while the piston moves and wrong at a stop.

use std::fmt;

use excavator_model::machine::Cylinder;

/// Motion phase of a piston at one time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MotionPhase {
    /// It moves.
    Moving,
    /// It stands, away from both ends of its stroke.
    Standing,
    /// It is at an end of its stroke.
    AtAnEnd,
}

impl MotionPhase {
    /// All phases.
    pub const ALL: [MotionPhase; 3] = [MotionPhase::Moving, MotionPhase::Standing, MotionPhase::AtAnEnd];
}

impl fmt::Display for MotionPhase {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            MotionPhase::Moving => "moving",
            MotionPhase::Standing => "standing",
            MotionPhase::AtAnEnd => "at an end",
        })
    }
}

/// The part of a signal's squared error that falls into one phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseShare {
    /// The phase.
    pub phase: MotionPhase,
    /// Its share of the time in which the signal is compared.
    pub of_time: f64,
    /// Its share of the squared error.
    pub of_error: f64,
}

/// Share of its largest speed below which a piston counts as standing.
const STANDING: f64 = 0.05;

/// Motion phase of this cylinder's piston at each sample, from its displacement (m) and velocity (m/s). Samples that
/// were not measured count as moving.
pub fn motion_phases(displacement: &[f64], velocity: &[f64], cylinder: &Cylinder) -> Vec<MotionPhase> {
    let fastest = velocity.iter().filter(|speed| speed.is_finite()).fold(0.0_f64, |most, speed| most.max(speed.abs()));
    let phase = |(position, speed): (&f64, &f64)| {
        if cylinder.is_at_an_end(*position) {
            MotionPhase::AtAnEnd
        } else if speed.abs() < STANDING * fastest {
            MotionPhase::Standing
        } else {
            MotionPhase::Moving
        }
    };
    displacement.iter().zip(velocity).map(phase).collect()
}

/// Distribution of an error over the phases, in their order. Phases without a sample are left out.
pub fn phase_shares(phases: &[MotionPhase], error: &[f64]) -> Vec<PhaseShare> {
    let of = |wanted: Option<MotionPhase>| {
        let chosen = phases.iter().zip(error).filter(|(phase, _)| wanted.is_none_or(|wanted| wanted == **phase));
        let compared = chosen.map(|(_, error)| error).filter(|error| error.is_finite());
        compared.fold((0.0, 0.0), |(count, squares), error| (count + 1.0, squares + error * error))
    };
    let (count, squares) = of(None);
    let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    MotionPhase::ALL
        .into_iter()
        .map(|phase| {
            let (own, own_squares) = of(Some(phase));
            PhaseShare { phase, of_time: share(own, count), of_error: share(own_squares, squares) }
        })
        .filter(|share| share.of_time > 0.0)
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;

    use super::*;

    #[test]
    fn an_error_at_an_end_is_told_from_one_on_the_way() {
        let displacement = [0.0, 0.1, 0.2, 0.299, 0.3, f64::NAN];
        let velocity = [0.0, 0.1, 0.1, 0.1, 0.0, 0.1];
        let phases = motion_phases(&displacement, &velocity, &built_in("zx30u-arm").unwrap().machine.cylinders[0]);
        use MotionPhase::{AtAnEnd, Moving, Standing};
        assert_eq!(phases, [Standing, Moving, Moving, AtAnEnd, AtAnEnd, Moving]);
        let shares = phase_shares(&phases, &[1.0, 1.0, 1.0, 3.0, 2.0, f64::NAN]);
        let of = |phase| shares.iter().find(|share| share.phase == phase).map(|share| (share.of_time, share.of_error));
        assert_eq!(of(AtAnEnd), Some((2.0 / 5.0, 13.0 / 16.0)));
        assert_eq!(of(Moving), Some((2.0 / 5.0, 2.0 / 16.0)));
        assert!(phase_shares(&[], &[]).is_empty());
    }
}
