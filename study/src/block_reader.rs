//! Reads a bag of our own topics in blocks, in parallel to the work on them.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::mpsc::{Receiver, sync_channel};

use excavator_bags::map::TopicMap;
use excavator_bags::table::Table;
use excavator_bags::{BagError, ReadReport, Topics, read_recording_in_blocks};
use excavator_model::recording::Recording;

/// Whether a recording can only be read whole: a map resamples every signal onto one clock, which needs the complete recording.
pub fn needs_a_map(path: &Path, map: Option<&Path>) -> bool {
    map.is_some() || TopicMap::beside(path).is_some() || Table::is_table(path)
}

/// Reads the bag in blocks of `samples` while `work` consumes them. At most `waiting` blocks are queued. `choose` selects the
/// part of a block to keep, and whether to continue reading. Returns the report on the bag and the result of `work`.
///
/// # Errors
/// The errors of [`read_recording_in_blocks`].
pub fn read_beside<T>(
    path: &Path,
    namespace: Option<&str>,
    samples: usize,
    waiting: usize,
    mut choose: impl FnMut(Recording) -> (Option<Recording>, ControlFlow<()>) + Send,
    work: impl FnOnce(Receiver<Recording>) -> T,
) -> Result<(ReadReport, T), BagError> {
    if !path.exists() {
        return Err(rosbag2::Error::DoesNotExist { path: path.to_path_buf() }.into());
    }
    let topics = Topics::in_bag(path, namespace)?;
    let (sender, blocks) = sync_channel(waiting);
    std::thread::scope(|scope| {
        let reader = scope.spawn(move || {
            read_recording_in_blocks(path, &topics, samples, |block| {
                let (wanted, goes_on) = choose(block);
                // The receiver may have ended; its result states the reason.
                let has_ended = wanted.is_some_and(|wanted| sender.send(wanted).is_err());
                if has_ended { ControlFlow::Break(()) } else { goes_on }
            })
        });
        let outcome = work(blocks);
        let report = reader.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        Ok((report?, outcome))
    })
}
