//! Common code of the program and the Python package: it prepares recordings for use, and presents results as JSON,
//! sentences and pages.
//!
//! | module | content |
//! |---|---|
//! | [`recording_part`] | `BAG@20..40`: a part of a recording |
//! | [`recordings`] | checks before a recording is used, samples that are left out, the most informative stretches of a long recording |
//! | [`results`] | the result of each verb, with its JSON, its sentence and its page |
//! | [`sentences`] | result sentences that no page contains |
//! | [`numbers`] | numbers formatted for users |
//! | [`simulated`] | simulations of commands, from rest |
//! | [`profile_file`], [`diagnosis_file`] | files that one verb writes and another reads |
//!
//! This crate prints nothing. It returns remarks for the user.
//!
//! ```no_run
//! use std::path::Path;
//!
//! use excavator_bags::prelude::*;
//! use excavator_model::document::built_in;
//! use excavator_workbench::prelude::*;
//!
//! let model = built_in("zx30u-arm")?;
//! let (recording, report) = read_recording_or_mapped(Path::new("drive_1"), Origin::default())?;
//! let mut remarks = report.problems();
//! let usage = Use { accept: &[], conditions: &[] };
//! let recording = checked("drive_1", recording, &report, &usage, &model, &mut remarks)?;
//! let compared = Compared::of(&model, &recording, None, None)?;
//! println!("{}", compared.sentence());
//! std::fs::write("compared.json", compared.json()?)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod diagnosis_file;
mod error;
mod json_text;
pub mod numbers;
pub mod prelude;
pub mod profile_file;
pub mod recording_part;
pub mod recordings;
pub mod results;
pub mod sentences;
pub mod simulated;

pub use error::WorkError;
pub use json_text::json_text;
