//! Converts the command line to a data sheet in SI units.

use std::f64::consts::TAU;

use excavator_bags::map::Dimension;
use excavator_model::template::{Actuator, CylinderKind, DataSheet, DriveKind, Load, RatedFlow, ValveCommand};

use super::number;
use crate::cli::{DriveChoice, NewModelArguments};
use crate::error::VerbError;

/// The data sheet of the arguments.
pub fn data_sheet(arguments: &NewModelArguments) -> Result<DataSheet, VerbError> {
    let pressure = |option, text: &String| number::of(option, text, Dimension::Pressure, "70 bar");
    let flow = |option, text: &String| number::of(option, text, Dimension::Flow, "23 l/min");
    let rated = match &arguments.rated_flow {
        None => None,
        Some(text) => Some(RatedFlow {
            flow: flow("--rated-flow", text)?,
            drop: pressure("--rated-drop", &arguments.rated_drop)?,
        }),
    };
    let command = match arguments.command.as_deref().map(|text| number::command("--command", text)).transpose()? {
        None => None,
        Some((area, Dimension::Area)) => Some(ValveCommand::Area(area)),
        Some((volts, Dimension::Voltage)) => Some(ValveCommand::Volts(volts)),
        Some((amperes, Dimension::Current)) => Some(ValveCommand::Amperes(amperes)),
        Some((share, _)) => Some(ValveCommand::Share(share)),
    };
    Ok(DataSheet {
        name: word("--name", &arguments.name)?,
        part: word("--part", &arguments.part)?,
        drive: drive(arguments.drive),
        actuator: actuator(arguments)?,
        load: load(arguments)?,
        command,
        rated,
        supply_pressure: arguments.supply.as_ref().map(|text| pressure("--supply", text)).transpose()?,
        pump_flow: arguments.pump_flow.as_ref().map(|text| flow("--pump-flow", text)).transpose()?,
        dead_volumes: arguments.dead_volume.as_deref().map(volumes).transpose()?,
        bulk_modulus: arguments.bulk_modulus.as_ref().map(|text| pressure("--bulk-modulus", text)).transpose()?,
        load_sensing_margin: arguments.margin.as_ref().map(|text| pressure("--margin", text)).transpose()?,
        metering_drop: arguments.metering_drop.as_ref().map(|text| pressure("--metering-drop", text)).transpose()?,
    })
}

/// One volume for both sides, or one for each.
fn volumes(text: &str) -> Result<[f64; 2], VerbError> {
    let one = |text: &str| number::other("--dead-volume", text, "m3", "50 cm3, 45 cm3");
    match text.split_once([',', ';', '/']).filter(|(cap, _)| cap.contains(|c: char| c.is_ascii_alphabetic())) {
        Some((cap, rod)) => Ok([one(cap)?, one(rod)?]),
        None => one(text).map(|volume| [volume; 2]),
    }
}

/// A name that is valid in a model file and in the names of signals.
fn word(option: &str, text: &str) -> Result<String, VerbError> {
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !text.is_empty() && text.chars().all(fits) {
        return Ok(text.to_string());
    }
    Err(VerbError::NewModel(format!("{option} \"{text}\" is no word of letters, digits, - and _")))
}

fn drive(choice: Option<DriveChoice>) -> DriveKind {
    match choice {
        Some(DriveChoice::OpenCentre) => DriveKind::OpenCentre,
        Some(DriveChoice::LoadSensing) => DriveKind::LoadSensing,
        Some(DriveChoice::Pump) => DriveKind::Pump,
        Some(DriveChoice::Force) => DriveKind::Force,
        Some(DriveChoice::ImposedMotion) => DriveKind::ImposedMotion,
        Some(DriveChoice::Valve) | None => DriveKind::Valve,
    }
}

fn actuator(arguments: &NewModelArguments) -> Result<Actuator, VerbError> {
    if let Some(volume) = &arguments.motor {
        let displacement = number::other("--motor", volume, "m3", "50 cm3")? / TAU;
        let turns = arguments.gear.unwrap_or(1.0);
        let ratio = match &arguments.drum {
            None => turns,
            Some(radius) => turns / number::of("--drum", radius, Dimension::Length, "150 mm")?,
        };
        return Ok(Actuator::Motor { displacement, ratio });
    }
    let Some(cylinder) = &arguments.cylinder else {
        return Err(VerbError::NewModel(
            "say what is driven: --cylinder \"16/10 x 100\" (bore, rod and stroke in mm) or --motor \"50 cm3\" (volume of a turn)".to_string(),
        ));
    };
    let [bore, rod, stroke] = number::plain::<3>("--cylinder", cylinder, "16/10 x 100")?.map(|length| 1e-3 * length);
    if rod >= bore {
        return Err(VerbError::NewModel(format!(
            "--cylinder \"{cylinder}\": the rod of {:.1} mm does not fit the bore of {:.1} mm; say BORE/ROD x STROKE",
            1e3 * rod,
            1e3 * bore
        )));
    }
    let kind = match (arguments.double_rod, arguments.single_acting) {
        (true, _) => CylinderKind::DoubleRod,
        (_, true) => CylinderKind::SingleActing,
        _ => CylinderKind::Differential,
    };
    Ok(Actuator::Cylinder { bore, rod, stroke, kind })
}

fn load(arguments: &NewModelArguments) -> Result<Load, VerbError> {
    let inertia =
        || arguments.inertia.as_deref().map(|text| number::other("--inertia", text, "kg m2", "40 kg m2")).transpose();
    if let Some(link) = &arguments.link {
        let [foot_arm, rod_arm, pin_length] =
            number::plain::<3>("--link", link, "1100, 330, 1100")?.map(|length| 1e-3 * length);
        let moment = arguments.gravity_moment.as_deref();
        return Ok(Load::Link {
            foot_arm,
            rod_arm,
            pin_length,
            inertia: inertia()?.ok_or_else(|| missing("its moment of inertia (--inertia \"230 kg m2\")"))?,
            gravity_moment: moment
                .map(|text| number::other("--gravity-moment", text, "kg m", "190 kg m"))
                .transpose()?
                .ok_or_else(|| {
                    missing("mass times distance of its centre of gravity (--gravity-moment \"190 kg m\")")
                })?,
            mirrored: arguments.mirrored,
        });
    }
    if let Some(mass) = &arguments.mass {
        let mass = number::other("--mass", mass, "kg", "5 kg")?;
        return Ok(Load::Mass { mass: Some(mass), slope: slope_sine(arguments.slope) });
    }
    match (inertia()?, &arguments.motor) {
        (Some(inertia), Some(_)) => Ok(Load::Rotor {
            inertia,
            torque: arguments
                .torque
                .as_deref()
                .map(|text| number::other("--torque", text, "N m", "735 N m"))
                .transpose()?
                .unwrap_or(0.0),
        }),
        (Some(_), None) => Err(missing("the pins of its cylinder (--link \"1100, 330, 1100\")")),
        (None, Some(_)) => Err(VerbError::NewModel(
            "say what the motor moves: --inertia \"40 kg m2\", or --mass \"5 kg\" with a --drum".to_string(),
        )),
        // A mass along a line that nobody knows.
        (None, None) => Ok(Load::Mass { mass: None, slope: slope_sine(arguments.slope) }),
    }
}

/// Sine of a slope in degrees; exact for horizontal and vertical.
fn slope_sine(degrees: f64) -> f64 {
    if degrees.rem_euclid(180.0) == 0.0 { 0.0 } else { degrees.to_radians().sin() }
}

fn missing(what: &str) -> VerbError {
    VerbError::NewModel(format!("this load needs {what}"))
}
