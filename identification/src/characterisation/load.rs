//! Piston force that links and load require, computed with the model.

use excavator_model::Model;
use excavator_model::equations::{Inputs, Layout, System};
use excavator_model::recording::Recording;

use super::stretches::Steady;

/// Effects that make up the load.
const LOAD: [&str; 3] = ["inertia", "gravity", "payload"];

/// Pressure force (N) that moves the model's links and load as in `stretch`, without friction: the load that Eq. 16 of \[B\]
/// takes from a load cell.
pub(super) fn load_force(model: &Model, cylinder: usize, recording: &Recording, stretch: &Steady) -> f64 {
    let mut load = model.clone();
    load.effects.retain(|effect| LOAD.contains(&effect.name()));
    let system = System::new(&load);
    let layout = Layout::of(&load);
    let mut state = vec![0.0; layout.len];
    let middle = (stretch.samples.first + stretch.samples.last) / 2;
    for (index, other) in model.machine.cylinders.iter().enumerate() {
        let measured = recording.cylinder(&other.name).ok().map(|signals| {
            let (angle, position) = (signals.joint_angle[middle], signals.displacement[middle]);
            if position.is_finite() { other.linkage.joint(position) } else { angle }
        });
        state[layout.joint(index)] = measured.unwrap_or(0.0);
    }
    let linkage = &model.machine.cylinders[cylinder].linkage;
    // Joint angle as a function of displacement: value, first and second derivative.
    let step = 1e-3;
    let joint = [-step, 0.0, step].map(|offset| linkage.joint(stretch.displacement + offset));
    let slope = (joint[2] - joint[0]) / (2.0 * step);
    let bend = (joint[2] - 2.0 * joint[1] + joint[0]) / (step * step);
    let speed = stretch.speed.value;
    let acceleration = slope * stretch.acceleration + bend * speed * speed;
    state[layout.joint(cylinder)] = joint[1];
    state[layout.rate(cylinder)] = slope * speed;
    let mut workspace = system.workspace();
    let mut rates = vec![0.0; layout.len];
    let inputs = Inputs::zero(model.machine.cylinders.len());
    system.rates(&mut workspace, &load.parameter_values(), &state, &inputs, &mut rates);
    let rows = &workspace.rows;
    // G = ds/dq is the reciprocal of the slope of q(s).
    (rows.mass_at(cylinder, cylinder) * acceleration - rows.torque[cylinder]) * slope
}
