//! Long recordings: selects the most informative stretches while the bag is read.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::mpsc::Receiver;

use excavator_bags::ReadReport;
use excavator_bags::map::{Origin, read_recording_or_mapped};
use excavator_identification::regression::RegressionError;
use excavator_identification::selection::{Chosen, Selection, SelectionSettings, joined};
use excavator_model::Model;
use excavator_model::recording::Recording;

use crate::WorkError;
use crate::block_reader::{needs_a_map, read_beside};
use crate::recording_part::Part;
use crate::recordings::{BLOCK, at_useful_rate, is_long};

/// Blocks that may be queued for the selection.
const WAITING: usize = 1;

/// Reads a recording. Of a long one, returns the stretches most informative about the parameters of `model`, and how they were
/// chosen (without the recording itself).
///
/// # Errors
/// [`WorkError::Recording`] if there is no recording, [`WorkError::Part`], and [`WorkError::Regression`] if a long one lacks
/// inputs.
pub(crate) fn recording_or_stretches(
    path: &Path,
    origin: Origin<'_>,
    model: &Model,
) -> Result<(Recording, ReadReport, Option<Chosen>), WorkError> {
    let (whole, part) = Part::split(path)?;
    if !whole.exists() || needs_a_map(&whole, origin.map) {
        let (recording, mut report) = read_recording_or_mapped(&whole, origin)?;
        let (recording, reduced) = at_useful_rate(in_part(recording, part, path)?);
        report.notes.extend(reduced);
        if !is_long(recording.len(), recording.recorded_time(), model) {
            return Ok((recording, report, None));
        }
        let mut selection = Selection::new(model, SelectionSettings::default());
        selection.offer(&recording)?;
        if selection.is_blind() {
            // Nothing tells the stretches apart, and all of it is in memory.
            return Ok((recording, report, None));
        }
        return Ok(of_stretches(selection.finish(&path.display().to_string()), report));
    }
    in_blocks(path, (&whole, origin.namespace), part, model)
}

fn in_part(recording: Recording, part: Option<Part>, path: &Path) -> Result<Recording, WorkError> {
    match part {
        Some(part) => Ok(part.of(&recording, path)?),
        None => Ok(recording),
    }
}

/// Reads a bag of our own topics block by block: the next block is read while the current one is processed.
fn in_blocks(
    path: &Path,
    (whole, namespace): (&Path, Option<&str>),
    part: Option<Part>,
    model: &Model,
) -> Result<(Recording, ReadReport, Option<Chosen>), WorkError> {
    let (mut start, mut end) = (None, 0.0);
    let choose = |block: Recording| {
        let offset = (block.start_nanoseconds - *start.get_or_insert(block.start_nanoseconds)) as f64 * 1e-9;
        end = offset + block.duration();
        let is_last = part.is_some_and(|part| part.ends_before(end));
        let wanted = match part {
            Some(part) => part.of_block(&block, offset),
            None => Some(block),
        };
        (wanted, if is_last { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    };
    let (report, outcome) = read_beside(whole, namespace, BLOCK, WAITING, choose, |blocks| taken(blocks, path, model))?;
    match outcome? {
        Taken::Whole(recording) if recording.is_empty() => match part {
            Some(part) => Err(part.is_beyond(end, path)),
            None => Ok((recording, report, None)),
        },
        Taken::Whole(recording) => Ok((recording, report, None)),
        Taken::Stretches(chosen) => Ok(of_stretches(chosen, report)),
    }
}

fn of_stretches(mut chosen: Chosen, report: ReadReport) -> (Recording, ReadReport, Option<Chosen>) {
    (std::mem::take(&mut chosen.recording), report, Some(chosen))
}

enum Taken {
    Whole(Recording),
    Stretches(Chosen),
}

/// Returns all blocks joined if they are short in total, else the most informative stretches.
fn taken(blocks: Receiver<Recording>, path: &Path, model: &Model) -> Result<Taken, RegressionError> {
    let source = path.display().to_string();
    let mut pending: Vec<Recording> = Vec::new();
    let mut selection: Option<Selection<'_>> = None;
    for block in blocks {
        pending.push(block);
        let (samples, duration) =
            (pending.iter().map(Recording::len).sum(), pending.iter().map(Recording::recorded_time).sum());
        if selection.is_some() || is_long(samples, duration, model) {
            let selection = selection.get_or_insert_with(|| Selection::new(model, SelectionSettings::default()));
            pending.drain(..).try_for_each(|block| selection.offer(&block))?;
        }
    }
    Ok(match (selection, pending.len()) {
        (Some(selection), _) => Taken::Stretches(selection.finish(&source)),
        (None, 1) => Taken::Whole(Recording { source, ..pending.swap_remove(0) }),
        (None, _) => Taken::Whole(joined(&source, &pending)),
    })
}
