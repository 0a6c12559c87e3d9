//! The page of figures.

use std::fmt::Write;

use crate::figures::{Figures, Group, Run};

const HEAD: &str = "# What it costs

Made by `cargo run --release -p excavator-speed -- page` from `docs/speed.json`; do not edit.

Every group ran in one go on one machine, ours and others alike. `ratio` is the wall time over that of the group's first row. Times
are the shortest of several runs; a verb is a process of its own, with its start. Memory is the largest resident set.
";

const FLAME: &str = "
![Flame graph of a diagnosis: most of the time is spent in the integrator, most of that in the rates of the equations](pictures/diagnose-flame.svg)

Where the time of a diagnosis with two effects goes: three quarters are fits by output error, and nearly all of a fit is the integration of the
states with their sensitivities. Half of that is the linearisation, a third the rates. What a round of the search does beside fits
(promises, starts, screening, the weak form) takes a tenth.
";

/// The page in Markdown, with the parts in this order.
pub fn page(figures: &Figures, order: &[&str]) -> String {
    let mut text = String::from(HEAD);
    let _ = writeln!(text, "\nMachine: {}, {} threads.", figures.processor, figures.threads);
    for (name, part) in order.iter().filter_map(|name| Some((*name, figures.parts.get(*name)?))) {
        for group in &part.groups {
            text += &group_text(group);
            let _ = writeln!(text, "\nMeasured on {}.", part.date);
        }
        if name == "diagnose" {
            text += FLAME;
        }
    }
    text
}

/// A heading, a sentence and a table.
pub fn group_text(group: &Group) -> String {
    let has_process = group.runs.iter().any(|run| run.peak_megabytes.is_some());
    let first = group.runs.first().and_then(|run| run.seconds);
    let (more, rule) = if has_process { ("CPU time | memory | ", "---:|---:|") } else { ("", "") };
    let mut text = format!("\n## {}\n\n{}\n\n", group.name, group.what);
    let _ = writeln!(text, "| | time | ratio | {more}{} |\n|---|---:|---:|{rule}---|", group.result);
    for run in &group.runs {
        let ratio = first.zip(run.seconds).map_or(String::new(), |(first, own)| three_digits(own / first));
        let process = if has_process { process_cells(run) } else { String::new() };
        let _ = writeln!(text, "| {} | {} | {ratio} | {process}{} |", run.name, time(run.seconds), run.result);
    }
    text
}

fn process_cells(run: &Run) -> String {
    let memory = run.peak_megabytes.map_or(String::new(), |megabytes| format!("{megabytes:.0} MB"));
    format!("{} | {memory} | ", time(run.processor_seconds))
}

fn time(seconds: Option<f64>) -> String {
    match seconds {
        None => String::new(),
        Some(seconds) if seconds < 1.0 => format!("{} ms", three_digits(1e3 * seconds)),
        Some(seconds) => format!("{} s", three_digits(seconds)),
    }
}

/// A positive number with three digits, never in powers of ten.
fn three_digits(value: f64) -> String {
    let digits = (2.0 - value.abs().max(1e-3).log10().floor()).clamp(0.0, 4.0) as usize;
    format!("{value:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!(
            [0.0123, 0.5, 1.0, 12.34, 123.4, 1234.0].map(three_digits),
            ["0.0123", "0.500", "1.00", "12.3", "123", "1234"]
        );
    }
}
