//! Distortions of measurements by instruments, as sums that effects add to.

use super::Channel;
use crate::scalar::Scalar;

/// What one instrument reports of a true value x: `x(t - delay) + offset`.
///
/// Offset and delay affect the report alone, not forces or flows. So they are not states: a delay in the equations of
/// motion would cost several states per signal and would be accurate for slow signals only.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distortion<T> {
    /// Added to the true value, in the channel's unit.
    pub offset: T,
    /// Delay of the report, s.
    pub delay: T,
}

impl<T: Scalar> Distortion<T> {
    /// An ideal instrument.
    pub fn none() -> Self {
        Distortion { offset: T::from(0.0), delay: T::from(0.0) }
    }

    /// The true value as a function of the parameters, for equations that take measurements as inputs: `corrected` is
    /// the true value at the present parameters ([`crate::simulation::undistorted`]) and `slope` its time derivative.
    /// The result has the value `corrected` and the derivatives `-d(offset) + slope d(delay)`.
    pub fn truth(&self, corrected: f64, slope: f64) -> T {
        (self.offset - self.offset.value()) * -1.0 + (self.delay - self.delay.value()) * slope + corrected
    }
}

/// All instruments of a machine.
#[derive(Debug, Clone, PartialEq)]
pub struct Instruments<T> {
    /// Per cylinder: joint angle, displacement, velocity, cap pressure, rod pressure, rod force.
    cylinders: Vec<[Distortion<T>; 6]>,
    pump_pressure: Distortion<T>,
}

impl<T: Scalar> Instruments<T> {
    /// Ideal instruments of `cylinders` cylinders.
    pub fn true_ones(cylinders: usize) -> Self {
        Instruments { cylinders: vec![[Distortion::none(); 6]; cylinders], pump_pressure: Distortion::none() }
    }

    /// Number of cylinders.
    pub fn cylinders(&self) -> usize {
        self.cylinders.len()
    }

    /// Distortion of the instrument of a channel.
    pub fn of(&self, channel: Channel) -> Distortion<T> {
        match place(channel) {
            Some((cylinder, signal)) => self.cylinders[cylinder][signal],
            None => self.pump_pressure,
        }
    }

    /// Mutable access to the same, for an effect to add to.
    pub fn of_mut(&mut self, channel: Channel) -> &mut Distortion<T> {
        match place(channel) {
            Some((cylinder, signal)) => &mut self.cylinders[cylinder][signal],
            None => &mut self.pump_pressure,
        }
    }

    /// Whether every instrument is ideal.
    pub fn are_true(&self) -> bool {
        let mut all = self.cylinders.iter().flatten().chain([&self.pump_pressure]);
        all.all(|distortion| distortion.offset.value() == 0.0 && distortion.delay.value() == 0.0)
    }
}

fn place(channel: Channel) -> Option<(usize, usize)> {
    match channel {
        Channel::JointAngle(cylinder) => Some((cylinder, 0)),
        Channel::Displacement(cylinder) => Some((cylinder, 1)),
        Channel::Velocity(cylinder) => Some((cylinder, 2)),
        Channel::CapPressure(cylinder) => Some((cylinder, 3)),
        Channel::RodPressure(cylinder) => Some((cylinder, 4)),
        Channel::RodForce(cylinder) => Some((cylinder, 5)),
        Channel::PumpPressure => None,
    }
}
