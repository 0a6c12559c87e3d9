//! `excavator energy`

use excavator_identification::energy::{EnergyAnalysis, MissingPower};
use excavator_model::Model;
use excavator_study::sentences::ledger_sentence;

use crate::cli::{EnergyArguments, Extent};
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::{energy_table, ledger_table, opening_table, print};

pub fn run(arguments: &EnergyArguments) -> Result<(), VerbError> {
    let outputs = [("--report", arguments.report.as_deref()), arguments.result.output()];
    let inputs =
        Inputs::recordings([&arguments.bag], arguments.mapping.map.as_deref()).and_all(arguments.model.files());
    files::check(&outputs, &inputs, arguments.result.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let energetic = arguments.mapping.preparation(Extent { whole: true }).energy(&arguments.bag, model)?;
    if arguments.result.is_shown() {
        let missing = energetic.missing();
        show(&energetic.model, &energetic.analysis, &missing);
        print_next(&next(arguments, missing.is_empty(), energetic.analysis.duration));
    }
    files::write_told(&energetic, arguments.report.as_deref(), &arguments.result)
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

fn show(model: &Model, analysis: &EnergyAnalysis, missing: &[MissingPower]) {
    print(&ledger_sentence(model, analysis, missing));
    print(&energy_table(model, analysis).to_string());
    if let Some(cycle) = &analysis.cycle {
        print(&format!("energies per cycle are means over {} cycles of {:.3} s", cycle.count, cycle.period));
    }
    print(&opening_table(model, analysis).to_string());
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
    if let Some(criterion) = analysis.phase_criterion() {
        print(&criterion.sentence);
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
