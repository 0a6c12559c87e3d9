//! Tables of the errors of each signal.

use excavator_identification::refinement::Refinement;
use excavator_identification::validation::{Comparison, Correlation, ErrorSums, errors_of, mean_error_of};
use maud::{Markup, html};

use super::numbers::{NOTHING, decimal, significant};
use super::{units, words};

/// Mean and largest absolute value of the error (measured - model) of a signal, SI.
fn error_sizes(comparison: &Comparison, name: &str) -> Option<(f64, f64)> {
    let pairs = || {
        comparison
            .measured
            .signal(name)
            .into_iter()
            .flatten()
            .zip(comparison.simulated.signal(name).into_iter().flatten())
    };
    let errors = || pairs().map(|(m, s)| (m - s).abs()).filter(|error| error.is_finite());
    let count = errors().count();
    (count > 0).then(|| ((errors().map(|e| e * e).sum::<f64>() / count as f64).sqrt(), errors().fold(0.0, f64::max)))
}

/// NMSE, FIT, phase delay and errors of every signal of every recording.
pub(super) fn measures(comparisons: &[Comparison]) -> Markup {
    html! {
        div.wide { table.data {
            thead { tr {
                th { "Signal" } th.n { "NMSE" } th.n { "FIT" } th.n { "Phase delay" } th.n { "RMS error" } th.n { "Largest error" }
                th.n { "Error autocorrelation" } th.n { "Correlation with the input" }
            } }
            tbody {
                @for comparison in comparisons {
                    @if comparisons.len() > 1 { tr.group { td colspan="8" { (comparison.measured.source) } } }
                    @for signal in &comparison.signals {
                        @let unit = units::of_signal(&comparison.machine, &signal.name);
                        @let sizes = error_sizes(comparison, &signal.name);
                        tr {
                            td { (words::signal(&signal.name)) " " code.code-name { (signal.name) } }
                            td.n { (significant(signal.error.normalised(), 3)) @if !signal.error.tells() { "*" } }
                            td.n { @let fit = signal.error.fit_percent(); @if fit.is_finite() { (decimal(fit)) " %" } @else { (NOTHING) } }
                            td.n { (signal.phase_delay_degrees.map_or(NOTHING.to_string(), |d| format!("{}°", decimal(d)))) }
                            td.n { (sizes.map_or(NOTHING.to_string(), |s| format!("{} {}", significant(s.0 * unit.factor, 3), unit.symbol))) }
                            td.n { (sizes.map_or(NOTHING.to_string(), |s| format!("{} {}", significant(s.1 * unit.factor, 3), unit.symbol))) }
                            td.n { (correlation(signal.autocorrelation)) }
                            td.n { (correlation(signal.input_correlation)) }
                        }
                    }
                    tr.sum { td { "Mean" } td.n { (significant(comparison.mean_error(), 3)) } td {} td {} td {} td {} td {} td {} }
                }
            }
        } }
        p.note {
            @if comparisons.iter().flat_map(|one| &one.signals).any(|signal| !signal.error.tells()) {
                "* Not in the mean: the signal is mostly noise, or it does not change. "
            }
            "NMSE: squared error over the signal's own variance; 0 is perfect, 1 is no better than its mean. "
            "FIT = 100 (1 − √NMSE) %. Phase delay: by how much the model lags behind the measurement at the frequency of "
            "the excitation" (frequencies(comparisons)) "; negative where it leads. "
            "Error autocorrelation and correlation with the input: the largest value over lags of up to 2 s, if it is "
            "significant. The error of a complete model is noise and shows neither."
        }
    }
}

/// A correlation with its lag, or "no" if chance explains it.
fn correlation(found: Option<Correlation>) -> String {
    match found {
        None => NOTHING.to_string(),
        Some(found) if found.is_significant() => {
            format!("{} after {} s", significant(found.value, 2), significant(found.lag, 2))
        }
        Some(_) => "no".to_string(),
    }
}

fn frequencies(comparisons: &[Comparison]) -> String {
    let found: Vec<String> = comparisons
        .iter()
        .filter_map(|c| c.excitation_frequency)
        .map(|f| format!("{} Hz", significant(f, 3)))
        .collect();
    if found.is_empty() { String::new() } else { format!(" ({})", found.join(", ")) }
}

/// The compared recordings: source, length and rate of each.
pub(super) fn recordings(comparisons: &[Comparison]) -> Markup {
    html! {
        @if comparisons.is_empty() { p.empty { "No recording." } } @else {
            div.wide { table.data {
                thead { tr { th { "Recording" } th.n { "Duration" } th.n { "Samples" } th.n { "Rate" } } }
                tbody { @for comparison in comparisons {
                    @let recording = &comparison.measured;
                    tr {
                        td.source { code { (recording.source) } }
                        td.n { (format!("{:.1} s", recording.duration())) }
                        td.n { (recording.len()) }
                        td.n { (significant(1.0 / recording.sample_interval(), 3)) " Hz" }
                    }
                } }
            } }
        }
    }
}

/// Mean NMSE over recordings of every signal at every stage of a refinement, in stage order.
pub(super) struct Stages {
    /// "given", "refitted", "+ effect".
    pub names: Vec<String>,
    /// Per signal: its name and one error per stage.
    pub signals: Vec<(String, Vec<f64>)>,
    /// Mean over signals per stage.
    pub mean: Vec<f64>,
}

impl Stages {
    /// The stages of a refinement.
    pub fn of(refinement: &Refinement) -> Self {
        let mut stages: Vec<(String, &[Comparison])> = Vec::new();
        if !refinement.given.is_empty() {
            stages.push(("as given".to_string(), &refinement.given));
        }
        for step in &refinement.steps {
            let name = step.added.as_ref().map_or("refitted".to_string(), |added| format!("+ {}", added_name(added)));
            stages.push((name, &step.comparisons));
        }
        let errors: Vec<Vec<(&str, ErrorSums)>> =
            stages.iter().map(|(_, comparisons)| errors_of(comparisons)).collect();
        let mut names: Vec<&str> = Vec::new();
        for (name, _) in errors.iter().flatten() {
            if !names.contains(name) {
                names.push(name);
            }
        }
        let own = |stage: &[(&str, ErrorSums)], name: &str| {
            stage.iter().find(|(own, _)| *own == name).map_or(f64::NAN, |(_, error)| error.normalised())
        };
        Stages {
            signals: names
                .into_iter()
                .map(|name| (name.to_string(), errors.iter().map(|stage| own(stage, name)).collect()))
                .collect(),
            mean: stages.iter().map(|(_, comparisons)| mean_error_of(comparisons)).collect(),
            names: stages.into_iter().map(|(name, _)| name).collect(),
        }
    }

    /// The errors as a table, one column per stage.
    pub fn table(&self) -> Markup {
        html! {
            div.wide { table.data {
                thead { tr { th { "NMSE on validation" } @for name in &self.names { th.n { (name) } } } }
                tbody {
                    @for (name, errors) in &self.signals {
                        tr { td { (words::signal(name)) " " code.code-name { (name) } } (error_cells(errors)) }
                    }
                    tr.sum { td { "Mean" } (error_cells(&self.mean)) }
                }
            } }
        }
    }
}

fn error_cells(errors: &[f64]) -> Markup {
    html! {
        @for (index, error) in errors.iter().enumerate() {
            td.n.final[index + 1 == errors.len()] { (significant(*error, 3)) }
        }
    }
}

/// `valve_dead_zone@arm` -> "valve dead zone, arm".
pub(super) fn added_name(added: &str) -> String {
    match added.split_once('@') {
        Some((effect, place)) => format!("{}, {place}", words::spoken(effect)),
        None => words::spoken(added),
    }
}
