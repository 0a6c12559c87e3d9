//! The program described by itself: its command line with the parameters of the nodes, and the pages made of it.

mod man;
#[cfg(feature = "live")]
mod parameters;
#[cfg(feature = "live")]
mod parameters_page;
mod results_page;
mod verbs_page;

use clap::{Command, CommandFactory};

use crate::cli::Arguments;

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        command().debug_assert();
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
