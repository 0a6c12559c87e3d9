//! Compares the units of a map with those of the machine.

use excavator_bags::MappedUnit;
use excavator_bags::map::{Dimension, SignalKind, SignalName};
use excavator_model::machine::Machine;

/// A signal that the map gives in another dimension than the machine has it in.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{source_name}: {signal} is mapped in {unit}, {} {found}, but {machine} takes it in {}, {} {wanted}: correct `unit` in the map, or \
     give `scale`, like \"0.1 {}/{unit}\"",
    article(*found), in_machine(*wanted), article(*wanted), in_machine(*wanted)
)]
pub struct MappedUnitError {
    /// The recording.
    pub source_name: String,
    /// The signal.
    pub signal: SignalName,
    /// Unit in the map or in the data.
    pub unit: &'static str,
    /// What the values measure.
    pub found: Dimension,
    /// The machine.
    pub machine: String,
    /// What the machine takes.
    pub wanted: Dimension,
}

/// Checks that every mapped signal measures what the machine has under this name. A signal whose unit nobody states is taken in the
/// unit of the machine.
///
/// # Errors
/// [`MappedUnitError`], the first one.
pub fn check(source_name: &str, machine: &Machine, mapped: &[MappedUnit]) -> Result<(), MappedUnitError> {
    for MappedUnit { signal, unit, dimension } in mapped {
        if let Some(wanted) = dimension_in(machine, signal).filter(|wanted| wanted != dimension) {
            return Err(MappedUnitError {
                source_name: source_name.to_string(),
                signal: signal.clone(),
                unit,
                found: *dimension,
                machine: machine.name.clone(),
                wanted,
            });
        }
    }
    Ok(())
}

/// What a machine measures as this signal; `None` for a signal that it does not have.
fn dimension_in(machine: &Machine, signal: &SignalName) -> Option<Dimension> {
    let Some(name) = &signal.cylinder else { return Some(signal.kind.dimension()) };
    let cylinder = machine.cylinders.iter().find(|cylinder| cylinder.name == *name)?;
    match signal.kind {
        SignalKind::OrificeArea | SignalKind::OrificeCommand => {
            Some(Dimension::of_command(cylinder.chambers?.drive.command_unit()))
        }
        SignalKind::Displacement if cylinder.is_motor() => Some(Dimension::Angle),
        SignalKind::Velocity if cylinder.is_motor() => Some(Dimension::RotationalSpeed),
        kind => Some(kind.dimension()),
    }
}

/// The unit in which people write what a machine takes.
fn in_machine(dimension: Dimension) -> &'static str {
    if dimension == Dimension::Area { "mm2" } else { dimension.si_unit() }
}

fn article(dimension: Dimension) -> &'static str {
    if dimension.to_string().starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

    fn mapped(signal: &str, unit: &'static str, dimension: Dimension) -> [MappedUnit; 1] {
        [MappedUnit { signal: signal.parse().unwrap(), unit, dimension }]
    }

    #[test]
    fn every_signal_has_the_dimension_of_its_machine() {
        let machine = built_in("zx30u-arm").unwrap().machine;
        for (signal, unit, dimension) in [
            ("arm.orifice_area", "mm2", Dimension::Area),
            ("arm.orifice_command", "m2", Dimension::Area),
            ("arm.displacement", "mm", Dimension::Length),
            ("boom.orifice_command", "V", Dimension::Voltage),
            ("pump_flow", "l/min", Dimension::Flow),
        ] {
            assert_eq!(check("bag", &machine, &mapped(signal, unit, dimension)), Ok(()), "{signal} {unit}");
        }
        for (signal, unit, dimension) in [
            ("arm.orifice_area", "V", Dimension::Voltage),
            ("arm.orifice_command", "%", Dimension::Number),
            ("arm.orifice_command", "mA", Dimension::Current),
            ("arm.displacement", "deg", Dimension::Angle),
            ("arm.velocity", "rpm", Dimension::RotationalSpeed),
        ] {
            let error = check("bag", &machine, &mapped(signal, unit, dimension)).unwrap_err().to_string();
            assert!(error.contains(&format!("is mapped in {unit}, a")) && error.contains("correct `unit`"), "{error}");
            assert_eq!(error.lines().count(), 1);
        }
    }
}
