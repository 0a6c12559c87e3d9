//! Where the piston meets its stops, from positions at which its motion ends although it is driven on.

use excavator_model::recording::noise_level;

use super::estimate::Estimate;
use super::track::Track;

/// Share of the largest input by which the piston must be driven against a stop. Below, a dead zone could hold it.
const DRIVEN: f64 = 0.5;
/// Share of the stroke by which a stop may be away from its place in the model.
const NEAR: f64 = 0.1;
/// Share of the stroke within which a piston counts as at the same place.
const SAME_PLACE: f64 = 2.5e-3;
/// Speed below which a piston stands, in strokes per second.
const STANDING: f64 = 2e-3;
/// Least time at a stop, s, for a cylinder of the reference size.
const LEAST_TIME: f64 = 0.1;

/// Stops of a cylinder, m: retracted and extended. `None` where the recordings do not reach one. `null` is the input at which the
/// valve is closed.
pub(super) fn stops(tracks: &[Track], null: f64) -> [Option<Estimate>; 2] {
    [-1.0, 1.0].map(|side| stop(tracks, null, side))
}

fn stop(tracks: &[Track], null: f64, side: f64) -> Option<Estimate> {
    let first = tracks.first().filter(|track| track.stroke.is_finite() && !track.opening.is_empty())?;
    let (stroke, end) = (first.stroke, first.ends[usize::from(side > 0.0)]);
    let all = || tracks.iter().flat_map(|track| (0..track.time.len()).map(move |index| (track, index)));
    let largest = all().map(|(track, index)| side * (track.opening[index] - null)).fold(0.0_f64, f64::max);
    let stands = |(track, index): &(&Track, usize)| {
        track.velocity[*index].abs() < STANDING * stroke
            && side * (track.smooth_opening[*index] - null) > DRIVEN * largest
            && (track.displacement[*index] - end).abs() < NEAR * stroke
    };
    let mut places: Vec<f64> = all().filter(stands).map(|(track, index)| side * track.displacement[index]).collect();
    places.sort_by(f64::total_cmp);
    // The farthest place; a piston that stood before it was stopped by something else.
    let farthest = *places.get(places.len().checked_sub(1 + places.len() / 20)?)?;
    places.retain(|place| (place - farthest).abs() < SAME_PLACE * stroke);
    let interval = first.time.get(1)? - first.time.first()?;
    if places.len() < 10 || (places.len() as f64) * interval < LEAST_TIME * first.size.time() {
        return None;
    }
    let middle = places[places.len() / 2];
    // Neighbouring readings share the resolution of the sensor.
    let error = noise_level(&first.displacement).max(stroke * 1e-5);
    Some(Estimate { value: side * middle, error })
}
