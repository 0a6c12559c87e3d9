//! `excavator compare`

use excavator_report::{comparison_sentence, others_sentence};
use excavator_study::Study;

use crate::cli::CompareArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::{comparison_table, correlation_table, not_in_mean, phase_table, print, print_detail};

pub fn run(arguments: &CompareArguments) -> Result<(), VerbError> {
    let outputs = [("--report", arguments.report.as_deref()), arguments.result.output()];
    let bags = std::iter::once(&arguments.bag).chain(&arguments.repeat);
    let inputs = Inputs::recordings(bags, arguments.mapping.map.as_deref()).and_all(arguments.model.files());
    files::check(&outputs, &inputs, arguments.result.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let preparation = arguments.mapping.preparation(arguments.extent);
    let recording = preparation.recording(&arguments.bag, &model)?;
    let against =
        arguments.against.as_deref().map(|name| sources::another_model(name, &arguments.model)).transpose()?;
    let again = arguments.repeat.as_deref().map(|bag| preparation.whole(bag, &model)).transpose()?;
    let compared = Study::of_recording(model, recording).compare(against.as_ref(), again.as_ref())?;
    let (comparison, baselines, others) = (&compared.comparison, &compared.baselines, compared.others());
    if arguments.result.is_shown() {
        print(&comparison_sentence(comparison, baselines));
        others.iter().for_each(|other| print(&others_sentence(comparison, *other)));
        print(&comparison_table(comparison, baselines, &others).to_string());
        not_in_mean(comparison).iter().for_each(|note| print(note));
        print_detail(&correlation_table(comparison).to_string());
        if let Some(table) = phase_table(comparison) {
            print_detail(&table.to_string());
        }
        let (why, duration) = ("find out what the model is missing", comparison.measured.duration());
        print_next(&NextStep::diagnosis_of_halves(why, &arguments.model, &arguments.bag, duration, &arguments.mapping));
    }
    files::write_told(&compared, arguments.report.as_deref(), &arguments.result)
}
