//! Reads the flow balances of a machine by themselves, with motion and pressures as measured.
//!
//! No effect on the forces can pay there for what the flows lack. So several missing effects are found together that no search
//! finds one after the other.

mod flow_fit;
mod flow_sets;

use excavator_model::effects::{Family, Kind};
use excavator_model::machine::Supply;
use excavator_model::recording::{Recording, is_measured};
use excavator_model::{Model, ModelEffect};

use super::Addition;
use super::addition::additions;
use crate::regression::Ground;

pub(super) use flow_sets::{FlowSets, flow_sets};

/// A set of effects that the flow balances ask for.
#[derive(Debug, Clone)]
pub(super) struct FlowSet {
    /// The effects.
    pub additions: Vec<Addition>,
    /// The model with them. The parameters of its flows are fitted, all others are as given.
    pub model: Model,
}

/// Whether the recordings have all that the flow balances need: motion, both pressures and the opening of every cylinder, and
/// the pressure of a pump line. A command does not tell where the spool was.
pub(super) fn flows_are_measured(model: &Model, recordings: &[&Recording]) -> bool {
    let needs_pump = matches!(model.machine.supply, Supply::PumpLine(_));
    recordings.iter().all(|recording| {
        (!needs_pump || is_measured(&recording.pump_pressure))
            && model.machine.cylinders.iter().all(|cylinder| {
                cylinder.chambers.is_some()
                    && recording.cylinder(&cylinder.name).is_ok_and(|signals| {
                        (is_measured(&signals.displacement) || is_measured(&signals.joint_angle))
                            && is_measured(&signals.cap_pressure)
                            && is_measured(&signals.rod_pressure)
                            && is_measured(&signals.orifice_area)
                    })
            })
    })
}

/// Whether an effect acts in flow balances and is fitted there.
fn is_of_flows(effect: &ModelEffect) -> bool {
    let card = effect.physics.card();
    !matches!(card.family, Family::Recording | Family::Rounding) && card.is_of_flows()
}

/// Bulk modulus of oil with hoses and little air, Pa. Flows with little pressure in them do not show it, and a fit of the whole
/// machine does not come back from a far stiffer one.
const STIFFEST: f64 = 2e9;

/// `given` with the effects and parameters of the flows of `fitted`.
pub(super) fn with_flows_of(given: &Model, fitted: &Model) -> Model {
    let mut model = given.clone();
    for effect in fitted.effects.iter().filter(|effect| is_of_flows(effect)) {
        let Some(own) = model.effects.iter_mut().find(|own| own.is(effect.name(), effect.site)) else {
            model.effects.push(effect.clone());
            continue;
        };
        for (own, found) in own.parameters.iter_mut().zip(&effect.parameters).filter(|(own, _)| !own.known) {
            // A reciprocal parameter is a bulk modulus.
            own.value = if own.card.kind == Kind::Reciprocal { found.value.min(STIFFEST) } else { found.value };
        }
    }
    model
}

/// Whether the flow balances by themselves show an addition.
pub(super) fn is_read(one: &Addition) -> bool {
    one.physics.card().is_of_flows() && Ground::keeps_signals(&*one.physics)
}

/// Additions to the flow balances.
fn flow_additions(model: &Model, recordings: &[&Recording]) -> Vec<Addition> {
    additions(model, recordings).into_iter().filter(is_read).collect()
}

/// Additions that change the meaning of a signal. Balances that take it as measured cannot show them.
pub(super) fn unread(model: &Model, recordings: &[&Recording]) -> Vec<Addition> {
    additions(model, recordings).into_iter().filter(|one| !Ground::keeps_signals(&*one.physics)).collect()
}
