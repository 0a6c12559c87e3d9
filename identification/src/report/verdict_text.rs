//! The verdict in plain sentences.

use excavator_model::effects::Family;
use excavator_model::{Model, site_name};

use super::numbers::{percent, ratio, significant};
use super::plausibility_text::implausible_sentence;
use super::words;
use crate::diagnosis::{Adequacy, Candidate, Diagnosis, Verdict};
use crate::fit::Fit;
use crate::fitted_along::still_shows;

/// What a diagnosis found, in one or two plain sentences. Effects that the recordings cannot tell apart are all named.
pub fn verdict_sentence(model: &Model, diagnosis: &Diagnosis) -> String {
    let machine = &model.machine.name;
    let verdict = match diagnosis.verdict {
        Verdict::Adequate => format!(
            "Nothing is missing in {machine} that these recordings can show: what is left of the error is {}.",
            match diagnosis.adequacy {
                Some(Adequacy::SmallError) => "about a hundredth of each signal's own size, too small to act on",
                Some(Adequacy::Inputs) =>
                    "no more than the readings of the inputs leave open, by their noise and by what happens between samples",
                Some(Adequacy::Noise) if is_off_in_moments(&diagnosis.nominal_validation) =>
                    "the noise of the sensors, but for a few moments in which the model is off; record more of these to learn what \
                     happens then",
                Some(Adequacy::Noise) | None => "the noise of the sensors",
            }
        ),
        Verdict::MissingEffect => missing(machine, diagnosis),
        Verdict::Unexplained => unexplained(machine, diagnosis),
    };
    let verdict = if diagnosis.too_coarse && diagnosis.verdict != Verdict::Adequate {
        format!(
            "{verdict} Beware: the readings of the inputs leave as much open; record command and opening faster, or with less noise, \
             before acting on this."
        )
    } else {
        verdict
    };
    let last = diagnosis.chain.last().map_or(&diagnosis.nominal.model, |link| &link.fit.model);
    let implausible = implausible_sentence(model, last).map_or(String::new(), |sentence| format!(" {sentence}"));
    let verdict = format!("{verdict}{}{implausible}", fitted_along(model, last));
    let (undetermined, fitted) = (diagnosis.nominal.undetermined(), diagnosis.nominal.fitted.len());
    if 2 * undetermined.len() <= fitted {
        return verdict;
    }
    format!(
        "{verdict} Beware: the 95 % intervals of {} of {fitted} parameters include zero ({}), so these recordings say \
         little about the model.",
        undetermined.len(),
        names_of(&diagnosis.nominal.model, &undetermined).join(", ")
    )
}

/// Loss beyond that of the typical moments from which on a twentieth of the recordings is worth a word: half as much squared error
/// again as the sensors' noise, all of it there.
const IN_MOMENTS: f64 = 0.4;

fn is_off_in_moments(fit: &Fit) -> bool {
    fit.loss() - fit.typical_loss() > IN_MOMENTS
}

/// What is said where no effect was tried.
pub const NONE_TRIED: &str =
    "The model leaves nothing but the sensors' noise: there was nothing for an effect to explain, so none was tried.";

/// What is said of an effect that was fitted along.
struct Telling {
    effect: &'static str,
    /// Of one, and of several.
    sentences: [&'static str; 2],
    /// Of its parameter, behind "that of the arm".
    value: fn(f64) -> String,
}

const TELLINGS: [Telling; 5] = [
    Telling {
        effect: "spool_sensor_lead",
        sentences: [
            "The spool sensor is not read together with the other instruments",
            "The spool sensors are not read together with the other instruments",
        ],
        value: |time| format!("{:.2} ms {}", 1e3 * time.abs(), if time > 0.0 { "before" } else { "after" }),
    },
    Telling {
        effect: "spool_sensor_offset",
        sentences: [
            "The spool sensor does not read zero where its valve is closed",
            "The spool sensors do not read zero where their valves are closed",
        ],
        value: |area| format!("{}{} mm2", if area > 0.0 { "+" } else { "" }, significant(1e6 * area, 2)),
    },
    Telling {
        effect: "friction_reversal",
        sentences: [
            "Friction turns round over another speed than the usual 1 mm/s",
            "Friction turns round over other speeds than the usual 1 mm/s",
        ],
        value: |speed| format!("over {} mm/s", significant(1e3 * speed, 2)),
    },
    Telling {
        effect: "friction_corner",
        sentences: [
            "Friction turns another corner than the usual one",
            "Friction turns other corners than the usual one",
        ],
        value: |sharpness| if sharpness > 0.0 { "a sharper one".into() } else { "a softer one".into() },
    },
    Telling {
        effect: "orifice_transition",
        sentences: [
            "The valve's flow turns turbulent at another pressure drop than the usual 2 kPa",
            "The valves' flows turn turbulent at other pressure drops than the usual 2 kPa",
        ],
        value: |drop| format!("at {} kPa", significant(1e-3 * drop, 2)),
    },
];

/// The nuisance effects that were fitted up to the model `last`, with a space before them; empty where there are none.
fn fitted_along(given: &Model, last: &Model) -> String {
    let told = |telling: &Telling| {
        let found = last.effects.iter().filter(|effect| effect.name() == telling.effect);
        let found: Vec<String> = found
            .filter(|effect| !given.has(effect.name(), effect.site) && still_shows(effect))
            .filter_map(|effect| {
                let place = site_name(&last.machine, effect.site);
                Some(format!("that of the {place} {}", (telling.value)(effect.parameters.first()?.value)))
            })
            .collect();
        let sentence = telling.sentences[usize::from(found.len() > 1)];
        let values = words::list(&found, "and");
        if found.is_empty() { String::new() } else { format!(" {sentence} ({values}); this is taken into account.") }
    };
    TELLINGS.iter().map(told).collect()
}

fn names_of(model: &Model, parameters: &[usize]) -> Vec<String> {
    let names = model.parameter_names();
    parameters.iter().filter_map(|&index| names.get(index).cloned()).collect()
}

fn missing(machine: &str, diagnosis: &Diagnosis) -> String {
    let Some(first) = diagnosis.chain.first().or(diagnosis.candidates.first()) else {
        return format!("An effect of the catalogue is missing in {machine}.");
    };
    let names: Vec<String> = tied(diagnosis, first).into_iter().map(place_of).collect();
    let mut text = format!("Missing in {machine}: {}", words::list(&names, "or"));
    text += match names.len() {
        1 => ". ",
        2 => ": these recordings cannot tell the two apart. ",
        _ => ": these recordings cannot tell them apart. ",
    };
    let times = times_smaller(diagnosis, first);
    let found = format!("the squared error on recordings it was not fitted to becomes {times} times smaller");
    text += &match names.len() {
        1 => format!("With it {found}."),
        _ => format!("With the first of them {found}."),
    };
    let further: Vec<String> = diagnosis.chain.iter().skip(1).map(place_of).collect();
    if let (Some(last), false) = (diagnosis.chain.last(), further.is_empty()) {
        let (names, times) = (words::list(&further, "and"), times_smaller(diagnosis, last));
        text += &format!(" Beyond it: {names}, with which it becomes {times} times smaller.");
    }
    text
}

/// By what the squared error on the validation recordings is smaller with everything up to this link. The gain of its evidence
/// may be less: it is that of a few steps, or the smaller one of several recordings.
fn times_smaller(diagnosis: &Diagnosis, link: &Candidate) -> String {
    ratio((diagnosis.nominal_validation.loss() - link.validation.loss()).exp())
}

/// Share of a residual that a variable must explain to be named.
const LEAST_SHARE: f64 = 0.1;

fn unexplained(machine: &str, diagnosis: &Diagnosis) -> String {
    let helpful: Vec<String> = diagnosis.chain.iter().map(place_of).collect();
    let level = level_with_construction(diagnosis);
    let mut text = if !level.is_empty() {
        format!(
            "Something is missing in {machine}, and these recordings cannot tell whether that is {} or how the machine is built",
            words::list(&level, "or")
        )
    } else if helpful.is_empty() {
        format!("Something is missing in {machine}, and it is none of the effects in the catalogue")
    } else {
        format!("Something is missing in {machine} that no effect in the catalogue explains wholly")
    };
    if let Some(left) = &diagnosis.unexplained {
        text += &format!(": the {} does not close; ", words::equation(&left.equation));
        text += &if left.share_of_residual < LEAST_SHARE {
            "its residual follows no single variable".to_string()
        } else {
            let share = percent(left.share_of_residual);
            format!("{share} of its residual follows the {}", words::variable(left.variable))
        };
    }
    text += ".";
    if let Some(last) = diagnosis.chain.last() {
        let (verb, explain) = if helpful.len() == 1 { ("makes", "does") } else { ("make", "do") };
        let times = times_smaller(diagnosis, last);
        text += &format!(
            " Of the catalogue, {} {verb} the squared error on recordings it was not fitted to {times} times smaller, but \
             {explain} not explain all of it.",
            words::list(&helpful, "and")
        );
    }
    text + &construction(diagnosis)
}

/// Candidates that explain as much as a machine that is built otherwise.
fn level_with_construction(diagnosis: &Diagnosis) -> Vec<String> {
    let Some(built) = &diagnosis.construction else { return Vec::new() };
    let tied = diagnosis.candidates.iter().filter(|candidate| candidate.tied_with_first);
    let (construction, level): (Vec<_>, Vec<_>) =
        tied.partition(|candidate| candidate.physics.card().family == Family::Construction);
    if construction.iter().any(|candidate| candidate.is_same_addition(built)) {
        level.into_iter().map(place_of).collect()
    } else {
        Vec::new()
    }
}

/// What explains the recordings if the machine is built so, with a space before it.
fn construction(diagnosis: &Diagnosis) -> String {
    diagnosis.construction.as_ref().map_or(String::new(), |built| {
        format!(
            " With a {} the squared error would become {} times smaller. How a machine is built no diagnosis says: if this one has \
             that, add {}@{} by hand.",
            place_of(built),
            times_smaller(diagnosis, built),
            built.name(),
            built.place
        )
    })
}

/// The first candidate and those tied with it.
pub(super) fn tied<'a>(diagnosis: &'a Diagnosis, first: &'a Candidate) -> Vec<&'a Candidate> {
    let others = diagnosis.candidates.iter().filter(|other| other.tied_with_first && !other.is_same_addition(first));
    std::iter::once(first).chain(others).collect()
}

/// "valve dead zone at the arm valve section".
pub(super) fn place_of(candidate: &Candidate) -> String {
    words::effect_at(candidate.physics.card(), &candidate.place)
}
