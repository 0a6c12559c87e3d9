//! Results as tables.

mod changes;
mod characterisation;
mod energy;
mod pairs;
mod proposals;

pub use changes::change_table;
pub use characterisation::{characterisation_table, refusals};
pub use energy::{energy_table, ledger_table, opening_table};
pub use pairs::pair_table;
pub use proposals::proposal_table;

use comfy_table::presets::{NOTHING, UTF8_FULL_CONDENSED};
use comfy_table::{Attribute, Cell, CellAlignment, ColumnConstraint, ContentArrangement, Table, Width};
use excavator_identification::diagnosis::Diagnosis;
use excavator_identification::refinement::Refinement;
use excavator_identification::validation::{
    Baselines, Comparison, Correlation, ErrorSums, MotionPhase, SignalComparison, errors_of, mean_error_of,
};
use excavator_identification::value_marks::{remedies, value_mark};
use excavator_model::Model;
use excavator_report::{Beside, signal_unit};
use excavator_study::numbers::number;

/// A number with so many decimals, and no minus sign before zero.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = text.chars().all(|character| matches!(character, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_string() } else { text }
}

/// An empty table, as wide as the terminal.
pub fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_content_arrangement(ContentArrangement::Dynamic);
    table.set_header(header.iter().map(|text| Cell::new(text).add_attribute(Attribute::Bold)));
    table
}

/// A cell with a number.
pub fn right(text: impl ToString) -> Cell {
    Cell::new(text.to_string()).set_alignment(CellAlignment::Right)
}

/// Effects of one family, without lines: name, place and summary, which is wrapped if the terminal is too narrow. With
/// `name_width` and `place_width` in characters, the columns of several such tables align.
pub fn effect_table(effects: &[[&str; 3]], name_width: u16, place_width: u16) -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING);
    table.set_content_arrangement(ContentArrangement::Dynamic);
    table.add_rows(effects.iter().map(|texts| texts.map(Cell::new)));
    let padding = 2;
    for (column, width) in table.column_iter_mut().zip([name_width, place_width]) {
        column.set_constraint(ColumnConstraint::Absolute(Width::Fixed(width + padding)));
    }
    table
}

/// Identified parameters with 95 % intervals, and a remark if a value must not be taken as it is.
pub fn parameter_table(model: &Model, fitted: &[usize]) -> Table {
    let marks: Vec<Option<String>> =
        fitted.iter().map(|&index| value_mark(model, index).map(|mark| mark.to_string())).collect();
    let with_remarks = marks.iter().any(Option::is_some);
    let heads = ["parameter", "value", "± 95 %", "unit", "remark"];
    let mut table = table(if with_remarks { &heads } else { &heads[..4] });
    let names = model.parameter_names();
    for (index, (_, parameter)) in model.parameters().enumerate() {
        let Some(place) = fitted.iter().position(|&fitted| fitted == index) else { continue };
        let margin = parameter.margin_95.map_or("-".into(), number);
        let mut row = vec![
            Cell::new(&names[index]),
            right(number(parameter.value)),
            right(margin),
            Cell::new(&*parameter.card.unit),
        ];
        if with_remarks {
            row.push(Cell::new(marks[place].as_deref().unwrap_or_default()));
        }
        table.add_row(row);
    }
    table
}

/// What would determine the values that have a remark, one line per effect.
pub fn remedy_lines(model: &Model, fitted: &[usize]) -> Vec<String> {
    let lines = remedies(model, fitted).into_iter();
    lines.map(|(names, experiment)| format!("To determine {}: {experiment}", names.join(", "))).collect()
}

/// Errors of every signal beside those of noise, of a model without physics, and of a constant value.
pub fn comparison_table(comparison: &Comparison, baselines: &Baselines, others: &[Beside<'_>]) -> Table {
    let held = format!("{:.1} s before", baselines.held);
    let mut heads = vec!["signal", "RMS error", "NMSE"];
    heads.extend(others.iter().map(|other| other.label()));
    heads.extend(["noise", "linear ARX", &held, "delay °"]);
    let mut table = table(&heads);
    for (signal, baseline) in comparison.signals.iter().zip(&baselines.signals) {
        let (factor, unit) = signal_unit(&comparison.machine, &signal.name);
        let mark = if signal.error.tells() { "" } else { NOT_IN_MEAN };
        let mut cells = vec![
            Cell::new(&signal.name),
            right(format!("{} {unit}", number(factor * signal.error.root_mean_square())))
                .add_attribute(Attribute::Bold),
            right(format!("{}{mark}", number(signal.error.normalised()))),
        ];
        cells.extend(others.iter().map(|other| right(number(other.error_of(&signal.name)))));
        cells.extend([
            right(number(baseline.noise)),
            right(number(baseline.arx)),
            right(number(baseline.held)),
            right(signal.phase_delay_degrees.map_or("-".into(), |degrees| format!("{degrees:.1}"))),
        ]);
        table.add_row(cells);
    }
    table
}

/// Marks an error that does not count in the mean.
const NOT_IN_MEAN: &str = "*";

/// Explains the mark, where a signal has it.
pub fn not_in_mean(comparison: &Comparison) -> Option<String> {
    let is_marked = comparison.signals.iter().any(|signal| !signal.error.tells());
    is_marked.then(|| format!("{NOT_IN_MEAN} not in the mean: the signal is mostly noise, or it does not change"))
}

/// Whether the error of every signal still correlates with its own past, or with the input.
pub fn correlation_table(comparison: &Comparison) -> Table {
    let mut table = table(&["signal", "error autocorrelation", "correlation with input"]);
    for signal in &comparison.signals {
        table.add_row([
            Cell::new(&signal.name),
            right(correlation(signal.autocorrelation)),
            right(correlation(signal.input_correlation)),
        ]);
    }
    table
}

/// The share of each signal's squared error while the piston moves, stands, or is at an end of its stroke. None if it stays in
/// one of these phases all the time.
pub fn phase_table(comparison: &Comparison) -> Option<Table> {
    let share_of = |signal: &SignalComparison, phase| signal.phases.iter().find(|share| share.phase == phase).copied();
    let seen: Vec<MotionPhase> = MotionPhase::ALL
        .into_iter()
        .filter(|&phase| comparison.signals.iter().any(|signal| share_of(signal, phase).is_some()))
        .collect();
    if seen.len() < 2 {
        return None;
    }
    let heads: Vec<String> = std::iter::once("squared error while the piston is".to_string())
        .chain(seen.iter().map(MotionPhase::to_string))
        .collect();
    let mut table = table(&heads.iter().map(String::as_str).collect::<Vec<_>>());
    for signal in &comparison.signals {
        let share = |&phase: &MotionPhase| match share_of(signal, phase) {
            Some(share) => format!("{:.0} % in {:.0} % of the time", 100.0 * share.of_error, 100.0 * share.of_time),
            None => "-".to_string(),
        };
        table.add_row(std::iter::once(Cell::new(&signal.name)).chain(seen.iter().map(share).map(right)));
    }
    Some(table)
}

/// A correlation with its lag, "no" if chance explains it, "-" if it cannot be determined.
fn correlation(found: Option<Correlation>) -> String {
    match found {
        None => "-".to_string(),
        Some(found) if found.is_significant() => format!("{:.2} at a lag of {:.0} ms", found.value, 1e3 * found.lag),
        Some(_) => "no".to_string(),
    }
}

/// Effects with their improvement on the validation recordings: those of the verdict, others with evidence, the rest. With
/// `detail` also their certainty.
pub fn candidate_table(diagnosis: &Diagnosis, detail: bool) -> Table {
    let mut heads = vec!["effect", "at", "NMSE before", "NMSE after", "verdict"];
    if detail {
        heads.extend(["improvement", "significance", "first in"]);
    }
    let mut table = table(&heads);
    for candidate in diagnosis.candidates().iter().chain(&diagnosis.rejected()) {
        let mut row = vec![
            Cell::new(candidate.name()),
            Cell::new(candidate.place()),
            right(number(candidate.errors[0].unwrap_or(f64::NAN))),
            right(number(candidate.errors[1].unwrap_or(f64::NAN))),
            Cell::new(candidate.result()),
        ];
        if detail {
            row.extend([
                right(format!("{:.2}", candidate.improvement)),
                right(format!("{:.1}", candidate.standing.significance)),
                right(format!("{:.0} %", 100.0 * candidate.standing.is_first)),
            ]);
        }
        table.add_row(row);
    }
    table
}

/// A model of the story, with its comparison with each validation recording.
#[derive(Debug)]
pub struct Stage<'c> {
    /// Its label: "as given", "identified", "+ effect@place".
    pub name: String,
    /// Its comparisons.
    pub comparisons: &'c [Comparison],
}

impl<'c> Stage<'c> {
    /// The model with its own values, if it can be simulated, and the model after each addition.
    pub fn all(given: &'c [Comparison], steps: impl Iterator<Item = (Option<&'c str>, &'c [Comparison])>) -> Vec<Self> {
        let given = Stage { name: "as given".into(), comparisons: given };
        let steps = steps.map(|(added, comparisons)| Stage {
            name: added.map_or_else(|| "identified".to_string(), |added| format!("+ {added}")),
            comparisons,
        });
        std::iter::once(given).filter(|stage| !stage.comparisons.is_empty()).chain(steps).collect()
    }

    /// The stages of a refinement.
    pub fn of_refinement(refinement: &'c Refinement) -> Vec<Self> {
        Stage::all(&refinement.given, refinement.compared_steps())
    }
}

/// Normalised mean squared error of every signal on the validation recordings, stage by stage.
pub fn stage_table(stages: &[Stage<'_>]) -> Table {
    let heads: Vec<&str> = std::iter::once("NMSE").chain(stages.iter().map(|stage| stage.name.as_str())).collect();
    let mut table = table(&heads);
    let errors: Vec<_> = stages.iter().map(|stage| errors_of(stage.comparisons)).collect();
    let signals = errors.first().map_or(&[][..], Vec::as_slice);
    for (name, _) in signals {
        let of = |stage: &Vec<(&str, ErrorSums)>| {
            stage.iter().find(|(own, _)| own == name).map_or(f64::NAN, |(_, error)| error.normalised())
        };
        let cells = errors.iter().map(|stage| right(number(of(stage))));
        table.add_row(std::iter::once(Cell::new(name)).chain(cells));
    }
    if signals.len() < 2 {
        return table;
    }
    let mean = |stage: &Stage<'_>| right(number(mean_error_of(stage.comparisons))).add_attribute(Attribute::Bold);
    let means = stages.iter().map(mean);
    table.add_row(std::iter::once(Cell::new("mean").add_attribute(Attribute::Bold)).chain(means));
    table
}
