//! What people and programs see of a characterisation.

use comfy_table::{Cell, Table};
use excavator_identification::characterisation::{
    ChamberLeakage, Characterisation, Edge, Estimate, FrictionCurve, Polynomial, Refusal,
};
use excavator_report::leakage_unit;
use serde_json::{Map, Value, json};

use super::json::finite;
use super::tables::{number, right, table};

/// Everything that was found of a cylinder, with 95 % intervals.
pub fn characterisation_table(found: &Characterisation) -> Table {
    let mut rows = table(&["what", "value", "± 95 %", "unit"]);
    let mut row = |what: String, estimate: Estimate, unit: &str| {
        let cells = [right(number(estimate.value)), right(number(1.96 * estimate.error))];
        rows.add_row([Cell::new(what), cells[0].clone(), cells[1].clone(), Cell::new(unit)]);
    };
    for (edge, gain) in &found.gains {
        let Ok(gain) = gain else { continue };
        let (Some(first), Some(last)) = (gain.points.first(), gain.points.last()) else { continue };
        for (word, curve) in [("from closed", Some(&gain.polynomial)), ("from its edge", gain.past_edge.as_ref())] {
            let Some(curve) = curve else { continue };
            for point in if curve.degree() == 0 { vec![first] } else { vec![first, last] } {
                let x = point.opening / gain.maximum;
                let place = if curve.degree() == 0 { String::new() } else { format!(" at {:.0} %", 100.0 * x) };
                let what = format!("gain {}, opening {word}{place} (degree {})", edge.name(), curve.degree());
                row(what, Estimate { value: curve.at(x), error: curve.error_at(x) }, "m/(s sqrt(Pa))");
            }
        }
    }
    for (edge, zone) in &found.dead_zones {
        let Ok(zone) = zone else { continue };
        row(format!("dead zone {}", edge.name()), scaled(zone.dead_zone, 1e6), "mm2");
        row(format!("hysteresis {}", edge.name()), scaled(zone.hysteresis, 1e6), "mm2");
    }
    if let Ok(leakage) = &found.leakage {
        let (factor, unit) = leakage_unit();
        let sides = [("cap side", &leakage.cap), ("rod side", &leakage.rod)];
        for (name, side) in sides.iter().filter_map(|(name, side)| Some((name, side.as_ref().ok()?))) {
            row(format!("leakage pump to {name}"), scaled(side.from_pump, factor), &unit);
            row(format!("leakage {name} to tank"), scaled(side.to_tank, factor), &unit);
            row(format!("time constant {name}"), side.time_constant, "s");
            row(format!("static gain {name}"), side.static_gain, "-");
        }
    }
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

/// One line for everything that was not found, with the reason; the same reason is told once.
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
    if let Err(refusal) = &found.friction {
        tell("friction".into(), refusal);
    }
    told.into_iter().map(|(names, refusal)| format!("no {}: {refusal}", names.join(", "))).collect()
}

fn scaled(estimate: Estimate, factor: f64) -> Estimate {
    Estimate { value: factor * estimate.value, error: factor * estimate.error }
}

fn estimate(estimate: Estimate) -> Value {
    json!({"value": finite(estimate.value), "std_error": finite(estimate.error)})
}

fn polynomial(curve: &Polynomial) -> Value {
    let rows = (0..curve.covariance.nrows())
        .map(|row| curve.covariance.row(row).iter().map(|&entry| finite(entry)).collect::<Vec<Value>>());
    json!({
        "coefficients": curve.coefficients,
        "covariance": rows.collect::<Vec<_>>(),
        "degree": curve.degree(),
        "reason": curve.reason,
    })
}

fn or_refused<T>(found: &Result<T, Refusal>, of: impl Fn(&T) -> Value) -> Value {
    match found {
        Ok(found) => of(found),
        Err(refusal) => json!({"refused": refusal.to_string()}),
    }
}

fn by_edge<T>(found: &[(Edge, Result<T, Refusal>)], of: impl Fn(&T) -> Value) -> Value {
    Value::Object(found.iter().map(|(edge, one)| (edge.key().to_string(), or_refused(one, &of))).collect::<Map<_, _>>())
}

fn chamber(side: &ChamberLeakage) -> Value {
    json!({
        "from_pump": estimate(side.from_pump),
        "to_tank": estimate(side.to_tank),
        "time_constant": estimate(side.time_constant),
        "static_gain": estimate(side.static_gain),
    })
}

fn friction(curve: &FrictionCurve) -> Value {
    let terms = curve.terms.iter().map(|term| {
        json!({
            "effect": term.effect,
            "times": term.shape,
            "value": finite(term.coefficient.value),
            "std_error": finite(term.coefficient.error),
            "unit": term.unit,
        })
    });
    let points = curve.points.iter().map(|point| [finite(point.speed), finite(point.force)]);
    json!({
        "from_load_cell": curve.from_load_cell,
        "load_share": curve.load_share.map_or(Value::Null, estimate),
        "terms": terms.collect::<Vec<_>>(),
        "stribeck_speed": curve.stribeck_speed.map_or(Value::Null, estimate),
        "scatter": finite(curve.scatter),
        "reason": curve.reason,
        "speed_and_force": points.collect::<Vec<_>>(),
    })
}

/// Result of `characterise`.
pub fn characterisation_json(found: &[Characterisation]) -> Value {
    let cylinders = found.iter().map(|one| {
        let gains = by_edge(&one.gains, |gain| {
            let points = gain.points.iter().map(|point| {
                json!({
                    "opening": finite(point.opening),
                    "speed": finite(point.speed),
                    "flow": finite(point.flow),
                    "pressure_drop": finite(point.pressure_drop),
                    "gain": estimate(point.gain),
                    "gain_past_edge": point.gain_past_edge.map_or(Value::Null, estimate),
                })
            });
            json!({
                "points": points.collect::<Vec<_>>(),
                "from_closed": polynomial(&gain.polynomial),
                "from_edge": gain.past_edge.as_ref().map_or(Value::Null, polynomial),
            })
        });
        let dead_zones = by_edge(&one.dead_zones, |zone| {
            json!({
                "opening": estimate(zone.opening),
                "closing": estimate(zone.closing),
                "dead_zone": estimate(zone.dead_zone),
                "hysteresis": estimate(zone.hysteresis),
                "rate": finite(zone.rate),
                "runs": [zone.runs.0, zone.runs.1],
            })
        });
        let leakage = or_refused(&one.leakage, |leakage| {
            json!({
                "cap": or_refused(&leakage.cap, chamber),
                "rod": or_refused(&leakage.rod, chamber),
                "bulk_modulus": finite(leakage.bulk_modulus),
                "holds": leakage.holds.len(),
            })
        });
        json!({
            "name": one.cylinder,
            "maximum_orifice_area": finite(one.maximum_orifice_area),
            "gains": gains,
            "dead_zones": dead_zones,
            "valve_leakage": leakage,
            "friction": or_refused(&one.friction, friction),
        })
    });
    json!({"cylinders": cylinders.collect::<Vec<_>>()})
}
