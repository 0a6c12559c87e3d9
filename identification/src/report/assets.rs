//! What a page carries along so that it needs no network.

/// uPlot 1.6.32 (npm package `uplot`), unchanged. Its first comment, an address, is left out of pages.
const UPLOT_SCRIPT: &str = include_str!("assets/uPlot.iife.min.js");

/// Style sheet of uPlot.
pub(super) const UPLOT_STYLE: &str = include_str!("assets/uPlot.min.css");

/// Licence of uPlot (MIT), which asks to go with every copy.
pub(super) const UPLOT_LICENCE: &str = include_str!("assets/uPlot.LICENSE");

/// Style sheet of the pages.
pub(super) const PAGE_STYLE: &str = include_str!("assets/report.css");

/// Draws the plots over time.
pub(super) const PAGE_SCRIPT: &str = include_str!("assets/report.js");

/// The plotting library without its first comment.
pub(super) fn uplot_script() -> &'static str {
    match UPLOT_SCRIPT.split_once("*/") {
        Some((comment, script)) if comment.starts_with("/*!") => script,
        _ => UPLOT_SCRIPT,
    }
}

/// uPlot for pages of others: its script, its style sheet, and its licence, which has to go with them.
pub fn plotting() -> (&'static str, &'static str, &'static str) {
    (uplot_script(), UPLOT_STYLE, UPLOT_LICENCE)
}
