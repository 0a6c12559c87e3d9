//! Shows progress on standard error, only on a terminal.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use super::printable;

/// A progress bar with a short description of the current step.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// A bar, hidden if standard error is not a terminal.
    pub fn new() -> Self {
        let bar = if std::io::stderr().is_terminal() { ProgressBar::new(1000) } else { ProgressBar::hidden() };
        // The template is constant. If it were ever wrong, the default style would still show progress.
        if let Ok(style) = ProgressStyle::with_template("{spinner} {bar:30} {percent:>3} %  about {eta} left  {msg}") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Progress { bar }
    }

    /// Shows the current step and the fraction done.
    pub fn tell(&self, what: &str, fraction: f64) {
        self.bar.set_position((fraction.clamp(0.0, 1.0) * 1000.0) as u64);
        self.bar.set_message(printable(what).into_owned());
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
