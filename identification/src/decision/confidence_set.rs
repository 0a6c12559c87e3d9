//! The model confidence set (Hansen, Lunde and Nason 2011): the hypotheses that the recordings cannot distinguish from the best
//! one.

use super::resampling::{DRAWS, Resampled, spread};

/// The p-value of each hypothesis: the smallest error probability at which it leaves the set. The last one to stay has 1.
///
/// As long as the remaining hypotheses differ by more than chance, the worst one is removed. The distance of each from the mean
/// of all, in its own standard errors, is compared with that in resampled recordings (the statistic T_max of the paper).
pub(super) fn set_p_values(hypotheses: &[&Resampled]) -> Vec<f64> {
    let mut remaining: Vec<usize> = (0..hypotheses.len()).collect();
    let mut p_values = vec![1.0; hypotheses.len()];
    let mut largest = 0.0_f64;
    while remaining.len() > 1 {
        let (worst, p) = worst(hypotheses, &remaining);
        largest = largest.max(p);
        p_values[remaining.remove(worst)] = largest;
    }
    p_values
}

/// The position of the worst remaining hypothesis, and the probability that chance makes one so bad.
fn worst(hypotheses: &[&Resampled], remaining: &[usize]) -> (usize, f64) {
    let count = remaining.len() as f64;
    let mean: f64 = remaining.iter().map(|&number| hypotheses[number].mean).sum::<f64>() / count;
    let means: Vec<f64> = (0..DRAWS)
        .map(|draw| remaining.iter().map(|&number| hypotheses[number].draws[draw]).sum::<f64>() / count)
        .collect();
    // For each: its distance from the mean, and the deviation from that distance in each draw, in standard errors.
    let distances: Vec<(f64, Vec<f64>)> = remaining
        .iter()
        .map(|&number| {
            let own = hypotheses[number];
            let distance = own.mean - mean;
            let off: Vec<f64> = own.draws.iter().zip(&means).map(|(draw, mean)| draw - mean - distance).collect();
            let error = spread(&off).max(f64::MIN_POSITIVE);
            (distance / error, off.into_iter().map(|value| value / error).collect())
        })
        .collect();
    let (worst, largest) = distances
        .iter()
        .map(|(distance, _)| *distance)
        .enumerate()
        .fold((0, f64::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best });
    let by_chance = |draw: usize| distances.iter().map(|(_, off)| off[draw]).fold(f64::NEG_INFINITY, f64::max);
    let exceeding = (0..DRAWS).filter(|&draw| by_chance(draw) >= largest).count();
    (worst, exceeding as f64 / DRAWS as f64)
}
