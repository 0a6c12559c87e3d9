//! The page, with everything in it.

use excavator_identification::report::plotting;

const FRAME: &str = include_str!("assets/dashboard.html");
const STYLE: &str = include_str!("assets/dashboard.css");
const SCRIPT: &str = include_str!("assets/dashboard.js");

/// The whole page; it asks for nothing but its own stream.
pub(super) fn page() -> String {
    let (script, style, licence) = plotting();
    FRAME
        .replace("/*STYLE*/", &format!("{style}\n{STYLE}"))
        .replace("/*LICENCE*/", &format!("/*\n{}*/", licence.replace("*/", "")))
        .replace("/*UPLOT*/", script)
        .replace("/*SCRIPT*/", SCRIPT)
}
