//! Whether a valve is open far enough to move its piston.

/// Opening, as a share of the largest, that moves a piston. Near closed, overlap decides.
const OPEN: f64 = 0.2;

/// Largest magnitude of the opening, m²; zero if nothing is measured.
pub(super) fn largest(opening: &[f64]) -> f64 {
    opening.iter().filter(|area| area.is_finite()).fold(0.0, |most, area| most.max(area.abs()))
}

/// Whether a valve is open to one side throughout a stretch, relative to the `largest` opening of the recording.
pub(super) fn open_one_way(stretch: &[f64], largest: f64) -> bool {
    stretch.iter().all(|&area| area > OPEN * largest) || stretch.iter().all(|&area| area < -OPEN * largest)
}
