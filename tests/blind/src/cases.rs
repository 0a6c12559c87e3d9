//! Cases drawn from a seed.

use excavator_model::simulation::Profile;
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::manoeuvres::Manoeuvre;
use crate::plant::{Base, CATALOGUE, Effects, Extras, FOREIGN, Kind, Plant, Reversal, Shape};
use crate::strength::{Strength, compare, size};

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
    /// Two to five effects of the catalogue, each of which can be seen beside the others.
    Several,
    /// Two effects of the catalogue beside one that no catalogue has.
    Beside,
}

/// Kinds that are hidden alone: they need another manoeuvre, act for a while only, take a sensor away or are one.
const ALONE: [&str; 8] = [
    "valve_lag",
    "end_cushion",
    "payload",
    "picked_up_payload",
    "external_contact",
    "pressure_sensor_offset",
    "displacement_sensor_offset",
    "sensor_delay",
];

/// Share of the signals' change that each of several effects must cause beside the others.
const VISIBLE: f64 = 0.003;

/// Largest factor on the strength of each of several effects.
const LARGEST_FAULT: f64 = 4.0;

/// Draws of several effects until each can be seen.
const TRIES: usize = 20;

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
        let mut hidden = draw_hidden(&mut generator, number, sort, wish);
        let is_several = matches!(sort, Sort::Several | Sort::Beside);
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
        let mut sized = if is_several {
            Sized::faults(&hidden, &mut generator)
        } else {
            Sized::draw(&hidden, strength, &bare, &validation, begin[1], &mut generator)
        };
        for _ in 0..TRIES {
            if !is_several || sized.can_all_be_seen(&bare, &validation, begin[1]) {
                break;
            }
            hidden = draw_hidden(&mut generator, number, sort, wish);
            sized = Sized::faults(&hidden, &mut generator);
        }
        let plant = Plant { effects: sized.effects(None), ..bare };
        Case { number, sort, hidden, strength, plant, identification, validation, begin, generator }
    }

    /// The same machine, moved by a command profile from mid-stroke in both recordings. What is hidden was sized before.
    pub fn follow(&mut self, profile: &Profile) {
        self.identification = Manoeuvre::of_profile(profile.clone());
        self.validation = self.identification.clone();
        self.begin = [0.0; 2];
    }

    /// What an answer should name: of an effect outside the catalogue only that something is left, if others are hidden too.
    pub fn nameable(&self) -> impl Iterator<Item = &'static Kind> + '_ {
        let is_foreign = |kind: &Kind| FOREIGN.iter().any(|other| other.name == kind.name);
        self.hidden.iter().copied().filter(move |kind| self.sort != Sort::Beside || !is_foreign(kind))
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

/// Effects with their individual forms and the factors on their strength.
struct Sized(Vec<(&'static Kind, Shape, f64)>);

impl Sized {
    /// Each of the size at which it alone changes the manoeuvre as much as `strength` says.
    fn draw(
        hidden: &[&'static Kind],
        strength: Strength,
        bare: &Plant,
        manoeuvre: &Manoeuvre,
        begin: f64,
        generator: &mut ChaCha8Rng,
    ) -> Self {
        let (least, most) = strength.band();
        let drawn: Vec<(&'static Kind, Shape, f64)> = hidden
            .iter()
            .map(|&kind| {
                let shape: Shape = [0, 1, 2, 3].map(|_| generator.random::<f64>());
                (kind, shape, least * (most / least).powf(generator.random::<f64>()))
            })
            .collect();
        let sized = drawn.into_iter().map(|(kind, shape, target)| {
            let alone = |factor: f64| Plant { effects: Sized(vec![(kind, shape, factor)]).effects(None), ..*bare };
            (kind, shape, size(target, kind.limit, manoeuvre, begin, &alone))
        });
        Sized(sized.collect())
    }

    /// Each from a middling fault up to four times that, whatever it changes.
    fn faults(hidden: &[&'static Kind], generator: &mut ChaCha8Rng) -> Self {
        let fault = |&kind: &&'static Kind| {
            let shape: Shape = [0, 1, 2, 3].map(|_| generator.random::<f64>());
            (kind, shape, kind.limit.min(LARGEST_FAULT).powf(generator.random::<f64>()))
        };
        Sized(hidden.iter().map(fault).collect())
    }

    /// All of them, or all but one.
    fn effects(&self, without: Option<usize>) -> Effects {
        let mut effects = Effects::default();
        for (number, (kind, shape, factor)) in self.0.iter().enumerate() {
            if without != Some(number) {
                (kind.set)(&mut effects, shape, *factor);
            }
        }
        effects
    }

    /// Whether each changes the manoeuvre beside the others. Of two that act in the same place the larger may hide the smaller.
    fn can_all_be_seen(&self, bare: &Plant, manoeuvre: &Manoeuvre, begin: f64) -> bool {
        let all = Plant { effects: self.effects(None), ..*bare };
        (0..self.0.len()).into_par_iter().all(|number| {
            let less = Plant { effects: self.effects(Some(number)), ..*bare };
            compare(&all, &less, manoeuvre, begin).is_ok_and(|change| change.share() >= VISIBLE)
        })
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
        Sort::Several | Sort::Beside => {
            let fit = |kind: &&'static Kind| !ALONE.contains(&kind.name);
            let several: Vec<&'static Kind> = any.iter().copied().filter(fit).collect();
            let count = if sort == Sort::Beside { 2 } else { 2 + number as usize % 4 };
            let stranger = (sort == Sort::Beside).then(|| foreign.choose(generator).copied()).flatten();
            several.sample(generator, count).copied().chain(stranger).collect()
        }
        Sort::Pair => {
            // A payload cannot be seen, so it would make no pair.
            let fit = |kind: &&'static Kind| kind.identifiable && first.is_none_or(|first| first.name != kind.name);
            let others: Vec<&'static Kind> = any.iter().copied().filter(fit).collect();
            let first = first.filter(|kind| kind.identifiable).or_else(|| CATALOGUE.first());
            first.into_iter().chain(others.choose(generator).copied()).collect()
        }
    }
}
