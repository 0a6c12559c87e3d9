//! The machine part of a new model file.

use std::fmt::Write;

use super::{Actuator, CylinderKind, DataSheet, DriveKind, Load, MissingFromDataSheet, ValveCommand};

/// Volume of hoses and ports as a fraction of the stroke volume.
const DEAD_SHARE: f64 = 0.1;

/// The text before the first effect.
pub(super) fn text(sheet: &DataSheet) -> Result<String, MissingFromDataSheet> {
    let mut text = format!(
        "# {}\n#\n# Numbers are in SI units. Those with `known = true` and the machine's own are taken as they are; `identify` finds the\n\
         # others, and their values here are starts. `excavator model check FILE` tries the file.\n\nformat = 2\n\n\
         [machine]\nname = \"{}\"\ndescription = \"{}\"\ngravity = {{ value = 9.81, unit = \"m/s2\" }}\n\n",
        sentence(sheet),
        sheet.name,
        sentence(sheet)
    );
    text += "# How the joint moves.\n[machine.mechanism]\n";
    text += match sheet.load {
        Load::Mass { .. } => "kind = \"linear_load\"\n\n",
        Load::Rotor { .. } => "kind = \"rotor\"\n\n",
        Load::Link { .. } => {
            "kind = \"single_link\"\n# The link hangs straight down where this and the joint's angle add up to zero.\n\
             base_angle = { value = 0.0, unit = \"rad\", source = \"to be set\" }\n\n"
        }
    };
    text += &supply(sheet)?;
    let _ = write!(text, "[[machine.cylinders]]\nname = \"{}\"\n", sheet.part);
    text += &actuator(sheet)?;
    Ok(text)
}

fn sentence(sheet: &DataSheet) -> String {
    let drive = match sheet.drive {
        DriveKind::Valve => "on a valve with constant supply pressure",
        DriveKind::OpenCentre => "on an open-centre valve with a pump of constant flow",
        DriveKind::LoadSensing => "on a compensated valve with a load-sensing pump",
        DriveKind::Pump => "on a pump of its own in a closed circuit",
        DriveKind::Force => "driven by a measured force",
        DriveKind::ImposedMotion => "moved by a testing machine",
    };
    let actuator = match sheet.actuator {
        Actuator::Cylinder { bore, rod, stroke, .. } => {
            format!("Cylinder {:.0}/{:.0} mm, stroke {:.0} mm,", 1e3 * bore, 1e3 * rod, 1e3 * stroke)
        }
        Actuator::Motor { displacement, .. } => {
            format!("Hydraulic motor of {:.1} cm3 per turn", 1e6 * displacement * std::f64::consts::TAU)
        }
    };
    format!("{actuator} {drive}")
}

/// A constant, as a line of TOML.
fn constant(key: &str, value: f64, unit: &str, source: &str) -> String {
    format!("{key} = {{ value = {}, unit = \"{unit}\", source = \"{source}\" }}\n", short(value))
}

/// Formats a number with six digits. TOML requires a point or an exponent in it.
pub(super) fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) { format!("{rounded:?}") } else { format!("{rounded:e}") }
}

const SHEET: &str = "data sheet";

fn supply(sheet: &DataSheet) -> Result<String, MissingFromDataSheet> {
    let tank = constant("tank_pressure", 0.0, "Pa", "open to the air; a recording that measures it overrides this");
    let pressure = |what| sheet.supply_pressure.ok_or(MissingFromDataSheet { what });
    let source = |kind: &str, pressure: f64| {
        format!("# {kind}\n[machine.supply]\nkind = \"pressure_source\"\n")
            + &constant("pressure", pressure, "Pa", SHEET)
            + &tank
            + "\n"
    };
    Ok(match sheet.drive {
        DriveKind::Valve => source(
            "A supply of constant pressure. A recording that measures it overrides the value.",
            pressure("the pressure of its supply (--supply, as in --supply \"70 bar\")")?,
        ),
        DriveKind::LoadSensing if sheet.pump_flow.is_none() => source(
            "The pump's flow is not known, so its pressure counts as constant: the compensators keep it from the valve.",
            pressure("the cut-off pressure of its pump (--supply, as in --supply \"210 bar\")")?,
        ),
        DriveKind::Pump => {
            source("The charge line that fills the closed circuit.", sheet.supply_pressure.unwrap_or(FILLED_FROM_TANK))
        }
        DriveKind::OpenCentre | DriveKind::LoadSensing => {
            let (flow, from) = sheet.largest_pump_flow();
            "# The pump and the oil between it and the valves. The flow is the most that the pump gives.\n[machine.supply]\n\
             kind = \"pump_line\"\n"
                .to_string()
                + &constant("volume", LINE_TIME * flow, "m3", "estimated: a third of a second of flow")
                + &constant("flow", flow, "m3/s", from)
                + &tank
                + "\n"
        }
        DriveKind::Force | DriveKind::ImposedMotion => "[machine.supply]\nkind = \"none\"\n\n".to_string(),
    })
}

/// Charge pressure of a closed circuit that make-up valves fill from the tank, Pa.
const FILLED_FROM_TANK: f64 = 1e5;

/// Volume of the pump line divided by the pump flow, s: that of \[A\] Table 1.
const LINE_TIME: f64 = 0.32;

fn actuator(sheet: &DataSheet) -> Result<String, MissingFromDataSheet> {
    match sheet.actuator {
        Actuator::Motor { .. } if matches!(sheet.drive, DriveKind::Force | DriveKind::ImposedMotion) => {
            Err(MissingFromDataSheet {
                what: "a cylinder, since motors are driven by oil; an axis with a measured torque is a cylinder in other units: \
                       1 rad as 1 m, 1 N m as 1 N, 1 kg m2 as 1 kg (--cylinder and --mass)",
            })
        }
        Actuator::Motor { displacement, ratio } => {
            let unit = if matches!(sheet.load, Load::Mass { .. }) { "rad/m" } else { "-" };
            let estimated = [MOTOR_TURNS * std::f64::consts::TAU * displacement; 2];
            let [cap, rod] = sheet.dead_volumes.unwrap_or(estimated);
            let source = if sheet.dead_volumes.is_some() { SHEET } else { "estimated: oil between valve and motor" };
            let text = "# The motor's shaft turns the load through a gear. Displacement and velocity of a motor are those of its shaft, in rad\n\
                        # and rad/s; forces are torques on the shaft.\n[machine.cylinders.linkage]\nkind = \"gear\"\n"
                .to_string()
                + &constant("ratio", ratio, unit, SHEET)
                + "\n[machine.cylinders.motor]\n"
                + &constant("displacement", displacement, "m3/rad", "data sheet: volume of a turn divided by 2 pi")
                + &constant("cap_volume", cap, "m3", source)
                + &constant("rod_volume", rod, "m3", source);
            Ok(text + &drive(sheet)?)
        }
        Actuator::Cylinder { stroke, kind, .. } => {
            let mut text = "# Displacement counts from mid-stroke, + with the rod extending.\n".to_string()
                + &constant("stroke", stroke, "m", SHEET)
                + &linkage(&sheet.load);
            let [cap, rod] = sheet.areas();
            let areas = constant("cap_area", cap, "m2", "from the bore")
                + &constant("rod_area", rod, "m2", "from bore and rod");
            match sheet.drive {
                DriveKind::Force => {}
                DriveKind::ImposedMotion => text += &format!("\n[machine.cylinders.imposed_motion]\n{areas}"),
                _ => {
                    let estimated = [cap, rod].map(|area| DEAD_SHARE * area * stroke);
                    let dead = sheet.dead_volumes.unwrap_or(estimated);
                    let source =
                        if sheet.dead_volumes.is_some() { SHEET } else { "estimated: a tenth of the stroke's" };
                    if kind == CylinderKind::SingleActing {
                        text += "\n# The rod side holds air: the effect vented_rod_side keeps it at tank pressure.";
                    }
                    text += "\n[machine.cylinders.chambers]\n";
                    text += &areas;
                    text += &constant("cap_dead_volume", dead[0], "m3", source);
                    text += &constant("rod_dead_volume", dead[1], "m3", source);
                    text += &drive(sheet)?;
                }
            }
            Ok(text)
        }
    }
}

/// Oil volume on each side of a motor, in turns of its shaft.
const MOTOR_TURNS: f64 = 4.0;

fn linkage(load: &Load) -> String {
    let start = "\n[machine.cylinders.linkage]\n";
    match *load {
        Load::Link { foot_arm, rod_arm, pin_length, mirrored, .. } => {
            format!("{start}kind = \"triangle\"\n")
                + &constant("foot_arm", foot_arm, "m", SHEET)
                + &constant("rod_arm", rod_arm, "m", SHEET)
                + &constant("mid_stroke_length", pin_length, "m", SHEET)
                + &format!("mirrored = {mirrored}\n")
        }
        Load::Mass { .. } | Load::Rotor { .. } => format!("{start}kind = \"direct\"\n"),
    }
}

fn drive(sheet: &DataSheet) -> Result<String, MissingFromDataSheet> {
    if sheet.drive == DriveKind::Pump {
        let (flow, from) = sheet.largest_pump_flow();
        return Ok("# The recording's orifice_area is the flow of the pump without losses: speed times displacement, in m3/s.\n".to_string()
            + &constant("maximum_pump_flow", flow, "m3/s", from));
    }
    let command = sheet.command.ok_or(MissingFromDataSheet {
        what: "the input at which its valve is fully open (--command, as in --command \"10 V\" or --command \"115 mm2\")",
    })?;
    Ok(match command {
        ValveCommand::Area(area) => constant("maximum_orifice_area", area, "m2", SHEET),
        ValveCommand::Volts(volts) => constant("full_command", volts, "V", SHEET),
        ValveCommand::Amperes(amperes) => constant("full_command", amperes, "A", SHEET),
        ValveCommand::Share(share) => constant("full_command", share, "-", SHEET),
    })
}
