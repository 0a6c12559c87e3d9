//! Prints a design.

use comfy_table::{Cell, Table};
use excavator_identification::design::SeparationDesign;
use excavator_study::numbers::number;

use super::{right, table};

/// The expected result for every pair.
pub fn pair_table(design: &SeparationDesign) -> Table {
    let header = ["effect", "other", "under sines", "distance, σ", "improvement", "significance", "expected"];
    let mut table = table(&header);
    for pair in &design.pairs {
        table.add_row([
            Cell::new(&pair.first),
            Cell::new(&pair.second),
            right(pair.improvement_before.map_or("-".into(), |value| format!("{value:.2}"))),
            right(number(pair.distance)),
            right(format!("{:.2}", pair.expected_improvement)),
            right(format!("{:.1}", pair.expected_significance)),
            Cell::new(if pair.separated { "separated" } else { "not separated" }),
        ]);
    }
    table
}
