//! Finds the stretch of time in which the equation of motion fails most, whatever the motion.

use excavator_model::Model;
use excavator_model::effects::Site;
use excavator_model::recording::Recording;

use crate::regression::{EquationKind, WeakFormSettings, weak_residuals};

/// A stretch of time, s after the first sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    pub begin: f64,
    pub duration: f64,
}

/// Shortest stretch, s: shorter than a push by hand, longer than a shock.
const SHORTEST: f64 = 0.2;

/// At most `count` stretches, none inside another, in which a constant force explains most of the motion residual of
/// `model`, best first. Scan statistic: squared sum of residuals over their number.
pub(super) fn worst_stretches(model: &Model, site: Site, recordings: &[&Recording], count: usize) -> Vec<Stretch> {
    let Site::Cylinder(cylinder) = site else { return Vec::new() };
    let settings = WeakFormSettings { velocity_guard: 0.0, ..WeakFormSettings::default() };
    let mut found: Vec<(f64, Stretch)> = Vec::new();
    let shortest = SHORTEST * model.machine.size().time();
    for recording in recordings {
        let Ok(residuals) = weak_residuals(model, recording, &settings) else { continue };
        let points: Vec<(f64, f64)> = residuals
            .iter()
            .filter(|residual| residual.kind == EquationKind::Motion(cylinder) && residual.in_noise_units.is_finite())
            .map(|residual| (recording.time[residual.sample] - recording.time[0], residual.in_noise_units))
            .collect();
        let mut free = vec![(0, points.len())];
        for _ in 0..count {
            let best =
                free.iter().enumerate().filter_map(|(number, &part)| Some((number, scan(&points, part, shortest)?)));
            let Some((number, (gain, (first, last)))) = best.max_by(|a, b| a.1.0.total_cmp(&b.1.0)) else { break };
            let (part_first, part_last) = free.swap_remove(number);
            free.extend([(part_first, first), (last, part_last)]);
            let (begin, end) = (points[first].0, points[last - 1].0);
            found.push((gain, Stretch { begin, duration: end - begin }));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().take(count).map(|(_, stretch)| stretch).collect()
}

/// The best stretch `first..last` among the points of one part, with its score.
fn scan(points: &[(f64, f64)], (from, to): (usize, usize), shortest: f64) -> Option<(f64, (usize, usize))> {
    let mut sums = vec![0.0];
    for (_, residual) in points.get(from..to)? {
        sums.push(sums[sums.len() - 1] + residual);
    }
    let mut best: Option<(f64, (usize, usize))> = None;
    for first in from..to {
        for last in first + 1..to {
            if points[last - 1].0 - points[first].0 < shortest {
                continue;
            }
            let sum: f64 = sums[last - from] - sums[first - from];
            let score = sum * sum / (last - first) as f64;
            if best.is_none_or(|(known, _)| score > known) {
                best = Some((score, (first, last)));
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stretch_that_is_off_is_found_beside_a_restless_rest() {
        let points: Vec<(f64, f64)> = (0..200)
            .map(|index| {
                let restless = if index % 2 == 0 { 1.5 } else { -1.5 };
                (f64::from(index) * 0.05, restless - if (60..90).contains(&index) { 2.0 } else { 0.0 })
            })
            .collect();
        let (score, (first, last)) = scan(&points, (0, 200), SHORTEST).unwrap_or_else(|| unreachable!());
        assert!((59..=61).contains(&first) && (89..=91).contains(&last), "{first} {last}");
        assert!((score - 120.0).abs() < 10.0, "{score}");
        assert_eq!(scan(&points, (10, 12), SHORTEST), None);
    }
}
