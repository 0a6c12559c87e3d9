//! Skips rows that cannot be read.

use super::sqlite_connection::{Bounded, SqliteFault};
use super::sqlite_query::{last_row, rows_from};

/// About the number of rows in one page of the database. Larger steps could skip intact pages between two damaged ones.
const LARGEST_STEP: i64 = 64;
/// After this many failed probes the step size is no longer limited: so much is lost that speed matters more.
const PATIENT_PROBES: usize = 5_000;

/// The first row id after `bad` from which reading succeeds; `None` if nothing readable follows.
pub(super) fn next_readable(connection: &Bounded, bad: i64) -> Option<i64> {
    let last = last_row(connection).ok().flatten().unwrap_or(i64::MAX);
    let (mut before, mut step) = (bad, 1_i64);
    let mut probes = 0;
    let mut good = loop {
        let probe = before.checked_add(step).filter(|&probe| probe <= last)?;
        match first_row(connection, probe) {
            Ok(found) => break found?,
            Err(_) => before = probe,
        }
        probes += 1;
        if step < LARGEST_STEP || probes > PATIENT_PROBES {
            step = step.saturating_mul(2);
        }
    };
    // Binary search between `before`, which fails, and `good` for the first that succeeds.
    while good.checked_sub(before).is_some_and(|distance| distance > 1) {
        let middle = before + (good - before) / 2;
        match first_row(connection, middle) {
            Ok(Some(found)) if found < good => good = found.max(middle),
            Ok(_) => good = middle,
            Err(_) => before = middle,
        }
    }
    Some(good)
}

/// Id of the first row at or after `from`, after the whole row has been read.
fn first_row(connection: &Bounded, from: i64) -> Result<Option<i64>, SqliteFault> {
    let mut found = None;
    rows_from(connection, from, |row| {
        found = Some(row.id);
        false
    })?;
    Ok(found)
}
