//! The effect catalogue: one physical effect per file.
//!
//! Every effect has four faces, all from one formula written once for any [`Scalar`]:
//! 1. *simulation*: what it adds to the [`Rows`] of the equations of motion ([`Physics::contribute`]);
//! 2. *regressor*: the derivative of those rows with respect to its parameters, by dual numbers;
//! 3. *power*: its forces times velocities and its flows times pressures ([`crate::energy`]);
//! 4. *how it shows*: its [`Card`], in words a machine engineer understands, with the experiment that shows it best.
//!
//! To add one: write a file with a unit struct and its [`Physics`], and add a line to [`CATALOGUE`].

mod card;
mod physics;
mod prior;

mod asymmetric_friction;
mod bypass_overlap;
mod cavitation;
mod coulomb_friction;
mod displacement_sensor_offset;
mod end_cushion;
mod end_stop;
mod entrained_air;
mod external_contact;
mod external_leakage;
mod force_offset;
mod friction_corner;
mod friction_reversal;
mod gravity;
mod hose_loss;
mod hose_pressure_loss;
mod inertia;
mod internal_leakage;
mod joint_spring;
mod load_check_valve;
mod make_up_valve;
mod oil_compressibility;
mod open_centre_bypass;
mod opening_scale;
mod orifice_flow;
mod orifice_transition;
mod payload;
mod pressure_compensation;
mod pressure_dependent_friction;
mod pressure_sensor_offset;
mod pump_leakage;
mod relief_valve;
mod sensor_delay;
mod spool_sensor_lead;
mod spool_sensor_offset;
mod stribeck_friction;
mod valve_dead_zone;
mod valve_directional_gain;
mod valve_gain_curve;
mod valve_hysteresis;
mod valve_lag;
mod valve_leakage;
mod viscous_damping;

pub use card::{ActsOn, Card, Corner, Family, Kind, Needs, ParameterCard, Site, Start};
pub use physics::{Effect, Hooks, Number, Physics};
pub use prior::{Finding, Prior, PriorScale, RecordingScales, Spread};

use crate::equations::Rows;
use crate::scalar::Scalar;

/// Every effect that the program knows, base effects of \[A\] first, then the candidates beyond them.
pub static CATALOGUE: &[&dyn Effect] = &[
    &inertia::Inertia,
    &gravity::Gravity,
    &viscous_damping::ViscousDamping,
    &coulomb_friction::CoulombFriction,
    &force_offset::ForceOffset,
    &oil_compressibility::OilCompressibility,
    &orifice_flow::OrificeFlow,
    &open_centre_bypass::OpenCentreBypass,
    &internal_leakage::InternalLeakage,
    &external_leakage::ExternalLeakage,
    &end_stop::EndStop,
    &cavitation::Cavitation,
    &spool_sensor_lead::SpoolSensorLead,
    &spool_sensor_offset::SpoolSensorOffset,
    &friction_reversal::FrictionReversal,
    &friction_corner::FrictionCorner,
    &orifice_transition::OrificeTransition,
    &pressure_compensation::PressureCompensation,
    &joint_spring::JointSpring,
    &valve_dead_zone::ValveDeadZone,
    &valve_directional_gain::ValveDirectionalGain,
    &valve_gain_curve::ValveGainCurve,
    &valve_hysteresis::ValveHysteresis,
    &valve_leakage::ValveLeakage,
    &valve_lag::ValveLag,
    &load_check_valve::LoadCheckValve,
    &make_up_valve::MakeUpValve,
    &hose_loss::HoseLoss,
    &hose_pressure_loss::HosePressureLoss,
    &entrained_air::EntrainedAir,
    &stribeck_friction::StribeckFriction,
    &pressure_dependent_friction::PressureDependentFriction,
    &asymmetric_friction::AsymmetricFriction,
    &end_cushion::EndCushion,
    &relief_valve::ReliefValve,
    &pump_leakage::PumpLeakage,
    &bypass_overlap::BypassOverlap,
    &opening_scale::OpeningScale,
    &pressure_sensor_offset::PressureSensorOffset,
    &displacement_sensor_offset::DisplacementSensorOffset,
    &sensor_delay::SensorDelay,
    &payload::Payload,
    &external_contact::ExternalContact,
];

/// An effect name that the catalogue does not have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown effect \"{name}\"{}; `excavator effects` lists all", did_you_mean(suggestion))]
pub struct UnknownEffect {
    /// The name asked for.
    pub name: String,
    /// The nearest name in the catalogue, if one is near.
    pub suggestion: Option<String>,
}

fn did_you_mean(suggestion: &Option<String>) -> String {
    suggestion.as_ref().map_or(String::new(), |name| format!(" (did you mean \"{name}\"?)"))
}

/// The effect of this name.
///
/// # Errors
/// [`UnknownEffect`] with the nearest name that exists.
pub fn find(name: &str) -> Result<&'static dyn Effect, UnknownEffect> {
    CATALOGUE.iter().copied().find(|effect| effect.card().name == name).ok_or_else(|| UnknownEffect {
        name: name.to_string(),
        suggestion: nearest(name, CATALOGUE.iter().map(|effect| effect.card().name)),
    })
}

/// The candidate nearest in spelling to `name`, if it is near enough to be what was meant.
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<String> {
    candidates
        .map(|candidate| (strsim::jaro_winkler(name, candidate), candidate))
        .filter(|(similarity, _)| *similarity > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate.to_string())
}
