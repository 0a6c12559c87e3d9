//! `excavator characterise`

use excavator_identification::characterisation::Characterisation;
use excavator_model::document::to_text;
use excavator_study::Study;

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
        print_next(&next(arguments));
    }
    if let Some(path) = &arguments.output {
        files::write(path, &to_text(&characterised.steady_model()?)?, arguments.result.overwriting)?;
    }
    files::write_told(&characterised, arguments.report.as_deref(), &arguments.result)
}

/// A fit needs the whole recordings, not only the parts that the procedures use.
fn next(arguments: &CharacteriseArguments) -> NextStep {
    let step = NextStep::new("fit all parameters to the same recordings", "identify");
    let step = step.same_model(&arguments.model).word("--bag");
    let step = arguments.bags.iter().fold(step, |step, bag| step.word(bag.display().to_string()));
    step.mapping(&arguments.mapping)
}
