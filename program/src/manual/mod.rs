//! Generates the program's description: its command line with the parameters of the nodes, and the pages made from it.

mod man;
#[cfg(feature = "live")]
mod parameters;
#[cfg(feature = "live")]
mod parameters_page;
mod results_page;
mod verbs_page;

use clap::{Command, CommandFactory};

use crate::cli::Arguments;
use crate::terminal::filled;

pub use man::write_man_pages;
#[cfg(feature = "live")]
pub use parameters_page::parameters_page;
pub use results_page::{results_page, write_schemas};
pub use verbs_page::verbs_page;

/// The command line. The help of each node lists its parameters.
pub fn command() -> Command {
    let all = Arguments::command();
    #[cfg(feature = "live")]
    let all = all.mut_subcommand("node", |node| {
        let kinds: Vec<String> = node.get_subcommands().map(|kind| kind.get_name().to_string()).collect();
        kinds.into_iter().fold(node, |node, kind| {
            let help = parameters::help(&kind);
            node.mut_subcommand(kind, |kind| kind.after_help(help))
        })
    });
    all
}

/// The command line for a terminal of this many columns. No usage is wider.
pub fn command_within(width: Option<usize>) -> Command {
    let mut all = command();
    if let Some(width) = width {
        all.build();
        break_usages(&mut all, width);
    }
    all
}

/// Wraps usages before options and choices. clap wraps all other text itself.
fn break_usages(command: &mut Command, width: usize) {
    command.get_subcommands_mut().for_each(|verb| break_usages(verb, width));
    let usage = command.render_usage().to_string();
    if usage.chars().count() <= width || usage.contains('\n') {
        return;
    }
    // An option stays on one line with its value.
    let usage = usage.trim_start_matches(USAGE).replace("|--", " | --").replace(" <", &format!("{TIE}<"));
    let usage = usage.replace(&format!("{TIE}<-"), " <-");
    let lines = filled(&usage, Some(width.saturating_sub(USAGE.len())));
    let indented = lines.replace('\n', &format!("\n{}", " ".repeat(USAGE.len()))).replace(TIE, " ");
    *command = std::mem::take(command).override_usage(indented);
}

/// The text that clap writes before a usage.
const USAGE: &str = "Usage: ";

/// Marks a space at which a line must not break.
const TIE: char = '\u{1}';

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        command().debug_assert();
    }

    #[test]
    fn no_usage_is_wider_than_the_terminal() {
        let mut all = command_within(Some(80));
        for verb in all.get_subcommands_mut() {
            let usage = verb.render_usage().to_string();
            assert!(usage.lines().all(|line| line.chars().count() <= 80), "{usage}");
        }
        let design = all.find_subcommand_mut("design").map(|design| design.render_usage().to_string());
        let design = design.unwrap_or_default();
        assert!(design.lines().count() > 1 && design.contains("--model <MODEL>"), "{design}");
    }

    #[test]
    #[cfg(feature = "live")]
    fn the_help_of_a_node_lists_its_parameters() {
        let mut all = command();
        let node = all.find_subcommand_mut("node").and_then(|node| node.find_subcommand_mut("arm-simulator"));
        let help = node.map(|node| node.render_help().to_string()).unwrap_or_default();
        assert!(help.contains("rate") && help.contains("command_timeout"), "{help}");
    }
}
