//! `excavator characterise`

use excavator_identification::characterisation::Characterisation;
use excavator_model::document::to_text;
use excavator_model::effects::Site;
use excavator_model::machine::{CommandUnit, Machine};
use excavator_model::{Model, ModelEffect, Parameter, site_name};
use excavator_study::Study;
use excavator_study::numbers::number;

use crate::cli::{CharacteriseArguments, Extent};
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::{characterisation_table, print, refusals};

pub fn run(arguments: &CharacteriseArguments) -> Result<(), VerbError> {
    let outputs =
        [("-o", arguments.output.as_deref()), ("--report", arguments.report.as_deref()), arguments.result.output()];
    let inputs = Inputs::recordings(&arguments.bags, arguments.mapping.map.as_deref()).and_all(arguments.model.files());
    files::check(&outputs, &inputs, arguments.result.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let preparation = arguments.mapping.preparation(Extent { whole: true });
    let recordings = preparation.recordings(&arguments.bags, &model)?;
    let characterised = Study::of_fitted(model, recordings).characterise();
    if arguments.result.is_shown() {
        for one in characterised.found() {
            let (results, all) = (one.results(), Characterisation::MOST_RESULTS);
            print(&format!(
                "These recordings show {results} of {all} results for {} of {}.",
                one.cylinder,
                characterised.machine()
            ));
            print(&characterisation_table(one).to_string());
            refusals(one).iter().for_each(|line| print(line));
        }
    }
    if let Some(path) = &arguments.output {
        let read = characterised.steady_model()?;
        files::write(path, &to_text(&read)?, arguments.result.overwriting)?;
        if arguments.result.is_shown() {
            added(characterised.model(), &read).iter().for_each(|line| print(line));
        }
    }
    if arguments.result.is_shown() {
        print_next(&next(arguments));
    }
    files::write_told(&characterised, arguments.report.as_deref(), &arguments.result)
}

/// A fit needs the whole recordings, not only the parts that the procedures use.
fn next(arguments: &CharacteriseArguments) -> NextStep {
    let step = NextStep::new("fit all parameters to the same recordings", "identify");
    let step = match &arguments.output {
        Some(read) => step.model(read, &arguments.model),
        None => step.same_model(&arguments.model),
    };
    let step = step.word("--bag");
    let step = arguments.bags.iter().fold(step, |step, bag| step.word(bag.display().to_string()));
    step.mapping(&arguments.mapping)
}

/// What steady stretches added to the model, one line each.
fn added(given: &Model, read: &Model) -> Vec<String> {
    let is_new = |effect: &&ModelEffect| !given.has(effect.name(), effect.site);
    let of_effect = |effect: &ModelEffect| {
        let place = site_name(&read.machine, effect.site);
        let values: Vec<String> = effect.parameters.iter().map(|one| shown(&read.machine, effect.site, one)).collect();
        format!(
            "Added to the model, since steady stretches show it: {} at {place} ({}).",
            effect.name(),
            values.join(", ")
        )
    };
    read.effects.iter().filter(is_new).map(of_effect).collect()
}

/// A parameter in the unit that people use for the input of its drive.
fn shown(machine: &Machine, site: Site, parameter: &Parameter) -> String {
    let Site::Cylinder(cylinder) = site else { return number(parameter.value) };
    let unit = machine.cylinders[cylinder].chambers.map_or(CommandUnit::One, |chambers| chambers.drive.command_unit());
    let (factor, unit) = unit.for_people();
    format!("{} {} {unit}", parameter.card.name, number(factor * parameter.value))
}
