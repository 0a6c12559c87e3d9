//! Resamples a signal to the times of the clock.

use super::signal_source::Resampling;
use super::track::Track;

/// Maximum distance for linear interpolation, in median intervals of the signal: one or two lost messages are bridged,
/// but no values are invented for a silent sensor.
const INTERVALS_BRIDGED: f64 = 5.0;

/// How a signal is resampled to the clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Policy {
    pub method: Resampling,
    /// Maximum time that is bridged, ns.
    pub maximum_gap: f64,
}

impl Policy {
    /// The policy for a track; `maximum_gap` in s, as in the map.
    pub fn of(method: Resampling, maximum_gap: Option<f64>, track: &Track) -> Policy {
        let maximum_gap = match (maximum_gap, method) {
            (Some(seconds), _) => seconds * 1e9,
            (None, Resampling::Hold) => f64::INFINITY,
            (None, Resampling::Linear) => INTERVALS_BRIDGED * track.median_interval().unwrap_or(0.0),
        };
        Policy { method, maximum_gap }
    }
}

/// The values of a track at the clock times (ns, ascending); `NaN` where the policy yields no value.
pub(super) fn resample(track: &Track, clock: &[i64], policy: Policy) -> Vec<f64> {
    // Index of the first sample after the clock time; both ascend, so it only increases.
    let mut after = 0;
    clock
        .iter()
        .map(|&now| {
            while track.get(after).is_some_and(|(stamp, _)| stamp <= now) {
                after += 1;
            }
            let Some((before, value)) = after.checked_sub(1).and_then(|place| track.get(place)) else {
                return f64::NAN;
            };
            let age = now.saturating_sub(before) as f64;
            match policy.method {
                _ if age == 0.0 => value,
                Resampling::Hold if age <= policy.maximum_gap => value,
                Resampling::Hold => f64::NAN,
                Resampling::Linear => match track.get(after) {
                    Some((next, next_value)) => {
                        let gap = next.saturating_sub(before) as f64;
                        if gap <= policy.maximum_gap { value + age / gap * (next_value - value) } else { f64::NAN }
                    }
                    None => f64::NAN,
                },
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track() -> Track {
        Track::new(vec![(100, 1.0), (300, 3.0), (200, 2.0), (1_000, 10.0), (1_000, 11.0)])
    }

    fn bits(values: &[f64]) -> Vec<u64> {
        values.iter().map(|value| value.to_bits()).collect()
    }

    #[test]
    fn lines_join_values_but_not_over_gaps_nor_beyond_the_ends() {
        let policy = Policy { method: Resampling::Linear, maximum_gap: 500.0 };
        let found = resample(&track(), &[50, 100, 150, 300, 301, 999, 1_000, 1_001], policy);
        let nan = f64::NAN;
        assert_eq!(bits(&found), bits(&[nan, 1.0, 1.5, 3.0, nan, nan, 10.0, nan]));
    }

    #[test]
    fn held_values_grow_old() {
        let policy = Policy { method: Resampling::Hold, maximum_gap: 500.0 };
        let found = resample(&track(), &[99, 100, 199, 800, 801, 1_500, 1_501], policy);
        let nan = f64::NAN;
        assert_eq!(bits(&found), bits(&[nan, 1.0, 1.0, 3.0, nan, 10.0, nan]));
    }

    #[test]
    fn without_a_limit_lines_bridge_five_intervals_and_commands_everything() {
        let linear = Policy::of(Resampling::Linear, None, &track());
        assert_eq!(linear.maximum_gap, 500.0);
        assert_eq!(Policy::of(Resampling::Hold, None, &track()).maximum_gap, f64::INFINITY);
        assert_eq!(Policy::of(Resampling::Linear, Some(2.0), &track()).maximum_gap, 2e9);
    }
}
