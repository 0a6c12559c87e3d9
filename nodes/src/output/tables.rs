//! Tables for people.

use comfy_table::presets::{NOTHING, UTF8_FULL_CONDENSED};
use comfy_table::{Attribute, Cell, CellAlignment, ColumnConstraint, ContentArrangement, Table, Width};
use excavator_identification::diagnosis::Diagnosis;
use excavator_identification::refinement::Refinement;
use excavator_identification::validation::{Comparison, Correlation, MotionPhase, SignalComparison};
use excavator_identification::value_marks::{remedies, value_mark};
use excavator_model::Model;

/// A number with four significant digits, short.
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return "-".to_string();
    }
    let size = value.abs();
    if size == 0.0 {
        "0".to_string()
    } else if (0.01..1e5).contains(&size) {
        let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.3e}")
    }
}

pub(super) fn table(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header(header.iter().map(|text| Cell::new(text).add_attribute(Attribute::Bold)));
    table
}

pub(super) fn right(text: impl ToString) -> Cell {
    Cell::new(text.to_string()).set_alignment(CellAlignment::Right)
}

/// Effects of one family, without lines: name, place and summary, which is wrapped where a terminal is too narrow. The columns
/// of several such tables stand below each other, `name_width` and `place_width` characters wide.
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

/// Identified parameters with 95 % intervals, and a remark where a value is not to be taken as it is.
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

/// What would determine the values with a remark, a line for each effect.
pub fn remedy_lines(model: &Model, fitted: &[usize]) -> Vec<String> {
    let lines = remedies(model, fitted).into_iter();
    lines.map(|(names, experiment)| format!("To determine {}: {experiment}", names.join(", "))).collect()
}

/// Errors of every signal.
pub fn comparison_table(comparison: &Comparison) -> Table {
    let mut table = table(&["signal", "NMSE", "FIT %", "phase delay °", "error like its past", "error like the input"]);
    for signal in &comparison.signals {
        table.add_row([
            Cell::new(&signal.name),
            right(number(signal.normalised_error)),
            right(format!("{:.1}", signal.fit)),
            right(signal.phase_delay_degrees.map_or("-".into(), |degrees| format!("{degrees:.1}"))),
            right(correlation(signal.autocorrelation)),
            right(correlation(signal.input_correlation)),
        ]);
    }
    table
}

/// Where the squared error of each signal lies: while the piston moves, stands, or is at an end of its stroke. None where it does one
/// of these all the time.
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

/// A correlation with its lag, "no" where chance explains it, "-" where nothing can be said.
fn correlation(found: Option<Correlation>) -> String {
    match found {
        None => "-".to_string(),
        Some(found) if found.is_significant() => format!("{:.2} after {:.2} s", found.value, found.lag),
        Some(_) => "no".to_string(),
    }
}

/// Effects with what they improve on the validation recordings: those of the verdict, others with evidence, the rest.
pub fn candidate_table(diagnosis: &Diagnosis) -> Table {
    let mut table =
        table(&["effect", "at", "NMSE before", "after", "improvement", "significance", "first in", "verdict"]);
    for candidate in diagnosis.candidates().iter().chain(&diagnosis.rejected()) {
        table.add_row([
            Cell::new(candidate.name()),
            Cell::new(candidate.place()),
            right(number(candidate.errors[0])),
            right(number(candidate.errors[1])),
            right(format!("{:.2}", candidate.improvement)),
            right(format!("{:.1}", candidate.standing.significance)),
            right(format!("{:.0} %", 100.0 * candidate.standing.is_first)),
            Cell::new(candidate.result()),
        ]);
    }
    table
}

/// Normalised mean squared error of every signal, step by step.
pub fn step_table(refinement: &Refinement) -> Table {
    let Some(first) = refinement.steps.first().and_then(|step| step.comparisons.first()) else {
        return table(&["step"]);
    };
    let mut header: Vec<&str> = vec!["NMSE on validation"];
    header.extend(first.signals.iter().map(|signal| signal.name.as_str()));
    header.push("mean");
    let mut table = table(&header);
    let mut row = |name: String, comparisons: &[Comparison]| {
        let count = comparisons.len() as f64;
        let mean = |of: &dyn Fn(&Comparison) -> f64| comparisons.iter().map(of).sum::<f64>() / count;
        let mut cells = vec![Cell::new(name)];
        for index in 0..first.signals.len() {
            let of = |comparison: &Comparison| comparison.signals.get(index).map_or(f64::NAN, |s| s.normalised_error);
            cells.push(right(number(mean(&of))));
        }
        cells.push(right(number(mean(&Comparison::mean_error))).add_attribute(Attribute::Bold));
        table.add_row(cells);
    };
    if !refinement.given.is_empty() {
        row("as given".into(), &refinement.given);
    }
    for step in &refinement.steps {
        let name = step.added.as_ref().map_or("identified".to_string(), |added| format!("+ {added}"));
        row(name, &step.comparisons);
    }
    table
}
