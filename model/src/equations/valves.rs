//! The part of the equations in which effects act on the valves.

use super::{Oil, Rounding, Situation, System, Warmth};
use crate::effects::{Number, Site};

impl<'m> System<'m> {
    /// The opening of a cylinder's input, after the effects on its reading; `rates` are the reading's before and after this instant.
    pub(super) fn read<T: Number>(&self, cylinder: usize, parameters: &[T], reading: T, rates: [T; 2]) -> T {
        let mut spool = reading;
        for &number in &self.readers_of_input_rate {
            let effect = &self.model.effects[number];
            if effect.site == Site::Cylinder(cylinder) {
                let (first, last) = self.parameter_ranges[number];
                spool = T::hooks(&*effect.physics).read(&parameters[first..last], spool, rates);
            }
        }
        spool
    }

    /// The valve's part of the situation: spools, then openings, then the adjustments for other effects.
    pub(super) fn observe_valves<T: Number>(
        &self,
        situation: &mut Situation<'m, T>,
        parameters: &[T],
        state: &[T],
        rates: &mut [T],
    ) {
        for piston in &mut situation.pistons {
            piston.bypass_closing = piston.spool;
        }
        for &number in &self.adjusting {
            let effect = &self.model.effects[number];
            let Site::Cylinder(index) = effect.site else { continue };
            let (first, last) = self.parameter_ranges[number];
            let (state_first, states) = self.layout.effect_states[number];
            let own_states = &state[state_first..state_first + states];
            let own_rates = &mut rates[state_first..state_first + states];
            let piston = &mut situation.pistons[index];
            let size = &self.sizes[index];
            let [metering, bypass] =
                T::hooks(&*effect.physics).spool(size, &parameters[first..last], own_states, own_rates, piston.spool);
            piston.bypass_closing += bypass - piston.spool;
            piston.spool = metering;
        }
        for (piston, size) in situation.pistons.iter_mut().zip(&self.sizes) {
            piston.opening = piston.spool;
            piston.bypass_closing = piston.bypass_closing.abs();
            piston.backflow = T::from(1.0);
            piston.compensator_margin = None;
            piston.hose_resistance = None;
            piston.warmth = Warmth::USUAL;
            piston.rounding = if self.as_printed { Rounding::none() } else { Rounding::of_the_equations(size) };
        }
        for &number in &self.adjusting {
            let effect = &self.model.effects[number];
            let (first, last) = self.parameter_ranges[number];
            let own = &parameters[first..last];
            if let Site::Cylinder(index) = effect.site
                && self.model.machine.cylinders[index].chambers.is_some()
            {
                let opening = situation.pistons[index].opening;
                situation.pistons[index].opening =
                    T::hooks(&*effect.physics).opening(effect.site, own, opening, situation);
            }
        }
        for piston in &mut situation.pistons {
            piston.supply_opening = piston.opening;
            piston.return_opening = piston.opening;
        }
        situation.pump_oil = Oil::USUAL;
        for &number in &self.adjusting {
            let effect = &self.model.effects[number];
            let (first, last) = self.parameter_ranges[number];
            T::hooks(&*effect.physics).adjust(effect.site, &parameters[first..last], situation);
        }
    }
}
