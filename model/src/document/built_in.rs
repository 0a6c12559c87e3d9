//! Models that come with the program.

use super::{DocumentError, parse};
use crate::Model;
use crate::effects::{Catalogue, nearest};

/// Names and texts of the built-in models.
pub static BUILT_IN: &[(&str, &str)] = &[
    ("zx30u-arm", include_str!("machines/zx30u-arm.toml")),
    ("zx30u", include_str!("machines/zx30u.toml")),
    ("zx30u-bucket", include_str!("machines/zx30u-bucket.toml")),
    ("zx30u-excavator", include_str!("machines/zx30u-excavator.toml")),
    ("servo-bench", include_str!("machines/servo-bench.toml")),
    ("emps", include_str!("machines/emps.toml")),
];

/// The built-in model of this name.
///
/// ```
/// use excavator_model::prelude::*;
///
/// let model = built_in("zx30u-arm")?;
/// assert_eq!(model.machine.cylinders[0].stroke, 0.6); // m
/// assert_eq!(model.value_of("arm.coulomb_friction"), Some(160.0)); // N
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`DocumentError::Unknown`] with the nearest name.
pub fn built_in(name: &str) -> Result<Model, DocumentError> {
    let Some((_, text)) = BUILT_IN.iter().find(|(candidate, _)| *candidate == name) else {
        let suggestion = nearest(name, BUILT_IN.iter().map(|(candidate, _)| *candidate));
        return Err(DocumentError::Unknown {
            name: name.to_string(),
            suggestion: suggestion.map_or(String::new(), |near| format!(" (did you mean \"{near}\"?)")),
        });
    };
    parse(name, text, &Catalogue::built_in())
}
