//! Sensor models: noise, resolution, missing values.

use excavator_msgs::ArmState;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Quality of the instruments.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Quality {
    /// Displacement: standard deviation and resolution, m.
    pub displacement: Instrument,
    /// Joint angle, rad.
    pub joint_angle: Instrument,
    /// Velocity, m/s.
    pub velocity: Instrument,
    /// All pressures, Pa.
    pub pressure: Instrument,
    /// Spool, m².
    pub orifice_area: Instrument,
    /// Probability that one signal of a sample is missing.
    pub dropout_probability: f64,
    /// Probability that a whole sample is never published.
    pub loss_probability: f64,
}

/// One kind of instrument.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Instrument {
    /// Standard deviation of white noise, in the unit of the signal.
    pub noise: f64,
    /// Resolution; 0 for none.
    pub quantum: f64,
}

/// Signals that may have no sensor.
pub(super) const SIGNALS: [&str; 10] = [
    "joint_angle",
    "displacement",
    "velocity",
    "cap_pressure",
    "rod_pressure",
    "orifice_area",
    "pump_pressure",
    "tank_pressure",
    "pump_flow",
    "oil_temperature",
];

/// The instruments of a machine.
pub(super) struct Sensors {
    generator: ChaCha8Rng,
    not_measured: Vec<String>,
}

impl Sensors {
    /// Instruments for all signals except `not_measured`.
    pub fn new(seed: u64, not_measured: Vec<String>) -> Self {
        Sensors { generator: ChaCha8Rng::seed_from_u64(seed), not_measured }
    }

    /// Turns the truth into a measurement; `false` when the sample is lost.
    pub fn measure(&mut self, state: &mut ArmState, quality: &Quality) -> bool {
        for cylinder in &mut state.cylinders {
            self.read("joint_angle", &mut cylinder.joint_angle, quality.joint_angle, quality);
            self.read("displacement", &mut cylinder.displacement, quality.displacement, quality);
            self.read("velocity", &mut cylinder.velocity, quality.velocity, quality);
            self.read("cap_pressure", &mut cylinder.cap_pressure, quality.pressure, quality);
            self.read("rod_pressure", &mut cylinder.rod_pressure, quality.pressure, quality);
            self.read("orifice_area", &mut cylinder.orifice_area, quality.orifice_area, quality);
        }
        self.read("pump_pressure", &mut state.pump_pressure, quality.pressure, quality);
        self.read("tank_pressure", &mut state.tank_pressure, quality.pressure, quality);
        self.read("pump_flow", &mut state.pump_flow, Instrument::default(), quality);
        self.read("oil_temperature", &mut state.oil_temperature, Instrument::default(), quality);
        !self.happens(quality.loss_probability)
    }

    fn read(&mut self, name: &str, value: &mut f64, instrument: Instrument, quality: &Quality) {
        if self.not_measured.iter().any(|missing| missing == name) || self.happens(quality.dropout_probability) {
            *value = f64::NAN;
            return;
        }
        if instrument.noise > 0.0 {
            let draw: f64 = StandardNormal.sample(&mut self.generator);
            *value += instrument.noise * draw;
        }
        if instrument.quantum > 0.0 {
            *value = (*value / instrument.quantum).round() * instrument.quantum;
        }
    }

    fn happens(&mut self, probability: f64) -> bool {
        probability > 0.0 && self.generator.random::<f64>() < probability
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use excavator_msgs::{CylinderState, Header};

    fn state() -> ArmState {
        let cylinder = CylinderState { displacement: 0.1234, cap_pressure: 1e6, ..CylinderState::unmeasured("arm") };
        ArmState {
            header: Header::default(),
            cylinders: vec![cylinder],
            pump_pressure: 2e6,
            tank_pressure: 0.0,
            pump_flow: 3.8e-4,
            oil_temperature: 27.0,
        }
    }

    #[test]
    fn perfect_instruments_change_nothing() {
        let mut measured = state();
        assert!(Sensors::new(1, Vec::new()).measure(&mut measured, &Quality::default()));
        assert_eq!(measured.cylinders[0].displacement, 0.1234);
        assert_eq!(measured.pump_flow, 3.8e-4);
    }

    #[test]
    fn noise_and_resolution_are_as_asked() {
        let quality = Quality {
            displacement: Instrument { noise: 1e-3, quantum: 0.0 },
            pressure: Instrument { noise: 0.0, quantum: 3e5 },
            ..Quality::default()
        };
        let mut sensors = Sensors::new(7, Vec::new());
        let draws = 4000;
        let mut squares = 0.0;
        for _ in 0..draws {
            let mut measured = state();
            sensors.measure(&mut measured, &quality);
            squares += (measured.cylinders[0].displacement - 0.1234).powi(2);
            assert_eq!(measured.cylinders[0].cap_pressure, 9e5);
        }
        let deviation = (squares / f64::from(draws)).sqrt();
        // The standard deviation of 4000 draws has a standard error of 1.1 %; the tolerance is five times that.
        assert!((deviation / 1e-3 - 1.0).abs() < 0.056, "{deviation}");
    }

    #[test]
    fn missing_signals_are_nan_and_lost_samples_are_told() {
        let mut measured = state();
        let mut sensors = Sensors::new(1, vec!["displacement".to_string()]);
        let quality = Quality { loss_probability: 1.0, ..Quality::default() };
        assert!(!sensors.measure(&mut measured, &quality));
        assert!(measured.cylinders[0].displacement.is_nan());
        assert_eq!(measured.cylinders[0].cap_pressure, 1e6);
    }
}
