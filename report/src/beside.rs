//! What stands beside a model in the plots of a comparison.

use excavator_identification::validation::{Comparison, Repeat};

use super::plot_line::{Line, MODEL, OTHER_MODEL, SECOND_RUN};

/// Additional data on every plot of a recording.
#[derive(Debug, Clone, Copy)]
pub enum Beside<'a> {
    /// Another model of the machine.
    Model(&'a Comparison),
    /// Another run of the machine, aligned.
    Run(&'a Repeat),
}

impl<'a> Beside<'a> {
    /// The comparison.
    pub fn comparison(self) -> &'a Comparison {
        match self {
            Beside::Model(comparison) => comparison,
            Beside::Run(run) => &run.comparison,
        }
    }

    /// Its name in a legend or a column heading.
    pub fn label(self) -> &'static str {
        self.line().label
    }

    /// NMSE of a signal; `NaN` if it has none.
    pub fn error_of(self, signal: &str) -> f64 {
        let own = self.comparison().signals.iter().find(|own| own.name == signal);
        own.map_or(f64::NAN, |own| own.error.normalised())
    }

    fn line(self) -> Line {
        match self {
            Beside::Model(_) => OTHER_MODEL,
            Beside::Run(_) => SECOND_RUN,
        }
    }
}

/// Lines of a recording, its model, and all additional data.
pub(super) fn comparison_lines<'a>(comparison: &'a Comparison, others: &[Beside<'a>]) -> Vec<(Line, &'a Comparison)> {
    std::iter::once((MODEL, comparison)).chain(others.iter().map(|other| (other.line(), other.comparison()))).collect()
}
