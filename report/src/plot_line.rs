//! How the lines of measurements and models look in every plot over time.

/// Style of one model's line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Label in the legend.
    pub label: &'static str,
    /// CSS colour.
    pub colour: &'static str,
    /// Dashed, so that lines differ without colour.
    pub dashed: bool,
}

/// The only or the final model.
pub(super) const MODEL: Line = Line { label: "model", colour: "var(--blue)", dashed: false };
/// The model before effects were added.
pub(super) const BEFORE: Line = Line { label: "before", colour: "var(--orange)", dashed: true };
/// The model with all effects.
pub(super) const AFTER: Line = Line { label: "after", colour: "var(--blue)", dashed: false };
/// A second model beside the first.
pub(super) const OTHER_MODEL: Line = Line { label: "other model", colour: "var(--orange)", dashed: true };
/// A second run of the machine.
pub(super) const SECOND_RUN: Line = Line { label: "second run", colour: "var(--purple)", dashed: true };
/// The measurement.
pub(super) const MEASURED: Line = Line { label: "measured", colour: "var(--measured)", dashed: false };
