//! `excavator changed`

use excavator_study::results::{Changed, Outcome};

use crate::cli::ChangedArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::{change_table, print};

pub fn run(arguments: &ChangedArguments) -> Result<(), VerbError> {
    let outputs = [("--report", arguments.report.as_deref()), arguments.result.output()];
    let bags = arguments.before.iter().chain(&arguments.after);
    let inputs = Inputs::recordings(bags, arguments.mapping.map.as_deref()).and_all(arguments.model.files());
    files::check(&outputs, &inputs, arguments.result.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let preparation = arguments.mapping.preparation(arguments.extent);
    let changed = preparation.study(model, [&arguments.before, &arguments.after])?.changed()?;
    if arguments.result.is_shown() {
        print(&changed.sentence());
        print(&change_table(&changed.found).to_string());
        next(arguments, &changed).iter().for_each(print_next);
    }
    files::write_told(&changed, arguments.report.as_deref(), &arguments.result)
}

/// If the parameters leave more than noise after, an effect is new: a diagnosis of these recordings names it.
fn next(arguments: &ChangedArguments, changed: &Changed) -> Option<NextStep> {
    let (model, mapping, bag) = (&arguments.model, &arguments.mapping, arguments.after.first()?);
    let [_, is_new] = changed.found.leaves_more_than_noise();
    if is_new {
        let why = "look for the effect that the model lacks after";
        return Some(NextStep::diagnosis_of_halves(why, model, bag, changed.duration, mapping));
    }
    let step = NextStep::new("see the model beside the recording after", "compare").same_model(model);
    Some(step.path("--bag", bag).mapping(mapping).extent(arguments.extent))
}
