//! Times that a table has in two columns: a day and a time of day, or seconds and nanoseconds.

use super::time_cells::TimeKind;
use super::time_text::DAY;
use super::{Table, Values};

/// Ends of the headings of whole seconds, and of their fractions with the fractions in a second.
const SECONDS: [&str; 6] = ["seconds", "secs", "sec", "second", "tv_sec", "s"];
const FRACTIONS: [(&str, f64); 16] = [
    ("nanoseconds", 1e9),
    ("nanosecs", 1e9),
    ("nanosec", 1e9),
    ("nsecs", 1e9),
    ("nsec", 1e9),
    ("nanos", 1e9),
    ("ns", 1e9),
    ("microseconds", 1e6),
    ("microsec", 1e6),
    ("usecs", 1e6),
    ("usec", 1e6),
    ("us", 1e6),
    ("milliseconds", 1e3),
    ("millis", 1e3),
    ("msec", 1e3),
    ("ms", 1e3),
];
/// Larger numbers of seconds are since the epoch.
const EPOCH_SECONDS: f64 = 1e8;

/// Makes one column of times of two. The first of them stays as it is, but where it has the seconds; then it is replaced.
pub(super) fn combine(table: &mut Table, kinds: &[Option<TimeKind>]) {
    day_and_time(table, kinds);
    seconds_and_fraction(table);
}

/// A column of days and one of times of day: the latter becomes one of moments.
fn day_and_time(table: &mut Table, kinds: &[Option<TimeKind>]) {
    let find = |wanted: TimeKind| kinds.iter().position(|kind| *kind == Some(wanted));
    let (Some(date), Some(time)) = (find(TimeKind::DaysOnly), find(TimeKind::OfDay)) else { return };
    let (Values::Stamps(days), Values::Numbers(seconds)) = (&table.columns[date].values, &table.columns[time].values)
    else {
        return;
    };
    let is_one_day = days.iter().flatten().min() == days.iter().flatten().max();
    let mut last = None;
    let stamps = days.iter().zip(seconds).map(|(day, seconds)| {
        // Some loggers write the day in the first row only.
        last = day.or(last);
        let clock = (seconds * 1e9).round();
        // Where the days change, the midnights in the times of day are counted already.
        let clock = if is_one_day { clock as i64 } else { (clock as i64).rem_euclid(DAY) };
        last.filter(|_| seconds.is_finite())?.checked_add(clock)
    });
    let stamps = Values::Stamps(stamps.collect());
    let (date, time_name) = (table.columns[date].name.clone(), table.columns[time].name.clone());
    table.columns[time].values = stamps;
    table.columns[time].unit = None;
    table.notes.push(format!("column {time_name}: the days of column {date} were added"));
}

/// Columns of whole seconds and of the rest of a second: the former becomes the sum.
fn seconds_and_fraction(table: &mut Table) {
    for place in 0..table.columns.len().saturating_sub(1) {
        let (whole, rest) = (&table.columns[place], &table.columns[place + 1]);
        let is_named = fractions_of(&whole.name, &rest.name);
        let has_no_heading =
            whole.name == format!("column_{}", place + 1) && rest.name == format!("column_{}", place + 2);
        let Some(of_second) = is_named.or(has_no_heading.then_some(1e9)) else { continue };
        let (Values::Numbers(seconds), Values::Numbers(fractions)) = (&whole.values, &rest.values) else { continue };
        let is_whole = |value: &f64| value.is_nan() || value.fract() == 0.0;
        let is_rest = |value: &f64| value.is_nan() || (value.fract() == 0.0 && (0.0..of_second).contains(value));
        if !seconds.iter().all(is_whole)
            || !fractions.iter().all(is_rest)
            || fractions.iter().all(|value| *value == 0.0)
        {
            continue;
        }
        let pairs = || seconds.iter().zip(fractions);
        let is_dated = seconds.iter().any(|seconds| *seconds > EPOCH_SECONDS);
        // Without headings, the numbers must be clear: whole seconds since the epoch, and a sum that grows.
        if is_named.is_none() && !(is_dated && is_growing(seconds, fractions)) {
            continue;
        }
        let values = if is_dated {
            let stamp = |(whole, rest): (&f64, &f64)| {
                let is_known = whole.is_finite() && rest.is_finite() && *whole < 9e9;
                is_known
                    .then(|| (*whole as i64).checked_mul(1_000_000_000)?.checked_add((rest * 1e9 / of_second) as i64))?
            };
            Values::Stamps(pairs().map(stamp).collect())
        } else {
            Values::Numbers(pairs().map(|(whole, rest)| whole + rest / of_second).collect())
        };
        let (whole, rest) = (whole.name.clone(), rest.name.clone());
        table.columns[place].unit = matches!(values, Values::Numbers(_)).then(|| "s".to_string());
        table.columns[place].values = values;
        table.notes.push(format!("column {whole}: the fractions of a second in column {rest} were added"));
        return;
    }
}

/// Whether seconds and nanoseconds together only grow, though neither does alone.
fn is_growing(seconds: &[f64], fractions: &[f64]) -> bool {
    let pairs = || seconds.iter().zip(fractions);
    let grows = pairs().zip(pairs().skip(1)).all(|((s, f), (next_s, next_f))| (next_s, next_f) > (s, f));
    let stands = seconds.windows(2).any(|pair| pair[0] == pair[1]);
    grows && stands && fractions.iter().any(|fraction| *fraction >= 1e6)
}

/// Fractions in a second, if the headings are those of seconds and of their fractions.
fn fractions_of(whole: &str, rest: &str) -> Option<f64> {
    let (whole, rest) = (whole.to_lowercase(), rest.to_lowercase());
    let before = |name: &str, ending: &str| name.strip_suffix(ending).map(str::to_string);
    let stem = SECONDS.iter().find_map(|ending| before(&whole, ending))?;
    let is_end = |stem: &str| stem.is_empty() || stem.ends_with(|c: char| !c.is_alphanumeric());
    let (_, of_second) =
        FRACTIONS.iter().find(|(ending, _)| before(&rest, ending).is_some_and(|other| other == stem))?;
    is_end(&stem).then_some(*of_second)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_go_with_their_own_fractions() {
        for (whole, rest, wanted) in [
            (".header.stamp.secs", ".header.stamp.nsecs", Some(1e9)),
            ("stamp_sec", "stamp_nanosec", Some(1e9)),
            ("Seconds", "Microseconds", Some(1e6)),
            ("sec", "msec", Some(1e3)),
            ("a.sec", "b.nanosec", None),
            ("pressures", "ns", None),
            ("time", "x", None),
        ] {
            assert_eq!(fractions_of(whole, rest), wanted, "{whole} {rest}");
        }
    }
}
