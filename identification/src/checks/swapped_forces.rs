//! Detects swapped chamber pressures from the motion and the areas alone, where no supply is measured.
//!
//! The force of the pressures, `A+ p+ - A- p-`, carries a load that depends on the position, accelerates a mass and overcomes friction
//! (\[A\] Eq. 1). Mass and friction are never negative. The level that both pressures share leaves no force with the right areas;
//! with the wrong ones it looks like a force that follows nothing.

use excavator_model::machine::Chambers;
use excavator_model::recording::{CylinderSignals, is_measured};
use nalgebra::{DMatrix, DVector};

use super::swapped::{CLEARLY, MUCH, Shares, WINDOW};

/// Fewest windows for a result: five for each of the eight numbers that are fitted.
const FEWEST: usize = 40;

/// Share of the largest speed below which the sign of the velocity is not taken as known.
const SLOW: f64 = 0.05;

/// Terms of the load, which may have any sign: a constant, the position and its square.
const LOADS: usize = 3;

/// Terms that are never negative: acceleration, velocity, sign of the velocity.
const LOSSES: usize = 3;

/// The unexplained squares of the pressure force as given and with swapped pressures, if they show that the two are swapped.
pub(super) fn swapped_by_force(
    time: &[f64],
    signals: &CylinderSignals,
    chambers: &Chambers,
    time_scale: f64,
) -> Option<Shares> {
    let needed = [&signals.displacement, &signals.cap_pressure, &signals.rod_pressure];
    if !needed.into_iter().all(|signal| is_measured(signal)) {
        return None;
    }
    let windows = windows(time, signals, WINDOW * time_scale);
    let terms = terms(&windows)?;
    let force = |sides: fn(&Window) -> [f64; 2]| {
        let forces = terms.rows.iter().map(|&number| {
            let [cap, rod] = sides(&windows[number]);
            chambers.cap_area * cap - chambers.rod_area * rod
        });
        DVector::from_iterator(terms.rows.len(), forces)
    };
    let [given, swapped] = [force(|one| one.pressures), force(|one| [one.pressures[1], one.pressures[0]])];
    let [of_given, of_swapped] = [&given, &swapped].map(|force| terms.unexplained(force));
    let shares = Shares { given: of_given / variation(&given), swapped: of_swapped / variation(&swapped) };
    // A load that follows nothing is unexplained both ways. It counts only if it is large beside the forces on the two sides.
    let side = |number: usize, area: f64| {
        let forces = terms.rows.iter().map(|&row| area * windows[row].pressures[number]);
        variation(&DVector::from_iterator(terms.rows.len(), forces))
    };
    let sides = side(0, chambers.cap_area) + side(1, chambers.rod_area);
    let is_sure = shares.given > MUCH
        && shares.given > CLEARLY * shares.swapped
        && of_given > CLEARLY * of_swapped
        && of_given > MUCH * sides;
    is_sure.then_some(shares)
}

/// Squares about the mean.
fn variation(values: &DVector<f64>) -> f64 {
    values.add_scalar(-values.mean()).norm_squared()
}

/// Means over a stretch of time.
struct Window {
    /// Mean position, m.
    position: f64,
    /// Velocity, m/s.
    velocity: f64,
    /// Pressures, Pa: cap side, rod side.
    pressures: [f64; 2],
}

fn windows(time: &[f64], signals: &CylinderSignals, length: f64) -> Vec<Window> {
    let (mut windows, mut first) = (Vec::new(), 0);
    while let Some(&start) = time.get(first) {
        let last = time.partition_point(|&t| t < start + length);
        let Some(&end) = time.get(last) else { break };
        let mean = |signal: &[f64]| signal[first..last].iter().sum::<f64>() / (last - first) as f64;
        windows.push(Window {
            position: mean(&signals.displacement),
            velocity: (signals.displacement[last] - signals.displacement[first]) / (end - start),
            pressures: [mean(&signals.cap_pressure), mean(&signals.rod_pressure)],
        });
        first = last;
    }
    windows
}

/// The terms of the force balance at the windows that have all signals.
struct Terms {
    rows: Vec<usize>,
    columns: DMatrix<f64>,
}

fn terms(windows: &[Window]) -> Option<Terms> {
    let is_known = |one: &Window| {
        [one.position, one.velocity, one.pressures[0], one.pressures[1]].iter().all(|value| value.is_finite())
    };
    let rows: Vec<usize> =
        (1..windows.len().saturating_sub(1)).filter(|&row| windows[row - 1..=row + 1].iter().all(is_known)).collect();
    if rows.len() < FEWEST {
        return None;
    }
    let largest = |of: &dyn Fn(usize) -> f64| rows.iter().fold(0.0_f64, |most, &row| most.max(of(row).abs()));
    let position = |row: usize| windows[row].position;
    let velocity = |row: usize| windows[row].velocity;
    let acceleration = |row: usize| windows[row + 1].velocity - windows[row - 1].velocity;
    let (far, fast, jerked) = (largest(&position), largest(&velocity), largest(&acceleration));
    if !(far > 0.0 && fast > 0.0 && jerked > 0.0) {
        return None;
    }
    let columns = DMatrix::from_fn(rows.len(), LOADS + LOSSES, |number, column| {
        let row = rows[number];
        match column {
            0 => 1.0,
            1 => position(row) / far,
            2 => (position(row) / far).powi(2),
            3 => acceleration(row) / jerked,
            4 => velocity(row) / fast,
            _ => (velocity(row) / (SLOW * fast)).clamp(-1.0, 1.0),
        }
    });
    Some(Terms { rows, columns })
}

impl Terms {
    /// Least unexplained squares of `force` where no loss is negative.
    fn unexplained(&self, force: &DVector<f64>) -> f64 {
        let left = |choice: usize| {
            let chosen: Vec<usize> =
                (0..LOADS).chain((0..LOSSES).filter(|loss| choice >> loss & 1 == 1).map(|loss| LOADS + loss)).collect();
            let columns = self.columns.select_columns(&chosen);
            let found = columns.clone().svd(true, true).solve(force, 1e-9).ok()?;
            let is_possible = found.iter().skip(LOADS).all(|loss| *loss >= 0.0);
            is_possible.then(|| (force - columns * found).norm_squared())
        };
        (0..1 << LOSSES).filter_map(left).fold(variation(force), f64::min)
    }
}
