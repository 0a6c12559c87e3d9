//! Gain and dead zone of a metering edge.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Estimate, finite};
use crate::characterisation;

/// Gain of one metering edge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Gain {
    /// Steady stretches, in order of opening.
    pub points: Vec<GainPoint>,
    /// Gain, m/(s sqrt(Pa)), over the opening as a share of the largest one, counted from the closed valve.
    pub from_closed: Polynomial,
    /// The same with the opening counted from the edge of the dead zone; `null` where that is not known.
    pub from_edge: Option<Polynomial>,
}

/// One steady stretch at one edge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct GainPoint {
    /// Opening by size, m2.
    pub opening: Option<f64>,
    /// Piston speed, m/s.
    pub speed: Option<f64>,
    /// Flow through the edge, m3/s.
    pub flow: Option<f64>,
    /// Pressure drop over the edge, Pa.
    pub pressure_drop: Option<f64>,
    /// Flow over opening and root of the pressure drop, m/(s sqrt(Pa)).
    pub gain: Estimate,
    /// The same with the opening counted from the edge of the dead zone, m/(s sqrt(Pa)); `null` where that is not known.
    pub gain_past_edge: Option<Estimate>,
}

/// A polynomial `c0 + c1 x + c2 x^2 + ...`; x is a pure number, so that all coefficients have the unit of the curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Polynomial {
    /// `c0`, `c1`, ..., in the unit of the curve.
    pub coefficients: Vec<Option<f64>>,
    /// Covariance of the coefficients, row by row, in the square of that unit.
    pub covariance: Vec<Vec<Option<f64>>>,
    /// Degree.
    pub degree: usize,
    /// Why this degree.
    pub reason: String,
}

/// Where flow through a metering edge begins and ends. Openings by size.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct DeadZone {
    /// Opening at which flow begins while the valve opens, m2.
    pub opening: Estimate,
    /// Opening at which it ends while the valve closes, m2.
    pub closing: Estimate,
    /// Mean of both, m2.
    pub dead_zone: Estimate,
    /// Opening less closing, m2: the width of a play.
    pub hysteresis: Estimate,
    /// Rate of the opening at the edge, m2/s: a lag of `hysteresis / (2 rate)` would look the same.
    pub rate: Option<f64>,
    /// Number of runs that opened, and of those that closed.
    pub runs: [usize; 2],
}

impl Gain {
    pub(super) fn of(gain: &characterisation::DirectionalGain) -> Self {
        Gain {
            points: gain.points.iter().map(GainPoint::of).collect(),
            from_closed: Polynomial::of(&gain.polynomial),
            from_edge: gain.past_edge.as_ref().map(Polynomial::of),
        }
    }
}

impl GainPoint {
    fn of(point: &characterisation::GainPoint) -> Self {
        GainPoint {
            opening: finite(point.opening),
            speed: finite(point.speed),
            flow: finite(point.flow),
            pressure_drop: finite(point.pressure_drop),
            gain: Estimate::of(point.gain),
            gain_past_edge: point.gain_past_edge.map(Estimate::of),
        }
    }
}

impl Polynomial {
    fn of(curve: &characterisation::Polynomial) -> Self {
        let rows = curve.covariance.row_iter();
        Polynomial {
            coefficients: curve.coefficients.iter().map(|&one| finite(one)).collect(),
            covariance: rows.map(|row| row.iter().map(|&entry| finite(entry)).collect()).collect(),
            degree: curve.degree(),
            reason: curve.reason.clone(),
        }
    }
}

impl DeadZone {
    pub(super) fn of(zone: &characterisation::DeadZone) -> Self {
        DeadZone {
            opening: Estimate::of(zone.opening),
            closing: Estimate::of(zone.closing),
            dead_zone: Estimate::of(zone.dead_zone),
            hysteresis: Estimate::of(zone.hysteresis),
            rate: finite(zone.rate),
            runs: [zone.runs.0, zone.runs.1],
        }
    }
}
