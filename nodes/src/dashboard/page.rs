//! The page, with all scripts and styles inlined.

use excavator_report::{KINEMATICS, plotting};

const FRAME: &str = include_str!("assets/dashboard.html");
const STYLE: &str = include_str!("assets/dashboard.css");
/// The scripts in the order of their dependencies.
const SCRIPTS: [&str; 9] = [
    include_str!("assets/basics.js"),
    KINEMATICS,
    include_str!("assets/picture.js"),
    include_str!("assets/values.js"),
    include_str!("assets/commands.js"),
    include_str!("assets/energy.js"),
    include_str!("assets/alarms.js"),
    include_str!("assets/plots.js"),
    include_str!("assets/dashboard.js"),
];

/// The whole page. It requests nothing except its own data.
pub(super) fn page() -> String {
    let (script, style, licence) = plotting();
    FRAME
        .replace("/*STYLE*/", &format!("{style}\n{STYLE}"))
        .replace("/*LICENCE*/", &format!("/*\n{}*/", licence.replace("*/", "")))
        .replace("/*UPLOT*/", script)
        .replace("/*SCRIPT*/", &SCRIPTS.join("\n"))
}
