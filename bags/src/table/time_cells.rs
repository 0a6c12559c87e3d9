//! Collects the cells of a column of times.

use super::Values;
use super::dates::stamp;
use super::time_text::{DAY, Day, TimeText};

/// Nothing is recorded so rarely that the time of day falls by more than this, except at midnight, ns.
const HALF_A_DAY: i64 = DAY / 2;

/// The times read so far. Which of day and month comes first is decided at the end.
#[derive(Debug, Default)]
pub(super) struct TimeCells {
    cells: Vec<Option<TimeText>>,
}

/// What a column of times is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TimeKind {
    /// Moments.
    Dated,
    /// Days without a time.
    DaysOnly,
    /// Times of day or durations, in s; midnights are counted.
    OfDay,
}

impl TimeCells {
    /// With empty cells before the first time.
    pub fn after(missing: usize) -> TimeCells {
        TimeCells { cells: vec![None; missing] }
    }

    /// Adds a cell. Returns whether it is a time.
    pub fn push(&mut self, cell: &str) -> bool {
        let time = TimeText::of(cell);
        self.cells.push(time);
        time.is_some()
    }

    /// The values; times of day in s. Adds what is not certain to `notes`.
    pub fn finish(self, name: &str, notes: &mut Vec<String>) -> (TimeKind, Values) {
        let known = || self.cells.iter().flatten();
        if known().all(|time| time.day.is_none()) {
            return (TimeKind::OfDay, Values::Numbers(seconds(&self.cells)));
        }
        let kind = if known().all(|time| time.clock.is_none()) { TimeKind::DaysOnly } else { TimeKind::Dated };
        let is_month_first = self.is_month_first(name, notes);
        let stamps = self.cells.iter().map(|cell| {
            let TimeText { day, clock, .. } = (*cell)?;
            let day = match day? {
                Day::Known(day) => day,
                Day::Either { day_first, month_first } => {
                    if is_month_first {
                        month_first
                    } else {
                        day_first
                    }
                }
            };
            stamp(day, clock.unwrap_or(0))
        });
        (kind, Values::Stamps(stamps.collect()))
    }

    /// Dates like 3/4/2026 are read in the order of the others, else in the one in which they are closer together.
    fn is_month_first(&self, name: &str, notes: &mut Vec<String>) -> bool {
        let (mut day_first, mut month_first) = (Range::default(), Range::default());
        let mut is_doubtful = false;
        let mut has_meridiem = false;
        for time in self.cells.iter().flatten() {
            has_meridiem |= time.has_meridiem;
            match time.day {
                Some(Day::Either { day_first: one, month_first: other }) => {
                    is_doubtful = true;
                    day_first.add(one);
                    month_first.add(other);
                }
                Some(Day::Known(day)) => {
                    day_first.add(day);
                    month_first.add(day);
                }
                None => {}
            }
        }
        if !is_doubtful {
            return false;
        }
        if day_first.length() != month_first.length() {
            return month_first.length() < day_first.length();
        }
        let order = if has_meridiem { "month/day" } else { "day/month" };
        notes.push(format!("column {name}: dates are read as {order}/year; nothing in them says so"));
        has_meridiem
    }
}

/// Times of day in s; each fall by half a day is a midnight.
fn seconds(cells: &[Option<TimeText>]) -> Vec<f64> {
    let (mut before, mut midnights) = (None, 0);
    let values = cells.iter().map(|cell| {
        let clock = (*cell)?.clock?;
        if before.is_some_and(|before: i64| before.saturating_sub(clock) > HALF_A_DAY) {
            midnights += 1;
        }
        before = Some(clock);
        Some(clock.saturating_add(midnights * DAY) as f64 / 1e9)
    });
    values.map(|value| value.unwrap_or(f64::NAN)).collect()
}

/// First and last of some days.
#[derive(Debug, Default)]
struct Range(Option<[i64; 2]>);

impl Range {
    fn add(&mut self, day: i64) {
        let [first, last] = self.0.unwrap_or([day, day]);
        self.0 = Some([first.min(day), last.max(day)]);
    }

    fn length(&self) -> i64 {
        self.0.map_or(0, |[first, last]| last - first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(cells: &[&str]) -> (TimeKind, Values, usize) {
        let mut times = TimeCells::default();
        for cell in cells {
            let _ = times.push(cell);
        }
        let mut notes = Vec::new();
        let (kind, values) = times.finish("t", &mut notes);
        (kind, values, notes.len())
    }

    #[test]
    fn midnight_is_no_step_back() {
        let (kind, values, _) = read(&["23:59:59.5", "", "00:00:00.5", "00:00:01.5"]);
        let Values::Numbers(values) = values else { unreachable!() };
        assert_eq!((kind, values[0], values[2], values[3]), (TimeKind::OfDay, 86_399.5, 86_400.5, 86_401.5));
        assert!(values[1].is_nan());
    }

    #[test]
    fn the_order_of_a_date_is_found_where_it_shows() {
        let days = |cells: &[&str]| match read(cells) {
            (_, Values::Stamps(stamps), notes) => {
                (stamps[1].zip(stamps[0]).map(|(b, a)| (b - a) / 1_000_000_000), notes)
            }
            _ => (None, 0),
        };
        assert_eq!(days(&["3/4/2026 23:59:59", "4/4/2026 00:00:00"]), (Some(1), 0));
        assert_eq!(days(&["4/3/2026 23:59:59", "4/4/2026 00:00:00"]), (Some(1), 0));
        assert_eq!(days(&["4/3/2026 10:00:00", "4/3/2026 10:00:01"]), (Some(1), 1));
        assert_eq!(days(&["13/3/2026 10:00:00", "13/3/2026 10:00:01"]), (Some(1), 0));
    }
}
