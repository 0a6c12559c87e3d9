//! What steady stretches tell of a drive, row by row, for terminal and page.

use excavator_identification::characterisation::{Characterisation, DriveCurve, Estimate};
use excavator_model::display::PressureUnit;

use super::leakage_unit;

/// A quantity in the unit that people use.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveRow {
    /// What it is.
    pub what: String,
    /// Value and standard error, in `unit`.
    pub estimate: Estimate,
    /// Unit for people; empty for a pure number.
    pub unit: String,
}

/// Null, dead zones, gains and leakage of a valve, or the losses of a pump; and the stops. Without what the recordings do not show.
pub fn drive_rows(one: &Characterisation) -> Vec<DriveRow> {
    let (factor, input_unit) = one.unit.for_people();
    let (leak_factor, leak_unit) = leakage_unit();
    let mut rows = Vec::new();
    let mut row = |what: String, found: Option<Estimate>, factor: f64, unit: &str| {
        rows.extend(found.map(|estimate| DriveRow { what, estimate: estimate.scaled(factor), unit: unit.to_string() }));
    };
    match &one.drive {
        Ok(DriveCurve::Valve(valve)) => {
            row("null of the valve".into(), Some(valve.null), factor, input_unit);
            for (way, zone) in ["extending", "retracting"].iter().zip(valve.dead_zones) {
                row(format!("dead zone {way}, steady"), zone, factor, input_unit);
            }
            for (side, gain) in ["cap", "rod"].iter().zip(valve.gains) {
                row(format!("gain of the {side} side, steady"), gain, 1.0, one.unit.flow_gain());
            }
            let shown = PressureUnit::shown();
            let margin = valve.compensator_margin;
            row("drop that the compensator leaves".into(), margin, shown.factor(), shown.symbol());
            row("standby pressure of the pump".into(), valve.standby_pressure, shown.factor(), shown.symbol());
            row("leakage past the piston, steady".into(), valve.leakage, leak_factor, &leak_unit);
        }
        Ok(DriveCurve::Pump(pump)) => {
            row("flow of the pump over its flow without losses".into(), Some(pump.share), 1.0, "-");
            row("leakage between both sides".into(), Some(pump.leakage), leak_factor, &leak_unit);
        }
        Err(_) => (),
    }
    for (end, stop) in ["retracted", "extended"].iter().zip(one.stops) {
        row(format!("stop of the {end} rod"), stop, 1e3, "mm");
    }
    rows
}
