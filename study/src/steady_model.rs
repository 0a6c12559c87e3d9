//! Writes what steady stretches tell into a model, as starts for a fit.

use excavator_identification::characterisation::{Characterisation, DriveCurve, Estimate, ValveCurve};
use excavator_model::effects::Site;
use excavator_model::{Model, ModelError};

use crate::read_values::{LEAST_SHARE, effect_of, is_clear, put};

/// Share of the full input below which a null does not matter: valves are adjusted to one per cent.
const LEAST_NULL: f64 = 0.01;

/// Largest relative error of a value that replaces a start.
const USEFUL: f64 = 0.5;

/// `model` with the values that the procedures found: null, dead zones, gains, losses of a pump, friction, weight,
/// stops. Lags and other friction laws are left out: they are effects that a diagnosis names.
///
/// # Errors
/// [`ModelError`] if a cylinder cannot have a null.
pub(crate) fn with_steady_values(model: &Model, found: &[Characterisation]) -> Result<Model, ModelError> {
    let mut model = model.clone();
    for one in found {
        let Some(place) = model.machine.cylinder_index(&one.cylinder) else { continue };
        let mut writer = Writer { model: &mut model, site: Site::Cylinder(place) };
        match &one.drive {
            Ok(DriveCurve::Valve(valve)) => {
                let full = one.maximum_orifice_area;
                let has_null = is_clear(valve.null, LEAST_NULL * full);
                if has_null {
                    // Held: a dead zone has the null in its middle, and a fit could move both.
                    writer.set_held("valve_null", valve.null)?;
                }
                writer.add_dead_zones(valve, if has_null { 0.0 } else { valve.null.value }, full)?;
                let gains = ["flow_gain_cap", "flow_gain_rod"].into_iter().zip(valve.gains);
                gains.for_each(|(name, gain)| gain.into_iter().for_each(|gain| writer.set(name, gain)));
                valve.leakage.into_iter().for_each(|leakage| writer.set("internal_leakage", leakage));
                valve.compensator_margin.into_iter().for_each(|margin| writer.set("compensator_margin", margin));
                if let Some(standby) = valve.standby_pressure {
                    writer.release("standby_pressure");
                    writer.set("standby_pressure", standby);
                }
            }
            Ok(DriveCurve::Pump(pump)) => {
                writer.set("pump_flow_share", pump.share);
                writer.set("internal_leakage", pump.leakage);
            }
            Err(_) => (),
        }
        if let Ok(friction) = &one.friction {
            // Both effects have one parameter, of their own name.
            for name in ["coulomb_friction", "viscous_damping"] {
                friction.coefficient(name).into_iter().for_each(|value| writer.set(name, value));
            }
            friction.load_share.into_iter().for_each(|share| writer.scale("gravity", share));
        }
        let ends = &mut model.machine.cylinders[place].ends;
        for (end, stop) in ends.iter_mut().zip(one.stops) {
            *end = stop.map_or(*end, |stop| stop.value);
        }
    }
    Ok(model)
}

struct Writer<'m> {
    model: &'m mut Model,
    site: Site,
}

const SOURCE: &str = "read from steady stretches";

impl Writer<'_> {
    /// Sets a parameter that the model has and a fit may change, if the value is positive and its error small.
    fn set(&mut self, name: &str, value: Estimate) {
        let is_useful = value.value > 0.0 && value.relative_error() < USEFUL;
        let own = self.model.effects.iter_mut().filter(|effect| effect.site == self.site);
        let parameter = own.flat_map(|effect| &mut effect.parameters).find(|one| one.card.name == name && !one.known);
        if let (true, Some(parameter)) = (is_useful, parameter) {
            (parameter.value, parameter.source) = (value.value, SOURCE.to_string());
            (parameter.standard_error, parameter.margin_95) = (Some(value.error), None);
        }
    }

    /// Lets a fit change a parameter that the model holds at zero, since the recordings show its effect.
    fn release(&mut self, name: &str) {
        let own = self.model.effects.iter_mut().filter(|effect| effect.site == self.site);
        own.flat_map(|effect| &mut effect.parameters)
            .filter(|one| one.card.name == name && one.value == 0.0)
            .for_each(|parameter| parameter.known = false);
    }

    /// Multiplies the parameters of an effect by a share that is not far from one.
    fn scale(&mut self, effect: &str, share: Estimate) {
        let is_useful = share.value > 0.0 && share.relative_error() < USEFUL;
        let own = self.model.effects.iter_mut().filter(|one| is_useful && one.is(effect, self.site));
        for parameter in own.flat_map(|effect| &mut effect.parameters).filter(|one| !one.known) {
            parameter.value *= share.value;
            parameter.source = SOURCE.to_string();
        }
    }

    /// Adds the dead zones that are clear of zero. A null that does not matter stays with them.
    fn add_dead_zones(&mut self, valve: &ValveCurve, null: f64, full: f64) -> Result<(), ModelError> {
        let zones = [1.0, -1.0].into_iter().zip(valve.dead_zones);
        let zones: Vec<Option<f64>> =
            zones.map(|(sign, zone)| zone.map(|zone| (zone.value + sign * null).max(0.0))).collect();
        let is_real = |zone: &Estimate| zone.value > 0.0 && is_clear(*zone, LEAST_SHARE * full);
        if valve.dead_zones.iter().flatten().any(is_real) {
            put(self.model, "valve_dead_zone", self.site, &zones, SOURCE)?;
        }
        Ok(())
    }

    /// Sets the only parameter of an effect, which is added if the model lacks it, and holds it.
    fn set_held(&mut self, effect: &str, value: Estimate) -> Result<(), ModelError> {
        let own = effect_of(self.model, effect, self.site)?;
        for parameter in own.into_iter().flat_map(|one| &mut one.parameters) {
            // The reading counts from the null that the model already has.
            parameter.value += value.value;
            (parameter.known, parameter.source) = (true, SOURCE.to_string());
        }
        Ok(())
    }
}
