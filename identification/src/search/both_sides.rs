//! Whether recordings show both sides of an effect that acts only beyond a threshold or in a window of time.

use excavator_model::ModelEffect;
use excavator_model::effects::Start;
use excavator_model::recording::Recording;

use super::starts::pump_pressure;

/// Quantile of the pump pressure. The recordings do not show both sides of a threshold below it: a relief valve that is
/// open three quarters of the time cannot be distinguished from a leak of the pump.
const VISITED: f64 = 0.25;

/// Largest share of the recordings that a window may fill: of 40 s, 2 s are outside.
const MOST_OF_THE_TIME: f64 = 0.95;

/// Whether the recordings show both sides of the point where the effect begins to act. A relief valve that is always
/// open is equivalent to a leak of the pump, and a contact that never ends to a constant force.
pub(super) fn is_seen_from_both_sides(effect: &ModelEffect, recordings: &[&Recording]) -> bool {
    let mut thresholds =
        effect.parameters.iter().filter(|parameter| matches!(parameter.card.start, Start::PumpPressureQuantiles(_)));
    let lowest = pump_pressure(recordings, VISITED);
    let is_visited = lowest.is_nan() || thresholds.all(|threshold| threshold.value > lowest);
    is_visited && share_inside(effect, recordings).is_none_or(|share| share <= MOST_OF_THE_TIME)
}

/// Share of the recorded time inside the effect's window. Returns `None` for an effect that has no window or acts
/// always.
fn share_inside(effect: &ModelEffect, recordings: &[&Recording]) -> Option<f64> {
    if effect.acts_always() {
        return None;
    }
    let (begin, duration) = effect.window().map(|(begin, duration)| (begin.value, duration.value))?;
    let end = begin + duration;
    let inside: f64 =
        recordings.iter().map(|recording| (end.min(recording.duration()) - begin.max(0.0)).max(0.0)).sum();
    let all: f64 = recordings.iter().map(|recording| recording.duration()).sum();
    Some(inside / all)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::Model;
    use excavator_model::document::built_in;
    use excavator_model::effects::{Catalogue, Site};

    use super::*;

    fn with(effect: &str, values: &[f64]) -> Model {
        let effect = Catalogue::built_in().find(effect).unwrap();
        let site = if effect.card().name == "relief_valve" { Site::PumpLine } else { Site::Cylinder(0) };
        let mut model = built_in("zx30u-arm").unwrap().with_effect(&effect, site).unwrap();
        for (parameter, value) in model.effects.last_mut().unwrap().parameters.iter_mut().zip(values) {
            parameter.value = *value;
        }
        model
    }

    fn both_sides(model: &Model, recordings: &[&Recording]) -> bool {
        is_seen_from_both_sides(model.effects.last().unwrap(), recordings)
    }

    /// 20 s with a pump pressure from 50 to 150 bar.
    fn recording() -> Recording {
        let time: Vec<f64> = (0..201).map(|index| f64::from(index) * 0.1).collect();
        let mut recording = Recording::unmeasured("bag", time, &["arm"]);
        recording.pump_pressure = recording.time.iter().map(|t| 5e6 + 5e5 * t).collect();
        recording
    }

    #[test]
    fn a_contact_has_to_begin_or_end() {
        let recording = recording();
        let seen = |begin, duration| {
            both_sides(&with("external_contact", &[begin, duration, 100.0]), &[&recording, &recording])
        };
        assert!(seen(5.0, 4.0));
        assert!(seen(12.0, 100.0), "it begins");
        assert!(seen(2.0, 100.0));
        assert!(!seen(0.2, 25.0));
        assert!(!seen(-1.0, 20.5));
    }

    #[test]
    fn a_load_may_be_there_always() {
        let recording = recording();
        let always = with("payload", &[50.0, 2.0]);
        assert!(both_sides(&always, &[&recording]));
        assert!(both_sides(&with("payload", &[50.0, 2.0, 7.0, 1e9]), &[&recording]));
        assert!(!both_sides(&with("payload", &[50.0, 2.0, 0.2, 1e9]), &[&recording]), "is there always");
    }

    #[test]
    fn a_relief_valve_has_to_have_been_closed() {
        let recording = recording();
        let relief = |pressure: f64| {
            let mut model = with("relief_valve", &[]);
            for parameter in &mut model.effects.last_mut().unwrap().parameters {
                if matches!(parameter.card.start, Start::PumpPressureQuantiles(_)) {
                    parameter.value = pressure;
                }
            }
            both_sides(&model, &[&recording])
        };
        assert!(relief(1.2e7));
        assert!(!relief(4e6));
        let unmeasured = Recording::unmeasured("bag", recording.time.clone(), &["arm"]);
        assert!(both_sides(&with("relief_valve", &[]), &[&unmeasured]), "nothing is known against it");
    }
}
