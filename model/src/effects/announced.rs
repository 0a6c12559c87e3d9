//! Finds hooks of an effect that would never be called, because the effect does not announce them.

use super::{Effect, Number, Site};
use crate::equations::Situation;
use crate::machine::Machine;

/// A hook that acts, and the method that has to return `true` for that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unannounced {
    /// The hook.
    pub hook: &'static str,
    /// The method.
    pub method: &'static str,
}

/// Share of the full command, and speed of the piston as a share of half the stroke per second, at which an effect is asked. Both
/// ways: an effect may act in one.
const ASKED: [(f64, f64); 4] = [(0.4, 0.2), (-0.4, -0.2), (0.05, 0.0), (0.9, -0.2)];

/// The first hook that changes something although the effect does not announce it. `parameters` are those of the effect, not neutral
/// ones.
pub fn unannounced(physics: &dyn Effect, machine: &Machine, site: Site, parameters: &[f64]) -> Option<Unannounced> {
    ASKED.into_iter().find_map(|(share, speed)| {
        let now = situation(machine, share, speed);
        let (states, mut rates) =
            (vec![0.5 * now.largest_opening(site); physics.states()], vec![0.0; physics.states()]);
        let hooks = f64::hooks(physics);
        let unannounced = |hook, method| Some(Unannounced { hook, method });
        if let Site::Cylinder(index) = site {
            let (piston, size) = (&now.pistons[index], machine.size_at(site));
            if !physics.adjusts_others() {
                let spool = piston.spool;
                if hooks.spool(&size, parameters, &states, &mut rates, spool) != [spool, spool] {
                    return unannounced("spool", "adjusts_others");
                }
                if hooks.opening(site, parameters, piston.opening, &now) != piston.opening {
                    return unannounced("opening", "adjusts_others");
                }
            }
            let rate = now.largest_opening(site);
            if !physics.reads_input_rate() && hooks.read(parameters, piston.spool, [rate, rate]) != piston.spool {
                return unannounced("read", "reads_input_rate");
            }
        }
        let mut adjusted = now.clone();
        hooks.adjust(site, parameters, &mut adjusted);
        let is_as_before = adjusted.pistons == now.pistons && adjusted.pump_oil == now.pump_oil;
        if !physics.adjusts_others() && !is_as_before {
            return unannounced("adjust", "adjusts_others");
        }
        let mut remembered = vec![0.0; physics.states()];
        hooks.remember(site, parameters, &states, &now, &mut remembered);
        if !physics.has_memory() && remembered.iter().any(|rate| *rate != 0.0) {
            return unannounced("remember", "has_memory");
        }
        None
    })
}

/// A machine at work: pistons move, valves are open by `share`, pressures are those of usual work.
fn situation(machine: &Machine, share: f64, speed: f64) -> Situation<'_, f64> {
    let mut now = Situation::empty(machine);
    (now.pump_pressure, now.tank_pressure, now.pump_flow) = (12e6, 3e5, 1e-3);
    for (cylinder, piston) in machine.cylinders.iter().zip(&mut now.pistons) {
        let travel = 0.5 * cylinder.usual_travel();
        piston.displacement = 0.1 * travel;
        piston.joint = cylinder.linkage.joint(piston.displacement);
        piston.lever = cylinder.linkage.lever(piston.joint);
        piston.velocity = speed * travel;
        piston.rate = piston.velocity / piston.lever;
        (piston.cap_pressure, piston.rod_pressure) = (6e6, 4e6);
        let Some(chambers) = &cylinder.chambers else { continue };
        piston.cap_volume = chambers.cap_volume(cylinder.stroke, piston.displacement);
        piston.rod_volume = chambers.rod_volume(cylinder.stroke, piston.displacement);
        let opening = share * chambers.full_command();
        (piston.command, piston.spool, piston.opening) = (opening, opening, opening);
        (piston.supply_opening, piston.return_opening, piston.bypass_closing) = (opening, opening, opening.abs());
    }
    now
}
