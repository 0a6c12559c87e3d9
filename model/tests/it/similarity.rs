//! A machine of another size that works with the same pressures and speeds does the same, slower or faster in proportion.

use crate::common;
use crate::common::scaled::{scaled, size_of};
use excavator_model::document::built_in;
use excavator_model::effects::{AnyEffect, Catalogue, Family, Growth, Site};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use excavator_model::{Model, ModelEffect};

/// Ratios of lengths and of the unit of openings. Powers of two, as [`Size`] has them, so that the numbers of the cards are in exact
/// proportion too.
const SCALES: [(f64, f64); 3] = [(0.125, 1.0), (4.0, 1.0), (1.0, 1024.0)];

/// The model with an effect of its usual size for this machine; where it acts in a window of time, from the third second on. Times of
/// a recorder are no property of a machine: they are scaled by hand.
fn with_usual(model: &Model, effect: &AnyEffect, site: Site, length: f64) -> Model {
    let mut with = model.clone();
    let mut added = ModelEffect::new(effect, &model.machine, site).unwrap();
    for parameter in &mut added.parameters {
        let of_the_recorder = parameter.card.unit == "s" && parameter.card.growth == Growth::NONE;
        parameter.value = match &parameter.card {
            card if card.start.is_a_time() => 3.0 * length,
            card if of_the_recorder => card.typical * length,
            card => card.typical,
        };
    }
    with.effects.push(added);
    with
}

fn drive(model: &Model, scale: (f64, f64)) -> Recording {
    let (length, opening) = (scale.0, size_of(scale).opening);
    let area = |_: usize, time: f64| {
        let t = time / length;
        opening * (6e-5 * (2.0 * t).sin() + 4e-5 * (5.3 * t).sin())
    };
    let mut recording = common::driven(model, 8.0 * length, 2e-3 * length, area, |_| 0.0);
    recording.pump_pressure.fill(f64::NAN);
    recording
}

#[test]
fn every_effect_is_the_same_on_machines_of_every_size() {
    let reference = built_in("zx30u-arm").unwrap();
    let catalogue = Catalogue::built_in();
    let candidates = catalogue.iter().filter(|effect| effect.card().family != Family::Construction);
    let mut compared = 0;
    for effect in candidates {
        for site in reference.free_sites(effect) {
            let run = |scale: (f64, f64)| {
                let model = with_usual(&scaled(&reference, scale), effect, site, scale.0);
                assert_eq!(model.machine.size(), size_of(scale));
                let rest = [0.05 * scale.0];
                simulate_from_rest(&model, &drive(&model, scale), &rest, Tolerances::default().scaled(0.05)).unwrap()
            };
            let known = run((1.0, 1.0));
            for scale in SCALES {
                let other = run(scale);
                for (signal, factor) in [
                    ("arm.displacement", scale.0),
                    ("arm.velocity", 1.0),
                    ("arm.cap_pressure", 1.0),
                    ("arm.rod_pressure", 1.0),
                    ("pump_pressure", 1.0),
                ] {
                    let (one, two) = (known.signal(signal).unwrap(), other.signal(signal).unwrap());
                    let largest = one.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
                    let off = one.iter().zip(two).fold(0.0_f64, |most, (a, b)| most.max((a - b / factor).abs()));
                    let name = &effect.card().name;
                    assert!(off <= 1e-6 * largest, "{name} at {site:?}, {scale:?}: {signal} {off:e} of {largest:e}");
                }
                compared += 1;
            }
        }
    }
    println!("{compared} simulations in proportion");
    assert!(compared >= 90, "{compared}");
}

#[test]
fn limits_and_starts_are_in_proportion() {
    let reference = built_in("zx30u-arm").unwrap();
    let scale = (0.125, 1024.0);
    let (small, size) = (scaled(&reference, scale), size_of(scale));
    for effect in Catalogue::built_in().iter() {
        for site in reference.free_sites(effect) {
            let [one, other] =
                [&reference, &small].map(|model| ModelEffect::new(effect, &model.machine, site).unwrap().parameters);
            for (one, other) in one.iter().zip(&other) {
                let factor = size.factor(one.card.growth);
                let name = &one.card.name;
                assert_eq!(other.card.minimum, factor * one.card.minimum, "{name}");
                assert_eq!(other.card.maximum, factor * one.card.maximum, "{name}");
                assert_eq!(other.value, factor * one.value, "{name}");
            }
        }
    }
}
