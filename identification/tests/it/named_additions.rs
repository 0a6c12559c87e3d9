//! An effect that somebody names is judged like one that was found: a wrong one is told, and so is a half answer.

use crate::common::{off_the_data_sheet, steered, with};
use excavator_identification::decision::Kind;
use excavator_identification::diagnosis::DiagnosisSettings;
use excavator_identification::refinement::{Additions, Reason, Refinement, refine};
use excavator_identification::search::Addition;
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Site};
use excavator_model::recording::Recording;

struct Machine {
    identification: Recording,
    validation: Recording,
}

impl Machine {
    fn record(truth: &Model) -> Machine {
        Machine { identification: steered(truth, 2.9, 24.0, 1), validation: steered(truth, 3.4, 14.0, 2) }
    }

    fn refined(&self, names: &[&str]) -> Refinement {
        let model = built_in("zx30u-arm").unwrap();
        let added = names
            .iter()
            .map(|name| Addition { physics: Catalogue::built_in().find(name).unwrap(), site: Site::Cylinder(0) })
            .collect();
        let (identification, validation) = ([&self.identification], [&self.validation]);
        let settings = DiagnosisSettings::default();
        let additions = Additions::Named(added);
        refine(&model, &identification, &validation, &additions, &settings, "today", &|_, _| {}).unwrap()
    }
}

fn helps(refinement: &Refinement) -> bool {
    matches!(&refinement.reason, Reason::Named(named) if named.helps)
}

#[test]
fn where_nothing_is_missing_nothing_is_explained() {
    let machine = Machine::record(&off_the_data_sheet("zx30u-arm", 0.1));
    let superfluous = machine.refined(&["stribeck_friction"]);
    assert_eq!((superfluous.verdict(), helps(&superfluous)), (Kind::Adequate, false));
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    #[test]
    fn what_explains_nothing_is_told() {
        let arm = off_the_data_sheet("zx30u-arm", 0.1);
        let machine = Machine::record(&with(&arm, "valve_dead_zone", Site::Cylinder(0), &[4e-6, 4e-6]));
        let wrong = machine.refined(&["external_contact"]);
        assert_eq!((wrong.verdict(), helps(&wrong)), (Kind::Unexplained, false));
        let right = machine.refined(&["valve_dead_zone"]);
        assert_eq!(right.verdict(), Kind::MissingEffect);
    }

    #[test]
    fn one_of_two_is_half_an_answer() {
        let arm = off_the_data_sheet("zx30u-arm", 0.1);
        let dead_zone = with(&arm, "valve_dead_zone", Site::Cylinder(0), &[6e-6, 6e-6]);
        let machine = Machine::record(&with(&dead_zone, "asymmetric_friction", Site::Cylinder(0), &[400.0, 0.0]));
        let half = machine.refined(&["valve_dead_zone"]);
        assert_eq!((half.verdict(), helps(&half)), (Kind::Unexplained, true), "{:?}", half.reason);
        let both = machine.refined(&["valve_dead_zone", "asymmetric_friction"]);
        assert_eq!(both.verdict(), Kind::MissingEffect, "{:?}", both.reason);
    }
}
