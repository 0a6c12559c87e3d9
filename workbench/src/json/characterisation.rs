//! What was read off recordings without a simulation.

use excavator_identification::characterisation::{
    ChamberLeakage, Characterisation, Edge, Estimate, FrictionCurve, Polynomial, Refusal,
};
use serde_json::{Map, Value, json};

use super::finite;

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
