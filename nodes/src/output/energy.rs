//! The energy of a recording, for people and for programs.

use comfy_table::{Cell, Table};
use excavator_identification::energy::{EnergyAnalysis, MissingPower, PlaceJudgement, Regime, Totals, missing_power};
use excavator_model::Model;
use excavator_model::effects::ActsOn;
use excavator_model::site_name;
use serde_json::{Map, Value, json};

use super::json::finite;
use super::tables::{fixed, number, right, table};

/// Where the energy went: over the recording, and per cycle where the work repeats.
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
                // A sum or difference of others: its deviation is not the sum or difference of theirs.
                (_, _, true) => format!("{mean:.2}"),
                (_, deviation, false) => format!("{mean:.2} ± {:.2}", deviation.abs()),
            })),
        ]);
    }
    rows
}

/// What 100 % is: the energy of the pump, or what was supplied where there is no pump.
fn input(model: &Model, totals: &Totals) -> f64 {
    let supplied = totals.cylinders.iter().map(|cylinder| cylinder.supplied.abs()).sum::<f64>();
    if matches!(model.machine.supply, excavator_model::machine::Supply::PumpLine(_)) { totals.pump } else { supplied }
}

/// What, how much in J, and whether it is a sum or difference of others.
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

/// The ledger, equation by equation.
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

/// All of it.
pub fn energy_json(model: &Model, analysis: &EnergyAnalysis) -> Value {
    let pump_line = analysis.pump_line(model).map(|line| {
        let sections: Map<String, Value> = line
            .sections
            .iter()
            .map(|s| (s.cylinder.clone(), json!({"metering_loss": s.metering_loss, "into_cylinder": s.into_cylinder})))
            .collect();
        json!({"pump": line.pump, "bypass_loss": line.bypass_loss, "sections": sections, "stored": line.stored, "residual": line.residual})
    });
    let phases: Map<String, Value> = analysis
        .traces
        .cylinders
        .iter()
        .filter_map(|trace| {
            let phase = trace.phase.as_ref()?;
            let lag = |lag: Option<f64>| lag.map_or(Value::Null, finite);
            Some((
                trace.name.clone(),
                json!({"frequency": phase.frequency, "analytical": lag(phase.analytical), "numerical": lag(phase.numerical),
                       "numerical_behind_analytical": lag(phase.numerical_behind_analytical)}),
            ))
        })
        .collect();
    let missing: Vec<Value> = missing_power(model, analysis).iter().map(missing_power_json).collect();
    json!({
        "source": analysis.source,
        "samples": analysis.samples,
        "duration": analysis.duration,
        "gaps": analysis.gaps,
        "energy": totals_json(model, &analysis.totals, true),
        "cycle": analysis.cycle.as_ref().map(|cycle| json!({
            "period": cycle.period,
            "count": cycle.count,
            "mean": totals_json(model, &cycle.mean, true),
            "standard_deviation": totals_json(model, &cycle.deviation, false),
        })),
        "pump_line": pump_line,
        "phase_delays_degrees": phases,
        "ledger": analysis.places.iter().map(|place| place_json(model, place)).collect::<Vec<_>>(),
        "ledger_closes": analysis.is_explained(),
        "missing_power": missing,
        "simulation_failed": analysis.simulation_failed,
        "parameters_have_errors": analysis.parameters_have_errors,
    })
}

/// Power that is missing at one equation.
pub fn missing_power_json(missing: &MissingPower) -> Value {
    json!({
        "cylinder": missing.cylinder, "equation": missing.equation, "condition": missing.regime.name(),
        "mean_power": finite(missing.mean), "size": finite(missing.size), "peak_power": finite(missing.peak),
        "band": finite(missing.band), "sentence": missing.sentence,
    })
}

fn place_json(model: &Model, place: &PlaceJudgement) -> Value {
    let regimes: Map<String, Value> = Regime::ALL
        .iter()
        .zip(&place.regimes)
        .filter(|(_, judged)| judged.windows > 0)
        .map(|(regime, judged)| {
            let numbers = json!({
                "windows": judged.windows, "mean": finite(judged.mean), "peak": finite(judged.peak), "size": finite(judged.size),
                "noise": finite(judged.noise), "parameters": finite(judged.parameters), "flow": finite(judged.flow),
                "band": finite(judged.band), "explained": judged.is_explained(),
            });
            (regime.name().to_string(), numbers)
        })
        .collect();
    json!({"equation": place.place.equation(model), "closes": place.is_explained(), "windows_outside": place.share_outside, "conditions": regimes})
}

/// Sums and differences of others only where `derived`: those of standard deviations mean nothing.
fn totals_json(model: &Model, totals: &Totals, derived: bool) -> Value {
    let cylinders: Map<String, Value> = model
        .machine
        .cylinders
        .iter()
        .zip(&totals.cylinders)
        .enumerate()
        .map(|(index, (cylinder, own))| {
            let mut numbers = json!({
                "supplied": own.supplied, "kinetic": own.kinetic, "potential": own.potential,
                "cap_internal": own.cap_internal, "rod_internal": own.rod_internal,
                "metering_loss": own.metering_loss,
            });
            if derived {
                numbers["stored"] = json!(own.stored());
                numbers["dissipation"] = json!(totals.dissipation(index));
                numbers["residual"] = json!(totals.residual(index));
            }
            (cylinder.name.clone(), numbers)
        })
        .collect();
    let effects: Vec<Value> = totals
        .effects
        .iter()
        .filter(|effect| effect.has_power)
        .map(|effect| {
            json!({"effect": effect.effect, "at": site_name(&model.machine, effect.site),
                   "into_cylinders": effect.into_cylinders, "into_pump_line": effect.into_pump_line})
        })
        .collect();
    json!({"duration": totals.duration, "pump": totals.pump, "pump_line": totals.pump_line, "cylinders": cylinders, "effects": effects})
}
