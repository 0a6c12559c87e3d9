//! Rest states of a machine.

use crate::SignalError;
use crate::equations::{Inputs, System};

/// Pressure above tank of the less loaded chamber of a cylinder at rest, Pa: enough that small motions do not cavitate.
const PRELOAD: f64 = 3e5;

/// [`rest_state`] of displacements (m) that the linkages can reach.
///
/// # Errors
/// [`SignalError::NoInitialState`] if one cannot.
pub fn reachable_rest_state(
    system: &System<'_>,
    displacements: &[f64],
    inputs: &Inputs<f64>,
) -> Result<Vec<f64>, SignalError> {
    let state = rest_state(system, displacements, inputs);
    let machine = &system.model().machine;
    let out_of_reach = |index: &usize| !state[system.layout().joint(*index)].is_finite();
    match (0..machine.cylinders.len()).find(out_of_reach) {
        None => Ok(state),
        Some(index) => Err(SignalError::NoInitialState {
            source_name: machine.name.clone(),
            signal: format!("{}.displacement", machine.cylinders[index].name),
            reason: format!("the linkage cannot reach {:.3} m", displacements.get(index).copied().unwrap_or(0.0)),
        }),
    }
}

/// State of a machine at rest with these piston displacements (m): velocities zero, chamber pressures in balance with
/// gravity, pump pressure a little above tank. Joints are `NaN` if the linkage cannot reach a displacement.
pub fn rest_state(system: &System<'_>, displacements: &[f64], inputs: &Inputs<f64>) -> Vec<f64> {
    let layout = system.layout();
    let machine = &system.model().machine;
    let mut state = vec![0.0; layout.len];
    for (index, cylinder) in machine.cylinders.iter().enumerate() {
        let displacement = displacements.get(index).copied().unwrap_or(0.0);
        state[layout.joint(index)] = cylinder.linkage.joint(displacement);
    }
    if let Some(pump) = layout.pump {
        state[pump] = inputs.tank_pressure + PRELOAD / 2.0;
    }
    system.set_effect_states(&inputs.orifice_area, &mut state);
    let mut workspace = system.workspace();
    let mut rates = vec![0.0; layout.len];
    system.rates(&mut workspace, &system.model().parameter_values(), &state, inputs, &mut rates);
    for (index, cylinder) in machine.cylinders.iter().enumerate() {
        let (Some(chambers), Some(cap), Some(rod)) =
            (cylinder.chambers, layout.cap_pressure(index), layout.rod_pressure(index))
        else {
            continue;
        };
        let piston = &workspace.situation.pistons[index];
        let needed = -workspace.rows.torque[index] / piston.lever;
        let preload = inputs.tank_pressure + PRELOAD;
        if needed >= preload * (chambers.cap_area - chambers.rod_area) {
            state[rod] = preload;
            state[cap] = (needed + chambers.rod_area * preload) / chambers.cap_area;
        } else {
            state[cap] = preload;
            state[rod] = (chambers.cap_area * preload - needed) / chambers.rod_area;
        }
    }
    state
}
