//! `excavator`: which physics is your hydraulic arm's model missing?

use std::process::ExitCode;

fn main() -> ExitCode {
    excavator::run_command_line()
}
