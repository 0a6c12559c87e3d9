//! Puts signals of recordings with different clocks on one time axis.

use excavator_model::recording::median_interval;

/// Signals on one time axis, s. Values are not finite where a recording has none.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Overlay {
    pub time: Vec<f64>,
    pub values: Vec<Vec<f64>>,
}

/// Divides time into cells and keeps the smallest and the largest value of each signal in each cell, in the order in which they came:
/// a single spike stays visible. A cell has at least two samples of the slowest signal, so that no line is interrupted.
///
/// `signals` are pairs of times (s) and values. The result has at most `most` points.
pub(super) fn overlay(signals: &[(Vec<f64>, &[f64])], most: usize) -> Overlay {
    let ends = signals.iter().filter_map(|(time, _)| Some((*time.first()?, *time.last()?)));
    let (start, end) =
        ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(start, end), (first, last)| (start.min(first), end.max(last)));
    if !(start.is_finite() && end > start) {
        return Overlay { time: Vec::new(), values: vec![Vec::new(); signals.len()] };
    }
    let slowest =
        signals.iter().map(|(time, _)| median_interval(time)).filter(|one| one.is_finite()).fold(0.0, f64::max);
    let cells = (most.max(2) / 2).min(((end - start) / (2.0 * slowest)).floor() as usize).max(1);
    let width = (end - start) / cells as f64;
    let time = (0..2 * cells).map(|half| start + (0.25 + 0.5 * half as f64) * width).collect();
    let values = signals
        .iter()
        .map(|(time, values)| {
            let mut extremes: Vec<[Option<(usize, f64)>; 2]> = vec![[None; 2]; cells];
            for (index, (moment, value)) in time.iter().zip(*values).enumerate().filter(|(_, (_, v))| v.is_finite()) {
                let cell = (((moment - start) / width) as usize).min(cells - 1);
                let [least, most] = &mut extremes[cell];
                if least.is_none_or(|(_, least)| *value < least) {
                    *least = Some((index, *value));
                }
                if most.is_none_or(|(_, most)| *value > most) {
                    *most = Some((index, *value));
                }
            }
            extremes.into_iter().flat_map(in_order).collect()
        })
        .collect();
    Overlay { time, values }
}

/// The values of a cell in the order of their samples.
fn in_order(mut extremes: [Option<(usize, f64)>; 2]) -> [f64; 2] {
    extremes.sort_by_key(|one| one.map(|(index, _)| index));
    extremes.map(|one| one.map_or(f64::NAN, |(_, value)| value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_stays_visible_and_clocks_may_differ() {
        let fast: Vec<f64> = (0..10_000).map(|sample| f64::from(sample) * 1e-3).collect();
        let mut values = vec![1.0; 10_000];
        values[4321] = 7.0;
        let slow: Vec<f64> = (0..50).map(|sample| 2.0 + f64::from(sample) * 0.1).collect();
        let (rising, nothing): (Vec<f64>, Vec<f64>) = (slow.clone(), vec![f64::NAN; 10_000]);
        let found = overlay(&[(fast.clone(), &values), (slow, &rising), (fast, &nothing)], 400);
        assert!(found.time.len() <= 400 && found.values.iter().all(|one| one.len() == found.time.len()));
        let spike = found.values[0].iter().position(|value| *value == 7.0);
        assert!(spike.is_some_and(|at| (found.time[at] - 4.321).abs() < 0.3));
        for (time, value) in found.time.iter().zip(&found.values[1]) {
            // It has samples from 2.0 s to 6.9 s; a cell is 0.2 s long.
            assert!(value.is_finite() || !(2.1..6.8).contains(time), "{time}: {value}");
            assert!(value.is_nan() || (1.8..7.1).contains(time), "{time}: {value}");
            assert!(value.is_nan() || (value - time).abs() < 0.3);
        }
        assert!(found.values[2].iter().all(|value| value.is_nan()));
    }

    #[test]
    fn nothing_is_an_empty_plot() {
        assert_eq!(overlay(&[(vec![], &[]), (vec![1.0], &[2.0])], 100).time, Vec::<f64>::new());
    }
}
