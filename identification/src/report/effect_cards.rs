//! What the catalogue says about an effect.

use maud::{Markup, html};

use super::parameter_table;
use super::verdict_text::place_of;
use crate::diagnosis::Candidate;

/// Card and fitted parameters of a named candidate.
pub(super) fn effect_card(candidate: &Candidate) -> Markup {
    let card = candidate.physics.card();
    html! {
        div.card {
            h3 { (capitalised(&place_of(candidate))) " " code.code-name { (card.name) "@" (candidate.place) } }
            dl {
                dt { "What it is" } dd { (card.summary) }
                dt { "Equation" } dd { code { (card.equation) } }
                dt { "How it shows" } dd { (card.shows) }
                dt { "Best experiment" } dd { (card.experiment) }
                dt { "Energy" } dd { (card.energy) }
                dt { "Source" } dd { (card.source) }
            }
            (parameter_table::of_effect(&candidate.fit.model, candidate.name(), candidate.site))
        }
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().collect::<String>() + letters.as_str())
}
