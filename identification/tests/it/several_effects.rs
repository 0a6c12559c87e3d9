//! Several effects are missing at once.

use excavator_identification::decision::Kind;
use excavator_identification::prelude::*;
use excavator_model::document::built_in;
use excavator_model::effects::Site;

use crate::common::{off_the_data_sheet, steered, with};

#[test]
fn three_effects_of_the_flows_are_found_together() {
    let machine = off_the_data_sheet("zx30u-arm", 0.1);
    let machine = with(&machine, "valve_dead_zone", Site::Cylinder(0), &[1.8e-5, 1.1e-5]);
    let machine = with(&machine, "pump_leakage", Site::PumpLine, &[1.4e-10]);
    let machine = with(&machine, "entrained_air", Site::Cylinder(0), &[0.025]);
    let identification = steered(&machine, 1.3, 24.0, 1);
    let validation = steered(&machine, 1.9, 12.0, 2);
    let model = built_in("zx30u-arm").unwrap();
    let settings = DiagnosisSettings::default();
    let found = diagnose(&model, &[&identification], &[&validation], &settings, &|_, _| {}).unwrap();
    let best = &found.trials[found.verdict.best];
    assert_eq!(best.key(), ["entrained_air@arm", "pump_leakage@pump", "valve_dead_zone@arm"]);
    assert_eq!(found.verdict.kind, Kind::MissingEffect, "{:?}", found.verdict.reasons);
    for (name, truth) in [
        ("arm.dead_zone_positive", 1.8e-5),
        ("arm.dead_zone_negative", 1.1e-5),
        ("pump.pump_leakage", 1.4e-10),
        ("arm.air_fraction", 0.025),
    ] {
        let names = best.fit.model.parameter_names();
        let index = names.iter().position(|own| own == name).unwrap();
        let value = best.fit.model.parameter_values()[index];
        assert!((value / truth - 1.0).abs() < 0.05, "{name}: {value} for {truth}");
    }
}
