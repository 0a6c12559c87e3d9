//! Parses times as people and loggers write them: dates of several countries, times of day, durations.

use jiff::civil::Date;

/// The forms that are read, for error messages.
pub(crate) const FORMS: &str = "numbers with a unit of time, 2026-11-20T10:00:00.5, 20.11.2026 10:00:00.5, 11/20/2026 10:00:00.5 AM, \
                                20-Nov-2026 10:00:00.5, 10:00:00.5, 10:00:00:500, and days of a spreadsheet";

const SECOND: i64 = 1_000_000_000;
pub(super) const DAY: i64 = 86_400 * SECOND;
/// Longest text that is a time.
const LONGEST: usize = 64;

/// Which number of a date comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Day {
    /// Days since 1970.
    Known(i64),
    /// `3/4/2026` is one day if the day comes first, and another if the month does.
    Either { day_first: i64, month_first: i64 },
}

/// A time as written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TimeText {
    /// `None` for a time of day and for a duration.
    pub day: Option<Day>,
    /// ns since midnight in UTC, or of a duration; `None` for a date alone.
    pub clock: Option<i64>,
    /// Whether it says AM or PM.
    pub has_meridiem: bool,
}

/// Months in English, German, French, Italian and Spanish, by their first three or four letters.
const MONTHS: [&[&str]; 12] = [
    &["jan", "jän", "gen", "ene"],
    &["feb", "fév", "fev"],
    &["mar", "mär", "mrz"],
    &["apr", "avr", "abr"],
    &["may", "mai", "mag"],
    &["jun", "juin", "giu"],
    &["jul", "juil", "lug"],
    &["aug", "aoû", "aou", "ago"],
    &["sep", "set"],
    &["oct", "okt", "ott"],
    &["nov"],
    &["dec", "dez", "déc", "dic"],
];
const WEEKDAYS: [&str; 18] = [
    "mon", "tue", "wed", "thu", "fri", "sat", "sun", "die", "mit", "don", "sam", "mo", "di", "mi", "do", "fr", "sa",
    "so",
];

impl TimeText {
    /// The time in a text; `None` for a number and for anything else.
    pub fn of(text: &str) -> Option<TimeText> {
        let text = text.trim().trim_matches(['"', '\'']);
        let has_digit = text.bytes().any(|byte| byte.is_ascii_digit());
        let has_sign = text.bytes().any(|byte| b":/-.".contains(&byte));
        if text.len() > LONGEST || text.len() < 5 || !has_digit || !has_sign {
            return None;
        }
        let mut parts = Parts::default();
        for token in text.split([' ', '\t', '_', '\u{a0}', '\u{202f}']).filter(|token| !token.is_empty()) {
            parts.take(token)?;
        }
        parts.finish()
    }
}

/// The parts of a time found so far.
#[derive(Debug, Default)]
struct Parts {
    day: Option<Day>,
    /// Numbers beside the name of a month.
    loose: Vec<i64>,
    month: Option<i64>,
    /// Whole days of a duration.
    days: i64,
    clock: Option<i64>,
    is_afternoon: Option<bool>,
    /// s east of Greenwich.
    zone: i64,
}

impl Parts {
    fn take(&mut self, token: &str) -> Option<()> {
        let token = token.strip_suffix(',').unwrap_or(token);
        // The day of a month in German: 20.
        let ordinal =
            token.strip_suffix('.').filter(|day| day.len() <= 2 && day.bytes().all(|byte| byte.is_ascii_digit()));
        let token = ordinal.unwrap_or(token);
        // A T between date and time, as in ISO 8601.
        if let Some((date, clock)) = token.split_once(['T', 't'])
            && date.ends_with(|c: char| c.is_ascii_digit())
            && clock.starts_with(|c: char| c.is_ascii_digit())
        {
            self.take(date)?;
            return self.take(clock);
        }
        let lower = token.to_lowercase();
        match lower.as_str() {
            "am" | "a.m." => return self.meridiem(false),
            "pm" | "p.m." => return self.meridiem(true),
            "z" | "utc" | "gmt" | "uhr" | "," => return Some(()),
            "days" | "day" | "d" => {
                self.days = self.loose.pop()?;
                return Some(());
            }
            _ => {}
        }
        if token.contains(':') && self.clock.is_none() {
            return self.clock(&lower);
        }
        if token.starts_with(['+', '-']) && self.clock.is_some() {
            self.zone = zone(token)?;
            return Some(());
        }
        if token.bytes().all(|byte| byte.is_ascii_digit()) {
            return (token.len() <= 4).then(|| token.parse().ok()).flatten().map(|number| self.loose.push(number));
        }
        if lower.starts_with(|c: char| c.is_alphabetic()) {
            return self.word(&lower);
        }
        if self.day.is_some() {
            return None;
        }
        self.day = Some(day(&lower)?);
        Some(())
    }

    fn meridiem(&mut self, is_afternoon: bool) -> Option<()> {
        self.is_afternoon = Some(is_afternoon);
        Some(())
    }

    fn word(&mut self, lower: &str) -> Option<()> {
        let word = lower.trim_end_matches(['.', ',']);
        match month(word) {
            Some(month) if self.month.is_none() => self.month = Some(month),
            _ => {
                let is_weekday =
                    WEEKDAYS.iter().any(|day| if day.len() == 2 { word == *day } else { word.starts_with(day) });
                return is_weekday.then_some(());
            }
        }
        Some(())
    }

    /// `10:00:00.5`, `10:00:00,5`, `10:00:00:500`, `10:00:00.5Z`, `10:00:00+01:00`, `10:00:00PM`.
    fn clock(&mut self, lower: &str) -> Option<()> {
        let mut text = lower.strip_suffix('z').unwrap_or(lower);
        for (suffix, is_afternoon) in [("am", false), ("pm", true)] {
            if let Some(rest) = text.strip_suffix(suffix) {
                self.is_afternoon = Some(is_afternoon);
                text = rest;
            }
        }
        if let Some(at) = text.rfind(['+', '-']).filter(|at| *at > 0) {
            self.zone = zone(&text[at..])?;
            text = &text[..at];
        }
        let fields: Vec<&str> = text.split(':').collect();
        let whole = |text: &str| -> Option<i64> {
            let is_number = !text.is_empty() && text.len() <= 6 && text.bytes().all(|byte| byte.is_ascii_digit());
            is_number.then(|| text.parse().ok()).flatten()
        };
        let sixty = |text: &str| whole(text).filter(|number| *number < 60);
        let (hours, minutes, seconds) = match fields.as_slice() {
            // Minutes and seconds with a fraction.
            [minutes, seconds] if seconds.contains(['.', ',']) => (0, whole(minutes)?, nanoseconds(seconds)?),
            [hours, minutes] => (whole(hours)?, sixty(minutes)?, 0),
            [hours, minutes, seconds] => (whole(hours)?, sixty(minutes)?, nanoseconds(seconds)?),
            [hours, minutes, seconds, rest] if [3, 6, 9].contains(&rest.len()) => {
                let fraction = whole_of_nine(rest)?;
                (whole(hours)?, sixty(minutes)?, sixty(seconds)? * SECOND + fraction)
            }
            _ => return None,
        };
        // "10:00" alone may be minutes and seconds, or a ratio.
        self.clock = Some((hours * 3600 + minutes * 60) * SECOND + seconds);
        (fields.len() > 2 || seconds > 0 || self.day.is_some() || self.month.is_some()).then_some(())
    }

    fn finish(mut self) -> Option<TimeText> {
        if let Some(month) = self.month {
            let (first, second) = (*self.loose.first()?, *self.loose.get(1)?);
            let (day, year) = if first > 31 { (second, first) } else { (first, second) };
            self.day = Some(Day::Known(days(year_of(year, 0)?, month, day)?));
            self.loose.clear();
        }
        if !self.loose.is_empty() || (self.day.is_none() && self.clock.is_none()) {
            return None;
        }
        let mut clock = self.clock;
        if let (Some(is_afternoon), Some(time)) = (self.is_afternoon, &mut clock) {
            let half = DAY / 2;
            let is_twelve = (half..half + DAY / 24).contains(time);
            if *time >= half + DAY / 24 {
                return None;
            }
            *time += match (is_afternoon, is_twelve) {
                (true, false) => half,
                (false, true) => -half,
                _ => 0,
            };
        }
        // A leap second and 24:00 are the next day; more hours are a duration.
        if self.day.is_some() && clock.is_some_and(|time| time > DAY + SECOND) {
            return None;
        }
        let clock = clock.map(|time| time + self.days * DAY - self.zone * SECOND);
        Some(TimeText { day: self.day, clock, has_meridiem: self.is_afternoon.is_some() })
    }
}

/// Seconds with a fraction, as ns; a leap second is one.
fn nanoseconds(text: &str) -> Option<i64> {
    let (whole, fraction) = text.split_once(['.', ',']).unwrap_or((text, ""));
    let is_number = (1..=2).contains(&whole.len()) && whole.bytes().all(|byte| byte.is_ascii_digit());
    let seconds: i64 = is_number.then(|| whole.parse().ok()).flatten().filter(|seconds| *seconds <= 60)?;
    Some(seconds * SECOND + whole_of_nine(fraction)?)
}

/// The digits after a decimal sign as billionths.
fn whole_of_nine(digits: &str) -> Option<i64> {
    if !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let nine = digits.bytes().chain(std::iter::repeat(b'0')).take(9);
    Some(nine.fold(0, |sum, digit| 10 * sum + i64::from(digit - b'0')))
}

/// `+01:00`, `-0330`, `+02` in s.
fn zone(text: &str) -> Option<i64> {
    let sign = if text.starts_with('-') { -1 } else { 1 };
    let digits: String = text[1..].chars().filter(|c| *c != ':').collect();
    if !(digits.len() == 2 || digits.len() == 4) || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let (hours, minutes): (i64, i64) =
        (digits[..2].parse().ok()?, digits.get(2..4).map_or(Some(0), |m| m.parse().ok())?);
    (hours <= 14).then_some(sign * (hours * 3600 + minutes * 60))
}

/// A date in one word: `2026-11-20`, `20.11.2026`, `11/20/26`, `20-Nov-2026`.
fn day(lower: &str) -> Option<Day> {
    let separator = lower.chars().find(|c| ['-', '/', '.'].contains(c))?;
    let parts: Vec<&str> = lower.split(separator).collect();
    let [first, second, third] = parts.as_slice() else { return None };
    let number = |text: &str| -> Option<i64> {
        let is_number = (1..=4).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then(|| text.parse().ok()).flatten()
    };
    if let Some(month) = month(second) {
        return Some(Day::Known(days(year_of(number(third)?, third.len())?, month, number(first)?)?));
    }
    let (one, two, three) = (number(first)?, number(second)?, number(third)?);
    if first.len() == 4 {
        return Some(Day::Known(days(one, two, three)?));
    }
    // A number like 1.2.3 is a version.
    if !(third.len() == 4 || (third.len() == 2 && first.len() == 2 && second.len() == 2)) {
        return None;
    }
    let year = year_of(three, third.len())?;
    let (day_first, month_first) = (days(year, two, one), days(year, one, two));
    match (day_first, month_first) {
        (Some(day), _) if separator == '.' => Some(Day::Known(day)),
        (Some(one), Some(other)) if one == other => Some(Day::Known(one)),
        (Some(day_first), Some(month_first)) => Some(Day::Either { day_first, month_first }),
        (one, other) => one.or(other).map(Day::Known),
    }
}

fn year_of(number: i64, digits: usize) -> Option<i64> {
    match number {
        1800..=2200 => Some(number),
        0..=69 if digits == 2 => Some(2000 + number),
        70..=99 if digits == 2 => Some(1900 + number),
        _ => None,
    }
}

fn month(word: &str) -> Option<i64> {
    let number = MONTHS.iter().position(|names| names.iter().any(|name| word.starts_with(name)))?;
    i64::try_from(number + 1).ok()
}

/// Days since 1970.
fn days(year: i64, month: i64, day: i64) -> Option<i64> {
    let date = Date::new(i16::try_from(year).ok()?, i8::try_from(month).ok()?, i8::try_from(day).ok()?).ok()?;
    let since = date.since(Date::constant(1970, 1, 1)).ok()?;
    Some(i64::from(since.get_days()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 20 November 2023, days since 1970.
    const DATE: i64 = 19_681;
    /// 10:00:00.5 in ns.
    const CLOCK: i64 = 36_000_500_000_000;

    #[test]
    fn one_moment_in_many_forms() {
        for text in [
            "2023-11-20T10:00:00.5Z",
            "2023-11-20 10:00:00.500",
            "2023/11/20 10:00:00,5",
            "2023.11.20 10:00:00.5",
            "2023-11-20T11:00:00.5+01:00",
            "20.11.2023 10:00:00,500",
            "20.11.2023, 10:00:00.5",
            "20.11.23 10:00:00.5",
            "20-11-2023_10:00:00.5",
            "20/11/2023 10:00:00:500",
            "11/20/2023 10:00:00.500 AM",
            "11/20/2023 10:00:00.5am",
            "20-Nov-2023 10:00:00.5",
            "20 Nov 2023 10:00:00.5",
            "Nov 20, 2023 10:00:00.5",
            "Mon Nov 20 10:00:00.5 2023",
            "Montag, 20. November 2023 10:00:00.5",
        ] {
            let wanted = Some((Some(Day::Known(DATE)), Some(CLOCK)));
            assert_eq!(TimeText::of(text).map(|found| (found.day, found.clock)), wanted, "{text}");
        }
    }

    #[test]
    fn times_of_day_and_durations() {
        let clock = |text| TimeText::of(text).map(|found| (found.day.is_some(), found.clock));
        for text in ["10:00:00.5", "10:00:00,500", "10:00:00:500", "10:00:00.5 AM", "0 days 10:00:00.500000"] {
            assert_eq!(clock(text), Some((false, Some(CLOCK))), "{text}");
        }
        assert_eq!(clock("12:00:00 AM"), Some((false, Some(0))));
        assert_eq!(clock("01:00:00 pm"), Some((false, Some(13 * 3600 * SECOND))));
        assert_eq!(clock("1 days 00:00:00"), Some((false, Some(DAY))));
        assert_eq!(clock("100:00:01"), Some((false, Some(360_001 * SECOND))));
        assert_eq!(clock("01:02.5"), Some((false, Some(62_500_000_000))));
        assert_eq!(clock("20.11.2023"), Some((true, None)));
    }

    #[test]
    fn a_date_may_have_two_readings() {
        let found = TimeText::of("3/4/2026 10:00:00").and_then(|found| found.day);
        assert!(matches!(found, Some(Day::Either { day_first, month_first }) if day_first - month_first == 30));
        assert!(matches!(TimeText::of("13/4/2026").and_then(|found| found.day), Some(Day::Known(_))));
    }

    #[test]
    fn what_is_no_time_is_none() {
        for text in [
            "",
            "1500000000",
            "12.5",
            "-1.5e-3",
            "1.2.3",
            "5-",
            "10:00",
            "1:2",
            "25.1 mm",
            "2023-13-20 10:00:00",
            "31.02.2023",
            "10:61:00",
            "a:b:c",
            "13:00:00 AM",
            "10:00:00 apples",
            "äöüäöüäöü",
            "5 bar",
            "1234-5678-9",
            "::",
        ] {
            assert_eq!(TimeText::of(text), None, "{text}");
        }
    }
}
