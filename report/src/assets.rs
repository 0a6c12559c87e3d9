//! Embedded files of a page, so that it needs no network.

/// uPlot 1.6.32 (npm package `uplot`), unchanged. Its first comment, an address, is left out of pages.
const UPLOT_SCRIPT: &str = include_str!("assets/uPlot.iife.min.js");

/// Style sheet of uPlot.
pub(super) const UPLOT_STYLE: &str = include_str!("assets/uPlot.min.css");

/// Licence of uPlot (MIT), which every copy must include.
pub(super) const UPLOT_LICENCE: &str = include_str!("assets/uPlot.LICENSE");

/// Style sheet of the pages, with the colours of the light scheme.
pub(super) const PAGE_STYLE: &str = include_str!("assets/report.css");

/// Colours of the dark scheme.
pub(super) const DARK_STYLE: &str = include_str!("assets/dark.css");

/// Chooses the colour scheme before anything is drawn.
pub(super) const SCHEME_SCRIPT: &str = include_str!("assets/scheme.js");

/// Scripts that run after a page is loaded, in this order: plots over time, their keyboard control, the moving machine,
/// contents and printing.
pub(super) const PAGE_SCRIPTS: [&str; 5] = [
    include_str!("assets/plots.js"),
    include_str!("assets/keyboard.js"),
    KINEMATICS,
    include_str!("assets/moving_machine.js"),
    include_str!("assets/page.js"),
];

/// Reads a robot description (URDF) in a browser and places its links in the plane of the arm: `readRobot`,
/// `placeLinks`, `outline` and their helpers, as functions of a script.
pub const KINEMATICS: &str = include_str!("assets/kinematics.js");

/// The plotting library without its first comment.
pub(super) fn uplot_script() -> &'static str {
    match UPLOT_SCRIPT.split_once("*/") {
        Some((comment, script)) if comment.starts_with("/*!") => script,
        _ => UPLOT_SCRIPT,
    }
}

/// uPlot for pages of other crates: its script, its style sheet, and its licence, which must be included.
pub fn plotting() -> (&'static str, &'static str, &'static str) {
    (uplot_script(), UPLOT_STYLE, UPLOT_LICENCE)
}
