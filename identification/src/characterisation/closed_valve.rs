//! Leakage of the closed valve from pressure transients: \[B\] Eq. 12-15.

use nalgebra::{DMatrix, Matrix2, Vector2};

use super::chamber_row::{BalanceRow, balance_rows};
use super::edge::Side;
use super::estimate::Estimate;
use super::refusal::Refusal;
use super::stretches::{Still, length, settled, still};
use super::track::Track;

/// Opening that counts as closed, as a share of the largest. It is below any intentional overlap.
const CLOSED: f64 = 0.02;
/// Minimum time with the valve closed, s.
const LEAST_HOLD: f64 = 0.5;
/// Number of holds needed. An error common to one hold is visible only with at least two.
const NEEDED: usize = 3;
/// Standard errors below zero beyond which a coefficient cannot be leakage: chance puts fewer than one zero coefficient in 700 so
/// low.
const OPPOSED: f64 = 3.0;
/// Standard error over value above which a coefficient is useless.
const USELESS: f64 = 0.5;

/// Leakage past the lands at one chamber while the valve is closed.
#[derive(Debug, Clone, PartialEq)]
pub struct ChamberLeakage {
    /// From the pump into the chamber, m³/(s Pa): C1 of the cap side, C3 of the rod side.
    pub from_pump: Estimate,
    /// From the chamber to tank, m³/(s Pa): C2 of the cap side, C4 of the rod side.
    pub to_tank: Estimate,
    /// Time constant V / (b (C1 + C2)) at mid-stroke with the piston held, s.
    pub time_constant: Estimate,
    /// Share C1 / (C1 + C2) of the pump pressure (above tank) at which the chamber pressure settles.
    pub static_gain: Estimate,
    /// Root mean square residual of the balances, m³.
    pub residual: f64,
}

/// A time with the valve closed.
#[derive(Debug, Clone, PartialEq)]
pub struct Hold {
    /// Recording, as an index.
    pub track: usize,
    /// Times since its start, s, thinned.
    pub time: Vec<f64>,
    /// Cap side pressure, Pa.
    pub cap_pressure: Vec<f64>,
    /// Rod side pressure, Pa.
    pub rod_pressure: Vec<f64>,
    /// Mean pump pressure, Pa.
    pub pump_pressure: f64,
    /// How far the piston creeps, m.
    pub creep: f64,
}

/// Leakage of the closed valve.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedValve {
    /// Cap side: C1, C2.
    pub cap: Result<ChamberLeakage, Refusal>,
    /// Rod side: C3, C4.
    pub rod: Result<ChamberLeakage, Refusal>,
    /// Bulk modulus on which the coefficients depend, Pa.
    pub bulk_modulus: f64,
    /// The transients.
    pub holds: Vec<Hold>,
}

impl ClosedValve {
    /// Subtracts this leakage from the flows of a track, so that the rest went through open edges.
    pub fn take_off(&self, track: &mut Track) {
        for index in 0..track.time.len() {
            let (pump, tank) = (track.pump_pressure[index], track.tank_pressure[index]);
            if let Ok(cap) = &self.cap {
                track.cap_flow[index] -= cap.flow(pump, track.cap_pressure[index], tank);
            }
            if let Ok(rod) = &self.rod {
                track.rod_flow[index] -= rod.flow(pump, track.rod_pressure[index], tank);
            }
        }
    }
}

impl ChamberLeakage {
    /// Flow into the chamber, m³/s: \[B\] Eq. 12.
    pub fn flow(&self, pump: f64, chamber: f64, tank: f64) -> f64 {
        self.from_pump.value * (pump - chamber) - self.to_tank.value * (chamber - tank)
    }
}

/// Leakage coefficients from all times with the valve closed.
///
/// Eq. 14 as printed assumes a held piston and omits the pump's share of the leakage from the time constant. Eq. 12 has
/// `C1 (Pp - P1) - C2 (P1 - Pt)`, so the time constant is `V / (b (C1 + C2))` and the static gain `C1 / (C1 + C2)`. If only
/// friction holds the load, the piston creeps while pressures change. The balance therefore includes the oil that the piston
/// displaces, and it is integrated so that no measured signal is differentiated. Both coefficients come from one least-squares
/// fit over all holds. Leakage past the piston's seals and to the outside is taken from the model.
///
/// # Errors
/// [`Refusal`].
pub fn valve_leakage(tracks: &[Track]) -> Result<ClosedValve, Refusal> {
    let cylinder = || tracks.first().map_or(String::new(), |track| track.cylinder.clone());
    let maximum = tracks.first().map_or(0.0, Track::maximum_opening);
    if maximum <= 0.0 {
        return Err(Refusal::NoValve { cylinder: cylinder() });
    }
    let bulk_modulus = tracks.iter().find_map(|track| track.bulk_modulus);
    let (bulk_modulus, bulk_error) = bulk_modulus.ok_or_else(|| Refusal::NoBulkModulus { cylinder: cylinder() })?;
    let closed = |track: &Track, run: &Still| {
        track.smooth_opening[run.first..=run.last].iter().all(|opening| opening.abs() <= CLOSED * maximum)
    };
    let mut holds: Vec<(usize, Still)> = Vec::new();
    let mut longest: f64 = 0.0;
    for (number, track) in tracks.iter().enumerate() {
        for run in still(track).into_iter().filter(|run| closed(track, run)) {
            longest = longest.max(length(track, run));
            holds.extend(settled(track, run).filter(|&run| length(track, run) >= LEAST_HOLD).map(|run| (number, run)));
        }
    }
    if holds.len() < NEEDED {
        return Err(Refusal::TooFewHolds {
            found: holds.len(),
            needed: NEEDED,
            longest,
            least: LEAST_HOLD,
            limit: CLOSED,
            suggested: 5.0,
        });
    }
    let of = |side| chamber(tracks, &holds, side, (bulk_modulus, bulk_error), longest);
    let (cap, rod) = (of(Side::Cap), of(Side::Rod));
    if let (Err(refusal), Err(_)) = (&cap, &rod) {
        return Err(refusal.clone());
    }
    let holds = holds.iter().map(|&(number, run)| shown(tracks, number, run)).collect();
    Ok(ClosedValve { cap, rod, bulk_modulus, holds })
}

fn chamber(
    tracks: &[Track],
    holds: &[(usize, Still)],
    side: Side,
    (bulk_modulus, bulk_error): (f64, f64),
    longest: f64,
) -> Result<ChamberLeakage, Refusal> {
    let rows: Vec<Vec<BalanceRow>> =
        holds.iter().map(|&(number, run)| balance_rows(&tracks[number], side, run, bulk_modulus)).collect();
    let change = holds.iter().map(|&(number, run)| {
        let pressures = tracks[number].pressure(side)[run.first..=run.last].iter().filter(|p| p.is_finite());
        let (low, high) =
            pressures.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
        high - low
    });
    let refused = |relative: f64| Refusal::TransientsTooSmall {
        side: if side == Side::Cap { "cap" } else { "rod" },
        holds: holds.len(),
        longest,
        change: change.clone().fold(0.0, f64::max),
        relative_error: 100.0 * relative,
    };
    let (values, covariance, residual) = balance_fit(&rows).ok_or_else(|| refused(f64::INFINITY))?;
    // The bulk modulus scales the stored oil. The part of the balance that it affects is at most the whole.
    let scale = bulk_error / bulk_modulus;
    let covariance = covariance + values * values.transpose() * (scale * scale);
    let opposed = (0..2).find(|&at| values[at] < -OPPOSED * covariance[(at, at)].sqrt());
    if let Some(at) = opposed {
        return Err(Refusal::OpposedLeakage {
            side: if side == Side::Cap { "cap" } else { "rod" },
            path: if at == 0 { "from the pump into" } else { "to tank out of" },
            value: values[at],
            error: covariance[(at, at)].sqrt(),
        });
    }
    let values = at_least_zero(values, &covariance);
    let estimate = |at: usize| Estimate { value: values[at], error: covariance[(at, at)].sqrt() };
    let (from_pump, to_tank) = (estimate(0), estimate(1));
    let best = from_pump.relative_error().min(to_tank.relative_error());
    let sum = values[0] + values[1];
    if best > USELESS || sum <= 0.0 {
        return Err(refused(best));
    }
    let track = &tracks[0];
    let volume = track.chambers.map_or(f64::NAN, |chambers| match side {
        Side::Cap => chambers.cap_volume(track.stroke, 0.0),
        Side::Rod => chambers.rod_volume(track.stroke, 0.0),
    });
    let spread = |gradient: Vector2<f64>| (gradient.transpose() * covariance * gradient)[0].max(0.0).sqrt();
    let time_constant = volume / (bulk_modulus * sum);
    Ok(ChamberLeakage {
        from_pump,
        to_tank,
        time_constant: Estimate { value: time_constant, error: spread(Vector2::repeat(time_constant / sum)) },
        static_gain: Estimate {
            value: values[0] / sum,
            error: spread(Vector2::new(values[1], -values[0]) / (sum * sum)),
        },
        residual,
    })
}

/// Applies the constraint that oil leaks from the higher pressure to the lower one. A coefficient that noise puts below zero
/// becomes zero, and the other one is the constrained solution of the balances.
fn at_least_zero(values: Vector2<f64>, covariance: &Matrix2<f64>) -> Vector2<f64> {
    let Some(at) = (0..2).find(|&at| values[at] < 0.0) else { return values };
    let other = 1 - at;
    let mut bounded = Vector2::zeros();
    bounded[other] = (values[other] - covariance[(other, at)] / covariance[(at, at)] * values[at]).max(0.0);
    bounded
}

/// Coefficients, covariance and root mean square residual. The covariance is the larger of two: from the scatter of single
/// balances and from the scatter of whole holds.
fn balance_fit(holds: &[Vec<BalanceRow>]) -> Option<(Vector2<f64>, Matrix2<f64>, f64)> {
    let rows: Vec<&BalanceRow> = holds.iter().flatten().collect();
    if rows.len() < 10 {
        return None;
    }
    let columns = |row: &BalanceRow| Vector2::new(row.pump, row.tank);
    let mut information = Matrix2::zeros();
    let mut right = Vector2::zeros();
    for row in &rows {
        information += columns(row) * columns(row).transpose();
        right += columns(row) * row.oil;
    }
    let inverse = information.try_inverse()?;
    let values = inverse * right;
    let left = |row: &BalanceRow| row.oil - columns(row).dot(&values);
    let freedom = rows.len().checked_sub(holds.len() + 2).filter(|&freedom| freedom > 0)? as f64;
    let squares: f64 = rows.iter().map(|row| left(row).powi(2)).sum();
    let plain = inverse * (squares / freedom);
    let mut scores = Matrix2::zeros();
    for hold in holds {
        let score: Vector2<f64> = hold.iter().map(|row| columns(row) * left(row)).sum();
        scores += score * score.transpose();
    }
    let count = holds.len() as f64;
    let clustered = inverse * scores * inverse * (count / (count - 1.0).max(1.0));
    let covariance = if clustered.trace() > plain.trace() { clustered } else { plain };
    let all = DMatrix::from_iterator(rows.len(), 1, rows.iter().map(|row| left(row)));
    values.iter().all(|v| v.is_finite()).then_some((values, covariance, all.norm() / (rows.len() as f64).sqrt()))
}

/// A hold for the page, thinned to at most two hundred points.
fn shown(tracks: &[Track], number: usize, run: Still) -> Hold {
    let track = &tracks[number];
    let stride = (run.last - run.first).div_ceil(200).max(1);
    let thin = |values: &[f64]| values[run.first..=run.last].iter().copied().step_by(stride).collect::<Vec<f64>>();
    Hold {
        track: number,
        time: thin(&track.time).iter().map(|t| t - track.time[run.first]).collect(),
        cap_pressure: thin(&track.cap_pressure),
        rod_pressure: thin(&track.rod_pressure),
        pump_pressure: track.pump_pressure[run.first..=run.last].iter().sum::<f64>()
            / (run.last - run.first + 1) as f64,
        creep: track.displacement[run.last] - track.displacement[run.first],
    }
}
