//! How strong an effect is: the share of the signals' change that it causes.

use crate::manoeuvres::Manoeuvre;
use crate::plant::{Effects, Plant, Sensors};
use crate::run::{Diverged, Lever, Truth, run};

/// How well an effect shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strength {
    /// A share of 0.2 % to 0.5 %: an engineer would want to know, and could overlook it.
    Weak,
    /// 1 % to 3 %.
    Medium,
    /// 5 % to 15 %: where most of the practice recordings are.
    Strong,
}

impl Strength {
    /// All of them.
    pub const ALL: [Strength; 3] = [Strength::Weak, Strength::Medium, Strength::Strong];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Strength::Weak => "weak",
            Strength::Medium => "medium",
            Strength::Strong => "strong",
        }
    }

    /// Least and largest share.
    pub fn band(self) -> (f64, f64) {
        match self {
            Strength::Weak => (0.002, 0.005),
            Strength::Medium => (0.01, 0.03),
            Strength::Strong => (0.05, 0.15),
        }
    }
}

/// NMSE of displacement, velocity, cap, rod and pump pressure between a plant with and without its effects at the same
/// commands, as instruments without noise would see them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// In the order above.
    pub nmse: [f64; 5],
}

impl Change {
    /// Mean over the five signals; a signal that has nothing to do with the other any more counts as 1.
    pub fn share(&self) -> f64 {
        self.nmse.iter().map(|nmse| nmse.min(1.0)).sum::<f64>() / 5.0
    }

    /// Of a run against a plant without effects under the same commands.
    pub fn between(with: &Truth, sensors: &Sensors, without: &Truth) -> Self {
        let late = sensors.pressure_delay;
        let measured: Vec<f64> = with.displacement.iter().map(|value| sensors.displacement(*value)).collect();
        let pairs = [
            (&measured, &without.displacement, sensors.displacement_delay, 0.0),
            (&with.velocity, &without.velocity, 0.0, 0.0),
            (&with.cap, &without.cap, late, sensors.cap_offset),
            (&with.rod, &without.rod, late, sensors.rod_offset),
            (&with.pump, &without.pump, late, sensors.pump_offset),
        ];
        let nmse = pairs.map(|(with, without, delay, offset)| {
            let seen = Truth::late(with, delay);
            let plain = Truth::late(without, 0.0);
            let mean = seen.iter().sum::<f64>() / seen.len() as f64;
            let spread: f64 = seen.iter().map(|value| (value - mean).powi(2)).sum();
            let error: f64 = seen.iter().zip(&plain).map(|(a, b)| (a + offset - b).powi(2)).sum();
            error / spread
        });
        Change { nmse }
    }
}

/// A run and what the effects changed in it.
///
/// # Errors
/// [`Diverged`].
pub fn run_and_compare(plant: &Plant, manoeuvre: &Manoeuvre, displacement: f64) -> Result<(Truth, Change), Diverged> {
    let plant = Plant { duration: manoeuvre.duration(), ..*plant };
    let with = run(&plant, Lever::Operator(manoeuvre), displacement)?;
    if plant.effects == Effects::default() {
        return Ok((with, Change { nmse: [0.0; 5] }));
    }
    let bare = Plant { effects: Effects::default(), ..plant };
    let without = run(&bare, Lever::Replay(&with.command), displacement)?;
    let change = Change::between(&with, &plant.effects.sensors, &without);
    Ok((with, change))
}

/// What the effects of `plant` change that `less` does not have, at the same commands.
///
/// # Errors
/// [`Diverged`].
pub fn compare(plant: &Plant, less: &Plant, manoeuvre: &Manoeuvre, displacement: f64) -> Result<Change, Diverged> {
    let [plant, less] = [plant, less].map(|one| Plant { duration: manoeuvre.duration(), ..*one });
    let with = run(&plant, Lever::Operator(manoeuvre), displacement)?;
    let without = run(&less, Lever::Replay(&with.command), displacement)?;
    Ok(Change::between(&with, &plant.effects.sensors, &without))
}

/// Searches the factor at which `set` changes the validation manoeuvre by `target`, at most `limit`: shares grow with
/// about the square of the factor, so a few corrections by the root of the ratio are enough. A run that breaks counts
/// as far too strong.
pub fn size(target: f64, limit: f64, manoeuvre: &Manoeuvre, displacement: f64, set: &dyn Fn(f64) -> Plant) -> f64 {
    let mut factor = 1.0_f64.min(limit);
    let mut best = (f64::INFINITY, factor);
    for _ in 0..6 {
        let share = run_and_compare(&set(factor), manoeuvre, displacement).map_or(10.0, |(_, change)| change.share());
        let miss = (share / target).ln();
        if miss.abs() < best.0 {
            best = (miss.abs(), factor);
        }
        if miss.abs() < 0.2 || (factor >= limit && miss < 0.0) {
            break;
        }
        // An effect with a threshold shows nothing at first: no more than three times per step.
        factor = (factor * (-0.5 * miss).exp().clamp(0.25, 3.0)).min(limit);
    }
    best.1
}
