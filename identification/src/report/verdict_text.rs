//! The verdict in plain sentences.

use excavator_model::effects::Family;
use excavator_model::{Model, ModelEffect, site_name};

use super::numbers::{percent, ratio, significant};
use super::words;
use crate::diagnosis::{Adequacy, Candidate, Diagnosis, Verdict};

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
    let verdict = format!("{verdict}{}", read_apart(model, diagnosis));
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

/// What was found of how the recordings were made, with a space before it; nothing where that is nothing.
fn read_apart(given: &Model, diagnosis: &Diagnosis) -> String {
    let last = diagnosis.chain.last().map_or(&diagnosis.nominal.model, |link| &link.fit.model);
    let found = last
        .effects
        .iter()
        .filter(|effect| effect.physics.card().family == Family::Recording && !given.has(effect.name(), effect.site));
    let (times, zeros): (Vec<_>, Vec<_>) = found.partition(|effect| effect.name() == "spool_sensor_lead");
    let told = |effects: Vec<&ModelEffect>, say: fn(f64) -> String| -> Vec<String> {
        let one = |effect: &ModelEffect| {
            let place = site_name(&last.machine, effect.site);
            Some(format!("that of the {place} {}", say(effect.parameters.first()?.value)))
        };
        effects.into_iter().filter_map(one).collect()
    };
    let when = |time: f64| format!("{:.2} ms {}", 1e3 * time.abs(), if time > 0.0 { "before" } else { "after" });
    let zero = |area: f64| format!("{}{} mm2", if area > 0.0 { "+" } else { "" }, significant(1e6 * area, 2));
    let mut text = String::new();
    for (found, what) in [
        (
            told(times, when),
            ["is not read together with the other instruments", "are not read together with the other instruments"],
        ),
        (
            told(zeros, zero),
            ["does not read zero where its valve is closed", "do not read zero where their valves are closed"],
        ),
    ] {
        text += &match found.len() {
            0 => String::new(),
            1 => format!(" The spool sensor {} ({}); this is taken into account.", what[0], found[0]),
            _ => {
                format!(" The spool sensors {} ({}); this is taken into account.", what[1], words::list(&found, "and"))
            }
        };
    }
    text
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
    let times = ratio(first.evidence.gain.exp());
    let found = format!("the squared error on recordings it was not fitted to becomes {times} times smaller");
    text += &match names.len() {
        1 => format!("With it {found}."),
        _ => format!("With the first of them {found}."),
    };
    let further: Vec<String> = diagnosis.chain.iter().skip(1).map(place_of).collect();
    if !further.is_empty() {
        text += &format!(" Beyond it: {}.", words::list(&further, "and"));
    }
    text
}

/// Share of a residual that a variable must explain to be named.
const LEAST_SHARE: f64 = 0.1;

fn unexplained(machine: &str, diagnosis: &Diagnosis) -> String {
    let helpful: Vec<String> = diagnosis.chain.iter().map(place_of).collect();
    let mut text = if helpful.is_empty() {
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
        let times = ratio((diagnosis.nominal_validation.loss() - last.validation.loss()).exp());
        text += &format!(
            " Of the catalogue, {} {verb} the squared error on recordings it was not fitted to {times} times smaller, but \
             {explain} not explain all of it.",
            words::list(&helpful, "and")
        );
    }
    text + &construction(diagnosis)
}

/// What explains the recordings if the machine is built so, with a space before it.
fn construction(diagnosis: &Diagnosis) -> String {
    diagnosis.construction.as_ref().map_or(String::new(), |built| {
        format!(
            " With a {} the squared error would become {} times smaller. How a machine is built no diagnosis says: if this one has \
             that, add {}@{} by hand.",
            place_of(built),
            ratio(built.evidence.gain.exp()),
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
