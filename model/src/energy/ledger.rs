//! The ledger itself and its sums.

use crate::effects::{ActsOn, Site, Text};
use crate::scalar::Scalar;

/// What one cylinder with its joint stores, J.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CylinderStorage<T = f64> {
    /// Kinetic energy `1/2 qd_i (J qd)_i`, \[A\] Eq. 9. What two joints share through the coupling of the mass matrix is
    /// split evenly, so that one joint's part can be negative; the sum cannot.
    pub kinetic: T,
    /// Potential energy of the link's weight, `-W g cos` of its absolute angle, \[A\] Eq. 9.
    pub potential: T,
    /// `V+ h(p+)` of the cap side's oil, \[A\] Eq. 9; zero without chambers.
    pub cap_internal: T,
    /// `V- h(p-)` of the rod side's oil, \[A\] Eq. 9.
    pub rod_internal: T,
}

/// Power of one effect of the model, W; positive where it gives energy to what it acts on.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct EffectPower<T = f64> {
    /// Name of the effect in the catalogue.
    pub effect: Text,
    /// Where it sits.
    pub site: Site,
    /// The part of the machine that it belongs to.
    pub acts_on: ActsOn,
    /// Whether the effect can have power here. One that only stores has not: its torque is in the storage, not in `mechanical` (a load
    /// that is picked up brings its energy along, so it does more). Nor has one that only rounds others, or acts on an instrument.
    pub has_power: bool,
    /// Torque times joint rate plus piston force times velocity.
    pub mechanical: T,
    /// Flow into the cap side times e(p+), \[A\] Eq. 11.
    pub cap: T,
    /// Flow into the rod side times e(p-), \[A\] Eq. 11.
    pub rod: T,
    /// Flow into the pump line times e(pp), less what the shaft of a cylinder's own pump gives.
    pub pump_line: T,
}

/// Storage and powers of a model at one instant. With `storage H`, along the model's solutions
/// `dH/dt = balance()`, and for the cylinders alone `dHc/dt = supply() + dissipation()`, \[A\] Eq. 11.
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
    /// Power of the pump `e(pp) Qp`, W; where the supply pressure is given, the power drawn from it and from the shafts of the cylinders' own
    /// pumps.
    pub pump_power: T,
    /// Power of the measured rod forces on cylinders without chambers, W.
    pub rod_force_power: T,
    /// Power that motors lose because oil expands in them, W: `(h(p+) A+ - h(p-) A-) v`. A piston makes room for the oil that it lets in
    /// and its chamber keeps what the oil has stored; a motor passes oil on, and the shaft gets the pressures' work alone.
    pub expansion_loss: T,
}

impl<T: Scalar> CylinderStorage<T> {
    /// All of it, J.
    pub fn total(&self) -> T {
        self.kinetic + self.potential + self.cap_internal + self.rod_internal
    }
}

impl<T: Scalar> EffectPower<T> {
    /// Power into links and chambers, W.
    pub fn into_cylinders(&self) -> T {
        self.mechanical + self.cap + self.rod
    }

    /// Power into links, chambers and pump line, W: minus what it dissipates.
    pub fn total(&self) -> T {
        self.into_cylinders() + self.pump_line
    }
}

impl<T: Scalar> Ledger<T> {
    /// Energy stored in links and chambers, J: H of \[A\] Eq. 9.
    pub fn stored_in_cylinders(&self) -> T {
        sum(self.cylinders.iter().map(CylinderStorage::total))
    }

    /// All energy stored, J.
    pub fn stored(&self) -> T {
        self.stored_in_cylinders() + self.pump_line
    }

    /// Power supplied to the cylinders, W: `b e+ Q+ + b e- Q-` of the flows through the valve, \[A\] Eq. 11, and the
    /// power of measured rod forces.
    pub fn supply(&self) -> T {
        sum(self.valve_effects().map(EffectPower::into_cylinders)) + self.rod_force_power
    }

    /// Power that all other effects give to the cylinders, W: the dissipation of \[A\] Eq. 11, zero or negative but for
    /// effects that give energy back (end stops) or bring it in (make-up flow).
    pub fn dissipation(&self) -> T {
        sum(self.effects.iter().filter(|effect| effect.acts_on != ActsOn::Valve).map(EffectPower::into_cylinders))
            - self.expansion_loss
    }

    /// Power lost between pump line and tank without passing a cylinder, W: bypass, relief valve, pump leakage.
    pub fn bypass_loss(&self) -> T {
        -sum(self.effects.iter().filter(|effect| effect.acts_on != ActsOn::Valve).map(|effect| effect.pump_line))
    }

    /// Power lost in the valve sections, W: drawn from the pump line, less what arrives in the chambers, with what the
    /// chambers send to tank.
    pub fn metering_loss(&self) -> T {
        -sum(self.valve_effects().map(EffectPower::total))
    }

    /// Rate of all energy stored, W: pump power and rod forces plus the powers of all effects.
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
