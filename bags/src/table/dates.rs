//! Dates in maps and in the cells of spreadsheets.

use super::time_text::{DAY, Day, TimeText};

/// A date, in ns since the epoch; UTC if it has no time zone. `None` for anything else, and where day and month may be
/// exchanged.
pub fn parse_date(text: &str) -> Option<i64> {
    match TimeText::of(text)? {
        TimeText { day: Some(Day::Known(day)), clock, .. } => stamp(day, clock.unwrap_or(0)),
        _ => None,
    }
}

/// The stamp of a moment on a day, ns since the epoch; `None` outside 1678 to 2262.
pub(super) fn stamp(day: i64, clock: i64) -> Option<i64> {
    day.checked_mul(DAY)?.checked_add(clock)
}

#[cfg(test)]
mod tests {
    use super::parse_date;

    #[test]
    fn dates_with_and_without_zone_and_nothing_else() {
        let wanted = Some(1_500_000_000_250_000_000);
        for text in ["2017-07-14T02:40:00.25Z", "2017-07-14 02:40:00.25", "2017-07-14T04:40:00.25+02:00"] {
            assert_eq!(parse_date(text), wanted, "{text}");
        }
        for text in ["", "1500000000", "12.5", "2017-13-14T02:40:00Z", "1234-5678-9", "äöüäöüäöü", "3/4/2017 02:40:00"]
        {
            assert_eq!(parse_date(text), None, "{text}");
        }
    }
}
