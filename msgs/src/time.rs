//! `builtin_interfaces/Time`.

use serde::{Deserialize, Serialize};

use crate::Message;

const NANOSECONDS_PER_SECOND: i64 = 1_000_000_000;

/// A point in time since the Unix epoch (or since the start, for simulated clocks).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
pub struct Time {
    /// Whole seconds, s; negative before the epoch.
    pub sec: i32,
    /// Nanoseconds to add to `sec`, ns, 0 to 999 999 999.
    pub nanosec: u32,
}

impl Time {
    /// The time that is `nanoseconds` (ns) after the epoch; `None` outside 1901 to 2038, which `sec` cannot hold.
    ///
    /// ```
    /// use excavator_msgs::Time;
    ///
    /// let time = Time::from_nanoseconds(1_500_000_000);
    /// assert_eq!(time, Some(Time { sec: 1, nanosec: 500_000_000 }));
    /// assert_eq!(time.map(Time::nanoseconds), Some(1_500_000_000));
    /// ```
    pub fn from_nanoseconds(nanoseconds: i64) -> Option<Time> {
        let sec = i32::try_from(nanoseconds.div_euclid(NANOSECONDS_PER_SECOND)).ok()?;
        let nanosec = u32::try_from(nanoseconds.rem_euclid(NANOSECONDS_PER_SECOND)).ok()?;
        Some(Time { sec, nanosec })
    }

    /// Nanoseconds since the epoch, ns. Exact for all field values, also for a `nanosec` above 999 999 999.
    pub fn nanoseconds(self) -> i64 {
        i64::from(self.sec) * NANOSECONDS_PER_SECOND + i64::from(self.nanosec)
    }
}

impl Message for Time {
    const TYPE_NAME: &'static str = "builtin_interfaces/msg/Time";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nanoseconds_survive_the_round_trip_on_both_sides_of_the_epoch() {
        for nanoseconds in [0, 1, -1, 999_999_999, 1_000_000_000, -1_000_000_001, 1_790_000_000_000_024_320] {
            assert_eq!(Time::from_nanoseconds(nanoseconds).map(Time::nanoseconds), Some(nanoseconds));
        }
    }

    #[test]
    fn a_time_after_2038_has_no_stamp() {
        assert_eq!(Time::from_nanoseconds((i64::from(i32::MAX) + 1) * NANOSECONDS_PER_SECOND), None);
        assert_eq!(Time::from_nanoseconds(i64::MAX), None);
    }
}
