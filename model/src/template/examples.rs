//! Example machines for each drive, actuator and unit of input that no built-in model covers.

use super::{Actuator, CylinderKind, DataSheet, DriveKind, Load, ValveCommand, model_text};
use crate::Model;
use crate::document::parse;
use crate::effects::Catalogue;

/// Models from example data sheets: a pump-driven cylinder of unequal areas and one of equal areas, a motor on a valve, a
/// load-sensing axis, a single-acting cylinder. The valves of the last three and of three more have an orifice area, a voltage, a
/// current or a share as input.
pub fn examples() -> Vec<Model> {
    let texts = sheets().into_iter().filter_map(|sheet| Some((model_text(&sheet).ok()?, sheet.name)));
    texts.filter_map(|(text, name)| parse(&name, &text, &Catalogue::built_in()).ok()).collect()
}

fn sheets() -> Vec<DataSheet> {
    let cylinder = |bore: f64, kind| Actuator::Cylinder { bore, rod: 0.6 * bore, stroke: 0.5, kind };
    let motor = Actuator::Motor { displacement: 8e-6, ratio: 10.0 };
    let sheet = |name: &str, drive, actuator, supply: f64| DataSheet {
        name: name.to_string(),
        part: "axis".to_string(),
        drive,
        actuator,
        load: Load::Mass { mass: Some(500.0), slope: 0.5 },
        command: Some(ValveCommand::Area(1.15e-4)),
        rated: None,
        supply_pressure: Some(supply),
        pump_flow: Some(3e-4),
        dead_volumes: None,
        bulk_modulus: None,
        load_sensing_margin: None,
        metering_drop: None,
    };
    let rotor = Load::Rotor { inertia: 40.0, torque: 50.0 };
    let with_motor = |name: &str, drive, supply| DataSheet { load: rotor, ..sheet(name, drive, motor, supply) };
    let with_command = |command, sheet: DataSheet| DataSheet { command: Some(command), ..sheet };
    let single_acting = cylinder(0.05, CylinderKind::SingleActing);
    let differential = cylinder(0.08, CylinderKind::Differential);
    let (volts, milliamperes) = (ValveCommand::Volts(10.0), ValveCommand::Amperes(0.02));
    vec![
        sheet("pump-driven", DriveKind::Pump, differential, 2e6),
        sheet("pump-driven-double-rod", DriveKind::Pump, cylinder(0.08, CylinderKind::DoubleRod), 2e6),
        with_motor("motor", DriveKind::Valve, 1e7),
        DataSheet { pump_flow: Some(4e-4), ..sheet("load-sensing", DriveKind::LoadSensing, differential, 2e7) },
        sheet("single-acting", DriveKind::Valve, single_acting, 1e7),
        with_command(volts, sheet("in-volts", DriveKind::OpenCentre, differential, 1e7)),
        with_command(milliamperes, sheet("in-amperes", DriveKind::OpenCentre, differential, 1e7)),
        with_command(ValveCommand::Share(1.0), sheet("as-a-share", DriveKind::OpenCentre, differential, 1e7)),
        with_command(volts, with_motor("motor-in-volts", DriveKind::OpenCentre, 1e7)),
        with_motor("pump-driven-motor", DriveKind::Pump, 2e6),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{oddities, trial};

    #[test]
    fn every_data_sheet_makes_a_machine_that_moves() {
        let models = examples();
        assert_eq!(models.len(), sheets().len());
        for model in models {
            let moved = trial(&model, 0).ok().flatten();
            assert!(
                moved.is_some_and(|trial| trial.speeds.iter().any(|speed| *speed > 1e-3)),
                "{}",
                model.machine.name
            );
            let odd: Vec<String> = oddities(&model).iter().map(ToString::to_string).collect();
            println!("{}: {odd:?}", model.machine.name);
        }
    }
}
