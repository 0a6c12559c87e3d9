//! `excavator effects`

use excavator_model::document::built_in;
use excavator_model::effects::{ActsOn, AnyEffect, Card, Effect, Family, Kind, ParameterCard, Site};
use excavator_study::numbers::number;
use serde_json::{Value, json};

use super::check_effects;
use crate::cli::EffectsArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs, write_json};
use crate::sources;
use crate::terminal::{effect_table, print};

pub fn run(arguments: &EffectsArguments) -> Result<(), VerbError> {
    if arguments.language {
        check_effects::language();
        return Ok(());
    }
    if !arguments.check.is_empty() {
        return check_effects::run(&arguments.check, &arguments.model);
    }
    let outputs = [arguments.result.output()];
    files::check(&outputs, &Inputs::default(), arguments.result.overwriting)?;
    let catalogue = sources::catalogue(&arguments.own)?;
    let wanted: Vec<AnyEffect> = match &arguments.name {
        Some(name) => vec![catalogue.find(name)?],
        None => catalogue.iter().cloned().collect(),
    };
    if arguments.result.is_shown() {
        match wanted.as_slice() {
            [one] if arguments.name.is_some() => page(&**one)?,
            all => list(all),
        }
    }
    let cards = wanted.iter().map(|effect| card_json(&**effect)).collect::<Result<Vec<Value>, _>>()?;
    write_json(&json!({ "effects": cards }), &arguments.result)
}

fn place(acts_on: ActsOn) -> &'static str {
    match acts_on {
        ActsOn::Cylinder => "cylinder",
        ActsOn::Valve => "valve",
        ActsOn::PumpLine => "pump line",
        ActsOn::CylinderOrPumpLine => "chambers, pump line",
        ActsOn::Instruments => "instruments",
    }
}

fn list(all: &[AnyEffect]) {
    let longest =
        |text: fn(&Card) -> &str| all.iter().map(|effect| text(effect.card()).len() as u16).max().unwrap_or_default();
    print(&format!("{} effects are in the catalogue; `excavator effects NAME` describes one.", all.len()));
    for (family, title) in [
        (Family::Base, "In the nominal model"),
        (Family::Recording, "Instruments and recording: estimated with every model, never a verdict"),
        (Family::Rounding, "Smoothing of corners: estimated with every model, never a verdict"),
        (Family::Construction, "Construction: added by hand, never a candidate"),
        (Family::Loss, "Losses of the nominal model: candidates where a model leaves them out"),
        (Family::Candidate, "Candidates beyond the nominal model"),
    ] {
        print(title);
        let own = all.iter().map(|effect| effect.card()).filter(|card| card.family == family);
        let rows: Vec<[&str; 3]> = own.map(|card| [&*card.name, place(card.acts_on), &*card.summary]).collect();
        print(&effect_table(&rows, longest(|card| &card.name), longest(|card| place(card.acts_on))).trim_fmt());
    }
}

/// The parameters of an effect on the machine where they look most typical.
fn parameters(effect: &dyn Effect) -> Result<&[ParameterCard], VerbError> {
    let machine = built_in("zx30u-arm")?.machine;
    let site = if effect.card().acts_on == ActsOn::PumpLine { Site::PumpLine } else { Site::Cylinder(0) };
    Ok(effect.parameters(&machine, site))
}

fn page(effect: &dyn Effect) -> Result<(), VerbError> {
    let card = effect.card();
    print(&format!("{}\n", card.summary));
    print(&format!("{:12}{} ({})", "name", card.name, place(card.acts_on)));
    for (title, text) in [
        ("equation", &card.equation),
        ("source", &card.source),
        ("shows as", &card.shows),
        ("experiment", &card.experiment),
        ("energy", &card.energy),
    ] {
        print(&format!("{title:12}{text}"));
    }
    print("parameters");
    for parameter in parameters(effect)? {
        print(&format!(
            "  {:24} {:6} {:18} {}; {} to {}",
            parameter.name,
            parameter.symbol,
            parameter.unit,
            parameter.meaning,
            number(parameter.minimum),
            number(parameter.maximum)
        ));
    }
    Ok(())
}

fn card_json(effect: &dyn Effect) -> Result<Value, VerbError> {
    let card = effect.card();
    let parameters: Vec<Value> = parameters(effect)?
        .iter()
        .map(|parameter| {
            let kind = match parameter.kind {
                Kind::Linear => "linear",
                Kind::Reciprocal => "reciprocal",
                Kind::Shape => "shape",
            };
            json!({
                "name": parameter.name, "symbol": parameter.symbol, "unit": parameter.unit, "kind": kind,
                "meaning": parameter.meaning, "minimum": parameter.minimum, "maximum": parameter.maximum,
            })
        })
        .collect();
    Ok(json!({
        "name": card.name, "acts_on": place(card.acts_on), "summary": card.summary, "equation": card.equation,
        "source": card.source, "shows": card.shows, "experiment": card.experiment, "energy": card.energy,
        "candidate": card.family.is_candidate(), "parameters": parameters,
    }))
}
