//! Reading a bag, beside the bare `mcap` crate and the readers of others.

use std::path::Path;

use excavator_bags::{Topics, read_recording};
use rosbag2::RawMessages;

use crate::clock::best_of;
use crate::figures::{Group, Run};
use crate::peers::Peers;

/// Repetitions of which the shortest counts.
const REPETITIONS: usize = 7;

/// Reads one bag with every reader.
///
/// # Errors
/// In words, where one of ours or the `mcap` crate cannot read it.
pub fn reading(bag: &Path, peers: &Peers) -> Result<Group, String> {
    let file = mcap_file(bag)?;
    let megabytes = std::fs::metadata(&file).map_err(|error| error.to_string())?.len() as f64 / 1e6;
    let (bare_seconds, bare_messages) = best_of(REPETITIONS, || bare(&file));
    let bare_messages = bare_messages?;
    let (raw_seconds, raw_messages) = best_of(REPETITIONS, || raw(&file));
    let raw_messages = raw_messages?;
    let (seconds, samples) = best_of(REPETITIONS, || columns(bag));
    let samples = samples?;
    let mut runs = vec![
        Run::timed("mcap crate, messages as bytes", bare_seconds, format!("{bare_messages} messages")),
        Run::timed("rosbag2, messages as bytes", raw_seconds, format!("{raw_messages} messages")),
        Run::timed("excavator-bags, decoded to columns", seconds, format!("{samples} samples")),
    ];
    runs.push(peers.run("rosbags, decoded messages", "rosbags", &serde_json::json!({ "bag": bag })));
    runs.push(peers.run("mcap-ros2-support, decoded messages", "mcap_ros2", &serde_json::json!({ "file": file })));
    Ok(Group {
        name: "Reading a bag".into(),
        what: format!("Five minutes at 1 kHz, states and commands of one cylinder, {megabytes:.0} MB with zstd."),
        result: "read".into(),
        runs,
    })
}

fn mcap_file(bag: &Path) -> Result<std::path::PathBuf, String> {
    let files = std::fs::read_dir(bag).map_err(|error| format!("{}: {error}", bag.display()))?;
    let mut paths = files.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    paths
        .find(|path| path.extension().is_some_and(|extension| extension == "mcap"))
        .ok_or_else(|| format!("{}: no .mcap file", bag.display()))
}

fn bare(file: &Path) -> Result<usize, String> {
    let bytes = std::fs::read(file).map_err(|error| error.to_string())?;
    let messages = mcap::MessageStream::new(&bytes).map_err(|error| error.to_string())?;
    let mut count = 0;
    for message in messages {
        count += usize::from(!message.map_err(|error| error.to_string())?.data.is_empty());
    }
    Ok(count)
}

fn raw(file: &Path) -> Result<usize, String> {
    let mut count = 0;
    for message in RawMessages::open(file).map_err(|error| error.to_string())? {
        count += usize::from(!message.map_err(|error| error.to_string())?.data.is_empty());
    }
    Ok(count)
}

fn columns(bag: &Path) -> Result<usize, String> {
    read_recording(bag, &Topics::default()).map(|(recording, _)| recording.len()).map_err(|error| error.to_string())
}
