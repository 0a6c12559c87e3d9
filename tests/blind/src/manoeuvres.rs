//! What the operator does.

use std::f64::consts::TAU;

use excavator_model::simulation::Profile;

/// Largest opening that the operator asks for, m²: 95 % of umax.
const MOST: f64 = 1.0925e-4;
/// Speed of centring, m² per m of (slowly averaged) displacement.
const CENTRING: f64 = 4e-4;
/// Most that centring adds, m².
const MOST_CENTRING: f64 = 5e-5;
/// Time over which the operator averages where the arm is, s.
const PATIENCE: f64 = 1.0;

/// A stretch of a manoeuvre; openings in m², frequencies in Hz, times in s.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// Lever at rest.
    Pause,
    /// Sine of this amplitude and frequency.
    Sine(f64, f64),
    /// Sines of these amplitudes, frequencies and phases (rad).
    Multisine(Vec<[f64; 3]>),
    /// Up within this ramp time, hold, down.
    Trapezoid(f64, f64),
    /// Sine whose frequency rises linearly from the second to the third number.
    Sweep(f64, f64, f64),
    /// A command profile, followed as it is.
    Profile(Profile),
}

/// A manoeuvre: motions with their durations in s.
#[derive(Debug, Clone, PartialEq)]
pub struct Manoeuvre {
    /// What is done, one after the other.
    pub motions: Vec<(f64, Motion)>,
    /// Where the operator keeps the arm, m from mid-stroke.
    pub centre: f64,
    /// How firmly, 1 = as usual; 0 does as told, whatever the arm does.
    pub firmness: f64,
}

impl Manoeuvre {
    /// 38 s for identification: sines of two amplitudes, trapezoids of four, a sweep, pauses.
    pub fn identification(centre: f64) -> Self {
        let mut motions = vec![
            (0.5, Motion::Pause),
            (8.0, Motion::Sine(9e-5, 0.5)),
            (5.0, Motion::Sine(5.5e-5, 0.4)),
            (1.5, Motion::Pause),
        ];
        for amplitude in [2e-5, 4e-5, 6e-5, 9e-5] {
            for side in [1.0, -1.0] {
                motions.push((1.3, Motion::Trapezoid(side * amplitude, 0.2)));
                motions.push((0.3, Motion::Pause));
            }
        }
        motions.extend([(0.7, Motion::Pause), (8.5, Motion::Sweep(8e-5, 0.3, 2.0)), (1.0, Motion::Pause)]);
        Manoeuvre { motions, centre, firmness: 1.0 }
    }

    /// 20 s for validation: 1 Hz sine, multisine, one trapezoid to each side.
    pub fn validation(centre: f64) -> Self {
        let multisine = vec![[3e-5, 0.35, 0.4], [3e-5, 0.9, 2.1], [2.5e-5, 1.7, 4.0], [1.5e-5, 2.6, 5.2]];
        let motions = vec![
            (0.5, Motion::Pause),
            (6.5, Motion::Sine(9e-5, 1.0)),
            (1.0, Motion::Pause),
            (7.0, Motion::Multisine(multisine)),
            (1.0, Motion::Pause),
            (1.3, Motion::Trapezoid(5e-5, 0.2)),
            (0.7, Motion::Pause),
            (1.3, Motion::Trapezoid(-5e-5, 0.2)),
            (0.7, Motion::Pause),
        ];
        Manoeuvre { motions, centre, firmness: 1.0 }
    }

    /// 16 s to try a law on: slower and larger than both others at first, then steps of many sizes.
    pub fn third(centre: f64) -> Self {
        let multisine = vec![[5e-5, 0.23, 1.4], [3.5e-5, 0.61, 3.3], [1.5e-5, 2.1, 0.2]];
        let mut motions = vec![(0.5, Motion::Pause), (9.0, Motion::Multisine(multisine)), (0.5, Motion::Pause)];
        for amplitude in [3e-5, -8e-5, 7e-5, -3e-5, 1.5e-5, -1.5e-5] {
            motions.push((0.8, Motion::Trapezoid(amplitude, 0.1)));
            motions.push((0.2, Motion::Pause));
        }
        Manoeuvre { motions, centre, firmness: 1.0 }
    }

    /// A command profile without anybody who steers back.
    pub fn of_profile(profile: Profile) -> Self {
        Manoeuvre { motions: vec![(profile.duration(), Motion::Profile(profile))], centre: 0.0, firmness: 0.0 }
    }

    /// The same by an operator who holds the arm near an end of the stroke, twice as firmly.
    pub fn firmer(self) -> Self {
        Manoeuvre { firmness: 2.0, ..self }
    }

    /// Length, s.
    pub fn duration(&self) -> f64 {
        self.motions.iter().map(|(duration, _)| duration).sum()
    }

    /// Opening that is meant at a time in s, m², before centring; `None` in pauses.
    pub fn wanted(&self, time: f64) -> Option<f64> {
        let mut begin = 0.0;
        for (duration, motion) in &self.motions {
            if time < begin + duration {
                return motion.at(time - begin, *duration);
            }
            begin += duration;
        }
        None
    }
}

impl Motion {
    fn at(&self, time: f64, duration: f64) -> Option<f64> {
        match self {
            Motion::Pause => None,
            Motion::Sine(amplitude, frequency) => Some(amplitude * (TAU * frequency * time).sin()),
            Motion::Multisine(lines) => {
                let line =
                    |[amplitude, frequency, phase]: &[f64; 3]| amplitude * (TAU * frequency * time + phase).sin();
                Some(lines.iter().map(line).sum())
            }
            Motion::Trapezoid(amplitude, ramp) => {
                Some(amplitude * (time / ramp).min((duration - time) / ramp).clamp(0.0, 1.0))
            }
            Motion::Sweep(amplitude, from, to) => {
                let cycles = from * time + 0.5 * (to - from) * time * time / duration;
                Some(amplitude * (TAU * cycles).sin())
            }
            Motion::Profile(profile) => Some(profile.area(time)),
        }
    }
}

/// The operator: does the manoeuvre and slowly steers the arm back to where it should be.
#[derive(Debug, Clone)]
pub struct Operator<'m> {
    manoeuvre: &'m Manoeuvre,
    average: f64,
}

impl<'m> Operator<'m> {
    /// At the lever of an arm that stands at `displacement` (m).
    pub fn new(manoeuvre: &'m Manoeuvre, displacement: f64) -> Self {
        Operator { manoeuvre, average: displacement }
    }

    /// Command in m² at a time in s, `interval` s after the one before; the arm is at `displacement` (m).
    pub fn command(&mut self, time: f64, interval: f64, displacement: f64) -> f64 {
        self.average += (displacement - self.average) * interval / PATIENCE;
        let Some(wanted) = self.manoeuvre.wanted(time) else { return 0.0 };
        let firmness = self.manoeuvre.firmness;
        if firmness == 0.0 {
            return wanted;
        }
        let centring = (CENTRING * (self.manoeuvre.centre - self.average)).clamp(-MOST_CENTRING, MOST_CENTRING);
        (wanted + firmness * centring).clamp(-MOST, MOST)
    }
}

#[cfg(test)]
mod tests {
    use excavator_model::simulation::Segment;

    use super::*;

    #[test]
    fn a_profile_is_followed_wherever_the_arm_is() {
        let sine = Segment::Sine { duration: 2.0, amplitude: 1.15e-4, frequency: 0.5 };
        let profile = Profile { cylinder: "arm".into(), segments: vec![sine] };
        let manoeuvre = Manoeuvre::of_profile(profile.clone());
        let mut operator = Operator::new(&manoeuvre, 0.2);
        for sample in 0..1100 {
            let time = f64::from(sample) * 0.002;
            assert_eq!(operator.command(time, 0.002, 0.2), profile.area(time), "at {time} s");
        }
        assert_eq!(manoeuvre.duration(), 2.0);
    }
}
