//! Cases drawn from a seed.

use excavator_model::simulation::Profile;
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use crate::manoeuvres::Manoeuvre;
use crate::plant::{Base, CATALOGUE, Effects, Extras, FOREIGN, Kind, Plant, Reversal, Shape};
use crate::strength::{Strength, size};

/// What sort of secret a case has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Sort {
    /// Nothing is hidden.
    Nothing,
    /// One effect of the catalogue.
    Single,
    /// Two effects of the catalogue.
    Pair,
    /// One effect that no catalogue has.
    Unknown,
}

/// Which cases are wanted; `None` or empty = drawn.
#[derive(Debug, Clone, Default)]
pub struct Wish {
    /// Sort of secret.
    pub sort: Option<Sort>,
    /// Effects to go round through, case after case.
    pub effects: Vec<&'static Kind>,
    /// Strength.
    pub strength: Option<Strength>,
    /// Leave out the small unmodelled extras, to see what they cost.
    pub without_extras: bool,
}

/// A machine with a secret, and what is done with it.
#[derive(Debug, Clone)]
pub struct Case {
    /// Number within its seed; seed and number give the case again.
    pub number: u64,
    /// Sort of secret.
    pub sort: Sort,
    /// What is hidden.
    pub hidden: Vec<&'static Kind>,
    /// How strong.
    pub strength: Strength,
    /// The machine.
    pub plant: Plant,
    /// Manoeuvre for identification.
    pub identification: Manoeuvre,
    /// Manoeuvre for validation.
    pub validation: Manoeuvre,
    /// Where identification and validation begin, m.
    pub begin: [f64; 2],
    /// For the instruments; drawn on after the case.
    pub generator: ChaCha8Rng,
}

impl Case {
    /// Draws case `number` of a seed.
    pub fn draw(seed: u64, number: u64, wish: &Wish) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(number);
        let sort = draw_sort(&mut generator, number, wish);
        let hidden = draw_hidden(&mut generator, number, sort, wish);
        let drawn = *Strength::ALL.choose(&mut generator).unwrap_or(&Strength::Medium);
        let strength = wish.strength.unwrap_or(drawn);
        // A cushion is only met by an operator who works near an end of the stroke.
        let near_end = hidden.iter().any(|kind| kind.name == "end_cushion");
        // At the retracted end, where gravity does not pull the arm away from it.
        let (centre, middle) = if near_end { (-0.29, -0.25) } else { (0.0, 0.0) };
        let begin = [0, 1].map(|_| middle + generator.random_range(-0.03..0.03));
        let base = Base::draw(&mut generator);
        let bare = Plant {
            base,
            effects: Effects::default(),
            extras: if wish.without_extras { Extras::none() } else { extras_of(seed, number) },
            blind_spool: hidden.iter().any(|kind| kind.name == "valve_lag"),
            duration: 0.0,
            boom_holding_torque: 0.0,
        };
        let hold = |manoeuvre: Manoeuvre| if near_end { manoeuvre.firmer() } else { manoeuvre };
        let (identification, validation) =
            (hold(Manoeuvre::identification(centre)), hold(Manoeuvre::validation(centre)));
        let mut effects = Effects::default();
        for kind in &hidden {
            let shape: Shape = [0, 1, 2, 3].map(|_| generator.random::<f64>());
            let (least, most) = strength.band();
            let target = least * (most / least).powf(generator.random::<f64>());
            let alone = |factor: f64| {
                let mut effects = Effects::default();
                (kind.set)(&mut effects, &shape, factor);
                Plant { effects, ..bare }
            };
            let factor = size(target, kind.limit, &validation, begin[1], &alone);
            (kind.set)(&mut effects, &shape, factor);
        }
        let plant = Plant { effects, ..bare };
        Case { number, sort, hidden, strength, plant, identification, validation, begin, generator }
    }

    /// The same machine, moved by a command profile from mid-stroke in both recordings. What is hidden was sized before.
    pub fn follow(&mut self, profile: &Profile) {
        self.identification = Manoeuvre::of_profile(profile.clone());
        self.validation = self.identification.clone();
        self.begin = [0.0; 2];
    }

    /// Names of what is hidden, joined by "+".
    pub fn secret(&self) -> String {
        if self.hidden.is_empty() {
            return "nothing".to_string();
        }
        self.hidden.iter().map(|kind| kind.name).collect::<Vec<_>>().join("+")
    }

    /// True parameters of what is hidden.
    pub fn truth(&self) -> Vec<(&'static str, f64)> {
        let all = self.hidden.iter().flat_map(|kind| (kind.truth)(&self.plant.effects));
        all.filter(|(_, value)| *value != 0.0).collect()
    }
}

/// The usual extras, with a friction that turns round as that of no other machine. From numbers of its own: the rest of a case is
/// the same with and without.
fn extras_of(seed: u64, number: u64) -> Extras {
    let mut generator = ChaCha8Rng::seed_from_u64(!seed);
    generator.set_stream(number);
    Extras { reversal: Reversal::draw(&mut generator), ..Extras::usual() }
}

/// Half of the cases hide one effect, the rest is shared evenly; one sort where the wish says so.
fn draw_sort(generator: &mut ChaCha8Rng, number: u64, wish: &Wish) -> Sort {
    let sorts = [Sort::Single, Sort::Single, Sort::Single, Sort::Nothing, Sort::Pair, Sort::Unknown];
    let drawn = *sorts.choose(generator).unwrap_or(&Sort::Single);
    let named = wish.effects.get(number as usize % wish.effects.len().max(1));
    match (wish.sort, named) {
        (Some(sort), _) => sort,
        (None, Some(kind)) if FOREIGN.iter().any(|foreign| foreign.name == kind.name) => Sort::Unknown,
        (None, Some(_)) => Sort::Single,
        (None, None) => drawn,
    }
}

fn draw_hidden(generator: &mut ChaCha8Rng, number: u64, sort: Sort, wish: &Wish) -> Vec<&'static Kind> {
    let named = wish.effects.get(number as usize % wish.effects.len().max(1)).copied();
    let any: Vec<&'static Kind> = CATALOGUE.iter().collect();
    let foreign: Vec<&'static Kind> = FOREIGN.iter().collect();
    let first = named.or_else(|| any.choose(generator).copied());
    match sort {
        Sort::Nothing => Vec::new(),
        Sort::Single => first.into_iter().collect(),
        Sort::Unknown => named.or_else(|| foreign.choose(generator).copied()).into_iter().collect(),
        Sort::Pair => {
            // A payload cannot be seen, so it would make no pair.
            let fit = |kind: &&'static Kind| kind.identifiable && first.is_none_or(|first| first.name != kind.name);
            let others: Vec<&'static Kind> = any.iter().copied().filter(fit).collect();
            let first = first.filter(|kind| kind.identifiable).or_else(|| CATALOGUE.first());
            first.into_iter().chain(others.choose(generator).copied()).collect()
        }
    }
}
