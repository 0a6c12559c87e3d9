//! Finds the candidates in a table.

use super::super::clock_source::{ClockSource, ColumnName};
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
                None => (clock(GUESSED_RATE), "no time found: put the true rate in Hz".into()),
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

/// Assumed rate of a table without any information, Hz: a placeholder.
const GUESSED_RATE: f64 = 100.0;

fn columns(table: &Table, clock: &str, rows: usize, time: &[f64]) -> Vec<Candidate> {
    let mut candidates = Vec::new();
    for column in table.columns.iter().filter(|column| column.name != clock) {
        let Values::Numbers(values) = &column.values else { continue };
        let fits = if rows == 0 { values.len() > 1 } else { values.len() == rows };
        if fits {
            let unit =
                column.unit.as_deref().and_then(Unit::named).map(|unit| (unit, "the heading says so".to_string()));
            candidates.push(Candidate {
                words: words(&column.name),
                origin: Origin::Column(column.name.clone()),
                dimension: unit.as_ref().map(|(unit, _)| unit.dimension),
                unit,
                time: if rows == 0 { (0..values.len()).map(|row| row as f64 / 100.0).collect() } else { time.to_vec() },
                values: values.clone(),
            });
        }
    }
    candidates
}

fn grows(values: &Values) -> bool {
    match values {
        Values::Numbers(numbers) => numbers.len() > 2 && numbers.windows(2).all(|pair| pair[1] > pair[0]),
        Values::Stamps(_) => true,
    }
}

/// Unit of a time column and the reason for it.
fn time_unit(heading: Option<&str>, numbers: &[f64]) -> (&'static str, &'static str) {
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
