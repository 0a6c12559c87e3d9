//! The effect catalogue: one physical effect per file.
//!
//! Every effect has four parts, all from one formula written once for any [`Scalar`]:
//! 1. *simulation*: what it adds to the [`Rows`] of the equations of motion ([`Physics::contribute`]);
//! 2. *regressor*: the derivative of those rows with respect to its parameters, by dual numbers;
//! 3. *power*: its forces times velocities and its flows times pressures ([`crate::energy`]);
//! 4. *how it shows*: its [`Card`], in the terms of a machine engineer, with the experiment that shows it best.
//!
//! To add a built-in effect, write a file with a unit struct and its [`Physics`], and add a line to `built_in.rs`. A user effect
//! needs no Rust ([`crate::formula`]), or is a [`Physics`] in another crate, added with [`Catalogue::with`].

mod announced;
mod built_in;
mod card;
mod catalogue;
mod physics;
mod prior;
mod site;

mod accumulator;
mod asymmetric_friction;
mod bulk_modulus_temperature;
mod bypass_overlap;
mod cavitation;
mod charge_check_valve;
mod coulomb_friction;
mod displacement_sensor_offset;
mod end_cushion;
mod end_stop;
mod end_stop_correction;
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
mod load_sensing_pump;
mod make_up_valve;
mod matched_pump_flow;
mod oil_compressibility;
mod open_centre_bypass;
mod opening_scale;
mod orifice_flow;
mod orifice_transition;
mod payload;
mod pressure_compensation;
mod pressure_dependent_friction;
mod pressure_sensor_offset;
mod pump_drive;
mod pump_leakage;
mod relief_valve;
mod seal_friction_temperature;
mod sensor_delay;
mod shuttle_valve;
mod spool_sensor_lead;
mod spool_sensor_offset;
mod stribeck_friction;
mod valve_area_law;
mod valve_dead_zone;
mod valve_directional_gain;
mod valve_edge_curves;
mod valve_gain_curve;
mod valve_hysteresis;
mod valve_lag;
mod valve_leakage;
mod valve_null;
mod vented_rod_side;
mod viscosity_temperature;
mod viscous_damping;

pub use crate::machine::Growth;
pub use announced::{Unannounced, unannounced};
pub use card::{ActsOn, Card, Corner, Family, Kind, Needs, ParameterCard, Start, Text, text};
pub use catalogue::{AnyEffect, Catalogue, TwiceInCatalogue, UnknownEffect};
pub use physics::{Effect, Hooks, Number, Physics};
pub use prior::{Finding, Prior, PriorScale, RecordingScales, Spread};
pub use site::Site;

use crate::equations::Rows;
use crate::scalar::Scalar;

/// The candidate nearest in spelling to `name`, if it is near enough to be a likely typo.
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<String> {
    candidates
        .map(|candidate| (strsim::jaro_winkler(name, candidate), candidate))
        .filter(|(similarity, _)| *similarity > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate.to_string())
}
