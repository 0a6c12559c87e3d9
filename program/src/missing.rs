//! Verbs that this build does not have.

use clap::error::{ContextKind, ContextValue, ErrorKind};

/// These verbs, and the feature that each needs.
const MISSING: &[(&str, &str)] = &[
    #[cfg(not(feature = "live"))]
    ("node", "live"),
    #[cfg(not(feature = "live"))]
    ("play", "live"),
    #[cfg(not(feature = "live"))]
    ("record", "live"),
    #[cfg(not(feature = "live"))]
    ("up", "live"),
    #[cfg(not(feature = "dashboard"))]
    ("dashboard", "dashboard"),
];

/// The error message if the command line names such a verb.
pub fn reason(refusal: &clap::Error) -> Option<String> {
    if refusal.kind() != ErrorKind::InvalidSubcommand {
        return None;
    }
    let Some(ContextValue::String(verb)) = refusal.get(ContextKind::InvalidSubcommand) else { return None };
    let (verb, feature) = MISSING.iter().find(|(name, _)| name == verb)?;
    Some(format!("`excavator {verb}` needs a build with the feature `{feature}`"))
}
