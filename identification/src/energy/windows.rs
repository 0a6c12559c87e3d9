//! Computes the ledger's residual window by window, without differentiation.

use excavator_model::Model;

use super::regime::Situation;
use super::{Books, EnergySettings, Place};

/// Missing power in one window.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Window {
    /// Centre, s.
    pub time: f64,
    /// Mean power stored at each place without a source in the model, W; negative: lost.
    pub residuals: Vec<f64>,
    /// Mean power through each place, W.
    pub flows: Vec<f64>,
    /// Motion and opening of each cylinder.
    pub situations: Vec<Situation>,
}

/// Columns of one place, entry by entry, computed once because every entry is in several windows.
struct Columns {
    /// Energy stored, J.
    stored: Vec<f64>,
    /// Power into it, W.
    power: Vec<f64>,
    /// Power through it, W.
    flow: Vec<f64>,
}

impl Columns {
    fn of(books: &Books, place: Place) -> Self {
        let each = |of: &dyn Fn(usize) -> f64| (0..books.len()).map(of).collect();
        Columns {
            stored: each(&|k| books.stored_at(place, k)),
            power: each(&|k| books.power_into(place, k)),
            flow: each(&|k| books.flow_through(place, k)),
        }
    }
}

/// Fewest entries of a window.
const FEWEST: usize = 20;
/// Longest pause between entries, as a share of the window's half width; a window with a longer one is skipped.
const LONGEST_PAUSE: f64 = 0.15;

/// Windows whose centres are in `own`, at multiples of a quarter of their length.
///
/// With a test function `phi` that is zero at the window's ends, `int phi (dE/dt - P) dt = -int (phi' E + phi P) dt`: the
/// derivative moves from the noisy energy to the test function (weak form). Division by `int phi` gives a mean power.
pub(super) fn windows(
    model: &Model,
    books: &Books,
    places: &[Place],
    own: (f64, f64),
    settings: &EnergySettings,
) -> Vec<Window> {
    let half = settings.window_half_width;
    let step = 0.5 * half;
    let (first, last) = ((own.0 / step).ceil() as i64, (own.1 / step).ceil() as i64);
    let columns: Vec<Columns> = places.iter().map(|&place| Columns::of(books, place)).collect();
    (first..last)
        .filter_map(|number| {
            let centre = number as f64 * step;
            let start = books.time.partition_point(|&t| t < centre - half);
            let end = books.time.partition_point(|&t| t <= centre + half);
            window(model, books, &columns, centre, start..end, half)
        })
        .collect()
}

fn window(
    model: &Model,
    books: &Books,
    columns: &[Columns],
    centre: f64,
    range: std::ops::Range<usize>,
    half: f64,
) -> Option<Window> {
    let time = books.time.get(range.clone())?;
    let (first, last) = (time.first()?, time.last()?);
    let whole = first - (centre - half) < LONGEST_PAUSE * half && centre + half - last < LONGEST_PAUSE * half;
    let paused = time.windows(2).any(|pair| pair[1] - pair[0] > LONGEST_PAUSE * half);
    if time.len() < FEWEST || !whole || paused {
        return None;
    }
    // Trapezoidal rule on the actual clock, with phi = (1 - s²)² and its derivative.
    let weights: Vec<(f64, f64)> = (0..time.len())
        .map(|k| {
            let before = if k > 0 { time[k] - time[k - 1] } else { 0.0 };
            let after = time.get(k + 1).map_or(0.0, |next| next - time[k]);
            let s = (time[k] - centre) / half;
            let dome = (1.0 - s * s).max(0.0);
            let length = 0.5 * (before + after);
            (dome * dome * length, -4.0 * s * dome / half * length)
        })
        .collect();
    let area: f64 = weights.iter().map(|weight| weight.0).sum();
    let mean = |of: &dyn Fn(usize) -> f64| {
        weights.iter().enumerate().map(|(k, weight)| weight.0 * of(range.start + k)).sum::<f64>() / area
    };
    // Mean derivative over the window. The constant part has no derivative and is subtracted first.
    let rate = |of: &dyn Fn(usize) -> f64| {
        let level = of(range.start);
        -weights.iter().enumerate().map(|(k, weight)| weight.1 * (of(range.start + k) - level)).sum::<f64>() / area
    };
    let residuals = columns.iter().map(|own| rate(&|k| own.stored[k]) - mean(&|k| own.power[k])).collect();
    let flows = columns.iter().map(|own| mean(&|k| own.flow[k])).collect();
    let situations = books
        .cylinders
        .iter()
        .zip(&model.machine.cylinders)
        .map(|(cylinder, machine)| {
            let largest = machine.chambers.map_or(f64::INFINITY, |chambers| chambers.full_command());
            let opening = |k: usize| cylinder.opening[k].abs() / largest;
            Situation {
                velocity: mean(&|k| cylinder.velocity[k]),
                opening: mean(&opening),
                opening_rate: rate(&opening),
            }
        })
        .collect();
    Some(Window { time: centre, residuals, flows, situations })
}
