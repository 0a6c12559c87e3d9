//! A contact that comes at another time in each recording, and an effect that is there all the time: both are named.

use crate::common::{off_the_data_sheet, steered, with};
use excavator_identification::decision::Kind;
use excavator_identification::diagnosis::{DiagnosisSettings, diagnose};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::Site;
use excavator_model::recording::Recording;

const ARM: Site = Site::Cylinder(0);

/// The arm with a loss in its hoses, and something that leans on it for three seconds from `begin` s on.
fn machine(begin: f64) -> Model {
    let lossy = with(&off_the_data_sheet("zx30u-arm", 0.1), "hose_loss", ARM, &[8e5]);
    with(&lossy, "external_contact", ARM, &[begin, 3.0, -280.0])
}

fn recorded(begin: f64, tempo: f64, duration: f64) -> Recording {
    steered(&machine(begin), tempo, duration, begin as u64)
}

#[test]
#[ignore = "half a minute; tests/run --long"]
fn both_are_named() {
    let (identification, validation) = (recorded(14.0, 2.9, 24.0), recorded(4.0, 3.4, 14.0));
    let model = built_in("zx30u-arm").unwrap();
    let settings = DiagnosisSettings::default();
    let found = diagnose(&model, &[&identification], &[&validation], &settings, &|_, _| {}).unwrap();
    let mut names: Vec<&str> = found.selected().iter().map(|one| one.name()).collect();
    names.sort_unstable();
    assert_eq!((found.verdict.kind, &names[..]), (Kind::MissingEffect, &["external_contact", "hose_loss"][..]));
    let left = found.best().validation.loss();
    assert!(left < 0.5, "{left}");
}
