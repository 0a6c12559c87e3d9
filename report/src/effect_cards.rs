//! Shows the catalogue's card of an effect.

use excavator_identification::diagnosis::{Candidate, Diagnosis, contribution};
use excavator_model::recording::Recording;
use maud::{Markup, html};

use super::effect_plot::effect_plot;
use super::parameter_table;
use super::verdict_text::place_of;
use super::words::capitalised;

/// Card, picture on `recordings` and fitted parameters of a named candidate: beside all other effects of the favoured hypothesis, if it
/// is one of them.
pub(super) fn effect_card(diagnosis: &Diagnosis, candidate: &Candidate<'_>, recordings: &[&Recording]) -> Markup {
    let card = candidate.addition.physics.card();
    let trial = Some(diagnosis.best()).filter(|best| best.adds(candidate.addition)).unwrap_or(candidate.trial);
    // If the picture cannot be made, the card has only text.
    let shown = contribution(trial, candidate.addition, recordings).ok().flatten();
    html! {
        div.card {
            h3 { (capitalised(&place_of(candidate))) " " code.code-name { (card.name) "@" (candidate.place()) } }
            dl {
                dt { "What it is" } dd { (card.summary) }
                dt { "Equation" } dd { code { (card.equation) } }
                dt { "How it shows" } dd { (card.shows) }
                dt { "Best experiment" } dd { (card.experiment) }
                dt { "Energy" } dd { (card.energy) }
                dt { "Source" } dd { (card.source) }
            }
            @if let Some(shown) = &shown { (effect_plot(&trial.fit.model.machine, shown)) }
            (parameter_table::of_effect(&trial.fit.model, candidate.name(), candidate.addition.site))
        }
    }
}
