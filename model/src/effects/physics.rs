//! The interface between an effect and the equations.
//!
//! To add a hook, write it with its default in [`Physics`], and add its signature to the list of `hooks!`. The list generates
//! everything else.

use super::{Card, Corner, Finding, ParameterCard, Rows, Scalar, Site};
use crate::equations::{Instruments, Situation};
use crate::formula::FormulaText;
use crate::machine::{Machine, Size};
use crate::scalar::Dual;

/// One physical effect, written once for any number type.
///
/// A user effect needs its card, its parameters, and its contribution to the equations:
///
/// ```
/// use std::sync::Arc;
///
/// use excavator_model::effects::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Start, text};
/// use excavator_model::equations::{Rows, Situation};
/// use excavator_model::prelude::*;
/// use excavator_model::scalar::Scalar;
///
/// /// Drag of a tool in soil.
/// struct ToolDrag;
///
/// static CARD: Card = Card {
///     name: text("tool_drag"),
///     acts_on: ActsOn::Cylinder,
///     needs: Needs::Nothing,
///     family: Family::Candidate,
///     summary: text("A torque against the joint's rate that grows with its square."),
///     equation: text("torque -k qd |qd|"),
///     source: text("example"),
///     shows: text("Torque error that bends upward with the rate."),
///     experiment: text("Steady strokes at several rates, in soil and in air."),
///     energy: text("Dissipates k |qd|^3."),
/// };
///
/// static PARAMETERS: &[ParameterCard] = &[ParameterCard {
///     name: text("tool_drag"),
///     symbol: text("k"),
///     unit: text("N m s2"),
///     meaning: text("torque at a rate of 1 rad/s"),
///     kind: Kind::Linear,
///     growth: Growth::TORQUE,
///     minimum: 0.0,
///     maximum: 1e6,
///     typical: 5e3,
///     start: Start::at(&[5e3]),
///     prior: None,
/// }];
///
/// impl Physics for ToolDrag {
///     fn card(&self) -> &Card {
///         &CARD
///     }
///
///     fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
///         PARAMETERS
///     }
///
///     fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
///         let Site::Cylinder(cylinder) = site else { return };
///         let rate = now.pistons[cylinder].rate;
///         rows.torque[cylinder] -= parameters[0] * rate * rate.abs();
///     }
/// }
///
/// let catalogue = Catalogue::built_in().with([Arc::new(ToolDrag) as _])?;
/// let plain = Model { catalogue, ..built_in("zx30u-arm")? };
/// let drag = plain.catalogue.find("tool_drag")?;
/// let model = plain.with_effect(&drag, Site::Cylinder(0))?;
/// assert_eq!(model.value_of("arm.tool_drag"), Some(5e3)); // N m s²
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Physics: Send + Sync {
    /// Its description.
    fn card(&self) -> &Card;

    /// Its parameters at `site` of `machine`, in the order in which [`Physics::contribute`] gets them.
    fn parameters(&self, machine: &Machine, site: Site) -> &[ParameterCard];

    /// Default value of a parameter that a model file may omit: for files older than the parameter.
    fn value_where_left_out(&self, _parameter: &str) -> Option<f64> {
        None
    }

    /// Plausible range of a parameter of a real machine, if it is narrower than the limits of a search.
    fn plausible(&self, _machine: &Machine, _site: Site, _parameter: &str) -> Option<[f64; 2]> {
        None
    }

    /// Whether real machines reach the maximum of a parameter (a check valve can be tight), so that it is not a mere limit of
    /// plausibility.
    fn has_natural_maximum(&self, _parameter: &str) -> bool {
        false
    }

    /// Whether an effect of this size matters. An effect within the accuracy of good instruments, or whose shape lies where
    /// nothing moves, is not an answer to missing physics, however well it absorbs an error. `size` is that of its place.
    fn is_practically_significant(&self, _size: &Size, _parameters: &[f64]) -> bool {
        true
    }

    /// Whether its contribution to the rows has power. Effects that shift an opening, round another effect or act on an
    /// instrument have none, and no line in an energy balance.
    fn has_power(&self) -> bool {
        true
    }

    /// Whether the power of its flows into the chambers comes from its own shaft, not from the supply.
    fn takes_power_from_a_shaft(&self) -> bool {
        false
    }

    /// Whether its compliance does not depend on pressure, so that the stored energy needs no integration.
    fn has_constant_compliance(&self) -> bool {
        false
    }

    /// The corner it rounds, for an effect that only rounds another effect's law.
    fn rounds(&self) -> Option<Corner> {
        None
    }

    /// The corner of its law with these parameters, for other effects to round.
    fn corner(&self, _parameters: &[f64]) -> Option<Corner> {
        None
    }

    /// The finding in a report for a nuisance effect with these parameters in these units; `None` for effects that a verdict
    /// names.
    fn finding(&self, _parameters: &[(f64, &str)]) -> Option<Finding> {
        None
    }

    /// The text of a law read from a formula.
    fn formula(&self) -> Option<&FormulaText> {
        None
    }

    /// Why it cannot act at `site` of `machine`, besides the requirements of its card.
    fn why_not(&self, _machine: &Machine, _site: Site) -> Option<String> {
        None
    }

    /// Number of states that it adds to the model.
    fn states(&self) -> usize {
        0
    }

    /// Whether its states are its own memory, handled by [`Physics::begin`] and [`Physics::remember`]. Other states are spools,
    /// as openings, handled by [`Physics::spool`].
    fn has_memory(&self) -> bool {
        false
    }

    /// Order of magnitude of a state, in its unit; for a spool its opening, m², on a machine of the reference size.
    fn state_scale(&self, _state: usize) -> f64 {
        1e-4
    }

    /// Whether its law needs the metering flows, so that it is evaluated after the valve's effects.
    fn reads_metering_flows(&self) -> bool {
        false
    }

    /// Whether its law depends on the oil temperature, so that a recording must have it.
    fn reads_temperature(&self) -> bool {
        false
    }

    /// Whether it only confines the state to the domain for which \[A\] prints its equations: end stops, boiling oil. The printed
    /// equations have no term for it.
    fn confines(&self) -> bool {
        false
    }

    /// Whether it changes what other effects see through [`Physics::spool`], [`Physics::opening`] or [`Physics::adjust`], which
    /// are called for such effects only. The parameters of all others affect only their own rows, which makes their derivatives
    /// cheap.
    fn adjusts_others(&self) -> bool {
        false
    }

    /// True positions of the metering edges and of the bypass (m²), given the spool position of the input; `states` are the
    /// effect's own, and their rates are written to `rates`. `size` is that of the valve's cylinder.
    fn spool<T: Scalar>(&self, _size: &Size, _parameters: &[T], _states: &[T], _rates: &mut [T], spool: T) -> [T; 2] {
        [spool, spool]
    }

    /// Whether the effect reads the rate of the input, by [`Physics::read`].
    fn reads_input_rate(&self) -> bool {
        false
    }

    /// The true opening (m²) of the input, given its reading and the reading's rates before and after this instant (m²/s). Called
    /// only for effects with [`Physics::reads_input_rate`], before any [`Physics::spool`].
    fn read<T: Scalar>(&self, _parameters: &[T], reading: T, _rates: [T; 2]) -> T {
        reading
    }

    /// The area open to flow (m²), given the area after the previous effects.
    fn opening<T: Scalar>(&self, _site: Site, _parameters: &[T], opening: T, _now: &Situation<T>) -> T {
        opening
    }

    /// Adjusts what other effects see, after all openings are known: the closing of the bypass, the share of backflow to the
    /// pump, the rounding of a corner.
    fn adjust<T: Scalar>(&self, _site: Site, _parameters: &[T], _now: &mut Situation<T>) {}

    /// Adds to the distortions of instruments, for an effect that acts on them and not on the machine.
    fn distort<T: Scalar>(&self, _site: Site, _parameters: &[T], _instruments: &mut Instruments<T>) {}

    /// Potential energy in J that the effect stores as a function of position, if its whole torque follows from it; `None` for
    /// all other effects. Contributions to the mass matrix do not need it: they store kinetic energy.
    fn potential<T: Scalar>(&self, _site: Site, _parameters: &[T], _now: &Situation<T>) -> Option<T> {
        None
    }

    /// Adds the effect at `site` to the rows of the equations of motion.
    fn contribute<T: Scalar>(&self, _site: Site, _parameters: &[T], _now: &Situation<T>, _rows: &mut Rows<T>) {}

    /// The same for an effect with memory.
    fn contribute_remembering<T: Scalar>(
        &self,
        site: Site,
        parameters: &[T],
        _states: &[T],
        now: &Situation<T>,
        rows: &mut Rows<T>,
    ) {
        self.contribute(site, parameters, now, rows);
    }

    /// Writes the rates of its memory to `rates`.
    fn remember<T: Scalar>(
        &self,
        _site: Site,
        _parameters: &[T],
        _states: &[T],
        _now: &Situation<T>,
        _rates: &mut [T],
    ) {
    }

    /// Sets its memory to the initial value.
    fn begin<T: Scalar>(&self, _site: Site, _parameters: &[T], _now: &Situation<T>, _states: &mut [T]) {}
}

/// The traits through which a model uses effects of different types, generated from the hooks of [`Physics`]: those that are the
/// same for every number type, and those in a number type `T`.
macro_rules! hooks {
    (
        same for every number type {
            $(fn $plain:ident($($plain_name:ident: $plain_type:ty),*) $(-> $plain_result:ty)?;)*
        }
        in number type T {
            $(fn $hook:ident($($name:ident: $type:ty),*) $(-> $result:ty)?;)*
        }
    ) => {
        /// [`Physics`] as a trait object, for the number types of the program. Implemented for every `Physics`; not to be
        /// implemented by hand.
        #[allow(missing_docs)]
        pub trait Effect: Hooks<f64> + Hooks<Dual> + Send + Sync {
            $(fn $plain(&self, $($plain_name: $plain_type),*) $(-> $plain_result)?;)*
        }

        impl<P: Physics> Effect for P {
            $(fn $plain(&self, $($plain_name: $plain_type),*) $(-> $plain_result)? {
                Physics::$plain(self, $($plain_name),*)
            })*
        }

        /// The hooks of [`Physics`] in one number type. Implemented for every `Physics`; not to be implemented by hand.
        #[allow(missing_docs)]
        pub trait Hooks<T> {
            $(fn $hook(&self, $($name: $type),*) $(-> $result)?;)*
        }

        impl<P: Physics, T: Scalar> Hooks<T> for P {
            $(fn $hook(&self, $($name: $type),*) $(-> $result)? {
                Physics::$hook(self, $($name),*)
            })*
        }
    };
}

hooks! {
    same for every number type {
        fn card() -> &Card;
        fn parameters(machine: &Machine, site: Site) -> &[ParameterCard];
        fn value_where_left_out(parameter: &str) -> Option<f64>;
        fn plausible(machine: &Machine, site: Site, parameter: &str) -> Option<[f64; 2]>;
        fn has_natural_maximum(parameter: &str) -> bool;
        fn is_practically_significant(size: &Size, parameters: &[f64]) -> bool;
        fn has_power() -> bool;
        fn takes_power_from_a_shaft() -> bool;
        fn has_constant_compliance() -> bool;
        fn confines() -> bool;
        fn rounds() -> Option<Corner>;
        fn corner(parameters: &[f64]) -> Option<Corner>;
        fn finding(parameters: &[(f64, &str)]) -> Option<Finding>;
        fn formula() -> Option<&FormulaText>;
        fn why_not(machine: &Machine, site: Site) -> Option<String>;
        fn states() -> usize;
        fn has_memory() -> bool;
        fn state_scale(state: usize) -> f64;
        fn reads_metering_flows() -> bool;
        fn reads_temperature() -> bool;
        fn reads_input_rate() -> bool;
        fn adjusts_others() -> bool;
    }
    in number type T {
        fn spool(size: &Size, parameters: &[T], states: &[T], rates: &mut [T], spool: T) -> [T; 2];
        fn read(parameters: &[T], reading: T, course: [T; 2]) -> T;
        fn opening(site: Site, parameters: &[T], opening: T, now: &Situation<T>) -> T;
        fn adjust(site: Site, parameters: &[T], now: &mut Situation<T>);
        fn distort(site: Site, parameters: &[T], instruments: &mut Instruments<T>);
        fn potential(site: Site, parameters: &[T], now: &Situation<T>) -> Option<T>;
        fn contribute(site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>);
        fn contribute_remembering(
            site: Site, parameters: &[T], states: &[T], now: &Situation<T>, rows: &mut Rows<T>);
        fn remember(site: Site, parameters: &[T], states: &[T], now: &Situation<T>, rates: &mut [T]);
        fn begin(site: Site, parameters: &[T], now: &Situation<T>, states: &mut [T]);
    }
}

impl dyn Effect + '_ {
    /// Whether it changes only what instruments report.
    pub fn is_an_instruments(&self) -> bool {
        !(self.has_power() || self.has_memory() || self.adjusts_others() || self.reads_input_rate())
    }
}

impl std::fmt::Debug for dyn Effect {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(&self.card().name)
    }
}

/// A number type for the evaluation of effects.
pub trait Number: Scalar {
    /// The hooks of an effect in this number type: `T::hooks(effect).contribute(...)`.
    fn hooks(effect: &dyn Effect) -> &dyn Hooks<Self>;
}

impl Number for f64 {
    #[inline]
    fn hooks(effect: &dyn Effect) -> &dyn Hooks<f64> {
        effect
    }
}

impl Number for Dual {
    #[inline]
    fn hooks(effect: &dyn Effect) -> &dyn Hooks<Dual> {
        effect
    }
}
