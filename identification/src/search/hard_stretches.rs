//! The stretches of recordings in which a model fails most.

use excavator_model::recording::Recording;

use crate::fit::Fit;

/// Parts of `recordings`, each of `duration` s or a multiple of it, in which `fit`, a fit to them, fails most. They
/// cover about `share` of the time. Returns `None` if the recordings are too short to choose from.
///
/// An effect that acts only briefly acts in these parts, or it explains nothing.
pub(super) fn hard_stretches(
    fit: &Fit,
    recordings: &[&Recording],
    duration: f64,
    share: f64,
) -> Option<Vec<Recording>> {
    let mut pieces: Vec<Piece> = Vec::new();
    for (number, recording) in recordings.iter().enumerate() {
        for samples in recording.pieces() {
            let (start, end) = (recording.time[samples.start], recording.time[samples.end - 1]);
            let count = ((end - start) / duration).round().max(1.0);
            let length = (end - start) / count;
            pieces.extend((0..count as usize).map(|piece| Piece {
                recording: number,
                begin: start + piece as f64 * length,
                end: start + (piece + 1) as f64 * length,
                failure: 0.0,
            }));
        }
    }
    let wanted = (pieces.len() as f64 * share).ceil() as usize;
    if wanted < FEWEST {
        return None;
    }
    for ((number, time), errors) in fit.block_places.iter().zip(&fit.block_errors) {
        let squares = errors.iter().zip(fit.errors.iter().zip(&fit.instruments));
        let failure: f64 = squares.map(|((squares, _), (error, own))| squares / error.max(own.noise).powi(2)).sum();
        let holds = |piece: &&mut Piece| piece.recording == *number && (piece.begin..piece.end).contains(time);
        if let Some(piece) = pieces.iter_mut().find(holds) {
            piece.failure += failure;
        }
    }
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by(|&a, &b| pieces[b].failure.total_cmp(&pieces[a].failure));
    let mut chosen: Vec<usize> = order.into_iter().take(wanted).collect();
    chosen.sort_unstable();
    let mut stretches: Vec<Piece> = Vec::new();
    for piece in chosen.into_iter().map(|number| pieces[number]) {
        match stretches.last_mut() {
            Some(last) if last.recording == piece.recording && last.end == piece.begin => last.end = piece.end,
            _ => stretches.push(piece),
        }
    }
    Some(stretches.iter().map(|piece| recordings[piece.recording].part(piece.begin, piece.end)).collect())
}

/// With fewer pieces than this there are hardly more readings than a screening needs.
const FEWEST: usize = 4;

#[derive(Debug, Clone, Copy)]
struct Piece {
    recording: usize,
    /// s after the recording's first sample.
    begin: f64,
    end: f64,
    /// Sum of squared errors in units of each instrument's error.
    failure: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::made_up::made_up_fit;

    /// A fit whose squared error is 1 in each block of half a second, and 100 in the blocks that begin in `bad`.
    fn fit(seconds: usize, bad: &[std::ops::Range<f64>]) -> Fit {
        let places: Vec<(usize, f64)> = (0..2 * seconds).map(|block| (0, block as f64 * 0.5)).collect();
        let error = |time: &f64| if bad.iter().any(|bad| bad.contains(time)) { 100.0 } else { 1.0 };
        let model = excavator_model::document::built_in("emps").unwrap_or_else(|_| unreachable!());
        let block_errors = places.iter().map(|(_, time)| vec![(error(time), 5)]).collect();
        Fit { block_errors, block_places: places, ..made_up_fit(model, 1.0, 1.0) }
    }

    fn recording(seconds: usize) -> Recording {
        Recording::unmeasured("bag", (0..10 * seconds + 1).map(|index| index as f64 * 0.1).collect(), &["load"])
    }

    #[test]
    fn stretches_in_a_row_are_one_part_and_good_ones_are_left_out() {
        let recording = recording(40);
        let bad = [4.0..8.0, 8.0..12.0, 20.0..22.0, 36.0..38.0];
        let parts = hard_stretches(&fit(40, &bad), &[&recording], 4.0, 0.4).unwrap_or_default();
        let spans: Vec<(i64, f64)> =
            parts.iter().map(|part| (part.start_nanoseconds / 1_000_000_000, part.duration().round())).collect();
        assert_eq!(spans, [(4, 8.0), (20, 4.0), (36, 4.0)]);
    }

    #[test]
    fn short_recordings_are_used_whole() {
        let recording = recording(20);
        assert!(hard_stretches(&fit(20, &[]), &[&recording], 4.0, 0.5).is_none());
    }
}
