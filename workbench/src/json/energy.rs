//! The energy of a recording.

use excavator_identification::energy::{EnergyAnalysis, MissingPower, PlaceJudgement, Regime, Totals, missing_power};
use excavator_model::{Model, site_name};
use serde_json::{Map, Value, json};

use super::finite;

/// Result of `energy`.
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
