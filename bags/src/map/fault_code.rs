//! Recognises numbers that a logger writes where it has no reading: -999, 65535, 1e30.

use super::track::Track;

/// Numbers that loggers, converters and data formats write in the place of a reading. -999 and 9999 are habits of loggers, the limits
/// of integers come from converters and field buses, 9.91e37 is that of SCPI and 9.96921e36 that of netCDF.
const CODES: [f64; 30] = [
    -99.0,
    -99.9,
    -99.99,
    -999.0,
    -999.9,
    -999.99,
    -9999.0,
    -9999.9,
    -99_999.0,
    -999_999.0,
    999.0,
    999.9,
    9999.0,
    9999.9,
    9999.99,
    -9999.99,
    999.99,
    99_999.0,
    999_999.0,
    32_767.0,
    -32_768.0,
    65_535.0,
    8_388_607.0,
    -8_388_608.0,
    16_777_215.0,
    2_147_483_647.0,
    -2_147_483_648.0,
    4_294_967_295.0,
    9_223_372_036_854_775_807.0,
    -9_223_372_036_854_775_808.0,
];
/// Nothing on a machine has so many of any unit.
const NO_READING: f64 = 1e20;
/// Relative difference within which a number is a code: single precision rounds.
const TOLERANCE: f64 = 1e-6;
/// Fewest other readings from which the range of a signal is known.
const FEWEST_OTHERS: usize = 10;

/// One code and the readings that have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FaultCode {
    /// The number.
    pub value: f64,
    /// How many readings have it.
    pub count: usize,
}

/// Makes readings that are such a number not measured (`NaN`), and returns the codes. A number of the list counts only if it is
/// further from all other readings than they are from each other: a pressure of 999 psi among others is a pressure.
pub(super) fn remove(samples: &mut [(i64, f64)]) -> Vec<FaultCode> {
    let mut codes: Vec<FaultCode> = Vec::new();
    let (mut least, mut most, mut others) = (f64::INFINITY, f64::NEG_INFINITY, 0);
    for &(_, value) in samples.iter() {
        if is_code(value) {
            match codes.iter_mut().find(|code| is_near(code.value, value)) {
                Some(code) => code.count += 1,
                None => codes.push(FaultCode { value, count: 1 }),
            }
        } else if value.is_finite() {
            least = least.min(value);
            most = most.max(value);
            others += 1;
        }
    }
    let is_apart = |value: f64| {
        let distance = if value > most { value - most } else { least - value };
        distance > most - least && distance > 0.0
    };
    codes.retain(|code| code.value.abs() >= NO_READING || others >= FEWEST_OTHERS && is_apart(code.value));
    if !codes.is_empty() {
        let is_one = |value: f64| codes.iter().any(|code| is_near(code.value, value));
        samples.iter_mut().filter(|(_, value)| is_one(*value)).for_each(|(_, value)| *value = f64::NAN);
    }
    codes
}

/// As [`remove`], of values without stamps.
pub(super) fn remove_from(values: &mut [f64]) {
    if values.iter().any(|value| is_code(*value)) {
        let mut samples: Vec<(i64, f64)> = values.iter().map(|value| (0, *value)).collect();
        remove(&mut samples);
        values.iter_mut().zip(samples).for_each(|(value, (_, cleaned))| *value = cleaned);
    }
}

fn is_code(value: f64) -> bool {
    // Most readings need no look at the list.
    value.abs() >= 99.0 && (value.abs() >= NO_READING || CODES.iter().any(|code| is_near(*code, value)))
}

fn is_near(code: f64, value: f64) -> bool {
    (value - code).abs() <= TOLERANCE * code.abs()
}

/// The remark on the codes of a signal with `readings` readings.
pub(super) fn note(label: &str, codes: &[FaultCode], track: &Track) -> Option<String> {
    if codes.is_empty() {
        return None;
    }
    let list: Vec<String> = codes.iter().map(|code| format!("{} ({} times)", shown(code.value), code.count)).collect();
    let (count, readings) = (codes.iter().map(|code| code.count).sum::<usize>(), track.len());
    Some(format!(
        "{label}: {count} of {readings} readings are a code for \"no reading\" and were taken as not measured: {}",
        list.join(", ")
    ))
}

fn shown(value: f64) -> String {
    if value.abs() < 1e10 { value.to_string() } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn removed(values: &[f64]) -> (Vec<(f64, usize)>, usize) {
        let mut samples: Vec<(i64, f64)> = (0..).zip(values.iter().copied()).collect();
        let codes = remove(&mut samples).iter().map(|code| (code.value, code.count)).collect();
        (codes, samples.iter().filter(|(_, value)| value.is_nan()).count())
    }

    fn readings(from: f64, to: f64, codes: &[f64]) -> Vec<f64> {
        let swing = (0..100).map(|i| from + (to - from) * f64::from(i) / 99.0);
        swing.chain(codes.iter().copied()).collect()
    }

    #[test]
    fn codes_far_from_all_readings_are_none() {
        assert_eq!(removed(&readings(0.0, 100.0, &[-999.0, -999.0])), (vec![(-999.0, 2)], 2));
        assert_eq!(removed(&readings(1000.0, 4000.0, &[65_535.0, 0.0])), (vec![(65_535.0, 1)], 1));
        assert_eq!(removed(&readings(-1.0, 1.0, &[1e30, -1e30, 2_147_483_647.0])).1, 3);
        assert_eq!(removed(&[3.4e38, 3.4e38]).1, 2);
        // As single precision has it.
        assert_eq!(removed(&readings(0.0, 1.0, &[f64::from(-999.9f32)])).1, 1);
    }

    #[test]
    fn numbers_that_may_be_readings_stay() {
        for values in [
            readings(0.0, 3000.0, &[999.0]),
            readings(500.0, 900.0, &[999.0]),
            readings(0.0, 65_535.0, &[65_535.0]),
            readings(0.0, 40_000.0, &[65_535.0]),
            readings(0.0, 100.0, &[150.0, -1000.0]),
            vec![999.0; 50],
            vec![],
        ] {
            assert_eq!(removed(&values), (vec![], 0), "{values:?}");
        }
    }
}
