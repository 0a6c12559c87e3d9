//! `speed`: measures what things cost, beside the programs of others, and writes the page of figures.

mod clock;
#[path = "../../../model/tests/it/common/mod.rs"]
mod common;
mod diffsol;
mod figures;
mod growth;
mod identification;
mod live;
mod page;
mod peers;
mod reading;
mod recordings;
mod references;
mod simulation;
mod truth;
mod verbs;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use figures::{Figures, Group, Part};
use peers::Peers;
use verbs::Program;

/// What reading, simulation, identification and diagnosis cost, and what another solver says
#[derive(Parser)]
#[command(name = "speed")]
struct Words {
    #[command(subcommand)]
    command: Wanted,
}

#[derive(Subcommand)]
enum Wanted {
    /// Measure costs beside the programs of others
    Measure(Measure),
    /// Measure how costs grow with length, joints and candidates
    Growth(Measure),
    /// Write docs/speed.md from docs/speed.json
    Page,
    /// Solve the motions that the tests of the model compare with, by diffsol
    References {
        /// Compare with the stored solutions instead of writing them
        #[arg(long)]
        check: bool,
    },
}

#[derive(clap::Args)]
struct Measure {
    /// Only these parts
    parts: Vec<String>,
    /// Python with what tests/speed/requirements.txt names; without, nothing of others is measured
    #[arg(long)]
    python: Option<PathBuf>,
    /// The program; by default the one beside this one
    #[arg(long)]
    program: Option<PathBuf>,
}

/// A part and what measures it.
type Measured = (&'static str, fn(&Program<'_>, &Peers) -> Result<Vec<Group>, String>);

const COSTS: [Measured; 7] = [
    ("reading", |program, peers| Ok(vec![reading::reading(&recordings::long(program.folder, 300.0, 1000.0)?, peers)?])),
    ("simulation", |_, peers| simulation::simulation(peers)),
    ("identification", |_, peers| Ok(vec![identification::identification(peers)?])),
    ("diagnose", |program, _| Ok(vec![verbs::diagnoses(program)?])),
    ("hour", |program, _| Ok(vec![verbs::long_recording(program, 3600.0, 1000.0)?])),
    ("week", |program, _| Ok(vec![verbs::week(program)?])),
    ("live", |program, _| Ok(vec![live::live(program)?])),
];

const GROWTH: [Measured; 3] = [
    ("growth-length", |program, _| growth::lengths(program)),
    ("growth-joints", |_, _| Ok(vec![growth::joints()?])),
    ("growth-candidates", |_, _| Ok(vec![growth::candidates()?])),
];

fn main() -> ExitCode {
    let done = match Words::parse().command {
        Wanted::Measure(words) => measure(&words, &COSTS).and_then(|()| write_page()),
        Wanted::Growth(words) => measure(&words, &GROWTH).and_then(|()| write_page()),
        Wanted::Page => write_page(),
        Wanted::References { check } => references::references(check),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}

/// Measures parts and stores each when it is done.
fn measure(words: &Measure, all: &[Measured]) -> Result<(), String> {
    if let Some(unknown) = words.parts.iter().find(|part| all.iter().all(|(name, _)| name != part)) {
        let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
        return Err(format!("no part \"{unknown}\"; there are {}", names.join(", ")));
    }
    let beside = std::env::current_exe().map_err(|error| error.to_string())?.with_file_name("excavator");
    let path = words.program.clone().unwrap_or(beside);
    let peers = Peers::new(words.python.clone());
    for (name, work) in all {
        if !words.parts.is_empty() && words.parts.iter().all(|part| part != name) {
            continue;
        }
        eprintln!("{name} ...");
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let groups = work(&Program { path: path.clone(), folder: folder.path() }, &peers)?;
        for group in &groups {
            eprint!("{}", page::group_text(group));
        }
        let mut figures = Figures::of_this_machine();
        figures.parts.insert(name.to_string(), Part::of_today(groups));
        let figures = match stored() {
            Ok(earlier) => figures.over(earlier),
            // The first run has nothing to keep.
            Err(_) => figures,
        };
        let text = serde_json::to_string_pretty(&figures).map_err(|error| error.to_string())?;
        std::fs::write(docs().join("speed.json"), text + "\n").map_err(|error| error.to_string())?;
    }
    Ok(())
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

fn stored() -> Result<Figures, String> {
    let path = docs().join("speed.json");
    let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    serde_json::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))
}

fn write_page() -> Result<(), String> {
    let order: Vec<&str> = COSTS.iter().chain(&GROWTH).map(|(name, _)| *name).collect();
    let path = docs().join("speed.md");
    std::fs::write(&path, page::page(&stored()?, &order)).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn the_page_in_the_docs_is_that_of_the_stored_figures() {
        let order: Vec<&str> = COSTS.iter().chain(&GROWTH).map(|(name, _)| *name).collect();
        let written = std::fs::read_to_string(docs().join("speed.md")).unwrap();
        assert_eq!(
            page::page(&stored().unwrap(), &order),
            written,
            "run: cargo run --release -p excavator-speed -- page"
        );
    }
}
