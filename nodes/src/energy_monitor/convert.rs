//! Converts between messages and the monitor.

use excavator_model::Model;
use excavator_model::energy::monitor::Balance;
use excavator_msgs::{ArmState, CylinderEnergy, EnergyState, EnergyTerm, Header, Time};

/// The state without cylinders that the model does not have, and without duplicates: any node on the network can send
/// thousands.
pub(super) fn trimmed(mut state: ArmState, model: &Model) -> ArmState {
    let mut open: Vec<&str> = model.machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
    state.cylinders.retain(|measured| {
        let place = open.iter().position(|name| *name == measured.name);
        place.map(|place| open.swap_remove(place)).is_some()
    });
    state
}

/// The message of a balance, with the stamp of its state.
pub(super) fn message(balance: &Balance, model: &Model) -> EnergyState {
    let cylinders = balance
        .cylinders
        .iter()
        .zip(&model.machine.cylinders)
        .map(|(energy, cylinder)| CylinderEnergy {
            name: cylinder.name.clone(),
            kinetic: energy.kinetic,
            potential: energy.potential,
            cap_internal: energy.cap_internal,
            rod_internal: energy.rod_internal,
            hamiltonian: energy.hamiltonian(),
            hamiltonian_rate: energy.hamiltonian_rate,
            dissipation: energy.dissipation(),
            supply: energy.supply,
            balance_residual: energy.residual(),
            terms: energy
                .terms
                .iter()
                .map(|term| EnergyTerm { effect: term.effect.to_string(), power: term.power })
                .collect(),
        })
        .collect();
    EnergyState {
        header: Header {
            stamp: Time::from_nanoseconds(balance.nanoseconds).unwrap_or_default(),
            frame_id: String::new(),
        },
        cylinders,
        pump_power: balance.pump_power,
        bypass_loss: balance.bypass_loss,
        metering_loss: balance.metering_loss,
    }
}
