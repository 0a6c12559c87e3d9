//! Finds runs of the valve from nearly closed to open, and back.

use super::edge::Direction;
use super::track::Track;

/// Share of the largest opening below which a run must begin (or end).
pub(super) const LOW: f64 = 0.05;
/// Share above which it must end (or begin).
pub(super) const HIGH: f64 = 0.2;
/// Longest run, s: in longer ones the load changes.
pub(super) const SLOWEST: f64 = 30.0;
/// Shortest run, in half widths of the smoothing parabola.
const FASTEST: f64 = 5.0;
/// Minimum rate of a run, in largest openings per second; anything slower is a rest at the turning point.
const RUNNING: f64 = 0.005;

/// Samples `first..=last` in which the opening moves in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sweep {
    pub first: usize,
    pub last: usize,
    /// Whether the valve opens.
    pub opens: bool,
}

/// Shortest time of a run that can be used, s.
pub(super) fn fastest(track: &Track) -> f64 {
    FASTEST * track.half_width
}

/// All runs of a track to one side.
pub(super) fn sweeps(track: &Track, direction: Direction) -> Vec<Sweep> {
    let (maximum, sign) = (track.maximum_opening(), direction.sign());
    let open = |index: usize| sign * track.smooth_opening[index];
    let mut found = Vec::new();
    for opens in [true, false] {
        let way = if opens { sign } else { -sign };
        let mut run: Option<(usize, usize)> = None;
        for index in 0..=track.opening.len() {
            let runs = index < track.opening.len()
                && way * track.opening_rate[index] > RUNNING * maximum
                && open(index) > -LOW * maximum;
            run = match (run, runs) {
                (None, true) => Some((index, index)),
                (Some((first, _)), true) => Some((first, index)),
                (Some((first, last)), false) => {
                    let (low, high) = if opens { (open(first), open(last)) } else { (open(last), open(first)) };
                    let took = track.time[last] - track.time[first];
                    if low <= LOW * maximum && high >= HIGH * maximum && (fastest(track)..=SLOWEST).contains(&took) {
                        found.push(Sweep { first, last, opens });
                    }
                    None
                }
                (None, false) => None,
            };
        }
    }
    found
}
