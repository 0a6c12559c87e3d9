//! What changed in a machine: one page to show to a colleague.

use excavator_identification::change::{Changes, ParameterChange};
use excavator_identification::decision::Policy;
use excavator_model::Model;
use maud::{Markup, html};

use super::change_text::{change_sentence, relative_change, workshop_value};
use super::numbers::significant;
use super::page::{Section, page, tile};

/// A page with the parameters that changed, those that did not, and those that cannot be compared.
pub fn change_page(model: &Model, changes: &Changes) -> String {
    let lead = html! {
        p.about { (model.machine.description) }
        p.verdict { (change_sentence(model, changes)) }
        div.tiles {
            @for one in changes.changed().take(3) { (tile(&relative_change(one), &one.name)) }
        }
    };
    let parts: [(_, _, Vec<&ParameterChange>); 3] = [
        ("changed", "Changed", changes.changed().collect()),
        ("unchanged", "Unchanged", changes.unchanged().collect()),
        ("undetermined", "Not determined on both sides", changes.undetermined().collect()),
    ];
    let sections: Vec<Section> = parts
        .into_iter()
        .filter(|(_, _, some)| !some.is_empty())
        .map(|(anchor, title, some)| Section { anchor, title: title.into(), body: table(&some) })
        .collect();
    page("Before and after", &model.machine.name, &lead, &sections)
}

fn table(parameters: &[&ParameterChange]) -> Markup {
    let policy = Policy::default();
    html! {
        div.wide { table.data {
            thead { tr {
                th { "Parameter" } th { "Meaning" } th.n { "Before (± 95 %)" } th.n { "After (± 95 %)" } th.n { "Change" } th.n { "Standard errors" }
            } }
            tbody { @for one in parameters { tr {
                td { code { (one.name) } }
                td { (one.meaning) }
                td.n { (workshop_value(one, 0)) }
                td.n { (workshop_value(one, 1)) }
                td.n { @if one.is_determined { (relative_change(one)) } @else { "–" } }
                td.n { (significant(one.significance(), 2)) }
            } } }
        } }
        p.note {
            "The model is fitted to the recordings before and to those after, each alone. A parameter changed if the difference exceeds "
            (policy.least_significance_of_change) " times its standard error and " (100.0 * policy.least_change) " % of its value. Offsets of sensors are fitted on "
            "both sides and not compared."
        }
    }
}
