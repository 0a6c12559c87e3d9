//! Prints what changed.

use comfy_table::{Cell, Table};
use excavator_identification::change::Changes;
use excavator_report::{relative_change, workshop_value};

use super::{right, table};

/// Parameters before and after: those that changed first, those that cannot be compared last.
pub fn change_table(changes: &Changes) -> Table {
    let mut table = table(&["parameter", "before", "after", "change", "result"]);
    for one in &changes.parameters {
        let result = match (one.is_determined, one.has_changed) {
            (_, true) => "changed",
            (true, false) => "unchanged",
            (false, false) => "not determined",
        };
        table.add_row([
            Cell::new(&one.name),
            right(workshop_value(one, 0)),
            right(workshop_value(one, 1)),
            right(if one.is_determined { relative_change(one) } else { "-".to_string() }),
            Cell::new(result),
        ]);
    }
    table
}
