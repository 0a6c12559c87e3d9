//! Energies and powers of a recording, as columns.

use excavator_model::Model;
use excavator_model::effects::{ActsOn, Site, Text};
use excavator_model::energy::Ledger;
use excavator_model::equations::{Inputs, Layout};

use super::Place;

/// One cylinder with its joint; one value per time of the [`Books`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CylinderBooks {
    /// Kinetic energy, J.
    pub kinetic: Vec<f64>,
    /// Potential energy, J.
    pub potential: Vec<f64>,
    /// Compression energy of the cap side's oil, J.
    pub cap_internal: Vec<f64>,
    /// Compression energy of the rod side's oil, J.
    pub rod_internal: Vec<f64>,
    /// Piston velocity, m/s.
    pub velocity: Vec<f64>,
    /// Spool opening, m².
    pub opening: Vec<f64>,
    /// Power of the cap side's pressure on the piston `p+ A+ v`, W.
    pub cap_work: Vec<f64>,
    /// Power of the rod side's pressure on the piston `-p- A- v`, W.
    pub rod_work: Vec<f64>,
    /// Power of the measured rod force, W; zero with chambers.
    pub rod_force_power: Vec<f64>,
}

/// Powers of one effect of the model, W; positive if the effect supplies energy to what it acts on.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectBooks {
    /// Name in the catalogue.
    pub effect: Text,
    /// Place of the effect.
    pub site: Site,
    /// What the effect acts on.
    pub acts_on: ActsOn,
    /// Whether it has power of its own, [`excavator_model::energy::EffectPower::has_power`].
    pub has_power: bool,
    /// On pistons and joints.
    pub mechanical: Vec<f64>,
    /// Into the cap side.
    pub cap: Vec<f64>,
    /// Into the rod side.
    pub rod: Vec<f64>,
    /// Into the pump line.
    pub pump_line: Vec<f64>,
}

/// Energies and powers along a stretch without gaps; every column is as long as `time`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Books {
    /// Time since the first sample of the recording, s.
    pub time: Vec<f64>,
    /// One entry per cylinder.
    pub cylinders: Vec<CylinderBooks>,
    /// Energy of the pump line's oil, J.
    pub pump_line: Vec<f64>,
    /// Power of the pump `e(pp) Qp`, W, as in [`Ledger`].
    pub pump_power: Vec<f64>,
    /// One entry per effect of the model.
    pub effects: Vec<EffectBooks>,
}

impl Books {
    /// Empty books with this capacity.
    pub(super) fn new(model: &Model, room: usize) -> Self {
        let column = || Vec::with_capacity(room);
        let effects = model.effects.iter().map(|effect| EffectBooks {
            effect: effect.name_text(),
            site: effect.site,
            acts_on: effect.physics.card().acts_on,
            has_power: true,
            mechanical: column(),
            cap: column(),
            rod: column(),
            pump_line: column(),
        });
        let cylinders = model.machine.cylinders.iter().map(|_| CylinderBooks {
            kinetic: column(),
            potential: column(),
            cap_internal: column(),
            rod_internal: column(),
            velocity: column(),
            opening: column(),
            cap_work: column(),
            rod_work: column(),
            rod_force_power: column(),
        });
        Books {
            time: column(),
            cylinders: cylinders.collect(),
            pump_line: column(),
            pump_power: column(),
            effects: effects.collect(),
        }
    }

    /// Appends one ledger with its state.
    pub(super) fn enter(
        &mut self,
        model: &Model,
        layout: &Layout,
        ledger: &Ledger,
        state: &[f64],
        inputs: &Inputs<f64>,
    ) {
        self.time.push(inputs.time);
        self.pump_line.push(ledger.pump_line);
        self.pump_power.push(ledger.pump_power);
        for (index, (books, stored)) in self.cylinders.iter_mut().zip(&ledger.cylinders).enumerate() {
            let cylinder = &model.machine.cylinders[index];
            let velocity = cylinder.linkage.lever(state[layout.joint(index)]) * state[layout.rate(index)];
            let pressures = layout.cap_pressure(index).zip(layout.rod_pressure(index));
            let (cap_work, rod_work) = match (&cylinder.chambers, pressures) {
                (Some(chambers), Some((cap, rod))) => {
                    (state[cap] * chambers.cap_area * velocity, -state[rod] * chambers.rod_area * velocity)
                }
                _ => (0.0, 0.0),
            };
            let pushed = if cylinder.chambers.is_some() { 0.0 } else { inputs.rod_force[index] * velocity };
            books.kinetic.push(stored.kinetic);
            books.potential.push(stored.potential);
            books.cap_internal.push(stored.cap_internal);
            books.rod_internal.push(stored.rod_internal);
            books.velocity.push(velocity);
            books.opening.push(inputs.orifice_area[index]);
            books.cap_work.push(cap_work);
            books.rod_work.push(rod_work);
            books.rod_force_power.push(pushed);
        }
        for (books, power) in self.effects.iter_mut().zip(&ledger.effects) {
            books.has_power = power.has_power;
            books.mechanical.push(power.mechanical);
            books.cap.push(power.cap);
            books.rod.push(power.rod);
            books.pump_line.push(power.pump_line);
        }
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there are no entries.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Energy stored at a place, J.
    pub fn stored_at(&self, place: Place, entry: usize) -> f64 {
        match place {
            Place::Motion => self.cylinders.iter().map(|c| c.kinetic[entry] + c.potential[entry]).sum(),
            Place::CapContinuity(index) => self.cylinders[index].cap_internal[entry],
            Place::RodContinuity(index) => self.cylinders[index].rod_internal[entry],
            Place::PumpContinuity => self.pump_line[entry],
        }
    }

    /// Power into a place according to the model, W: its rate of storage if nothing is missing.
    pub fn power_into(&self, place: Place, entry: usize) -> f64 {
        match place {
            Place::Motion => {
                let work = |c: &CylinderBooks| c.cap_work[entry] + c.rod_work[entry] + c.rod_force_power[entry];
                self.cylinders.iter().map(work).sum::<f64>()
                    + self.effects.iter().map(|effect| effect.mechanical[entry]).sum::<f64>()
            }
            Place::CapContinuity(index) => {
                self.at_cylinder(index).map(|effect| effect.cap[entry]).sum::<f64>()
                    - self.cylinders[index].cap_work[entry]
            }
            Place::RodContinuity(index) => {
                self.at_cylinder(index).map(|effect| effect.rod[entry]).sum::<f64>()
                    - self.cylinders[index].rod_work[entry]
            }
            Place::PumpContinuity => {
                self.pump_power[entry] + self.effects.iter().map(|effect| effect.pump_line[entry]).sum::<f64>()
            }
        }
    }

    /// Magnitude of the power through a place, W: the larger of inflow and outflow.
    pub fn flow_through(&self, place: Place, entry: usize) -> f64 {
        let effects = |part: fn(&EffectBooks) -> &Vec<f64>| {
            self.effects.iter().map(|effect| part(effect)[entry].abs()).sum::<f64>()
        };
        let both = match place {
            Place::Motion => {
                let work = |c: &CylinderBooks| {
                    c.cap_work[entry].abs() + c.rod_work[entry].abs() + c.rod_force_power[entry].abs()
                };
                self.cylinders.iter().map(work).sum::<f64>() + effects(|effect| &effect.mechanical)
            }
            Place::CapContinuity(index) => {
                self.at_cylinder(index).map(|effect| effect.cap[entry].abs()).sum::<f64>()
                    + self.cylinders[index].cap_work[entry].abs()
            }
            Place::RodContinuity(index) => {
                self.at_cylinder(index).map(|effect| effect.rod[entry].abs()).sum::<f64>()
                    + self.cylinders[index].rod_work[entry].abs()
            }
            Place::PumpContinuity => self.pump_power[entry].abs() + effects(|effect| &effect.pump_line),
        };
        0.5 * both
    }

    /// Energy stored in a cylinder and its joint, J: H of \[A\] Eq. 9.
    pub fn hamiltonian(&self, cylinder: usize, entry: usize) -> f64 {
        let c = &self.cylinders[cylinder];
        c.kinetic[entry] + c.potential[entry] + c.cap_internal[entry] + c.rod_internal[entry]
    }

    /// Power supplied to a cylinder through its valve or by the measured force on its rod, W: \[A\] Eq. 12.
    pub fn supply(&self, cylinder: usize, entry: usize) -> f64 {
        let valve = self.at_cylinder(cylinder).filter(|effect| effect.acts_on == ActsOn::Valve);
        valve.map(|effect| effect.into_cylinders(entry)).sum::<f64>() + self.cylinders[cylinder].rod_force_power[entry]
    }

    /// Power that all other effects supply to a cylinder, W: the dissipation of \[A\] Eq. 11, negative except for effects that
    /// return energy.
    pub fn dissipation(&self, cylinder: usize, entry: usize) -> f64 {
        let others = self.at_cylinder(cylinder).filter(|effect| effect.acts_on != ActsOn::Valve);
        others.map(|effect| effect.into_cylinders(entry)).sum()
    }

    fn at_cylinder(&self, cylinder: usize) -> impl Iterator<Item = &EffectBooks> {
        self.effects.iter().filter(move |effect| effect.site == Site::Cylinder(cylinder))
    }
}

impl EffectBooks {
    /// Power into links and chambers, W.
    pub fn into_cylinders(&self, entry: usize) -> f64 {
        self.mechanical[entry] + self.cap[entry] + self.rod[entry]
    }

    /// Power into links, chambers and pump line, W: the negative of the dissipated power.
    pub fn total(&self, entry: usize) -> f64 {
        self.into_cylinders(entry) + self.pump_line[entry]
    }
}
