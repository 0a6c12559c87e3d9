//! Prints proposed laws.

use comfy_table::{Cell, ContentArrangement, Table};
use excavator_identification::proposal::Proposals;
use excavator_report::law_result;
use excavator_study::numbers::number;

use super::{right, table};

/// Proposals, the best first.
pub fn proposal_table(found: &Proposals) -> Table {
    let mut table = table(&["law", "acts on", "at", "numbers", "NMSE before", "NMSE after", "result", "remarks"]);
    table.set_content_arrangement(ContentArrangement::Dynamic);
    for proposal in &found.proposals {
        let free = proposal.effect.parameters.iter().filter(|parameter| !parameter.known);
        let numbers: Vec<String> =
            free.map(|parameter| format!("{} = {}", parameter.card.name, number(parameter.value))).collect();
        table.add_row([
            Cell::new(&proposal.text.formula),
            Cell::new(proposal.text.acts_on.replace('_', " ")),
            Cell::new(&proposal.place),
            Cell::new(numbers.join(", ")),
            right(number(found.error_before)),
            right(number(proposal.validation_error)),
            Cell::new(law_result(found, proposal)),
            Cell::new(proposal.remarks().join("; ")),
        ]);
    }
    table
}
