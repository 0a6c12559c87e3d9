//! The plant at work: what truly happened, without instruments.

use crate::manoeuvres::{Manoeuvre, Operator};
use crate::plant::{Plant, STEP, step};

/// Samples per second of the recorder; commands come at the same rate.
pub const RATE: f64 = 500.0;
/// Points per sample, so that a delay needs no coarse interpolation.
pub const POINTS: usize = 4;

/// What truly happened, on a clock of [`RATE`] times [`POINTS`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Truth {
    /// Piston displacement, m.
    pub displacement: Vec<f64>,
    /// Piston velocity, m/s.
    pub velocity: Vec<f64>,
    /// Cap side pressure, Pa.
    pub cap: Vec<f64>,
    /// Rod side pressure, Pa.
    pub rod: Vec<f64>,
    /// Pump pressure, Pa.
    pub pump: Vec<f64>,
    /// Spool position that a sensor would see, m².
    pub spool: Vec<f64>,
    /// Commands, m², one per sample.
    pub command: Vec<f64>,
}

/// Something broke: a state is no number any more.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the plant's state stopped being finite at {time:.3} s; an effect is beyond what the step of 25 us resolves")]
pub struct Diverged {
    /// When, s.
    pub time: f64,
}

/// Who gives the commands.
#[derive(Debug, Clone, Copy)]
pub enum Lever<'a> {
    /// An operator who sees the arm.
    Operator(&'a Manoeuvre),
    /// Commands of another run, in m², one per sample.
    Replay(&'a [f64]),
}

/// Runs a plant from rest at `displacement` (m).
///
/// # Errors
/// [`Diverged`].
pub fn run(plant: &Plant, lever: Lever<'_>, displacement: f64) -> Result<Truth, Diverged> {
    let mut state = plant.at_rest(displacement);
    let plant =
        Plant { boom_holding_torque: plant.boom_gravity(0.0, std::f64::consts::FRAC_PI_3, state.values[0]), ..*plant };
    let samples = (plant.duration * RATE).round() as usize;
    let steps = (1.0 / (RATE * POINTS as f64 * STEP)).round() as usize;
    let delay = plant.effects.valve.lag.map_or(0.0, |lag| lag.delay);
    let mut operator = match lever {
        Lever::Operator(manoeuvre) => Some(Operator::new(manoeuvre, displacement)),
        Lever::Replay(_) => None,
    };
    let mut truth = Truth::default();
    for sample in 0..samples {
        let time = sample as f64 / RATE;
        let (seen, _) = plant.piston(&state);
        let command = match (&mut operator, lever) {
            (Some(operator), _) => operator.command(time, 1.0 / RATE, seen),
            (None, Lever::Replay(commands)) => commands.get(sample).copied().unwrap_or(0.0),
            (None, Lever::Operator(_)) => 0.0,
        };
        truth.command.push(command);
        for point in 0..POINTS {
            truth.note(&plant, &state, command);
            for number in 0..steps {
                let now = time + (point * steps + number) as f64 * STEP;
                let late = if delay > 0.0 { command_at(&truth.command, now - delay) } else { command };
                step(&plant, now, &mut state, command, late);
            }
        }
        if !state.values.iter().all(|value| value.is_finite()) {
            return Err(Diverged { time });
        }
    }
    Ok(truth)
}

/// The command held at a time in s; 0 before the first.
fn command_at(commands: &[f64], time: f64) -> f64 {
    if time < 0.0 {
        return 0.0;
    }
    commands.get((time * RATE + 1e-9) as usize).copied().unwrap_or(0.0)
}

impl Truth {
    fn note(&mut self, plant: &Plant, state: &crate::plant::State, command: f64) {
        let (displacement, velocity) = plant.piston(state);
        self.displacement.push(displacement);
        self.velocity.push(velocity);
        self.cap.push(state.values[2]);
        self.rod.push(state.values[3]);
        self.pump.push(state.values[4]);
        self.spool.push(plant.spool(state, command));
    }

    /// Number of samples (not points).
    pub fn samples(&self) -> usize {
        self.command.len()
    }

    /// A signal on the clock of samples, `delay` s late.
    pub fn late(signal: &[f64], delay: f64) -> Vec<f64> {
        let behind = delay * RATE * POINTS as f64;
        (0..signal.len() / POINTS)
            .map(|sample| {
                let place = ((sample * POINTS) as f64 - behind).max(0.0);
                let (low, share) = (place as usize, place.fract());
                let next = (low + 1).min(signal.len() - 1);
                signal[low] + share * (signal[next] - signal[low])
            })
            .collect()
    }
}
