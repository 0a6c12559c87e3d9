//! Reads several consecutive files as one recording.

use std::path::{Path, PathBuf};

use excavator_model::recording::{Recording, longest_gap};

use super::document::TopicMap;
use super::error::MapError;
use super::join::Join;
use super::read_mapped::{map_of, read_with};
use super::signal::SignalName;
use super::table_clock::Dating;
use crate::BagError;
use crate::reading::{ReadReport, gaps};

/// One file of a recording.
struct Piece {
    path: PathBuf,
    recording: Recording,
    report: ReadReport,
    is_dated: bool,
}

impl Piece {
    fn first(&self) -> i64 {
        self.recording.start_nanoseconds
    }

    fn last(&self) -> i64 {
        self.first().saturating_add((self.recording.duration() * 1e9).round() as i64)
    }
}

/// Reads files that are one recording. Each is read with the given map, otherwise with the one next to it, otherwise
/// with the one next to the first file. `joins` are tables recorded with a single file, for which the map needs no
/// `[[join]]`.
///
/// Files with absolute times keep them. A file with its own time 0 that would start before the end of the previous one
/// is moved behind it, by the shortest pause that makes it a separate piece (see [`Recording::pieces`]).
///
/// # Errors
/// All of [`read_mapped`](super::read_mapped) and [`read_recording`](crate::read_recording);
/// [`MapError::PiecesOverlap`] for files whose times overlap, [`MapError::JoinsOfPieces`],
/// [`MapError::JoinWithoutMap`].
pub fn read_pieces(
    paths: &[PathBuf],
    map: Option<&Path>,
    joins: &[PathBuf],
) -> Result<(Recording, ReadReport), BagError> {
    if paths.len() > 1 && !joins.is_empty() {
        return Err(MapError::JoinsOfPieces { pieces: paths.len() }.into());
    }
    let of_first = match paths.first() {
        Some(first) => map_of(first, map, None)?,
        None => None,
    };
    let mut pieces = Vec::new();
    for (number, path) in paths.iter().enumerate() {
        let own = if number == 0 { None } else { map_of(path, map, None)? };
        let mut map = own.or_else(|| of_first.clone());
        add_joins(path, map.as_mut(), joins)?;
        let (recording, report, dating) = read_with(path, map.as_ref(), None)?;
        pieces.push(Piece { path: path.clone(), recording, report, is_dated: dating == Dating::Dated });
    }
    if pieces.iter().all(|piece| piece.is_dated) {
        pieces.sort_by_key(Piece::first);
    }
    if pieces.len() == 1
        && let Some(Piece { recording, report, .. }) = pieces.pop()
    {
        return Ok((recording, report));
    }
    let mut notes = Vec::new();
    place(&mut pieces, &mut notes)?;
    let recording = one_of(&pieces);
    let mut report = ReadReport::default();
    for piece in pieces {
        report.add_piece(&piece.path, piece.report);
    }
    report.gaps = gaps(&recording);
    report.notes.extend(notes);
    Ok((recording, report))
}

/// Adds tables to those that the map joins.
fn add_joins(data: &Path, map: Option<&mut TopicMap>, joins: &[PathBuf]) -> Result<(), BagError> {
    let Some(first) = joins.first() else { return Ok(()) };
    let Some(map) = map else { return Err(MapError::JoinWithoutMap { file: first.clone() }.into()) };
    let folder = data.parent().unwrap_or(Path::new("."));
    for join in joins {
        let file = std::path::absolute(join).map_err(rosbag2::Error::io("find", join))?;
        let known = |other: &Join| std::path::absolute(folder.join(&other.file)).is_ok_and(|other| other == file);
        if !map.join.iter().any(known) {
            map.join.push(Join::of(&file));
        }
    }
    Ok(())
}

/// Moves undated pieces behind the previous one if they would overlap.
fn place(pieces: &mut [Piece], notes: &mut Vec<String>) -> Result<(), MapError> {
    // Longer than any gap within a piece, whichever of their intervals applies to the whole recording.
    let interval = pieces.iter().map(|piece| piece.recording.sample_interval()).fold(0.0, f64::max);
    let pause = longest_gap(interval) + interval;
    for number in 1..pieces.len() {
        let end = pieces[number - 1].last();
        let before = pieces[number - 1].path.clone();
        let piece = &mut pieces[number];
        if piece.first() > end {
            continue;
        }
        if piece.is_dated {
            let overlap = end.saturating_sub(piece.first()) as f64 / 1e9;
            return Err(MapError::PiecesOverlap { first: before, second: piece.path.clone(), overlap });
        }
        let begin = end.saturating_add((pause * 1e9).ceil() as i64);
        let moved = begin.saturating_sub(piece.recording.start_nanoseconds);
        piece.recording.start_nanoseconds = begin;
        piece.report.left_out.iter_mut().flatten().for_each(|moment| *moment = moment.saturating_add(moved));
        notes.push(format!(
            "{} counts time from its own start: it begins {pause:.3} s after the end of {}, which makes it a piece of its own",
            piece.path.display(),
            before.display()
        ));
    }
    Ok(())
}

/// The samples of all pieces on one clock; `NaN` for signals that a piece did not measure.
fn one_of(pieces: &[Piece]) -> Recording {
    let start = pieces.first().map_or(0, Piece::first);
    let mut time = Vec::new();
    for Piece { recording, .. } in pieces {
        let shift = recording.start_nanoseconds.saturating_sub(start) as f64 / 1e9;
        time.extend(recording.time.iter().map(|t| t + shift));
    }
    let sources: Vec<&str> = pieces.iter().map(|piece| piece.recording.source.as_str()).collect();
    let mut whole = Recording::unmeasured(&sources.join(", "), time, &[]);
    whole.start_nanoseconds = start;
    let mut begin = 0;
    for Piece { recording, .. } in pieces {
        let end = begin + recording.len();
        for (name, values) in recording.signals() {
            if let Ok(name) = name.parse::<SignalName>()
                && let Some(place) = name.column(&mut whole).get_mut(begin..end)
            {
                place.copy_from_slice(values);
            }
        }
        begin = end;
    }
    whole
}
