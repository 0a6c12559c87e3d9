//! `excavator simulate`

use std::path::Path;

use excavator_bags::{Topics, write_recording};
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_model::simulation::simulate;
use excavator_study::profile_file::ProfileFile;
use excavator_study::simulated::simulate_profile;
use rosbag2::WriteOptions;

use crate::cli::{Extent, SimulateArguments};
use crate::error::VerbError;
use crate::files;
use crate::next_step::{NextStep, print_next};
use crate::terminal::print;
use crate::{sources, terminal};

pub fn run(arguments: &SimulateArguments) -> Result<(), VerbError> {
    let inputs = files::Inputs::recordings([&arguments.input], arguments.mapping.map.as_deref())
        .and_all(arguments.model.files());
    files::check_bag(&arguments.output, &inputs, arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let simulated = if arguments.input.extension().is_some_and(|extension| extension == "toml") {
        with_profile(&model, &arguments.input)?
    } else {
        let preparation = arguments.mapping.preparation(Extent { whole: true });
        simulate(&model, &preparation.whole(&arguments.input, &model)?)?
    };
    let options = WriteOptions { replace: arguments.overwriting.force, ..WriteOptions::default() };
    write_recording(&arguments.output, &simulated, &Topics::default(), &options)?;
    print(&format!(
        "Simulated {:.1} s of {}: {} samples in {}.",
        simulated.duration(),
        model.machine.name,
        simulated.len(),
        arguments.output.display()
    ));
    print_next(&NextStep::new("see what is in it", "info").word(arguments.output.display().to_string()));
    Ok(())
}

fn with_profile(model: &Model, path: &Path) -> Result<Recording, VerbError> {
    let file = ProfileFile::read(path, &model.machine)?;
    for remark in file.remarks(&model.machine) {
        terminal::remark(&format!("{}: {remark}", path.display()));
    }
    Ok(simulate_profile(model, &file, path)?)
}
