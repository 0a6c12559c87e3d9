//! Parses dates in cells.

use jiff::civil::DateTime;
use jiff::{Timestamp, tz::TimeZone};

/// An ISO 8601 date with time, in ns since the epoch; UTC if it has no time zone. `None` for anything else.
pub fn parse_date(text: &str) -> Option<i64> {
    let text = text.trim();
    // Numbers are the common case and are never dates.
    if text.len() < 10 || !text.as_bytes().get(4).is_some_and(|sign| [b'-', b'/'].contains(sign)) {
        return None;
    }
    let text = text.replacen('/', "-", 2);
    let stamp = match text.parse::<Timestamp>() {
        Ok(stamp) => stamp,
        Err(_) => TimeZone::UTC.to_timestamp(text.parse::<DateTime>().ok()?).ok()?,
    };
    i64::try_from(stamp.as_nanosecond()).ok()
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
        for text in ["", "1500000000", "12.5", "2017-13-14T02:40:00Z", "1234-5678-9", "äöüäöüäöü"] {
            assert_eq!(parse_date(text), None, "{text}");
        }
    }
}
