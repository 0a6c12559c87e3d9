//! Energies over a stretch of time.

use excavator_model::Model;
use excavator_model::effects::{ActsOn, Site, Text};

use super::Books;

/// Energies that one cylinder and its joint received and gave away, J.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CylinderTotals {
    /// Supplied through the valve, or by the measured force on the rod.
    pub supplied: f64,
    /// Gain of kinetic energy.
    pub kinetic: f64,
    /// Gain of potential energy.
    pub potential: f64,
    /// Gain of the cap side's compression energy.
    pub cap_internal: f64,
    /// Gain of the rod side's compression energy.
    pub rod_internal: f64,
    /// Lost in the valve section between pump line, chambers and tank.
    pub metering_loss: f64,
}

impl CylinderTotals {
    /// Gain of stored energy, J.
    pub fn stored(&self) -> f64 {
        self.kinetic + self.potential + self.cap_internal + self.rod_internal
    }
}

/// Energy of one effect, J; positive if the effect supplied energy.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectTotal {
    /// Name in the catalogue.
    pub effect: Text,
    /// Place of the effect.
    pub site: Site,
    /// What the effect acts on.
    pub acts_on: ActsOn,
    /// Whether it has power of its own; the energy of effects that only store is in the gains of storage.
    pub has_power: bool,
    /// Given to links and chambers.
    pub into_cylinders: f64,
    /// Given to the pump line.
    pub into_pump_line: f64,
}

/// Energies over a stretch of time, by cylinder and by effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Totals {
    /// Accounted time, s; gaps are excluded.
    pub duration: f64,
    /// One entry per cylinder.
    pub cylinders: Vec<CylinderTotals>,
    /// One entry per effect of the model.
    pub effects: Vec<EffectTotal>,
    /// Energy of the pump, J.
    pub pump: f64,
    /// Gain of the pump line's energy, J.
    pub pump_line: f64,
}

impl Totals {
    /// Zero totals.
    pub(super) fn new(model: &Model) -> Self {
        let effects = model.effects.iter().map(|effect| EffectTotal {
            effect: effect.name_text(),
            site: effect.site,
            acts_on: effect.physics.card().acts_on,
            has_power: true,
            into_cylinders: 0.0,
            into_pump_line: 0.0,
        });
        Totals {
            duration: 0.0,
            cylinders: vec![CylinderTotals::default(); model.machine.cylinders.len()],
            effects: effects.collect(),
            pump: 0.0,
            pump_line: 0.0,
        }
    }

    /// Adds the time between an entry and the next one: powers by the trapezoidal rule, storage by its difference.
    pub(super) fn add(&mut self, books: &Books, entry: usize) {
        let (one, two) = (entry, entry + 1);
        let step = books.time[two] - books.time[one];
        let integral = |of: &dyn Fn(usize) -> f64| 0.5 * step * (of(one) + of(two));
        let gain = |column: &[f64]| column[two] - column[one];
        self.duration += step;
        self.pump += integral(&|k| books.pump_power[k]);
        self.pump_line += gain(&books.pump_line);
        for (index, (totals, own)) in self.cylinders.iter_mut().zip(&books.cylinders).enumerate() {
            totals.supplied += integral(&|k| books.supply(index, k));
            totals.kinetic += gain(&own.kinetic);
            totals.potential += gain(&own.potential);
            totals.cap_internal += gain(&own.cap_internal);
            totals.rod_internal += gain(&own.rod_internal);
        }
        for (total, own) in self.effects.iter_mut().zip(&books.effects) {
            total.has_power = own.has_power;
            let into_cylinders = integral(&|k| own.into_cylinders(k));
            let into_pump_line = integral(&|k| own.pump_line[k]);
            total.into_cylinders += into_cylinders;
            total.into_pump_line += into_pump_line;
            if let (ActsOn::Valve, Site::Cylinder(index)) = (own.acts_on, own.site) {
                self.cylinders[index].metering_loss -= into_cylinders + into_pump_line;
            }
        }
    }

    /// Lost between pump line and tank without passing a cylinder, J.
    pub fn bypass_loss(&self) -> f64 {
        -self.effects.iter().filter(|effect| effect.acts_on != ActsOn::Valve).map(|e| e.into_pump_line).sum::<f64>()
    }

    /// Given to a cylinder by all effects other than its valve, J; negative = dissipated.
    pub fn dissipation(&self, cylinder: usize) -> f64 {
        let own = |effect: &&EffectTotal| effect.site == Site::Cylinder(cylinder) && effect.acts_on != ActsOn::Valve;
        self.effects.iter().filter(own).map(|effect| effect.into_cylinders).sum()
    }

    /// Energy that a cylinder gained without a source in the model, J; negative: lost.
    pub fn residual(&self, cylinder: usize) -> f64 {
        let own = &self.cylinders[cylinder];
        own.stored() - own.supplied - self.dissipation(cylinder)
    }

    /// Energy that the pump line gained without a source in the model, J.
    pub fn pump_residual(&self) -> f64 {
        let drawn: f64 = self.effects.iter().map(|effect| effect.into_pump_line).sum();
        self.pump_line - self.pump - drawn
    }

    /// All numbers, always in the same order.
    pub(super) fn numbers_mut(&mut self) -> Vec<&mut f64> {
        let mut numbers = vec![&mut self.duration, &mut self.pump, &mut self.pump_line];
        for c in &mut self.cylinders {
            numbers.extend([
                &mut c.supplied,
                &mut c.kinetic,
                &mut c.potential,
                &mut c.cap_internal,
                &mut c.rod_internal,
                &mut c.metering_loss,
            ]);
        }
        for effect in &mut self.effects {
            numbers.extend([&mut effect.into_cylinders, &mut effect.into_pump_line]);
        }
        numbers
    }
}
