//! Finds the candidates in a table.

use super::super::clock_source::{ClockSource, ColumnName};
use super::super::day_serial;
use super::super::sparse::sparse_columns;
use super::super::table_clock::time_column;
use super::super::unit::{Dimension, Unit};
use super::candidate::{Candidate, Found, Origin, words};
use crate::table::{Sampling, Table, Values};

/// The columns that may be signals, and the clock.
pub(super) fn candidates(table: &Table) -> Found {
    let found = time_column(table).map(|column| (column, "named or written like a time")).or_else(|| {
        // Otherwise the first column that increases from the first row on, unless a line states the sampling rate.
        let column = table.columns.iter().find(|column| table.sampling.is_none() && grows(&column.values))?;
        Some((column, "the first column that only grows"))
    });
    let rows = found.map_or(0, |(column, _)| column.values.len());
    let (clock, time) = match found {
        None => {
            let clock = |rate: f64| ClockSource { rate: Some(rate), ..ClockSource::default() };
            let clock = match &table.sampling {
                Some(Sampling { rate, line }) => (clock(*rate), format!("the line \"{line}\" says so")),
                // The next verb asks for it.
                None => (ClockSource::default(), NO_TIME.into()),
            };
            (clock, Vec::new())
        }
        Some((column, reason)) => {
            let name = Some(ColumnName::Name(column.name.clone()));
            let mut clock = ClockSource { column: name, ..ClockSource::default() };
            let time = match &column.values {
                Values::Stamps(stamps) => {
                    let first = stamps.iter().flatten().next().copied().unwrap_or_default();
                    stamps.iter().map(|s| s.map_or(f64::NAN, |s| s.saturating_sub(first) as f64 / 1e9)).collect()
                }
                Values::Numbers(numbers) => {
                    let (name, why) = time_unit(column.unit.as_deref(), numbers);
                    let unit = Unit::named(name).unwrap_or(Unit::si(Dimension::Time));
                    clock.unit = Some(name.to_string());
                    let time: Vec<f64> = numbers.iter().map(|&number| unit.to_si(number)).collect();
                    return found_with(columns(table, &column.name, rows, &time), (clock, format!("{reason}; {why}")));
                }
            };
            ((clock, reason.to_string()), time)
        }
    };
    let name = clock.0.column.as_ref().map(ToString::to_string).unwrap_or_default();
    found_with(columns(table, &name, rows, &time), clock)
}

fn found_with(candidates: Vec<Candidate>, clock: (ClockSource, String)) -> Found {
    Found { candidates, clock, unreadable: Vec::new() }
}

/// The reason for a clock that nobody can guess.
pub(super) const NO_TIME: &str = "no time found: put the true rate in Hz";

fn columns(table: &Table, clock: &str, rows: usize, time: &[f64]) -> Vec<Candidate> {
    let mut candidates = Vec::new();
    let sparse = sparse_columns(table);
    let clock_place = table.columns.iter().position(|column| column.name == clock);
    for (place, column) in table.columns.iter().enumerate() {
        let Values::Numbers(values) = &column.values else { continue };
        let is_times = table.columns.iter().any(|other| other.times == Some(place));
        let fits = if rows == 0 { values.len() > 1 } else { values.len() == rows };
        if Some(place) == clock_place || is_times || !fits {
            continue;
        }
        let unit = column.unit.as_deref().and_then(Unit::named).map(|unit| (unit, "the heading says so".to_string()));
        let has_twin = table.columns.iter().filter(|other| other.name == column.name).count() > 1;
        let number = if has_twin { Some(place + 1) } else { None };
        let filled = values.iter().filter(|value| value.is_finite()).count() as f64 / values.len().max(1) as f64;
        let time = if rows == 0 { (0..values.len()).map(|row| row as f64 / 100.0).collect() } else { time.to_vec() };
        // The empty cells of a merged table are no samples.
        let (time, values) = match sparse.get(place) {
            Some(true) => time.iter().zip(values).filter(|(_, value)| value.is_finite()).unzip(),
            _ => (time, values.clone()),
        };
        candidates.push(Candidate {
            words: words(without_unit(&column.name, column.unit.as_deref())),
            origin: Origin::Column { name: column.name.clone(), number },
            dimension: unit.as_ref().map(|(unit, _)| unit.dimension),
            unit,
            time,
            values,
            filled,
        });
    }
    candidates
}

/// A heading without the unit at its end: the V of `u_V` is no velocity.
fn without_unit<'n>(name: &'n str, unit: Option<&str>) -> &'n str {
    let parts =
        name.rsplit_once('_').filter(|(_, ending)| Unit::named(ending).is_some_and(|found| Some(found.name) == unit));
    parts.map_or(name, |(stem, _)| stem)
}

fn grows(values: &Values) -> bool {
    match values {
        Values::Numbers(numbers) => numbers.len() > 2 && numbers.windows(2).all(|pair| pair[1] > pair[0]),
        Values::Stamps(_) => true,
    }
}

/// Unit of a time column and the reason for it.
fn time_unit(heading: Option<&str>, numbers: &[f64]) -> (&'static str, &'static str) {
    if heading.is_none() && day_serial::are_days(numbers) {
        return ("d", "days of a spreadsheet or of MATLAB, by their range and their steps");
    }
    let named = heading.and_then(Unit::named).filter(|unit| unit.dimension == Dimension::Time);
    if let Some(unit) = named {
        return (unit.name, "its unit is in the heading");
    }
    let mut steps: Vec<f64> = numbers.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect();
    if steps.is_empty() {
        return ("s", "no unit given");
    }
    let middle = steps.len() / 2;
    let step = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    // Machines are sampled between 1 Hz and 10 kHz.
    match step {
        step if step >= 5e4 => ("ns", "steps of over 50 000 can only be nanoseconds"),
        step if step > 200.0 => ("us", "steps of over 200 can only be microseconds"),
        step if step >= 1.0 => ("ms", "steps of 1 to 200 are most likely milliseconds"),
        _ => ("s", "steps under 1 are seconds"),
    }
}
