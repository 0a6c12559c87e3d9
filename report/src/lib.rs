//! The HTML report: the measurement, the simulation, and what the model is missing, on one page that a browser opens
//! from disk without a network.
//!
//! Each function returns a whole page as text; the caller writes it to a file. Plots over time are drawn by uPlot,
//! which is part of the page; all others are inline pictures. All text from models and recordings is escaped.

mod assets;
mod beside;
mod change_page;
mod change_text;
mod characterisation_page;
mod characterisation_plots;
mod comparison_page;
mod comparison_text;
mod diagnosis_page;
mod drive_rows;
mod effect_cards;
mod effect_plot;
mod energy_flow;
mod energy_page;
mod energy_tables;
mod energy_text;
mod error_plots;
mod evidence_tables;
mod frontier_plot;
mod machine_picture;
mod named_text;
mod numbers;
mod overlay;
mod page;
mod parameter_table;
mod plausibility_text;
mod plot_gaps;
mod plot_json;
mod plot_line;
mod power_plots;
mod proposal_page;
mod proposal_text;
mod recordings_page;
mod refinement_page;
mod residual_units;
mod sankey;
mod signal_tables;
mod step_plot;
mod svg;
mod time_plots;
mod unexplained_plot;
mod units;
mod verdict_text;
mod words;

#[cfg(test)]
mod tests;

pub use assets::{KINEMATICS, plotting};
pub use beside::Beside;
pub use change_page::change_page;
pub use change_text::{change_sentence, relative_change, workshop_value};
pub use characterisation_page::{characterisation_page, leakage_unit};
pub use comparison_page::comparison_page;
pub use comparison_text::{comparison_sentence, others_sentence};
pub use diagnosis_page::diagnosis_page;
pub use drive_rows::{DriveRow, drive_rows};
pub use energy_page::energy_page;
pub use energy_text::{budget_label, budget_sentence, delivered_by};
pub use named_text::refinement_sentence;
pub use plausibility_text::implausible_sentence;
pub use proposal_page::{proposal_page, result as law_result};
pub use proposal_text::{guess_sentence, proposal_sentence};
pub use recordings_page::{Viewed, ViewedSignal, recordings_page};
pub use refinement_page::refinement_page;
pub use units::signal_unit;
pub use verdict_text::{NONE_TRIED, verdict_sentence};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
