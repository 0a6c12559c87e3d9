//! `excavator report`

use excavator_study::StudyFile;

use super::{diagnose, saved_study};
use crate::cli::ReportArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::print_next;

pub fn run(arguments: &ReportArguments) -> Result<(), VerbError> {
    let path = &arguments.study;
    let study = StudyFile::read(path)?;
    let (model, recordings) = (saved_study::model(&study), saved_study::recordings(&study));
    let outputs = [("--report", arguments.report.as_deref()), arguments.result.output()];
    let inputs = Inputs::recordings(recordings.bags(), recordings.mapping.map.as_deref()).and_all([path.clone()]);
    files::check(&outputs, &inputs, arguments.result.overwriting)?;
    let files = study.validation.clone();
    let mut diagnosed = study.diagnosed(path)?;
    if arguments.report.is_some() {
        files.iter().try_for_each(|file| file.check())?;
        let preparation = recordings.mapping.preparation(recordings.extent);
        diagnosed.validation = preparation.recordings(&recordings.validation, &diagnosed.model)?;
    }
    if arguments.result.is_shown() {
        diagnose::show(&diagnosed);
        print_next(&diagnose::next(&model, &recordings, Some(path), &diagnosed.diagnosis));
    }
    files::write_told(&diagnosed, arguments.report.as_deref(), &arguments.result)
}
