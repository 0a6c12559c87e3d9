//! The interface between an effect and the equations.

use super::{Card, ParameterCard, Rows, Scalar, Site};
use crate::equations::{Instruments, Situation};
use crate::machine::Machine;
use crate::scalar::Dual;

/// One physical effect, written once for any number type.
pub trait Physics: Sync {
    /// What is said about it.
    fn card(&self) -> &'static Card;

    /// Its parameters at `site` of `machine`, in the order in which [`Physics::contribute`] gets them.
    fn parameters(&self, machine: &Machine, site: Site) -> &'static [ParameterCard];

    /// Value of a parameter that a model file leaves out, where that may be: files that are older than the parameter.
    fn value_where_left_out(&self, _parameter: &str) -> Option<f64> {
        None
    }

    /// Whether an effect of this size says anything about a machine. One that is within the accuracy of good instruments, or whose
    /// shape lies where nothing moves, is no answer to what is missing, however well it takes up an error.
    fn is_worth_a_name(&self, _parameters: &[f64]) -> bool {
        true
    }

    /// Whether it has power of its own, by what it contributes to the rows. What shifts an opening, rounds another effect or acts on an
    /// instrument has none, and no line in an energy balance.
    fn has_power(&self) -> bool {
        true
    }

    /// Number of states that it adds to the model.
    fn states(&self) -> usize {
        0
    }

    /// Where the metering edges and where the bypass's really are (m²), given where the input says the spool is; `states` are the
    /// effect's own, whose rates go to `rates`. Asked of effects of valves only, as is [`Physics::opening`].
    fn spool<T: Scalar>(&self, _parameters: &[T], _states: &[T], _rates: &mut [T], spool: T) -> [T; 2] {
        [spool, spool]
    }

    /// Whether the effect looks at how the input changes, by [`Physics::read`].
    fn reads_course(&self) -> bool {
        false
    }

    /// The opening (m²) that the input means, given what it says and how fast that changes before and after this instant
    /// (m²/s). Asked of effects with [`Physics::reads_course`] only, before any [`Physics::spool`].
    fn read<T: Scalar>(&self, _parameters: &[T], reading: T, _course: [T; 2]) -> T {
        reading
    }

    /// The area open to flow (m²), given the area that the effects before it left open; `maximum` is umax.
    fn opening<T: Scalar>(&self, _parameters: &[T], opening: T, _maximum: f64) -> T {
        opening
    }

    /// Adjusts what the valve's other effects see: the closing of the bypass, the share of flow back to the pump. Asked
    /// of effects of valves and of the pump line, after all openings are known, and of those that round a corner.
    fn adjust<T: Scalar>(&self, _site: Site, _parameters: &[T], _now: &mut Situation<T>) {}

    /// Adds to what instruments make of what they measure, for an effect that acts on them and not on the machine.
    fn distort<T: Scalar>(&self, _site: Site, _parameters: &[T], _instruments: &mut Instruments<T>) {}

    /// Potential energy in J that the effect stores by posture, for an effect whose whole torque follows from it;
    /// `None` for all others. What an effect adds to the mass matrix needs no such word: it stores kinetic energy.
    fn potential<T: Scalar>(&self, _site: Site, _parameters: &[T], _now: &Situation<T>) -> Option<T> {
        None
    }

    /// Adds the effect at `site` to the rows of the equations of motion.
    fn contribute<T: Scalar>(&self, _site: Site, _parameters: &[T], _now: &Situation<T>, _rows: &mut Rows<T>) {}
}

/// [`Physics`] for the two number types that the program uses, so that a model can hold a list of unlike effects.
/// Implemented for every `Physics`; not to be implemented by hand.
#[allow(missing_docs)]
pub trait Effect: Sync {
    fn card(&self) -> &'static Card;
    fn parameters(&self, machine: &Machine, site: Site) -> &'static [ParameterCard];
    fn value_where_left_out(&self, parameter: &str) -> Option<f64>;
    fn is_worth_a_name(&self, parameters: &[f64]) -> bool;
    fn has_power(&self) -> bool;
    fn states(&self) -> usize;
    fn spool_plain(&self, parameters: &[f64], states: &[f64], rates: &mut [f64], spool: f64) -> [f64; 2];
    fn spool_dual(&self, parameters: &[Dual], states: &[Dual], rates: &mut [Dual], spool: Dual) -> [Dual; 2];
    fn reads_course(&self) -> bool;
    fn read_plain(&self, parameters: &[f64], reading: f64, course: [f64; 2]) -> f64;
    fn read_dual(&self, parameters: &[Dual], reading: Dual, course: [Dual; 2]) -> Dual;
    fn opening_plain(&self, parameters: &[f64], opening: f64, maximum: f64) -> f64;
    fn opening_dual(&self, parameters: &[Dual], opening: Dual, maximum: f64) -> Dual;
    fn adjust_plain(&self, site: Site, parameters: &[f64], now: &mut Situation<f64>);
    fn adjust_dual(&self, site: Site, parameters: &[Dual], now: &mut Situation<Dual>);
    fn distort_plain(&self, site: Site, parameters: &[f64], instruments: &mut Instruments<f64>);
    fn distort_dual(&self, site: Site, parameters: &[Dual], instruments: &mut Instruments<Dual>);
    fn potential_plain(&self, site: Site, parameters: &[f64], now: &Situation<f64>) -> Option<f64>;
    fn potential_dual(&self, site: Site, parameters: &[Dual], now: &Situation<Dual>) -> Option<Dual>;
    fn contribute_plain(&self, site: Site, parameters: &[f64], now: &Situation<f64>, rows: &mut Rows<f64>);
    fn contribute_dual(&self, site: Site, parameters: &[Dual], now: &Situation<Dual>, rows: &mut Rows<Dual>);
}

impl<P: Physics> Effect for P {
    fn card(&self) -> &'static Card {
        Physics::card(self)
    }
    fn parameters(&self, machine: &Machine, site: Site) -> &'static [ParameterCard] {
        Physics::parameters(self, machine, site)
    }
    fn value_where_left_out(&self, parameter: &str) -> Option<f64> {
        Physics::value_where_left_out(self, parameter)
    }
    fn is_worth_a_name(&self, parameters: &[f64]) -> bool {
        Physics::is_worth_a_name(self, parameters)
    }
    fn has_power(&self) -> bool {
        Physics::has_power(self)
    }
    fn states(&self) -> usize {
        Physics::states(self)
    }
    fn spool_plain(&self, parameters: &[f64], states: &[f64], rates: &mut [f64], spool: f64) -> [f64; 2] {
        self.spool(parameters, states, rates, spool)
    }
    fn spool_dual(&self, parameters: &[Dual], states: &[Dual], rates: &mut [Dual], spool: Dual) -> [Dual; 2] {
        self.spool(parameters, states, rates, spool)
    }
    fn reads_course(&self) -> bool {
        Physics::reads_course(self)
    }
    fn read_plain(&self, parameters: &[f64], reading: f64, course: [f64; 2]) -> f64 {
        self.read(parameters, reading, course)
    }
    fn read_dual(&self, parameters: &[Dual], reading: Dual, course: [Dual; 2]) -> Dual {
        self.read(parameters, reading, course)
    }
    fn opening_plain(&self, parameters: &[f64], opening: f64, maximum: f64) -> f64 {
        self.opening(parameters, opening, maximum)
    }
    fn opening_dual(&self, parameters: &[Dual], opening: Dual, maximum: f64) -> Dual {
        self.opening(parameters, opening, maximum)
    }
    fn adjust_plain(&self, site: Site, parameters: &[f64], now: &mut Situation<f64>) {
        self.adjust(site, parameters, now);
    }
    fn adjust_dual(&self, site: Site, parameters: &[Dual], now: &mut Situation<Dual>) {
        self.adjust(site, parameters, now);
    }
    fn distort_plain(&self, site: Site, parameters: &[f64], instruments: &mut Instruments<f64>) {
        self.distort(site, parameters, instruments);
    }
    fn distort_dual(&self, site: Site, parameters: &[Dual], instruments: &mut Instruments<Dual>) {
        self.distort(site, parameters, instruments);
    }
    fn potential_plain(&self, site: Site, parameters: &[f64], now: &Situation<f64>) -> Option<f64> {
        self.potential(site, parameters, now)
    }
    fn potential_dual(&self, site: Site, parameters: &[Dual], now: &Situation<Dual>) -> Option<Dual> {
        self.potential(site, parameters, now)
    }
    fn contribute_plain(&self, site: Site, parameters: &[f64], now: &Situation<f64>, rows: &mut Rows<f64>) {
        self.contribute(site, parameters, now, rows);
    }
    fn contribute_dual(&self, site: Site, parameters: &[Dual], now: &Situation<Dual>, rows: &mut Rows<Dual>) {
        self.contribute(site, parameters, now, rows);
    }
}

impl std::fmt::Debug for dyn Effect {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.card().name)
    }
}

/// A number type that effects can be evaluated with.
#[allow(missing_docs)]
pub trait Number: Scalar {
    fn spool(effect: &dyn Effect, parameters: &[Self], states: &[Self], rates: &mut [Self], spool: Self) -> [Self; 2];
    fn read(effect: &dyn Effect, parameters: &[Self], reading: Self, course: [Self; 2]) -> Self;
    fn opening(effect: &dyn Effect, parameters: &[Self], opening: Self, maximum: f64) -> Self;
    fn adjust(effect: &dyn Effect, site: Site, parameters: &[Self], now: &mut Situation<Self>);
    fn distort(effect: &dyn Effect, site: Site, parameters: &[Self], instruments: &mut Instruments<Self>);
    fn potential(effect: &dyn Effect, site: Site, parameters: &[Self], now: &Situation<Self>) -> Option<Self>;
    fn contribute(effect: &dyn Effect, site: Site, parameters: &[Self], now: &Situation<Self>, rows: &mut Rows<Self>);
}

impl Number for f64 {
    fn spool(effect: &dyn Effect, parameters: &[Self], states: &[Self], rates: &mut [Self], spool: Self) -> [Self; 2] {
        effect.spool_plain(parameters, states, rates, spool)
    }
    fn read(effect: &dyn Effect, parameters: &[Self], reading: Self, course: [Self; 2]) -> Self {
        effect.read_plain(parameters, reading, course)
    }
    fn opening(effect: &dyn Effect, parameters: &[Self], opening: Self, maximum: f64) -> Self {
        effect.opening_plain(parameters, opening, maximum)
    }
    fn adjust(effect: &dyn Effect, site: Site, parameters: &[Self], now: &mut Situation<Self>) {
        effect.adjust_plain(site, parameters, now);
    }
    fn distort(effect: &dyn Effect, site: Site, parameters: &[Self], instruments: &mut Instruments<Self>) {
        effect.distort_plain(site, parameters, instruments);
    }
    fn potential(effect: &dyn Effect, site: Site, parameters: &[Self], now: &Situation<Self>) -> Option<Self> {
        effect.potential_plain(site, parameters, now)
    }
    fn contribute(effect: &dyn Effect, site: Site, parameters: &[Self], now: &Situation<Self>, rows: &mut Rows<Self>) {
        effect.contribute_plain(site, parameters, now, rows);
    }
}

impl Number for Dual {
    fn spool(effect: &dyn Effect, parameters: &[Self], states: &[Self], rates: &mut [Self], spool: Self) -> [Self; 2] {
        effect.spool_dual(parameters, states, rates, spool)
    }
    fn read(effect: &dyn Effect, parameters: &[Self], reading: Self, course: [Self; 2]) -> Self {
        effect.read_dual(parameters, reading, course)
    }
    fn opening(effect: &dyn Effect, parameters: &[Self], opening: Self, maximum: f64) -> Self {
        effect.opening_dual(parameters, opening, maximum)
    }
    fn adjust(effect: &dyn Effect, site: Site, parameters: &[Self], now: &mut Situation<Self>) {
        effect.adjust_dual(site, parameters, now);
    }
    fn distort(effect: &dyn Effect, site: Site, parameters: &[Self], instruments: &mut Instruments<Self>) {
        effect.distort_dual(site, parameters, instruments);
    }
    fn potential(effect: &dyn Effect, site: Site, parameters: &[Self], now: &Situation<Self>) -> Option<Self> {
        effect.potential_dual(site, parameters, now)
    }
    fn contribute(effect: &dyn Effect, site: Site, parameters: &[Self], now: &Situation<Self>, rows: &mut Rows<Self>) {
        effect.contribute_dual(site, parameters, now, rows);
    }
}
