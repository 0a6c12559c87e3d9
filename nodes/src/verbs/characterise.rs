//! `excavator characterise`

use std::path::Path;

use excavator_identification::characterisation::{Characterisation, characterise};
use excavator_identification::results;
use excavator_model::recording::Recording;
use excavator_report::characterisation_page;

use super::{print, print_next};
use crate::cli::CharacteriseArguments;
use crate::error::VerbError;
use crate::output::{NextStep, characterisation_table, refusals, write_json};
use crate::outputs::{self, Inputs};
use crate::sources;

pub fn run(arguments: &CharacteriseArguments) -> Result<(), VerbError> {
    let outputs = [("--report", arguments.report.as_deref()), ("--json", arguments.json.json.as_deref())];
    let inputs = Inputs::recordings(&arguments.bags, arguments.mapping.map.as_deref()).and_all(arguments.model.files());
    outputs::check(&outputs, &inputs, arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let recordings = sources::recordings(&arguments.bags, &arguments.mapping, &model)?;
    let recordings: Vec<&Recording> = recordings.iter().collect();
    let found = characterise(&model, &recordings);
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        for one in &found {
            let (results, all) = (one.results(), Characterisation::MOST_RESULTS);
            print(&format!(
                "These recordings show {results} of {all} results for {} of {}.",
                one.cylinder, model.machine.name
            ));
            print(&characterisation_table(one).to_string());
            refusals(one).iter().for_each(|line| print(line));
        }
        print_next(&next(arguments));
    }
    if let Some(path) = &arguments.report {
        let sources: Vec<String> = recordings.iter().map(|recording| recording.source.clone()).collect();
        outputs::write(path, &characterisation_page(&model, &sources, &found), arguments.overwriting)?;
    }
    if let Some(path) = &arguments.json.json {
        write_json(path, &results::Characterisation::of(&found), arguments.overwriting)?;
    }
    Ok(())
}

/// A fit needs the whole recordings, not only the parts that the procedures use.
fn next(arguments: &CharacteriseArguments) -> NextStep {
    let step = NextStep::new("fit all parameters to the same recordings", "identify");
    let step = step.same_model(&arguments.model).word("--bag");
    let step = arguments.bags.iter().fold(step, |step, bag| step.word(bag.display().to_string()));
    step.mapping(&arguments.mapping)
}
