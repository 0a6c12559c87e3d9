//! A model: a machine plus a list of physical effects.

use std::collections::HashMap;
use std::sync::Arc;

use crate::effects::{
    self, ActsOn, AnyEffect, Catalogue, Corner, Effect, Finding, Needs, ParameterCard, Site, Text, Unannounced,
    unannounced,
};
use crate::errors::ModelError;
use crate::machine::{Drive, Machine, Size, Supply};

/// A machine plus a list of physical effects with parameter values.
#[derive(Debug, Clone)]
pub struct Model {
    /// Geometry and known constants.
    pub machine: Machine,
    /// The effects, in the order in which valve effects are applied to the spool.
    pub effects: Vec<ModelEffect>,
    /// Changes made to the model, oldest first.
    pub history: Vec<HistoryEntry>,
    /// The effects available to the model.
    pub catalogue: Catalogue,
    /// States that follow their measured signals instead of being simulated.
    pub imposed: Imposed,
}

/// States that follow their measured signals instead of being simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Imposed {
    /// Every state is simulated.
    #[default]
    Nothing,
    /// Motion and pressures are measured. Only states of effects are simulated, as the play of a valve.
    Everything,
}

/// One effect at one place with its parameter values.
#[derive(Debug, Clone)]
pub struct ModelEffect {
    /// The physics.
    pub physics: AnyEffect,
    /// Where it sits.
    pub site: Site,
    /// Size of the part of the machine where it sits.
    pub size: Size,
    /// Its parameters, in the order of its cards.
    pub parameters: Vec<Parameter>,
}

/// A parameter value and what is known about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// What it means.
    pub card: Arc<ParameterCard>,
    /// Value in the card's unit.
    pub value: f64,
    /// Whether the value is a known constant, which identification leaves alone.
    pub known: bool,
    /// Standard error of an identified value, in the card's unit.
    pub standard_error: Option<f64>,
    /// Half width of its 95 % interval, in the card's unit: more than 1.96 standard errors where these are poorly known
    /// themselves.
    pub margin_95: Option<f64>,
    /// Where the value comes from, as text for the user.
    pub source: String,
}

/// Something that was done to a model.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
pub struct HistoryEntry {
    /// When, ISO 8601.
    pub when: String,
    /// What, in one sentence.
    pub what: String,
    /// The recordings used.
    #[serde(default)]
    pub recordings: Vec<String>,
    /// Mean normalised squared error on the validation recordings before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub validation_error_before: Option<f64>,
    /// The same after.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub validation_error_after: Option<f64>,
}

impl ModelEffect {
    /// The effect at `site` of `machine`, with its cards' first start values.
    ///
    /// # Errors
    /// [`ModelError::WrongSite`] when the effect cannot act there.
    pub fn new(physics: &AnyEffect, machine: &Machine, site: Site) -> Result<Self, ModelError> {
        if let Some(reason) = why_not(&**physics, machine, site) {
            return Err(ModelError::WrongSite {
                effect: physics.card().name.to_string(),
                site: site_name(machine, site).into(),
                machine: machine.name.clone(),
                reason,
            });
        }
        let size = machine.size_at(site);
        let parameters = physics
            .parameters(machine, site)
            .iter()
            .map(|card| {
                let card = card.for_place(machine, site);
                // An effect with an optional time window acts always, until a search gives it a window.
                let always = match card.start {
                    effects::Start::Known(value) => Some(value),
                    _ if card.start.is_a_time() => physics.value_where_left_out(&card.name),
                    _ => None,
                };
                let first = match &card.start {
                    effects::Start::At(values) => values.first().copied().unwrap_or(card.typical),
                    effects::Start::PumpPressureQuantiles(_)
                    | effects::Start::Known(_)
                    | effects::Start::WorstStretchBegin
                    | effects::Start::WorstStretchDuration => card.typical,
                };
                Parameter {
                    card: Arc::new(card),
                    value: always.unwrap_or(first),
                    known: always.is_some(),
                    standard_error: None,
                    margin_95: None,
                    source: String::new(),
                }
            })
            .collect();
        Ok(ModelEffect { physics: physics.clone(), site, size, parameters })
    }

    /// Name in the catalogue.
    pub fn name(&self) -> &str {
        &self.physics.card().name
    }

    /// Name in the catalogue, as stored in results.
    pub fn name_text(&self) -> Text {
        self.physics.card().name.clone()
    }

    /// Parameters for begin and duration, s, of an effect that can act in a window of time.
    pub fn window(&self) -> Option<(&Parameter, &Parameter)> {
        let time = |start| self.parameters.iter().find(|parameter| parameter.card.start == start);
        Some((time(effects::Start::WorstStretchBegin)?, time(effects::Start::WorstStretchDuration)?))
    }

    /// Whether it acts from the beginning to the end of every recording, not in a window of time.
    pub fn acts_always(&self) -> bool {
        self.parameters
            .iter()
            .filter(|parameter| parameter.card.start.is_a_time())
            .all(|time| self.physics.value_where_left_out(&time.card.name) == Some(time.value))
    }

    /// Whether the effect is large enough to matter in practice.
    pub fn is_practically_significant(&self) -> bool {
        self.physics.is_practically_significant(&self.size, &self.values())
    }

    /// Finding for the report, for a nuisance effect.
    pub fn finding(&self) -> Option<Finding> {
        let parameters: Vec<_> =
            self.parameters.iter().map(|parameter| (parameter.value, &*parameter.card.unit)).collect();
        self.physics.finding(&parameters)
    }

    /// The corner of its law, at its parameter values, that other effects can round.
    pub fn corner(&self) -> Option<Corner> {
        self.physics.corner(&self.values())
    }

    fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.value).collect()
    }

    /// Whether this is the effect with this name at this site.
    pub fn is(&self, name: &str, site: Site) -> bool {
        self.name() == name && self.site == site
    }
}

/// Name of the pump line as a place of effects.
const PUMP: &str = "pump";

/// Name of the whole machine as a place of effects.
const MACHINE: &str = "machine";

/// Names of places that no cylinder can have.
pub(crate) const PLACES_BESIDE_CYLINDERS: [&str; 2] = [PUMP, MACHINE];

/// Name of a site: the cylinder's, "pump" or "machine".
pub fn site_name(machine: &Machine, site: Site) -> &str {
    match site {
        Site::Cylinder(index) => machine.cylinders.get(index).map_or("?", |cylinder| cylinder.name.as_str()),
        Site::PumpLine => PUMP,
        Site::Machine => MACHINE,
    }
}

/// The site with this name, as [`site_name`] writes it; `None` if the machine has no such place.
pub fn site_named(machine: &Machine, name: &str) -> Option<Site> {
    match name {
        PUMP => Some(Site::PumpLine),
        MACHINE => Some(Site::Machine),
        cylinder => machine.cylinder_index(cylinder).map(Site::Cylinder),
    }
}

/// Name of an effect at a place, as results and commands write it: `pump_leakage@pump`.
pub fn addition_name(effect: &str, place: &str) -> String {
    format!("{effect}@{place}")
}

fn why_not(physics: &dyn Effect, machine: &Machine, site: Site) -> Option<String> {
    let by_card = why_not_by_card(physics, machine, site).map(str::to_string);
    by_card.or_else(|| physics.why_not(machine, site))
}

fn why_not_by_card(physics: &dyn Effect, machine: &Machine, site: Site) -> Option<&'static str> {
    let card = physics.card();
    let pump_line = matches!(machine.supply, Supply::PumpLine(_));
    match (card.acts_on, site) {
        (ActsOn::PumpLine, Site::Cylinder(_)) => Some("it acts on the pump line; leave out the cylinder or say @pump"),
        (_, Site::Cylinder(index)) => {
            let Some(cylinder) = machine.cylinders.get(index) else { return Some("no such cylinder") };
            let drive = cylinder.chambers.map(|chambers| chambers.drive);
            match (card.needs, drive) {
                (Needs::Nothing, _) => None,
                // An imposed motion comes with measured pressures.
                (Needs::Pressures, None) if cylinder.imposed_motion.is_some() => None,
                (_, None) => Some("it acts on oil, and this cylinder has no chambers"),
                (Needs::Valve, Some(Drive::Pump { .. })) => Some("it acts on a valve, and a pump drives this cylinder"),
                (Needs::Pump, Some(Drive::Valve { .. })) => {
                    Some("it needs a pump that drives the cylinder, and a valve drives this one")
                }
                _ => None,
            }
        }
        (ActsOn::PumpLine | ActsOn::CylinderOrPumpLine | ActsOn::Instruments, Site::PumpLine) => {
            (!pump_line).then_some("the machine has no pump line")
        }
        (ActsOn::Cylinder | ActsOn::Valve, Site::PumpLine) => {
            Some("it acts on a cylinder; say which, as in EFFECT@arm")
        }
        (ActsOn::Instruments, Site::Machine) => None,
        (ActsOn::PumpLine, Site::Machine) => Some("it acts on the pump line; say EFFECT@pump"),
        (_, Site::Machine) => Some("it acts on one place at a time; say which, as in EFFECT@arm"),
    }
}

impl Model {
    /// Values of all parameters, effect after effect.
    pub fn parameter_values(&self) -> Vec<f64> {
        self.parameters().map(|(_, parameter)| parameter.value).collect()
    }

    /// All parameters with the index of their effect, effect after effect.
    pub fn parameters(&self) -> impl Iterator<Item = (usize, &Parameter)> {
        self.effects
            .iter()
            .enumerate()
            .flat_map(|(index, effect)| effect.parameters.iter().map(move |parameter| (index, parameter)))
    }

    /// All parameters, mutable, in the same order as [`Model::parameters`].
    pub fn parameters_mut(&mut self) -> impl Iterator<Item = &mut Parameter> {
        self.effects.iter_mut().flat_map(|effect| effect.parameters.iter_mut())
    }

    /// Contract names of all parameters (`arm.inertia`, `pump.bulk_modulus`, ...), in the same order. Where two formulas at one
    /// place use the same parameter name, the name of the effect precedes it: `arm.load_damping.k`.
    pub fn parameter_names(&self) -> Vec<String> {
        let plain = |(effect, parameter): (usize, &Parameter)| {
            format!("{}.{}", site_name(&self.machine, self.effects[effect].site), parameter.card.name)
        };
        let names: Vec<String> = self.parameters().map(plain).collect();
        let mut counts: HashMap<&str, usize> = HashMap::new();
        names.iter().for_each(|name| *counts.entry(name).or_default() += 1);
        let unique = |((effect, parameter), name): ((usize, &Parameter), &String)| {
            let effect = &self.effects[effect];
            let place = site_name(&self.machine, effect.site);
            match counts.get(name.as_str()) {
                Some(2..) => format!("{place}.{}.{}", effect.name(), parameter.card.name),
                _ => name.clone(),
            }
        };
        self.parameters().zip(&names).map(unique).collect()
    }

    /// Whether an effect depends on the oil temperature, so that recordings must have it.
    pub fn reads_temperature(&self) -> bool {
        self.effects.iter().any(|effect| effect.physics.reads_temperature())
    }

    /// Indices, in the order of [`Model::parameters`], of the parameters that identification may change.
    pub fn unknown_parameters(&self) -> Vec<usize> {
        self.parameters().enumerate().filter(|(_, (_, parameter))| !parameter.known).map(|(index, _)| index).collect()
    }

    /// Sets the values of all parameters, in the same order; surplus values are ignored.
    pub fn set_parameter_values(&mut self, values: &[f64]) {
        for (parameter, value) in self.parameters_mut().zip(values) {
            parameter.value = *value;
        }
    }

    /// The value of the parameter with this contract name.
    pub fn value_of(&self, name: &str) -> Option<f64> {
        let index = self.parameter_names().iter().position(|candidate| candidate == name)?;
        self.parameter_values().get(index).copied()
    }

    /// Whether the model has this effect at this site.
    pub fn has(&self, effect: &str, site: Site) -> bool {
        self.effect(effect, site).is_some()
    }

    /// The effect with this name at this site, if the model has it.
    pub fn effect(&self, name: &str, site: Site) -> Option<&ModelEffect> {
        self.effects.iter().find(|present| present.is(name, site))
    }

    /// Whether the model has an effect with this corner at this site, so that there is something to round.
    pub fn has_corner(&self, corner: Corner, site: Site) -> bool {
        self.effects.iter().any(|effect| effect.site == site && effect.corner() == Some(corner))
    }

    /// Sites where `physics` can act but is not present yet: cylinders in order, the pump line, the whole machine.
    ///
    /// An effect on the whole machine is present at every place. So the whole machine is free only if no place has the effect,
    /// and no place is free if the whole machine has it. On a machine with only one place, the whole machine is not offered as
    /// well.
    pub fn free_sites(&self, physics: &AnyEffect) -> Vec<Site> {
        let name = &physics.card().name;
        if self.has(name, Site::Machine) {
            return Vec::new();
        }
        let can_act = |site: &Site| why_not(&**physics, &self.machine, *site).is_none();
        let is_free = |site: &Site| !self.has(name, *site);
        let places = (0..self.machine.cylinders.len()).map(Site::Cylinder).chain([Site::PumpLine]);
        let places: Vec<Site> = places.filter(can_act).collect();
        let everywhere = (places.len() > 1 && places.iter().all(is_free)).then_some(Site::Machine).filter(can_act);
        places.into_iter().filter(is_free).chain(everywhere).collect()
    }

    /// A copy of the model with one more effect at its start values.
    ///
    /// ```
    /// use excavator_model::prelude::*;
    ///
    /// let plain = built_in("zx30u-arm")?;
    /// let dead_zone = plain.catalogue.find("valve_dead_zone")?;
    /// let model = plain.with_effect(&dead_zone, Site::Cylinder(0))?;
    /// assert_eq!(model.value_of("arm.dead_zone_positive"), Some(3e-6)); // m²
    /// assert!(model.with_effect(&dead_zone, Site::Cylinder(0)).is_err(), "it is there already");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError::WrongSite`], [`ModelError::AlreadyPresent`]; [`ModelError::Unannounced`] for an effect from elsewhere with a hook
    /// that would never be called.
    pub fn with_effect(&self, physics: &AnyEffect, site: Site) -> Result<Model, ModelError> {
        if self.has(&physics.card().name, site) {
            return Err(ModelError::AlreadyPresent {
                effect: physics.card().name.to_string(),
                site: site_name(&self.machine, site).into(),
                machine: self.machine.name.clone(),
            });
        }
        let effect = ModelEffect::new(physics, &self.machine, site)?;
        if Catalogue::built_in().find(effect.name()).is_err() {
            let typical: Vec<f64> = effect.parameters.iter().map(|parameter| parameter.card.typical).collect();
            if let Some(Unannounced { hook, method }) = unannounced(&**physics, &self.machine, site, &typical) {
                return Err(ModelError::Unannounced { effect: effect.name().to_string(), hook, method });
            }
        }
        let mut model = self.clone();
        model.effects.push(effect);
        Ok(model)
    }

    /// Sites from user input: `EFFECT` (at each place where it can act), `EFFECT@CYLINDER`, `EFFECT@pump`, or `EFFECT@machine`
    /// (one effect on all instruments).
    ///
    /// # Errors
    /// [`ModelError`] if the effect or the site does not exist, or the effect cannot act there.
    pub fn parse_addition(&self, text: &str) -> Result<Vec<(AnyEffect, Site)>, ModelError> {
        let (name, place) = text.split_once('@').map_or((text, None), |(name, place)| (name, Some(place)));
        let physics = self.catalogue.find(name)?;
        let wrong_site = |site: &str, reason: String| ModelError::WrongSite {
            effect: name.to_string(),
            site: site.to_string(),
            machine: self.machine.name.clone(),
            reason,
        };
        let Some(place) = place else {
            // The sites of the single places already cover the whole machine.
            let mut sites = self.free_sites(&physics);
            sites.retain(|site| *site != Site::Machine);
            if sites.is_empty() {
                return Err(wrong_site("any place", "it is there already, or nothing it could act on".into()));
            }
            return Ok(sites.into_iter().map(|site| (physics.clone(), site)).collect());
        };
        let site = site_named(&self.machine, place).ok_or_else(|| {
            let names: Vec<&str> = self.machine.cylinders.iter().map(|c| c.name.as_str()).collect();
            wrong_site(
                place,
                format!("the machine's cylinders are {}; other places are pump and machine", names.join(", ")),
            )
        })?;
        Ok(vec![(physics, site)])
    }
}
