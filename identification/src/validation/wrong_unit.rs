//! Recognises pressures that were read in another unit than they were recorded in.

use super::Comparison;

/// Units of pressure that are confused, and how much larger the true pressure is than the one that was read.
const CONFUSED: [(&str, &str, f64); 8] = [
    ("bar", "kPa", 100.0),
    ("kPa", "bar", 0.01),
    ("MPa", "bar", 10.0),
    ("bar", "MPa", 0.1),
    ("kPa", "Pa", 1000.0),
    ("Pa", "kPa", 0.001),
    ("bar", "psi", 14.504),
    ("psi", "bar", 0.068_95),
];

/// Factor by which the ratio of simulated to measured pressures may miss the ratio of two units. A load that is wrong by half moves
/// the pressures by as much; the units that are confused differ by a factor of ten.
const NEAR: f64 = 1.6;

/// Pressures that all are as many times too large or too small as another unit would make them.
#[derive(Debug, Clone, PartialEq)]
pub struct WrongUnit {
    /// Contract names of the pressures.
    pub signals: Vec<String>,
    /// The unit in which they seem to have been recorded.
    pub recorded: &'static str,
    /// The unit in which they seem to have been read.
    pub read: &'static str,
}

impl WrongUnit {
    /// Compares the measured pressures with the simulated ones. `None` if fewer than two are measured, or if no unit explains all.
    ///
    /// A hint, not a finding: a machine whose load is ten times that of the model looks the same.
    pub fn of(comparison: &Comparison) -> Option<WrongUnit> {
        let pressures = comparison.signals.iter().map(|signal| &signal.name).filter(|name| name.ends_with("pressure"));
        let ratios: Vec<(&String, f64)> = pressures.filter_map(|name| Some((name, ratio(comparison, name)?))).collect();
        if ratios.len() < 2 {
            return None;
        }
        let is_near = |factor: f64| ratios.iter().all(|(_, ratio)| (ratio / factor).max(factor / ratio) < NEAR);
        // Of bar read as psi and MPa read as bar, the nearer one.
        let middle = ratios.iter().map(|(_, ratio)| ratio.ln()).sum::<f64>() / ratios.len() as f64;
        let distance = |factor: f64| (factor.ln() - middle).abs();
        let near = CONFUSED.into_iter().filter(|(.., factor)| is_near(*factor));
        let (recorded, read, _) = near.min_by(|a, b| distance(a.2).total_cmp(&distance(b.2)))?;
        Some(WrongUnit { signals: ratios.into_iter().map(|(name, _)| name.clone()).collect(), recorded, read })
    }
}

/// Median size of a simulated signal over that of the measured one. A simulation that starts with wrong pressures jumps at first; a
/// median does not see that.
fn ratio(comparison: &Comparison, name: &str) -> Option<f64> {
    let (measured, simulated) = (comparison.measured.signal(name)?, comparison.simulated.signal(name)?);
    let pairs = measured.iter().zip(simulated).filter(|(m, s)| m.is_finite() && s.is_finite());
    let (mut measured, mut simulated): (Vec<f64>, Vec<f64>) = pairs.map(|(m, s)| (m.abs(), s.abs())).unzip();
    let ratio = middle(&mut simulated)? / middle(&mut measured)?;
    (ratio.is_finite() && ratio > 0.0).then_some(ratio)
}

fn middle(values: &mut [f64]) -> Option<f64> {
    let place = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(place, f64::total_cmp).1)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;
    use excavator_model::recording::Recording;
    use excavator_model::simulation::{Tolerances, simulate_from_rest};

    use super::*;
    use crate::validation::compare;

    /// The arm's own swing, with its pressures times `factor`.
    fn found(factor: f64) -> Option<WrongUnit> {
        let model = built_in("zx30u-arm").unwrap();
        let time: Vec<f64> = (0..1500).map(|sample| f64::from(sample) * 4e-3).collect();
        let mut command = Recording::unmeasured("swing", time, &["arm"]);
        command.tank_pressure.fill(1e5);
        command.cylinders[0].orifice_area = command.time.iter().map(|t| 5e-5 * (3.1 * t).sin()).collect();
        let mut recording = simulate_from_rest(&model, &command, &[0.05], Tolerances::default()).unwrap();
        let arm = &mut recording.cylinders[0];
        for pressures in [&mut arm.cap_pressure, &mut arm.rod_pressure, &mut recording.pump_pressure] {
            pressures.iter_mut().for_each(|pressure| *pressure *= factor);
        }
        WrongUnit::of(&compare(&model, &recording).unwrap())
    }

    #[test]
    fn pressures_in_another_unit_are_recognised() {
        assert_eq!(found(1.0), None);
        assert_eq!(found(0.4), None);
        for (factor, recorded, read) in [(0.01, "bar", "kPa"), (10.0, "bar", "MPa"), (14.504, "psi", "bar")] {
            let hint = found(factor).unwrap();
            assert_eq!((hint.recorded, hint.read, hint.signals.len()), (recorded, read, 3), "{factor}");
        }
    }
}
