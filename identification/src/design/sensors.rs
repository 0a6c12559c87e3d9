//! Sensors of a recording of the proposed manoeuvre.

use excavator_model::equations::{Channel, Layout};
use excavator_model::machine::{Machine, Supply};
use excavator_model::recording::Recording;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};

/// Instruments with the standard deviation of their noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensors {
    /// Contract name of a signal (`arm.displacement`, `pump_pressure`) and its noise, in its SI unit.
    pub noise: Vec<(String, f64)>,
    /// Noise of the spool sensors as a share of the valve's largest opening.
    pub spool: f64,
}

/// Noise of a displacement sensor, m.
const DISPLACEMENT: f64 = 5e-5;
/// Noise of a pressure sensor, Pa.
const PRESSURE: f64 = 2e3;
/// Noise of a spool sensor, share of its range.
const SPOOL: f64 = 0.002;

impl Sensors {
    /// Displacement (5e-5 m), chamber and pump pressures (2 kPa), spools (0.2 % of their range).
    pub fn usual(machine: &Machine) -> Self {
        let mut noise = Vec::new();
        for cylinder in &machine.cylinders {
            noise.push((format!("{}.displacement", cylinder.name), DISPLACEMENT));
            if cylinder.chambers.is_some() {
                noise.push((format!("{}.cap_pressure", cylinder.name), PRESSURE));
                noise.push((format!("{}.rod_pressure", cylinder.name), PRESSURE));
            }
        }
        if let Supply::PumpLine(_) = machine.supply {
            noise.push(("pump_pressure".to_string(), PRESSURE));
        }
        Sensors { noise, spool: SPOOL }
    }

    /// Noise of a signal; `None` if it is not measured.
    pub fn of(&self, name: &str) -> Option<f64> {
        self.noise.iter().find(|(own, _)| own == name).map(|(_, noise)| *noise)
    }

    /// Removes the outputs that are not measured.
    pub(super) fn hide_unmeasured(&self, machine: &Machine, layout: &Layout, recording: &mut Recording) {
        for channel in Channel::all(layout) {
            if self.of(&channel.name(machine)).is_none()
                && let Some(values) = channel.signal_mut(machine, recording)
            {
                values.fill(f64::NAN);
            }
        }
    }

    /// Adds noise to every measured output and to the spools.
    pub(super) fn disturb(
        &self,
        machine: &Machine,
        layout: &Layout,
        recording: &mut Recording,
        generator: &mut ChaCha8Rng,
    ) {
        let mut add = |values: &mut [f64], deviation: f64| {
            if let Ok(noise) = Normal::new(0.0, deviation) {
                values.iter_mut().for_each(|value| *value += noise.sample(generator));
            }
        };
        for channel in Channel::all(layout) {
            if let Some(deviation) = self.of(&channel.name(machine))
                && let Some(values) = channel.signal_mut(machine, recording)
            {
                add(values, deviation);
            }
        }
        for cylinder in &machine.cylinders {
            if let Some(chambers) = cylinder.chambers
                && let Some(signals) = recording.cylinders.iter_mut().find(|signals| signals.name == cylinder.name)
            {
                add(&mut signals.orifice_area, self.spool * chambers.full_command());
            }
        }
    }
}
