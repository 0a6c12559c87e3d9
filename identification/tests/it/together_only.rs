//! Parameters that the equations have together only.

use crate::common::swing;
use excavator_identification::regression::{RegressionError, WeakFormSettings, weak_form};
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Site};

#[test]
fn a_payload_is_held_and_the_rest_is_identified() {
    let plain = built_in("zx30u-arm").unwrap();
    let recording = swing(&plain);
    let mut model = plain.with_effect(&Catalogue::built_in().find("payload").unwrap(), Site::Cylinder(0)).unwrap();
    model.effects.last_mut().unwrap().parameters[0].value = 0.0;

    let found = weak_form(&model, &[&recording], &WeakFormSettings::default()).unwrap();
    let names = model.parameter_names();
    let held: Vec<(&str, &str)> =
        found.not_identified.iter().map(|(index, reason)| (names[*index].as_str(), reason.as_str())).collect();
    assert!(held.iter().any(|(name, why)| *name == "arm.payload_mass" && why.contains("together with")), "{held:?}");
    assert!(held.iter().all(|(name, _)| name.contains("payload")), "{held:?}");
    for ((name, value), truth) in names.iter().zip(found.model.parameter_values()).zip(plain.parameter_values()) {
        assert!((value / truth - 1.0).abs() < 0.02, "{name}: {value} for {truth}");
    }

    // A search that wants no parameter held is told which cannot be told apart.
    let strict = WeakFormSettings { hold_at_bounds: false, ..WeakFormSettings::default() };
    let refused = weak_form(&model, &[&recording], &strict);
    assert!(matches!(&refused, Err(RegressionError::NotIdentifiable { names, .. }) if names.len() > 1), "{refused:?}");
}
