//! A hook that an effect does not announce would never be called.

use std::sync::Arc;

use excavator_model::document::built_in;
use excavator_model::effects::{
    ActsOn, AnyEffect, Card, Catalogue, Family, Growth, Kind, Needs, ParameterCard, Physics, Site, Start, text,
    unannounced,
};
use excavator_model::equations::{Rows, Situation};
use excavator_model::machine::Machine;
use excavator_model::scalar::Scalar;
use excavator_model::{Model, ModelError};

static CARD: Card = Card {
    name: text("forgetful"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text("An effect whose author forgot something."),
    equation: text("opening k u"),
    source: text("test"),
    shows: text("Nothing."),
    experiment: text("None."),
    energy: text("None."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("share"),
    symbol: text("k"),
    unit: text("-"),
    meaning: text("share of the opening"),
    kind: Kind::Linear,
    growth: Growth::NONE,
    minimum: 0.0,
    maximum: 1.0,
    typical: 0.5,
    start: Start::at(&[0.5]),
    prior: None,
}];

/// What the effect does.
#[derive(Clone, Copy)]
enum Does {
    Opens,
    Adjusts,
    Reads,
    Remembers,
    Pushes,
}

struct Forgetful {
    does: Does,
    announces: bool,
}

impl Physics for Forgetful {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn adjusts_others(&self) -> bool {
        self.announces && matches!(self.does, Does::Opens | Does::Adjusts)
    }

    fn reads_input_rate(&self) -> bool {
        self.announces && matches!(self.does, Does::Reads)
    }

    fn states(&self) -> usize {
        usize::from(matches!(self.does, Does::Remembers))
    }

    fn has_memory(&self) -> bool {
        self.announces && matches!(self.does, Does::Remembers)
    }

    fn opening<T: Scalar>(&self, _site: Site, parameters: &[T], opening: T, _now: &Situation<T>) -> T {
        if matches!(self.does, Does::Opens) { opening * parameters[0] } else { opening }
    }

    fn adjust<T: Scalar>(&self, site: Site, parameters: &[T], now: &mut Situation<T>) {
        if let (Does::Adjusts, Site::Cylinder(index)) = (self.does, site) {
            now.pistons[index].backflow *= parameters[0];
        }
    }

    fn read<T: Scalar>(&self, parameters: &[T], reading: T, rates: [T; 2]) -> T {
        if matches!(self.does, Does::Reads) { reading + parameters[0] * rates[0] } else { reading }
    }

    fn remember<T: Scalar>(&self, site: Site, p: &[T], states: &[T], now: &Situation<T>, rates: &mut [T]) {
        if let (Does::Remembers, Site::Cylinder(index)) = (self.does, site) {
            rates[0] = p[0] * now.pistons[index].velocity - states[0];
        }
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        if let (Does::Pushes, Site::Cylinder(index)) = (self.does, site) {
            rows.piston_force[index] -= parameters[0] * now.pistons[index].velocity;
        }
    }
}

fn added(does: Does, announces: bool) -> Result<Model, ModelError> {
    let effect: AnyEffect = Arc::new(Forgetful { does, announces });
    built_in("zx30u-arm").unwrap().with_effect(&effect, Site::Cylinder(0))
}

#[test]
fn an_effect_that_forgot_to_announce_a_hook_is_refused() {
    let hooks = [
        (Does::Opens, "`opening`", "`adjusts_others`"),
        (Does::Adjusts, "`adjust`", "`adjusts_others`"),
        (Does::Reads, "`read`", "`reads_input_rate`"),
        (Does::Remembers, "`remember`", "`has_memory`"),
    ];
    for (does, hook, method) in hooks {
        let refusal = added(does, false).unwrap_err().to_string();
        assert!(refusal.contains(hook) && refusal.contains(method), "{refusal}");
        assert!(added(does, true).is_ok(), "{hook}");
    }
    assert!(added(Does::Pushes, false).is_ok(), "a contribution needs no announcement");
}

#[test]
fn every_built_in_effect_announces_its_hooks() {
    let mut asked = 0;
    for name in ["zx30u-arm", "zx30u", "servo-bench", "emps"] {
        let model = built_in(name).unwrap();
        for physics in &Catalogue::built_in() {
            for site in model.free_sites(physics) {
                let typical: Vec<f64> =
                    physics.parameters(&model.machine, site).iter().map(|card| card.typical).collect();
                assert_eq!(unannounced(&**physics, &model.machine, site, &typical), None, "{physics:?} of {name}");
                asked += 1;
            }
        }
    }
    assert!(asked > 100, "{asked}");
}
