//! `papers`: writes the blocks of docs/papers.md and docs/energy.md that come from simulation, or checks them.

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use excavator_papers::{BLOCKS, written};

/// Tables and sentences that compare with the papers, made by simulation with seeds
#[derive(Parser)]
#[command(name = "papers")]
struct Words {
    /// Only these blocks
    blocks: Vec<String>,
    /// Compare with the pages instead of writing them
    #[arg(long)]
    check: bool,
}

fn main() -> ExitCode {
    let words = Words::parse();
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let wanted =
        BLOCKS.iter().filter(|block| words.blocks.is_empty() || words.blocks.iter().any(|name| name == block.name));
    for block in wanted {
        eprintln!("{}", block.name);
        match replaced(block, &docs, words.check) {
            Ok(()) => (),
            Err(error) => {
                eprintln!("{}: {error}", block.name);
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

fn replaced(block: &excavator_papers::Block, docs: &Path, check: bool) -> Result<(), String> {
    let path = docs.join(block.page);
    // A page may be edited while a long block is made, so it is read afterwards.
    let text = block.text()?;
    let before = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let after = written(block, &text, &before)?;
    match (check, before == after) {
        (_, true) => Ok(()),
        (true, false) => Err(format!("{} is not what the command gives: run it without --check", block.page)),
        (false, false) => std::fs::write(&path, after).map_err(|error| format!("{}: {error}", path.display())),
    }
}
