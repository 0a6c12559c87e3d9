//! Oil balance of one chamber while the valve is closed.

use super::edge::Side;
use super::stretches::Still;
use super::track::Track;

/// Samples per second at which balances are taken, low enough that neighbouring rows do not share their noise.
const RATE: f64 = 50.0;

/// One balance `oil stored and displaced = C_pump pump_drop + C_tank (-tank_drop)` since the start of its hold, each less
/// its mean over the hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BalanceRow {
    /// `V/b p ± A s` and known leakage to elsewhere, m³.
    pub oil: f64,
    /// Integral of pump pressure less chamber pressure, Pa s.
    pub pump: f64,
    /// Integral of tank pressure less chamber pressure, Pa s.
    pub tank: f64,
}

/// Balances of one hold: the integral of \[B\] Eq. 12-13 with Eq. 1, in which the piston may creep.
pub(super) fn balance_rows(track: &Track, side: Side, hold: Still, bulk_modulus: f64) -> Vec<BalanceRow> {
    let Some(chambers) = track.chambers else { return Vec::new() };
    let pressure = track.pressure(side);
    let middle = track.displacement[(hold.first + hold.last) / 2];
    let (volume, area) = match side {
        Side::Cap => (chambers.cap_volume(track.stroke, middle), chambers.cap_area),
        Side::Rod => (chambers.rod_volume(track.stroke, middle), -chambers.rod_area),
    };
    let [past_seals, cap_out, rod_out] = track.seal_leakage;
    let lost = |index: usize| match side {
        Side::Cap => {
            past_seals * (track.cap_pressure[index] - track.rod_pressure[index]) + cap_out * track.cap_pressure[index]
        }
        Side::Rod => {
            past_seals * (track.rod_pressure[index] - track.cap_pressure[index]) + rod_out * track.rod_pressure[index]
        }
    };
    let mut rows: Vec<BalanceRow> = Vec::new();
    let (mut pump, mut tank, mut elsewhere) = (0.0, 0.0, 0.0);
    let mut next = track.time[hold.first];
    for index in hold.first..=hold.last {
        if index > hold.first {
            let step = 0.5 * (track.time[index] - track.time[index - 1]);
            let both = |of: &dyn Fn(usize) -> f64| step * (of(index) + of(index - 1));
            pump += both(&|at| track.pump_pressure[at] - pressure[at]);
            tank += both(&|at| track.tank_pressure[at] - pressure[at]);
            elsewhere += both(&lost);
        }
        if track.time[index] + 1e-9 < next {
            continue;
        }
        next += 1.0 / RATE;
        let oil = volume / bulk_modulus * pressure[index] + area * track.displacement[index] + elsewhere;
        if oil.is_finite() && pump.is_finite() && tank.is_finite() {
            rows.push(BalanceRow { oil, pump, tank });
        }
    }
    let count = rows.len() as f64;
    let mean = |of: fn(&BalanceRow) -> f64| rows.iter().map(of).sum::<f64>() / count;
    let [oil, pump, tank] = [mean(|row| row.oil), mean(|row| row.pump), mean(|row| row.tank)];
    for row in &mut rows {
        *row = BalanceRow { oil: row.oil - oil, pump: row.pump - pump, tank: row.tank - tank };
    }
    rows
}
