//! `excavator energy`

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::mpsc::Receiver;

use excavator_identification::energy::{
    Analyser, EnergyAnalysis, EnergyError, EnergySettings, MissingPower, analyse, missing_power,
};
use excavator_identification::results;
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_report::energy_page;
use excavator_study::WorkError;
use excavator_study::block_reader::{needs_a_map, read_beside};
use excavator_study::recordings::LEDGER_BLOCK;
use excavator_study::sentences::ledger_sentence;

use crate::cli::{EnergyArguments, Extent, Mapping};
use crate::error::VerbError;
use crate::files::{self, Inputs, write_json};
use crate::next_step::{NextStep, print_next};
use crate::terminal::{energy_table, ledger_table, print};
use crate::{sources, terminal};

/// Most blocks queued for the analysis.
const WAITING: usize = 4;

pub fn run(arguments: &EnergyArguments) -> Result<(), VerbError> {
    let outputs = [("--report", arguments.report.as_deref()), ("--json", arguments.json.json.as_deref())];
    let inputs =
        Inputs::recordings([&arguments.bag], arguments.mapping.map.as_deref()).and_all(arguments.model.files());
    files::check(&outputs, &inputs, arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let analysis = analyse_bag(&model, &arguments.bag, &arguments.mapping)?;
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        let missing = missing_power(&model, &analysis);
        show(&model, &analysis, &missing);
        print_next(&next(arguments, missing.is_empty(), analysis.duration));
    }
    if let Some(path) = &arguments.report {
        files::write(path, &energy_page(&model, &analysis), arguments.overwriting)?;
    }
    if let Some(path) = &arguments.json.json {
        write_json(path, &results::Energy::of(&model, &analysis), arguments.overwriting)?;
    }
    Ok(())
}

/// If power is missing, a diagnosis finds the cause; else the signals may still differ.
fn next(arguments: &EnergyArguments, closes: bool, duration: f64) -> NextStep {
    if closes {
        return NextStep::new("compare every signal", "compare")
            .same_model(&arguments.model)
            .path("--bag", &arguments.bag)
            .mapping(&arguments.mapping);
    }
    NextStep::diagnosis_of_halves(
        "find the effect that causes the missing power",
        &arguments.model,
        &arguments.bag,
        duration,
        &arguments.mapping,
    )
}

/// A bag of our own topics is read in blocks, whatever its length. A recording that needs a map is read whole.
fn analyse_bag(model: &Model, bag: &Path, mapping: &Mapping) -> Result<EnergyAnalysis, WorkError> {
    let settings = EnergySettings::default();
    if needs_a_map(bag, mapping.map.as_deref()) {
        return Ok(analyse(model, &mapping.preparation(Extent { whole: true }).whole(bag, model)?, settings)?);
    }
    let work = |blocks: Receiver<Recording>| {
        let mut analyser = Analyser::new(model, settings);
        for block in blocks {
            analyser.push(&block)?;
        }
        Ok::<_, EnergyError>(analyser)
    };
    let all = |block| (Some(block), ControlFlow::Continue(()));
    let (report, analysis) = read_beside(bag, mapping.origin().namespace, LEDGER_BLOCK, WAITING, all, work)?;
    for problem in report.problems() {
        terminal::remark(&format!("{}: {problem}", bag.display()));
    }
    Ok(analysis?.finish()?)
}

fn show(model: &Model, analysis: &EnergyAnalysis, missing: &[MissingPower]) {
    print(&ledger_sentence(model, analysis, missing));
    print(&energy_table(model, analysis).to_string());
    if let Some(cycle) = &analysis.cycle {
        print(&format!("energies per cycle are means over {} cycles of {:.3} s", cycle.count, cycle.period));
    }
    for trace in &analysis.traces.cylinders {
        if let Some(phase) = &trace.phase {
            let degrees = |lag: Option<f64>| lag.map_or("-".to_string(), |lag| format!("{lag:.1}°"));
            print(&format!(
                "dH/dt of {} at {:.2} Hz lags behind the experimental: analytical {}, numerical {}",
                trace.name,
                phase.frequency,
                degrees(phase.analytical),
                degrees(phase.numerical)
            ));
        }
    }
    if let Some(reason) = &analysis.simulation_failed {
        print(&format!("there is no numerical dH/dt: {reason}"));
    }
    print(&ledger_table(model, analysis).to_string());
    if !analysis.parameters_have_errors {
        print(
            "The parameters of the model have no standard errors, so they are treated as exact. Identify the model first.",
        );
    }
    for evidence in missing.iter().skip(1) {
        print(&format!("{}: {}", evidence.equation, evidence.sentence));
    }
}
