//! Five questions, for users who do not know the options.

use std::io::{BufRead, Write};

use clap::ValueEnum;

use crate::cli::{DriveChoice, NewModelArguments};
use crate::error::VerbError;

/// Fills the five answers into the arguments. An empty answer takes the example.
pub fn ask(
    mut arguments: NewModelArguments,
    from: &mut impl BufRead,
    to: &mut impl Write,
) -> Result<NewModelArguments, VerbError> {
    let mut ask = |question: &str, example: &str| question_answer(from, to, question, example);
    let drives = "What drives it: valve, open-centre, load-sensing, pump, force, imposed-motion?";
    let drive = loop {
        if let Ok(drive) = DriveChoice::from_str(&ask(drives, "valve")?, true) {
            break drive;
        }
    };
    arguments.drive = Some(drive);
    if arguments.cylinder.is_none() && arguments.motor.is_none() {
        let actuator = ask("Cylinder (bore/rod x stroke in mm) or motor (volume of a turn)?", "40/25 x 300")?;
        if actuator.contains('/') {
            arguments.cylinder = Some(actuator);
        } else {
            arguments.motor = Some(actuator);
        }
    }
    if arguments.mass.is_none() && arguments.inertia.is_none() && arguments.link.is_none() {
        let (question, example) = match arguments.motor {
            None => ("What mass does it move along its line? (--link says an arm)", "100 kg"),
            Some(_) => ("What inertia does it turn, or what mass does it move?", "40 kg m2"),
        };
        let load = ask(question, example)?;
        if load.contains("m2") || load.contains("m²") || load.contains("m^2") {
            arguments.inertia = Some(load);
        } else {
            arguments.mass = Some(load);
        }
    }
    let has_valve = matches!(drive, DriveChoice::Valve | DriveChoice::OpenCentre | DriveChoice::LoadSensing);
    if has_valve && arguments.command.is_none() {
        arguments.command = Some(ask("At which input is its valve fully open (V, mA, mm2, %)?", "10 V")?);
    }
    match drive {
        DriveChoice::Valve | DriveChoice::Pump if arguments.supply.is_none() => {
            arguments.supply = Some(ask("Pressure of the supply (for a pump drive, of the charge line)?", "70 bar")?);
        }
        DriveChoice::OpenCentre | DriveChoice::LoadSensing if arguments.pump_flow.is_none() => {
            arguments.pump_flow = Some(ask("Largest flow of the pump?", "23 l/min")?);
        }
        _ => {}
    }
    if drive == DriveChoice::Pump && arguments.pump_flow.is_none() {
        arguments.pump_flow = Some(ask("Flow of the pump at full speed and displacement?", "16 l/min")?);
    }
    Ok(arguments)
}

fn question_answer(
    from: &mut impl BufRead,
    to: &mut impl Write,
    question: &str,
    example: &str,
) -> Result<String, VerbError> {
    let broken = |error: std::io::Error| VerbError::NewModel(format!("no answer: {error}"));
    write!(to, "{question} [{example}] ").and_then(|()| to.flush()).map_err(broken)?;
    let mut answer = String::new();
    if from.read_line(&mut answer).map_err(broken)? == 0 {
        return Err(VerbError::NewModel("no answer: the input has ended".to_string()));
    }
    let answer = answer.trim();
    Ok(if answer.is_empty() { example } else { answer }.to_string())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn answered(answers: &str) -> Result<NewModelArguments, VerbError> {
        ask(NewModelArguments::default(), &mut answers.as_bytes(), &mut Vec::new())
    }

    #[test]
    fn five_answers_say_what_options_say() {
        let bench = answered("valve\n16/10 x 100\n5 kg\n5 V\n70 bar\n").unwrap();
        assert_eq!(bench.drive, Some(DriveChoice::Valve));
        assert_eq!(bench.cylinder.as_deref(), Some("16/10 x 100"));
        assert_eq!(bench.mass.as_deref(), Some("5 kg"));
        let motor = answered("what?\npump\n50 cm3\n\n20 bar\n\n").unwrap();
        assert_eq!((motor.motor.as_deref(), motor.inertia.as_deref()), (Some("50 cm3"), Some("40 kg m2")));
        assert_eq!(motor.pump_flow.as_deref(), Some("16 l/min"));
        assert!(answered("valve\n").is_err());
    }
}
