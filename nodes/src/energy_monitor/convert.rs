//! Between messages and the monitor.

use excavator_model::Model;
use excavator_model::energy::monitor::{Balance, CylinderSample, Sample};
use excavator_msgs::{ArmState, CylinderEnergy, EnergyState, EnergyTerm, Header, Time};

/// The state in the order of the model's cylinders; what the message does not have is not measured.
pub(super) fn sample(state: &ArmState, model: &Model) -> Sample {
    let cylinders = model
        .machine
        .cylinders
        .iter()
        .map(|cylinder| {
            state.cylinders.iter().find(|measured| measured.name == cylinder.name).map_or_else(
                CylinderSample::unmeasured,
                |measured| CylinderSample {
                    joint_angle: measured.joint_angle,
                    displacement: measured.displacement,
                    velocity: measured.velocity,
                    cap_pressure: measured.cap_pressure,
                    rod_pressure: measured.rod_pressure,
                    orifice_area: measured.orifice_area,
                    rod_force: measured.rod_force,
                },
            )
        })
        .collect();
    Sample {
        nanoseconds: state.header.stamp.nanoseconds(),
        cylinders,
        pump_pressure: state.pump_pressure,
        tank_pressure: state.tank_pressure,
        pump_flow: state.pump_flow,
    }
}

/// The state without cylinders that the model does not have, and without second entries of those that it has: whoever is on
/// the network can send thousands.
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
