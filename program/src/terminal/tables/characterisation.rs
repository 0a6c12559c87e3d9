//! Prints a characterisation.

use comfy_table::{Cell, Table};
use excavator_identification::characterisation::{Characterisation, Estimate, Refusal};
use excavator_report::{drive_rows, leakage_unit};
use excavator_study::numbers::number;

use super::{right, table};

/// All values found for a cylinder, with 95 % intervals.
pub fn characterisation_table(found: &Characterisation) -> Table {
    let mut rows = table(&["what", "value", "± 95 %", "unit"]);
    let mut row = |what: String, estimate: Estimate, unit: &str| {
        let cells = [right(number(estimate.value)), right(number(1.96 * estimate.error))];
        rows.add_row([Cell::new(what), cells[0].clone(), cells[1].clone(), Cell::new(unit)]);
    };
    let (factor, shown) = found.unit.for_people();
    for (edge, gain) in &found.gains {
        let Ok(gain) = gain else { continue };
        let (Some(first), Some(last)) = (gain.points.first(), gain.points.last()) else { continue };
        for (word, curve) in [("from closed", Some(&gain.polynomial)), ("from its edge", gain.past_edge.as_ref())] {
            let Some(curve) = curve else { continue };
            for point in if curve.degree() == 0 { vec![first] } else { vec![first, last] } {
                let x = point.opening / gain.maximum;
                let place = if curve.degree() == 0 { String::new() } else { format!(" at {:.0} %", 100.0 * x) };
                let what = format!("gain {}, opening {word}{place} (degree {})", edge.name(), curve.degree());
                row(what, Estimate { value: curve.at(x), error: curve.error_at(x) }, found.unit.flow_gain());
            }
        }
    }
    for (edge, zone) in &found.dead_zones {
        let Ok(zone) = zone else { continue };
        row(format!("dead zone {}", edge.name()), zone.dead_zone.scaled(factor), shown);
        row(format!("hysteresis {}", edge.name()), zone.hysteresis.scaled(factor), shown);
    }
    if let Ok(leakage) = &found.leakage {
        let (factor, unit) = leakage_unit();
        let sides = [("cap side", &leakage.cap), ("rod side", &leakage.rod)];
        for (name, side) in sides.iter().filter_map(|(name, side)| Some((name, side.as_ref().ok()?))) {
            row(format!("leakage pump to {name}"), side.from_pump.scaled(factor), &unit);
            row(format!("leakage {name} to tank"), side.to_tank.scaled(factor), &unit);
            row(format!("time constant {name}"), side.time_constant, "s");
            row(format!("static gain {name}"), side.static_gain, "-");
        }
    }
    drive_rows(found).into_iter().for_each(|one| row(one.what, one.estimate, &one.unit));
    if let Ok(friction) = &found.friction {
        for term in &friction.terms {
            row(format!("{}, times {}", term.effect, term.shape), term.coefficient, term.unit);
        }
        if let Some(faded) = friction.stribeck_speed {
            row("speed vs by which stribeck_friction fades".into(), faded, "m/s");
        }
        if let Some(share) = friction.load_share {
            row("load over the model's".into(), share, "-");
        }
    }
    rows
}

/// One line per reason, with the names of the values that were not found because of it.
pub fn refusals(found: &Characterisation) -> Vec<String> {
    let mut told: Vec<(Vec<String>, &Refusal)> = Vec::new();
    let mut tell = |what: String, refusal| match told.iter_mut().find(|(_, other)| *other == refusal) {
        Some((names, _)) => names.push(what),
        None => told.push((vec![what], refusal)),
    };
    for (edge, refusal) in found.gains.iter().filter_map(|(edge, gain)| Some((edge, gain.as_ref().err()?))) {
        tell(format!("gain {}", edge.name()), refusal);
    }
    for (edge, refusal) in found.dead_zones.iter().filter_map(|(edge, zone)| Some((edge, zone.as_ref().err()?))) {
        tell(format!("dead zone {}", edge.name()), refusal);
    }
    match &found.leakage {
        Err(refusal) => tell("leakage of the closed valve".into(), refusal),
        Ok(leakage) => {
            leakage.cap.as_ref().err().into_iter().for_each(|refusal| tell("leakage at the cap side".into(), refusal));
            leakage.rod.as_ref().err().into_iter().for_each(|refusal| tell("leakage at the rod side".into(), refusal));
        }
    }
    if let Err(refusal) = &found.drive {
        tell("curve of the drive".into(), refusal);
    }
    if let Err(refusal) = &found.friction {
        tell("friction".into(), refusal);
    }
    told.into_iter().map(|(names, refusal)| format!("no {}: {refusal}", names.join(", "))).collect()
}
