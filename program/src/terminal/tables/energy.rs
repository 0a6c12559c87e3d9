//! Prints the energy of a recording.

use comfy_table::{Cell, Table};
use excavator_identification::energy::EnergyAnalysis;
use excavator_identification::results::ByOpening;
use excavator_model::Model;
use excavator_report::{budget_label, delivered_by};
use excavator_study::numbers::number;

use super::{fixed, right, table};

/// Where the delivered energy went, as one sum: over the recording, and per cycle if the work repeats.
pub fn energy_table(model: &Model, analysis: &EnergyAnalysis) -> Table {
    let mut rows = table(&["energy", "J", "%", "J per cycle"]);
    let budget = analysis.budget(model);
    let cycle = analysis.cycle_budget(model);
    let mut add = |name: String, energy: f64, per_cycle: Option<String>| {
        rows.add_row([
            Cell::new(name),
            right(fixed(energy, 1)),
            right(fixed(100.0 * budget.share_of(energy), 1)),
            right(per_cycle.unwrap_or_else(|| "-".to_string())),
        ]);
    };
    let delivered = cycle.as_ref().map(|cycle| format!("{:.2}", cycle.mean.delivered));
    add(format!("delivered by the {}", delivered_by(model)), budget.delivered, delivered);
    for line in &budget.lines {
        let per_cycle = cycle.as_ref().and_then(|cycle| cycle.line(line)).map(|(mean, deviation)| match deviation {
            Some(deviation) => format!("{mean:.2} ± {deviation:.2}"),
            None => format!("{mean:.2}"),
        });
        add(format!("  {}", budget_label(line)), line.energy, per_cycle);
    }
    rows
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
