//! Checks the age of a command.

use excavator_msgs::Time;

use super::refusal::Refusal;

/// Limits for stamps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StampLimits {
    /// Largest age, s.
    pub max_age: f64,
    /// Whether an empty stamp is accepted.
    pub accept_unstamped: bool,
}

/// Longest time for which a stamp may be ahead of this node's clock, s. Clocks that PTP or NTP synchronises on one network
/// differ by less than 10 ms. The rest allows for a clock that is being set.
const MAX_AHEAD: f64 = 0.1;

/// Checks a stamp against the clocks (ns) that a sender may use: the system clock, and that of a simulation which is the source
/// of time. The stamp has to agree with one of them.
///
/// # Errors
/// [`Refusal::Unstamped`], [`Refusal::TooOld`], [`Refusal::FromTheFuture`], by the clock nearest to the stamp.
pub(super) fn check(stamp: Time, clocks: &[i64], limits: StampLimits) -> Result<(), Refusal> {
    if stamp == Time::default() {
        return if limits.accept_unstamped { Ok(()) } else { Err(Refusal::Unstamped) };
    }
    let ages = clocks.iter().map(|&now| (now - stamp.nanoseconds()) as f64 * 1e-9);
    let Some(age) = ages.min_by(|one, other| one.abs().total_cmp(&other.abs())) else { return Ok(()) };
    if age > limits.max_age {
        return Err(Refusal::TooOld { age, most: limits.max_age });
    }
    if age < -MAX_AHEAD {
        return Err(Refusal::FromTheFuture { ahead: -age, most: MAX_AHEAD });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOW: i64 = 1_800_000_000_000_000_000;
    const LIMITS: StampLimits = StampLimits { max_age: 0.5, accept_unstamped: false };

    fn stamped(seconds_after_now: f64) -> Time {
        Time::from_nanoseconds(NOW + (seconds_after_now * 1e9) as i64).unwrap_or_default()
    }

    #[test]
    fn stamps_of_now_pass_and_others_do_not() {
        for good in [0.0, -0.49, 0.09] {
            assert_eq!(check(stamped(good), &[NOW], LIMITS), Ok(()), "{good}");
        }
        assert_eq!(check(stamped(-0.75), &[NOW], LIMITS), Err(Refusal::TooOld { age: 0.75, most: 0.5 }));
        assert_eq!(check(stamped(2.0), &[NOW], LIMITS), Err(Refusal::FromTheFuture { ahead: 2.0, most: MAX_AHEAD }));
        let in_1970 = Time { sec: 1, nanosec: 0 };
        assert!(matches!(check(in_1970, &[NOW], LIMITS), Err(Refusal::TooOld { .. })));
    }

    #[test]
    fn an_empty_stamp_passes_only_where_it_is_accepted() {
        assert_eq!(check(Time::default(), &[NOW], LIMITS), Err(Refusal::Unstamped));
        let lenient = StampLimits { accept_unstamped: true, ..LIMITS };
        assert_eq!(check(Time::default(), &[NOW], lenient), Ok(()));
    }

    #[test]
    fn one_of_two_clocks_is_enough() {
        let simulated = 12_500_000_000;
        let stamp = Time { sec: 12, nanosec: 400_000_000 };
        assert_eq!(check(stamp, &[NOW, simulated], LIMITS), Ok(()));
        assert_eq!(check(stamped(0.0), &[NOW, simulated], LIMITS), Ok(()));
        assert!(check(stamp, &[NOW], LIMITS).is_err());
    }
}
