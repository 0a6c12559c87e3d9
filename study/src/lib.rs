//! Studies of a machine: from a question to its answer, the same for terminal, robot, Python and page.
//!
//! Recordings are made fit for use, a [`Study`] asks a question of them, and a result is presented as JSON, sentence and page. A
//! [`StudyFile`] keeps a result.
//!
//! | module | content |
//! |---|---|
//! | [`recording_part`] | `BAG@20..40`: a part of a recording |
//! | [`preparation`] | reads recordings by name and makes them fit for use |
//! | [`recordings`] | checks before a recording is used, samples that are left out, the most informative stretches of a long recording |
//! | [`results`] | the result of each verb, with its JSON, its sentence and its page |
//! | [`sentences`] | result sentences that no page contains |
//! | [`numbers`] | numbers formatted for users |
//! | [`simulated`] | simulations of commands, from rest |
//! | [`sheet`] | a data sheet as a file |
//! | [`position_test`] | a model from reference to position, from tables |
//! | [`valve_test`] | a static valve test from a table |
//! | [`profile_file`], [`diagnosis_file`], [`recording_files`] | files that one verb writes and another reads |
//!
//! This crate prints nothing. It returns remarks for the user.
//!
//! ```no_run
//! use std::path::Path;
//!
//! use excavator_bags::prelude::*;
//! use excavator_model::document::built_in;
//! use excavator_study::prelude::*;
//!
//! let model = built_in("zx30u-arm")?;
//! let (recording, report) = read_recording_or_mapped(Path::new("drive_1"), Origin::default())?;
//! let mut remarks = report.problems();
//! let usage = Use::default();
//! let recording = checked("drive_1", recording, &report, &usage, &model, &mut remarks)?;
//! let compared = Study::of_recording(model, recording).compare(None, None)?;
//! println!("{}", compared.sentence());
//! std::fs::write("compared.json", compared.json()?)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod block_reader;
pub mod diagnosis_file;
mod error;
mod json_text;
mod long_recording;
pub mod mapped_units;
mod model_files;
pub mod numbers;
pub mod position_test;
pub mod prelude;
pub mod preparation;
pub mod profile_file;
mod read_values;
pub mod recording_files;
pub mod recording_part;
pub mod recordings;
pub mod results;
pub mod sentences;
pub mod sheet;
pub mod simulated;
mod spikes;
mod steady_model;
mod study;
mod study_file;
pub mod valve_test;

pub use error::WorkError;
pub use json_text::json_text;
pub use model_files::model_named;
pub use study::Study;
pub use study_file::{StudyFile, StudyOptions};
