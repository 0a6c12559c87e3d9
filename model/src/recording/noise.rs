//! Distinguishes measured signals from commands, by their noise.

/// Fraction of the samples at which a measured value differs from the previous one. A command is constant between two messages of
/// its sender.
const OFTEN_NEW: f64 = 0.1;

/// Fraction of these at which it changes direction: two of three for noise, one of three with a coarse converter, none for a
/// ramp.
const OFTEN_TURNS: f64 = 0.2;

/// Fewest changes for a decision.
const FEWEST_CHANGES: usize = 20;

/// Whether a signal has measurement noise and so is not a command as sent.
pub fn has_noise(values: &[f64]) -> bool {
    let steps = || values.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| step.is_finite());
    let changes: Vec<f64> = steps().filter(|step| *step != 0.0).collect();
    let turns = changes.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
    let share = |count: usize, of: usize| count as f64 / of.max(1) as f64;
    changes.len() > FEWEST_CHANGES
        && share(changes.len(), steps().count()) > OFTEN_NEW
        && share(turns, changes.len()) > OFTEN_TURNS
}

#[cfg(test)]
mod tests {
    use super::has_noise;

    #[test]
    fn commands_have_none() {
        let sine: Vec<f64> = (0..2000).map(|sample| (0.01 * f64::from(sample)).sin()).collect();
        let steps: Vec<f64> = (0..2000).map(|sample| f64::from((sample / 50 * 7) % 11)).collect();
        let slow: Vec<f64> = sine.iter().enumerate().map(|(sample, _)| sine[sample / 10 * 10]).collect();
        for command in [&sine, &steps, &slow] {
            assert!(!has_noise(command));
        }
        // Noise of half a step of the converter.
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 33) as f64 / f64::from(u32::MAX >> 1) - 0.5
        };
        let measured: Vec<f64> = sine.iter().map(|value| (20.0 * value + 1.5 * random()).round()).collect();
        assert!(has_noise(&measured));
    }
}
