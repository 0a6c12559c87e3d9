//! Recognises the columns of merged tables: one row per message, in which the columns of other topics are empty.

use crate::table::{Table, Values};

/// Largest share of filled cells of a column that is clearly one of several topics.
const SPARSE: f64 = 0.6;
/// Share of the empty cells of a fuller column that lie where the others have values.
const ELSEWHERE: f64 = 0.8;
/// Share of empty cells from which a column may be one of several topics: below, they are drop-outs of a sensor.
const LEAST_EMPTY: f64 = 0.01;
/// Fewest values of a column of a topic.
const FEWEST_VALUES: usize = 2;

/// Which columns of a table have their own samples: the filled cells. In other columns an empty cell is a missing sample.
pub(crate) fn sparse_columns(table: &Table) -> Vec<bool> {
    let filled: Vec<Option<Vec<bool>>> = table.columns.iter().map(|column| filled(&column.values)).collect();
    let count = |cells: &[bool]| cells.iter().filter(|is_filled| **is_filled).count();
    let share = |cells: &[bool]| count(cells) as f64 / cells.len().max(1) as f64;
    let is_sparse = |cells: &[bool]| share(cells) <= SPARSE && count(cells) >= FEWEST_VALUES;
    let mut sparse: Vec<bool> = filled.iter().map(|cells| cells.as_deref().is_some_and(is_sparse)).collect();
    // A column is of a merged table only if another has values in rows where it has none.
    let rows = filled.iter().flatten().map(Vec::len).max().unwrap_or(0);
    let mut elsewhere = vec![false; rows];
    for (cells, _) in filled.iter().zip(&sparse).filter(|(_, is_sparse)| **is_sparse) {
        let cells = cells.as_deref().unwrap_or_default();
        elsewhere.iter_mut().zip(cells).for_each(|(any, is_filled)| *any |= is_filled);
    }
    for (cells, sparse) in filled.iter().zip(&mut sparse) {
        let Some(cells) = cells.as_deref().filter(|cells| !*sparse && share(cells) < 1.0 - LEAST_EMPTY) else {
            continue;
        };
        let empty = cells.len() - count(cells);
        let is_elsewhere = cells.iter().zip(&elsewhere).filter(|(is_filled, any)| !**is_filled && **any).count();
        *sparse = empty > 0 && is_elsewhere as f64 >= ELSEWHERE * empty as f64;
    }
    sparse
}

/// Which cells have values; `None` if all have.
fn filled(values: &Values) -> Option<Vec<bool>> {
    match values {
        Values::Numbers(numbers) if numbers.iter().any(|number| number.is_nan()) => {
            Some(numbers.iter().map(|number| !number.is_nan()).collect())
        }
        Values::Stamps(stamps) if stamps.iter().any(Option::is_none) => {
            Some(stamps.iter().map(Option::is_some).collect())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Column;

    fn sparse(columns: &[&dyn Fn(usize) -> bool]) -> Vec<bool> {
        let column = |is_filled: &&dyn Fn(usize) -> bool| Column {
            name: String::new(),
            unit: None,
            values: Values::Numbers((0..1200).map(|row| if is_filled(row) { 1.0 } else { f64::NAN }).collect()),
            times: None,
        };
        sparse_columns(&Table { columns: columns.iter().map(column).collect(), ..Table::default() })
    }

    #[test]
    fn topics_of_a_merged_table_are_recognised() {
        assert_eq!(
            sparse(&[&|_| true, &|row| row % 3 == 0, &|row| row % 3 == 1, &|row| row % 3 == 2]),
            [false, true, true, true]
        );
        // A slow topic beside a fast one, merged by time and not.
        assert_eq!(sparse(&[&|_| true, &|row| row % 10 == 0]), [false, true]);
        assert_eq!(sparse(&[&|_| true, &|row| row % 6 != 0, &|row| row % 3 == 0]), [false, true, true]);
    }

    #[test]
    fn drop_outs_are_missing_samples() {
        assert_eq!(
            sparse(&[&|_| true, &|row| row % 50 != 7, &|row| !(300..600).contains(&row)]),
            [false, false, false]
        );
    }
}
