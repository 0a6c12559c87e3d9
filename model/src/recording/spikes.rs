//! Single values far off the line of their neighbours: a disturbed cable, a second publisher, a lost frame.

/// Values on each side of a jump that show how fast the signal moves there.
const NEIGHBOURS: usize = 8;
/// Factor over the largest step among the neighbours by which a value must jump: nothing real starts and ends so.
const TIMES_THE_NEIGHBOURS: f64 = 8.0;
/// Factor over the noise by which it must jump: one sample of noise in 10^80 does.
const TIMES_THE_NOISE: f64 = 20.0;
/// Factor over the smallest steps of the signal, which are those of its converter if it has a coarse one.
const TIMES_THE_STEPS: f64 = 10.0;
/// Share of the signal's usual range by which it must jump; smaller spikes harm nothing.
const SHARE_OF_THE_RANGE: f64 = 0.02;
/// Share of the jump by which the values on both sides may differ.
const RETURNS: f64 = 0.2;
/// The value that a fifth of the sizes of second differences of white noise stay below, in its standard deviations: they have
/// variance 6, and a fifth of a normal variable is within 0.253.
const SECOND_DIFFERENCES: f64 = 0.62;
/// Share of the values that a second publisher may write, in turns with the first.
const LEAST_TURNS: f64 = 0.15;
const MOST_TURNS: f64 = 0.6;
/// Share of its values that have other values on both sides.
const ALONE: f64 = 0.9;
/// Fewest different values of the first publisher: a signal with fewer is switched.
const FEWEST_DISTINCT: usize = 20;
/// Values of a quick look.
const LOOKED_AT: usize = 4099;
/// Fewest values that show what is usual.
const FEWEST: usize = 50;

/// Indices of the values that jump away from both neighbours and back, while all around the signal is calm. Signals whose
/// samples are too far apart to follow them are the caller's to leave out: there, a single value may be real.
///
/// ```
/// use excavator_model::recording::spikes;
///
/// let mut signal: Vec<f64> = (0..200).map(|sample| (0.05 * f64::from(sample)).sin()).collect();
/// assert!(spikes(&signal).is_empty());
/// signal[70] = 3.0;
/// assert_eq!(spikes(&signal), [70]);
/// ```
pub fn spikes(signal: &[f64]) -> Vec<usize> {
    if !may_have_spikes(signal) {
        return Vec::new();
    }
    let known: Vec<(usize, f64)> = signal.iter().copied().enumerate().filter(|(_, value)| value.is_finite()).collect();
    if known.len() < FEWEST {
        return Vec::new();
    }
    let values: Vec<f64> = known.iter().map(|(_, value)| *value).collect();
    let found = second_writer(&values).unwrap_or_else(|| single(&values));
    found.into_iter().map(|index| known[index].0).collect()
}

/// Spikes among values that are all known.
fn single(values: &[f64]) -> Vec<usize> {
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let candidates: Vec<bool> = steps.windows(2).map(|pair| is_there_and_back(pair[0], pair[1])).collect();
    let least = least_jump(values, &steps);
    // Candidate k is value k + 1, between steps k and k + 1.
    let is_of_candidate = |step: usize| {
        let is = |candidate: usize| candidates.get(candidate) == Some(&true) && jump(&steps, candidate) > least;
        is(step) || step.checked_sub(1).is_some_and(is)
    };
    let is_spike = |candidate: usize| {
        if !candidates[candidate] || jump(&steps, candidate) <= least {
            return false;
        }
        let around = candidate.saturating_sub(NEIGHBOURS)..(candidate + 2 + NEIGHBOURS).min(steps.len());
        let calm: Vec<f64> =
            around.clone().filter(|step| !is_of_candidate(*step)).map(|step| steps[step].abs()).collect();
        // A signal that alternates has no calm neighbours.
        let largest = calm.iter().copied().fold(0.0, f64::max);
        2 * calm.len() >= around.len() && jump(&steps, candidate) > TIMES_THE_NEIGHBOURS * largest
    };
    let mut found: Vec<usize> =
        (0..candidates.len()).filter(|candidate| is_spike(*candidate)).map(|candidate| candidate + 1).collect();
    // The first and the last value have one neighbour only, so a jump there may be a machine that starts or stops. They are
    // spikes where others have exactly their value.
    let is_of_others = |index: usize, step: usize| {
        steps[step].abs() > least && found.iter().any(|&other| other != index && values[other] == values[index])
    };
    let last = steps.len();
    let (first_is, last_is) = (is_of_others(0, 0), is_of_others(last, last - 1));
    if first_is {
        found.insert(0, 0);
    }
    if last_is {
        found.push(last);
    }
    found
}

/// Whether any step is large enough, by a quick look at the range; most signals need no more, and no memory.
fn may_have_spikes(signal: &[f64]) -> bool {
    let some: Vec<f64> = some_of(signal).into_iter().filter(|value| value.is_finite()).collect();
    let range = quantile(some.clone(), 0.99) - quantile(some, 0.01);
    let mut last = f64::NAN;
    signal.iter().filter(|value| value.is_finite()).any(|&value| {
        let step = (value - std::mem::replace(&mut last, value)).abs();
        step > 0.5 * SHARE_OF_THE_RANGE * range
    })
}

/// At most a few thousand of the values, from all over the signal.
fn some_of(values: &[f64]) -> Vec<f64> {
    values.iter().copied().step_by(values.len().div_ceil(LOOKED_AT).max(1)).collect()
}

/// The value that occurs most often, with its share.
fn mode(mut values: Vec<f64>) -> Option<(f64, f64)> {
    values.sort_unstable_by(f64::total_cmp);
    let most = values.chunk_by(|one, other| one == other).max_by_key(|equal| equal.len())?;
    Some((*most.first()?, most.len() as f64 / values.len() as f64))
}

/// The values of a second publisher that writes one constant in turns with the signal: what is left without it is calm.
fn second_writer(values: &[f64]) -> Option<Vec<usize>> {
    mode(some_of(values)).filter(|(_, share)| *share > 0.5 * LEAST_TURNS)?;
    let (constant, share) = mode(values.to_vec())?;
    if !(LEAST_TURNS..=MOST_TURNS).contains(&share) {
        return None;
    }
    let (turns, others): (Vec<usize>, Vec<usize>) = (0..values.len()).partition(|&index| values[index] == constant);
    let alone = turns.windows(2).filter(|pair| pair[1] - pair[0] > 1).count();
    if (alone as f64) < ALONE * turns.len() as f64 {
        return None;
    }
    let others: Vec<f64> = others.into_iter().map(|index| values[index]).collect();
    let steps: Vec<f64> = others.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let jump = quantile(others.iter().map(|value| (value - constant).abs()).collect(), 0.5);
    let sizes: Vec<f64> = steps.iter().map(|step| step.abs()).collect();
    let calm = jump > TIMES_THE_NEIGHBOURS * quantile(sizes, 0.9) && jump > least_jump(&others, &steps);
    let mut distinct = others;
    distinct.sort_unstable_by(f64::total_cmp);
    distinct.dedup();
    (calm && distinct.len() >= FEWEST_DISTINCT).then_some(turns)
}

fn is_there_and_back(there: f64, back: f64) -> bool {
    there * back < 0.0 && (there + back).abs() <= RETURNS * there.abs().min(back.abs())
}

fn jump(steps: &[f64], candidate: usize) -> f64 {
    steps[candidate].abs().min(steps[candidate + 1].abs())
}

/// A jump that is no more than this is usual.
fn least_jump(values: &[f64], steps: &[f64]) -> f64 {
    let range = quantile(values.to_vec(), 0.99) - quantile(values.to_vec(), 0.01);
    let moving = steps.iter().map(|step| step.abs()).filter(|step| *step > 0.0).collect();
    // Each spike spoils three second differences, so the usual median would take many spikes for noise.
    let second = steps.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let noise = quantile(second, 0.2) / SECOND_DIFFERENCES;
    (TIMES_THE_NOISE * noise).max(TIMES_THE_STEPS * quantile(moving, 0.1)).max(SHARE_OF_THE_RANGE * range)
}

/// The value that this share does not exceed; zero without values.
fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    let place = (values.len() as f64 * share) as usize;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(place, f64::total_cmp).1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(samples: usize) -> Vec<f64> {
        (0..samples).map(|sample| 0.05 * (0.01 * sample as f64).sin()).collect()
    }

    #[test]
    fn zeros_of_a_second_publisher_are_spikes_also_when_they_are_many() {
        for every in [5, 8, 50] {
            let mut signal: Vec<f64> = wave(2000).iter().map(|value| value + 0.1).collect();
            let wrong: Vec<usize> = (3..1997).step_by(every).collect();
            wrong.iter().for_each(|&index| signal[index] = 0.0);
            assert_eq!(spikes(&signal), wrong, "every {every}");
        }
    }

    #[test]
    fn a_constant_in_turns_with_the_signal_is_a_second_publisher() {
        for turns in [1, 2, 3] {
            let (mut signal, mut wrong) = (Vec::new(), Vec::new());
            for (index, value) in wave(1500).into_iter().enumerate() {
                signal.push(value + 0.1);
                if index % turns == 0 {
                    wrong.push(signal.len());
                    signal.push(0.0);
                }
            }
            assert_eq!(spikes(&signal), wrong, "after every {turns}");
        }
    }

    #[test]
    fn an_end_is_a_spike_only_where_others_have_its_value() {
        let mut signal: Vec<f64> = wave(500).iter().map(|value| value + 0.2).collect();
        // A pump that starts, and a load that drops.
        (signal[0], signal[499]) = (0.0, 0.5);
        assert!(spikes(&signal).is_empty());
        (signal[200], signal[300], signal[499]) = (0.0, 0.0, 0.0);
        assert_eq!(spikes(&signal), [0, 200, 300, 499]);
    }

    #[test]
    fn missing_values_beside_a_spike_do_not_hide_it() {
        let mut signal = wave(500);
        signal[200] = f64::NAN;
        signal[201] = -4.0;
        assert_eq!(spikes(&signal), [201]);
    }

    #[test]
    fn fast_coarse_and_switched_signals_have_none() {
        let alternating: Vec<f64> = (0..500).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let coarse: Vec<f64> = wave(3000).iter().map(|value| (value / 0.001).round() * 0.001).collect();
        let steps: Vec<f64> = (0..1000).map(|k| f64::from(k / 50 % 2)).collect();
        // A drop of pressure that rings down within a few samples.
        let ringing: Vec<f64> = (0..1000)
            .map(|k| {
                let after = (k % 200) as f64;
                5e6 + 3e6 * (-0.3 * after).exp() * (1.2 * after).cos()
            })
            .collect();
        // A flicker of the last bit.
        let flicker: Vec<f64> = (0..1000).map(|k| if k % 37 == 0 { 1.0 } else { 0.0 }).collect();
        let peaks: Vec<f64> = (0..1000).map(|k| (-((k % 100) as f64 - 50.0).powi(2) / 4.0).exp()).collect();
        for signal in [&alternating, &coarse, &steps, &ringing, &flicker, &peaks] {
            assert_eq!(spikes(signal), Vec::<usize>::new());
        }
        assert!(spikes(&[f64::NAN; 100]).is_empty() && spikes(&[]).is_empty());
    }

    #[test]
    fn noise_has_none() {
        let mut state = 7_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1_u32 << 31)
        };
        // Logistic noise has heavier tails than sensors do.
        let signal: Vec<f64> =
            (0..200_000).map(|_| uniform().clamp(1e-9, 1.0 - 1e-9)).map(|u| (u / (1.0 - u)).ln()).collect();
        assert!(spikes(&signal).is_empty());
    }
}
