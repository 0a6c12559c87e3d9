//! What inputs that are known at samples only leave open.

use excavator_model::Model;
use excavator_model::equations::{Channel, System};
use excavator_model::recording::{Recording, linear};
use excavator_model::simulation::simulate;

use crate::fit::{Fit, FitSettings, evaluate};

/// `fit`, with the noise of each instrument raised by what the sampling of the inputs leaves open on `recordings`.
///
/// When a valve moved between two samples nobody knows: anywhere within half an interval of where a line puts it, in
/// square a third of what half an interval does. How far outputs go wrong by that is found by fitting the model to its
/// own outputs for inputs that are half an interval late. `None` when that cannot be simulated.
pub(super) fn with_input_floor(fit: &Fit, recordings: &[&Recording], settings: &FitSettings) -> Option<Fit> {
    let disturbed: Option<Vec<Recording>> =
        recordings.iter().map(|recording| answer_to_late_inputs(&fit.model, recording)).collect();
    let disturbed = disturbed?;
    let left = evaluate(&fit.model, &disturbed.iter().collect::<Vec<_>>(), settings).ok()?;
    let mut raised = fit.clone();
    for instrument in &mut raised.instruments {
        let position = left.instruments.iter().position(|own| own.name == instrument.name)?;
        instrument.noise = (instrument.noise.powi(2) + left.errors[position].powi(2) / 3.0).sqrt();
    }
    Some(raised)
}

/// What the model's instruments report where inputs come half a sample interval late, beside the inputs as they are.
fn answer_to_late_inputs(model: &Model, recording: &Recording) -> Option<Recording> {
    let simulated = simulate(model, &with_late_inputs(model, recording)).ok()?;
    let mut answer = recording.clone();
    let imposed = model.machine.has_imposed_motion();
    let is_output = |channel: &Channel| !imposed || matches!(channel, Channel::RodForce(_));
    for channel in Channel::all(System::new(model).layout()).into_iter().filter(is_output) {
        let reported = simulated.signal(&channel.name(&model.machine))?.to_vec();
        let Some(measured) = channel.signal_mut(&model.machine, &mut answer) else { continue };
        for (slot, value) in measured.iter_mut().zip(reported) {
            if slot.is_finite() {
                *slot = value;
            }
        }
    }
    Some(answer)
}

fn with_late_inputs(model: &Model, recording: &Recording) -> Recording {
    let mut late = recording.clone();
    let half = recording.sample_interval() / 2.0;
    let shift = |signal: &mut Vec<f64>| {
        *signal = recording.time.iter().map(|&t| linear(&recording.time, signal, t - half)).collect();
    };
    let imposed = model.machine.has_imposed_motion();
    for cylinder in &mut late.cylinders {
        shift(&mut cylinder.orifice_area);
        shift(&mut cylinder.orifice_command);
        if imposed {
            shift(&mut cylinder.displacement);
            shift(&mut cylinder.joint_angle);
        } else if !model.machine.has_chambers() {
            shift(&mut cylinder.rod_force);
        }
    }
    late
}
