//! Prints the energy of a recording.

use comfy_table::{Cell, Table};
use excavator_identification::energy::{EnergyAnalysis, Totals};
use excavator_identification::results::ByOpening;
use excavator_model::Model;
use excavator_model::effects::ActsOn;
use excavator_model::site_name;
use excavator_study::numbers::number;

use super::{fixed, right, table};

/// The flow of energy: over the recording, and per cycle if the work repeats.
pub fn energy_table(model: &Model, analysis: &EnergyAnalysis) -> Table {
    let mut rows = table(&["energy", "J", "%", "J per cycle"]);
    let all = lines(model, &analysis.totals);
    let cycle = analysis.cycle.as_ref().map(|cycle| (lines(model, &cycle.mean), lines(model, &cycle.deviation)));
    let whole = input(model, &analysis.totals);
    for (index, (name, energy, _)) in all.iter().enumerate() {
        let per_cycle = cycle.as_ref().and_then(|(mean, deviation)| Some((mean.get(index)?.1, deviation.get(index)?)));
        rows.add_row([
            Cell::new(name),
            right(fixed(*energy, 1)),
            right(fixed(100.0 * energy / whole, 1)),
            right(per_cycle.map_or("-".into(), |(mean, deviation)| match deviation {
                // The deviation of a sum or difference is not the sum or difference of the deviations, so it is not shown.
                (_, _, true) => format!("{mean:.2}"),
                (_, deviation, false) => format!("{mean:.2} ± {:.2}", deviation.abs()),
            })),
        ]);
    }
    rows
}

/// The energy that counts as 100 %: that of the pump, or the supplied energy if there is no pump.
fn input(model: &Model, totals: &Totals) -> f64 {
    let supplied = totals.cylinders.iter().map(|cylinder| cylinder.supplied.abs()).sum::<f64>();
    if matches!(model.machine.supply, excavator_model::machine::Supply::PumpLine(_)) { totals.pump } else { supplied }
}

/// Label, energy in J, and whether the line is a sum or difference of others.
fn lines(model: &Model, totals: &Totals) -> Vec<(String, f64, bool)> {
    let mut lines = Vec::new();
    if matches!(model.machine.supply, excavator_model::machine::Supply::PumpLine(_)) {
        lines.push(("pump".to_string(), totals.pump, false));
        for effect in
            totals.effects.iter().filter(|e| e.acts_on != ActsOn::Valve && e.has_power && e.into_pump_line != 0.0)
        {
            lines.push((format!("  lost: {} at the pump line", effect.effect), -effect.into_pump_line, false));
        }
        lines.push(("  stored in the pump line".to_string(), totals.pump_line, false));
        lines.push(("  not explained in the pump line".to_string(), totals.pump_residual(), true));
    }
    for (index, (cylinder, own)) in model.machine.cylinders.iter().zip(&totals.cylinders).enumerate() {
        let name = &cylinder.name;
        if cylinder.chambers.is_some() {
            lines.push((format!("  lost: metering at the {name} valve"), own.metering_loss, false));
        }
        lines.push((format!("supplied to the {name}"), own.supplied, false));
        for effect in totals.effects.iter().filter(|e| e.acts_on != ActsOn::Valve && e.has_power) {
            if site_name(&model.machine, effect.site) == name {
                lines.push((format!("  lost: {} at the {name}", effect.effect), -effect.into_cylinders, false));
            }
        }
        lines.push((format!("  stored in the {name}"), own.stored(), true));
        lines.push((format!("  not explained at the {name}"), totals.residual(index), true));
    }
    lines
}

/// Mean powers of each cylinder by the sign of its opening, two rows each.
pub fn opening_table(model: &Model, analysis: &EnergyAnalysis) -> Table {
    let mut rows = table(&["opening", "s", "supplied W", "oil gains W", "links gain W", "lost W"]);
    for one in &analysis.by_opening {
        let (name, both) = (&model.machine.cylinders[one.cylinder].name, ByOpening::of(one));
        for (sign, powers) in [("positive", both.positive), ("negative", both.negative)] {
            let lost = powers.dissipation.map(|power| -power);
            let values = [powers.duration, powers.supply, powers.oil, powers.links, lost];
            let cells = values.map(|value| right(value.map_or("-".into(), |value| fixed(value, 1))));
            rows.add_row(std::iter::once(Cell::new(format!("{name} {sign}"))).chain(cells));
        }
    }
    rows
}

/// The ledger, one row per equation.
pub fn ledger_table(model: &Model, analysis: &EnergyAnalysis) -> Table {
    let mut rows = table(&["equation", "missing W (rms)", "explained W", "worst", "ledger"]);
    for place in &analysis.places {
        let always = place.regimes.first();
        let worst = place.worst();
        rows.add_row([
            Cell::new(place.place.equation(model)),
            right(always.map_or("-".into(), |regime| number(regime.size))),
            right(always.map_or("-".into(), |regime| number(regime.band))),
            Cell::new(worst.map_or(String::new(), |worst| {
                format!("{}: {} W, explained {} W", worst.regime.words(), number(worst.size), number(worst.band))
            })),
            Cell::new(if place.is_explained() { "closes" } else { "does not close" }),
        ]);
    }
    rows
}
