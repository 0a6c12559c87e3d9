//! The energy ledger and its sums.

use crate::effects::{ActsOn, Site, Text};
use crate::scalar::Scalar;

/// Energy that one cylinder with its joint stores, J.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CylinderStorage<T = f64> {
    /// Kinetic energy `1/2 qd_i (J qd)_i`, \[A\] Eq. 9. The coupling terms of the mass matrix are split evenly between two
    /// joints, so one joint's part can be negative; the sum cannot.
    pub kinetic: T,
    /// Potential energy of the link's weight, `-W g cos` of its absolute angle, \[A\] Eq. 9.
    pub potential: T,
    /// `V+ h(p+)` of the cap side's oil, \[A\] Eq. 9; zero without chambers.
    pub cap_internal: T,
    /// `V- h(p-)` of the rod side's oil, \[A\] Eq. 9.
    pub rod_internal: T,
}

/// Power of one effect of the model, W; positive if the effect adds energy.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct EffectPower<T = f64> {
    /// Name of the effect in the catalogue.
    pub effect: Text,
    /// Where the effect acts.
    pub site: Site,
    /// The part of the machine that it belongs to.
    pub acts_on: ActsOn,
    /// Whether the effect can have power here. An effect that only stores energy has none: its torque is in the storage, not in
    /// `mechanical`. A load that is picked up adds its own energy, so it has power. Effects that only round other effects or act
    /// on an instrument have none.
    pub has_power: bool,
    /// Torque times joint rate plus piston force times velocity.
    pub mechanical: T,
    /// Flow into the cap side times e(p+), \[A\] Eq. 11.
    pub cap: T,
    /// Flow into the rod side times e(p-), \[A\] Eq. 11.
    pub rod: T,
    /// Flow into the pump line times e(pp), less the shaft power of a cylinder's own pump.
    pub pump_line: T,
}

/// Storage and powers of a model at one instant. With `storage H`, solutions of the model satisfy `dH/dt = balance()`, and for
/// the cylinders alone `dHc/dt = supply() + dissipation()`, \[A\] Eq. 11.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct Ledger<T = f64> {
    /// Storage of each cylinder with its joint.
    pub cylinders: Vec<CylinderStorage<T>>,
    /// Storage of the pump line `Vp h(pp)`, J; zero where the supply pressure is not a state.
    pub pump_line: T,
    /// One entry per effect of the model, in its order.
    pub effects: Vec<EffectPower<T>>,
    /// Power of the pump `e(pp) Qp`, W; if the supply pressure is given, the power drawn from it and from the shafts of the
    /// cylinders' own pumps.
    pub pump_power: T,
    /// Power of the measured rod forces on cylinders without chambers, W.
    pub rod_force_power: T,
    /// Power that motors lose because oil expands in them, W: `(h(p+) A+ - h(p-) A-) v`. A cylinder's chamber grows with the oil
    /// it takes in and keeps the stored energy. A motor passes the oil on, and the shaft gets only the work of the pressures.
    pub expansion_loss: T,
}

impl<T: Scalar> CylinderStorage<T> {
    /// Total stored energy, J.
    pub fn total(&self) -> T {
        self.kinetic + self.potential + self.cap_internal + self.rod_internal
    }
}

impl<T: Scalar> EffectPower<T> {
    /// Power into links and chambers, W.
    pub fn into_cylinders(&self) -> T {
        self.mechanical + self.cap + self.rod
    }

    /// Power into links, chambers and pump line, W; its negative is the dissipated power.
    pub fn total(&self) -> T {
        self.into_cylinders() + self.pump_line
    }
}

impl<T: Scalar> Ledger<T> {
    /// Energy stored in links and chambers, J: H of \[A\] Eq. 9.
    pub fn stored_in_cylinders(&self) -> T {
        sum(self.cylinders.iter().map(CylinderStorage::total))
    }

    /// Total stored energy, J.
    pub fn stored(&self) -> T {
        self.stored_in_cylinders() + self.pump_line
    }

    /// Power supplied to the cylinders, W: `b e+ Q+ + b e- Q-` of the flows through the valve, \[A\] Eq. 11, and the
    /// power of measured rod forces.
    pub fn supply(&self) -> T {
        sum(self.valve_effects().map(EffectPower::into_cylinders)) + self.rod_force_power
    }

    /// Power that all other effects add to the cylinders, W: the dissipation of \[A\] Eq. 11. It is zero or negative except for
    /// effects that return energy (end stops) or bring it in (make-up flow).
    pub fn dissipation(&self) -> T {
        sum(self.effects.iter().filter(|effect| effect.acts_on != ActsOn::Valve).map(EffectPower::into_cylinders))
            - self.expansion_loss
    }

    /// Power lost between pump line and tank outside the cylinders, W: bypass, relief valve, pump leakage.
    pub fn bypass_loss(&self) -> T {
        -sum(self.effects.iter().filter(|effect| effect.acts_on != ActsOn::Valve).map(|effect| effect.pump_line))
    }

    /// Power lost in the valve sections, W: the power drawn from the pump line, less the power that reaches the chambers, plus
    /// the loss of the flow from the chambers to tank.
    pub fn metering_loss(&self) -> T {
        -sum(self.valve_effects().map(EffectPower::total))
    }

    /// Rate of the total stored energy, W: pump power and rod forces plus the powers of all effects.
    ///
    /// With no rod force, `pump_power = bypass_loss + metering_loss + supply + d(pump_line)/dt`.
    pub fn balance(&self) -> T {
        self.pump_power + self.rod_force_power - self.expansion_loss + sum(self.effects.iter().map(EffectPower::total))
    }

    fn valve_effects(&self) -> impl Iterator<Item = &EffectPower<T>> {
        self.effects.iter().filter(|effect| effect.acts_on == ActsOn::Valve)
    }
}

fn sum<T: Scalar>(values: impl Iterator<Item = T>) -> T {
    values.fold(T::from(0.0), |sum, value| sum + value)
}
