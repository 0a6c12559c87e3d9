//! Text as a catalogue of formula effects: read, added to a machine, evaluated, and through a model file and back.

use excavator_model::document::{built_in, parse, parse_catalogue, to_text};
use excavator_model::effects::Catalogue;
use excavator_model::equations::{Inputs, System};
use excavator_model::scalar::{Dual, constant};

use crate::samples;

/// Effects of one catalogue that are tried on a machine: each costs an evaluation.
const TRIED: usize = 4;

/// # Panics
/// When a formula changes on its way through a model file, or an evaluation does.
#[allow(clippy::panic)]
pub fn run(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let catalogue = match parse_catalogue("fuzzed", &text, &Catalogue::built_in()) {
        Ok(catalogue) => catalogue,
        Err(error) => {
            let line = error.to_string();
            assert!(!line.contains('\n') && line.len() < 2000, "{line}");
            return false;
        }
    };
    let Ok(mut model) = built_in("zx30u-arm") else { return false };
    model.catalogue.clone_from(&catalogue);
    for physics in catalogue.iter().filter(|physics| physics.formula().is_some()).take(TRIED) {
        for site in model.free_sites(physics) {
            if let Ok(with) = model.with_effect(physics, site) {
                model = with;
            }
        }
    }
    let system = System::new(&model);
    let mut state = vec![0.0; system.layout().len];
    system.set_effect_states(&[1e-5], &mut state);
    let state: Vec<Dual> = state.into_iter().map(constant).collect();
    let parameters: Vec<Dual> = model.parameter_values().into_iter().map(constant).collect();
    let mut rates = state.clone();
    system.rates(&mut system.workspace(), &parameters, &state, &Inputs::zero(1), &mut rates);
    let Ok(written) = to_text(&model) else { return false };
    match parse("again", &written, &Catalogue::built_in()) {
        Ok(again) if again.parameter_names() == model.parameter_names() => true,
        // A start below zero of what is known, or one that has to be above zero, is refused in a model.
        Err(excavator_model::document::DocumentError::Impossible { .. }) => true,
        other => panic!("{other:?} through\n{written}"),
    }
}

pub fn seeds() -> Vec<Vec<u8>> {
    vec![samples::bytes("model/tests/data/own-effects.toml")]
}
