//! The effects of a new model file, with starts from the data sheet.

use std::fmt::Write;

use super::machine::short;
use super::{Actuator, CylinderKind, DataSheet, DriveKind, Load};
use crate::Model;
use crate::document::DocumentError;
use crate::effects::Site;

/// A value from the data sheet: parameter, value, whether it is known, source.
type Value = (&'static str, f64, bool, &'static str);

/// An effect of the file: its name, whether it acts on the pump line, and the data sheet's values of its parameters.
struct Entry {
    effect: &'static str,
    at_pump: bool,
    values: Vec<Value>,
}

/// The text of all effects.
pub(super) fn text(sheet: &DataSheet, bare: &Model) -> Result<String, DocumentError> {
    let mut model = bare.clone();
    let mut text = String::new();
    let inconsistent = |reason: String| DocumentError::Inconsistent { name: sheet.name.clone(), reason };
    for entry in entries(sheet) {
        let physics = model.catalogue.find(entry.effect).map_err(|error| inconsistent(error.to_string()))?;
        let (site, at) = if entry.at_pump { (Site::PumpLine, "pump") } else { (Site::Cylinder(0), &*sheet.part) };
        model = model.with_effect(&physics, site).map_err(|error| inconsistent(error.to_string()))?;
        let Some(added) = model.effects.last() else { continue };
        let card = physics.card();
        let _ = write!(
            text,
            "\n# {}\n[[effects]]\neffect = \"{}\"\nat = \"{at}\"\n[effects.parameters]\n",
            card.summary, card.name
        );
        for parameter in &added.parameters {
            let given = entry.values.iter().find(|(name, ..)| *name == parameter.card.name);
            let (value, known, source) = given
                .map_or((parameter.card.typical, false, ESTIMATED), |&(_, value, known, source)| {
                    (value, known, source)
                });
            let known = if known { "known = true, " } else { "" };
            let _ = writeln!(
                text,
                "{} = {{ value = {}, unit = \"{}\", {known}source = \"{source}\" }}",
                parameter.card.name,
                short(value),
                parameter.card.unit
            );
        }
    }
    Ok(text)
}

const ESTIMATED: &str = "start: usual for machines of this size";
const SHEET: &str = "data sheet";
const OURS: &str = "ours: stiff enough not to matter";

fn entries(sheet: &DataSheet) -> Vec<Entry> {
    let mut entries = mechanical(sheet);
    if !matches!(sheet.drive, DriveKind::Force | DriveKind::ImposedMotion) {
        entries.extend(hydraulic(sheet));
    }
    entries
}

fn entry(effect: &'static str, values: Vec<Value>) -> Entry {
    Entry { effect, at_pump: false, values }
}

fn at_pump(effect: &'static str, values: Vec<Value>) -> Entry {
    Entry { effect, at_pump: true, values }
}

/// Force of the working pressure on the piston, N; torque on a motor's shaft, N m.
fn full_force(sheet: &DataSheet) -> f64 {
    sheet.areas()[0] * sheet.working_pressure()
}

/// Speed at the usual flow, m/s; of a motor's shaft, rad/s.
fn usual_speed(sheet: &DataSheet) -> f64 {
    sheet.usual_flow() / sheet.areas()[0]
}

/// Usual Coulomb friction, and viscous friction at the usual speed, as fractions of the full force.
const COULOMB_SHARE: f64 = 0.02;
const VISCOUS_SHARE: f64 = 0.05;

/// Acceleration that the full force of a drive gives to its load, m/s².
const USUAL_ACCELERATION: f64 = 50.0;

/// Usual efficiency of a pump drive, and leakage across a piston as a fraction of the usual flow at the working
/// pressure.
const PUMP_SHARE: f64 = 0.97;
const LEAKAGE_SHARE: f64 = 0.005;

fn mechanical(sheet: &DataSheet) -> Vec<Entry> {
    const GRAVITY: f64 = 9.81;
    let friction = "start: 2 % of the full force";
    let damping = "start: 5 % of the full force at the usual speed";
    let mut entries = match sheet.load {
        Load::Mass { mass, slope } => {
            let guess = full_force(sheet) / USUAL_ACCELERATION;
            let (mass, source) =
                mass.map_or((guess, "start: the full force would give it 50 m/s2"), |mass| (mass, SHEET));
            let weight = ("weight", mass * GRAVITY * slope, false, "from mass and slope");
            let gravity = (slope != 0.0).then(|| entry("gravity", vec![weight]));
            let inertia = entry("inertia", vec![("mass", mass, false, source)]);
            std::iter::once(inertia).chain(gravity).collect()
        }
        Load::Link { inertia, gravity_moment, .. } => vec![
            entry("inertia", vec![("inertia", inertia, false, SHEET)]),
            entry("gravity", vec![("gravity_moment", gravity_moment, false, SHEET)]),
        ],
        Load::Rotor { inertia, torque } => {
            let gravity = (torque != 0.0).then(|| entry("gravity", vec![("load_torque", torque, false, SHEET)]));
            let inertia = entry("inertia", vec![("inertia", inertia, false, SHEET)]);
            std::iter::once(inertia).chain(gravity).collect::<Vec<_>>()
        }
    };
    let viscous = VISCOUS_SHARE * full_force(sheet) / usual_speed(sheet);
    entries.push(entry("viscous_damping", vec![("viscous_damping", viscous, false, damping)]));
    let coulomb = COULOMB_SHARE * full_force(sheet);
    entries.push(entry("coulomb_friction", vec![("coulomb_friction", coulomb, false, friction)]));
    if matches!(sheet.actuator, Actuator::Cylinder { .. }) && sheet.drive != DriveKind::ImposedMotion {
        // A tenth of a millimetre under full force on a stroke of 0.6 m.
        let Actuator::Cylinder { stroke, .. } = sheet.actuator else { return entries };
        let stiffness = full_force(sheet) / (stroke * 1.7e-4);
        let soft = 0.5 / usual_speed(sheet);
        entries.push(entry(
            "end_stop",
            vec![
                ("end_stop_stiffness", stiffness, true, OURS),
                ("end_stop_damping", soft, true, "ours: little rebound"),
            ],
        ));
    }
    entries
}

fn hydraulic(sheet: &DataSheet) -> Vec<Entry> {
    let (flow, pressure) = (sheet.usual_flow(), sheet.working_pressure());
    let (modulus, source) = sheet.bulk_modulus.map_or((1e9, "start: mineral oil in hoses"), |modulus| (modulus, SHEET));
    let modulus = ("bulk_modulus", modulus, false, source);
    let leakage = LEAKAGE_SHARE * flow / pressure;
    let leaks = "start: half a per cent of the flow";
    let mut entries = vec![
        entry("oil_compressibility", vec![modulus]),
        entry("internal_leakage", vec![("internal_leakage", leakage, false, leaks)]),
        entry(
            "external_leakage",
            vec![
                ("external_leakage_cap", 0.2 * leakage, false, leaks),
                ("external_leakage_rod", 0.2 * leakage, false, leaks),
            ],
        ),
        entry(
            "cavitation",
            vec![
                ("vapour_pressure", -9e4, true, "mineral oil boils near 10 kPa absolute"),
                ("make_up_gain", flow / 3e3, true, "ours: full flow at 3 kPa below"),
            ],
        ),
    ];
    if sheet.drive == DriveKind::Pump {
        entries.push(entry("pump_drive", vec![("pump_flow_share", PUMP_SHARE, false, "start: usual losses")]));
        let gain = flow / 1e5;
        let source = "start: all of the flow at 1 bar";
        entries.push(entry("charge_check_valve", vec![("charge_valve_gain", gain, false, source)]));
        if matches!(sheet.actuator, Actuator::Cylinder { kind: CylinderKind::Differential, .. }) {
            let opening = ("shuttle_opening_pressure", 2e5, false, "start: usual");
            entries.push(entry("shuttle_valve", vec![opening, ("shuttle_gain", gain, false, source)]));
        }
        return entries;
    }
    entries.push(entry("orifice_flow", flow_gains(sheet)));
    if matches!(sheet.actuator, Actuator::Cylinder { kind: CylinderKind::SingleActing, .. }) {
        entries.push(entry("vented_rod_side", vec![("vent_gain", flow / 1e5, true, "ours: full flow at 1 bar")]));
    }
    let line = ("bulk_modulus", 1e9, false, "start: mineral oil in hoses");
    match sheet.drive {
        DriveKind::OpenCentre => {
            let full = sheet.command.map_or(1.0, |command| command.value());
            let gain = flow / (full * 1e6_f64.sqrt());
            entries.push(at_pump("oil_compressibility", vec![line]));
            let bypass = ("bypass_flow_gain", gain, false, "start: all of the flow at 10 bar");
            entries.push(at_pump("open_centre_bypass", vec![bypass]));
        }
        DriveKind::LoadSensing => {
            let is_given = sheet.metering_drop.is_some();
            let source = if is_given { SHEET } else { "start: usual" };
            let margin = ("compensator_margin", sheet.metering_drop.unwrap_or(7e5), is_given, source);
            let (above, source) =
                sheet.load_sensing_margin.map_or((2e6, "usual: 20 bar; see the data sheet"), |margin| (margin, SHEET));
            let standby = ("standby_pressure", 0.0, true, "none shown");
            entries.push(entry("pressure_compensation", vec![margin, standby]));
            entries.push(entry("load_check_valve", vec![("check_tightness", 1.0, true, "usual with compensators")]));
            if sheet.pump_flow.is_none() {
                return entries;
            }
            entries.push(at_pump("oil_compressibility", vec![line]));
            entries.push(at_pump(
                "load_sensing_pump",
                vec![
                    ("load_sensing_margin", above, false, source),
                    ("cut_off_pressure", pressure, true, SHEET),
                    ("regulator_gain", flow / 2e5, false, "start: all of the flow at 2 bar"),
                    ("regulator_lag", 0.05, false, "start: usual"),
                ],
            ));
        }
        _ => {}
    }
    entries
}

/// Flow gains of the valve: from its rated flow, or such that half the working pressure drives the usual flow.
fn flow_gains(sheet: &DataSheet) -> Vec<Value> {
    let full = sheet.command.map_or(1.0, |command| command.value());
    let (flow, drop, source) = match (sheet.rated, sheet.drive) {
        (Some(rated), _) => (rated.flow, rated.drop, "data sheet: rated flow"),
        (None, DriveKind::LoadSensing) => {
            (sheet.usual_flow(), 7e5, "start: the pump's flow at the compensator's margin")
        }
        (None, DriveKind::OpenCentre) => (sheet.usual_flow(), 1e6, "start: the pump's flow at 10 bar"),
        (None, _) => (sheet.usual_flow(), 0.5 * sheet.working_pressure(), "start: a stroke in two seconds"),
    };
    let gain = flow / (full * drop.sqrt());
    let single = matches!(sheet.actuator, Actuator::Cylinder { kind: CylinderKind::SingleActing, .. });
    let rod = if single { (0.0, true, "no oil on the rod side") } else { (gain, false, source) };
    vec![("flow_gain_cap", gain, false, source), ("flow_gain_rod", rod.0, rod.1, rod.2)]
}
