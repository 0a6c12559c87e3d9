//! Writes the verdict in plain sentences. They state the reasons of the decision and decide nothing.

use excavator_identification::decision::{Differing, Kind, Reason};
use excavator_identification::diagnosis::{Candidate, Diagnosis};
use excavator_identification::fit::nuisances_shown;
use excavator_identification::search::Trial;
use excavator_model::effects::Finding;
use excavator_model::{Model, site_name};

use super::change_text::{change_of, spoken};
use super::numbers::{change_of_error, percent};
use super::plausibility_text::implausible_sentence;
use super::words;

/// Result of a diagnosis, in a few plain sentences. Effects that the recordings cannot separate are all named.
///
/// ```no_run
/// use excavator_identification::diagnosis::{DiagnosisSettings, diagnose};
/// use excavator_model::Model;
/// use excavator_model::recording::Recording;
/// use excavator_report::verdict_sentence;
///
/// fn tell(model: &Model, fitted: &Recording, judging: &Recording) -> Result<String, Box<dyn std::error::Error>> {
///     let progress = |_: &str, _: f64| ();
///     let found = diagnose(model, &[fitted], &[judging], &DiagnosisSettings::default(), &progress)?;
///     Ok(verdict_sentence(model, &found))
/// }
/// ```
pub fn verdict_sentence(model: &Model, diagnosis: &Diagnosis) -> String {
    let machine = &model.machine.name;
    let mut sentences = vec![match diagnosis.verdict.kind {
        Kind::Adequate => adequate(machine, diagnosis),
        Kind::MissingEffect => missing(machine, diagnosis),
        Kind::Unexplained => unexplained(machine, diagnosis),
    }];
    if diagnosis.verdict.is_too_coarse() {
        sentences.push(TOO_COARSE.to_string());
    }
    let last = &diagnosis.supported().fit.model;
    // Nuisances of a wrong model are biased too.
    if diagnosis.verdict.kind != Kind::Unexplained {
        sentences.extend(nuisances(model, last));
    }
    sentences.extend(implausible_sentence(model, last));
    sentences.extend(undetermined(diagnosis));
    sentences.extend(lost_messages(diagnosis));
    sentences.join(" ")
}

/// What the recordings lack of the signals that the verdict rests on.
fn lost_messages(diagnosis: &Diagnosis) -> Option<String> {
    let lost = &diagnosis.lost_messages;
    (!lost.is_empty()).then(|| format!("The verdict rests on signals with losses: {}.", lost.join("; ")))
}

const TOO_COARSE: &str = "The recordings are coarse: the readings of the inputs alone could cause an error of this size. Record command and \
                          opening faster, or with less noise, before acting on this.";

/// Text for a diagnosis in which no effect was tried.
pub const NONE_TRIED: &str =
    "The model leaves only sensor noise. There was nothing for an effect to explain, so none was tried.";

fn adequate(machine: &str, diagnosis: &Diagnosis) -> String {
    let mut text = format!("Nothing is missing in {machine} that these recordings can show.");
    for reason in &diagnosis.verdict.reasons {
        text += &match reason {
            Reason::WithinNoise { .. } => " The remaining error is sensor noise.".to_string(),
            Reason::ExceptMoments { share_of_time } => format!(
                " In {} of the time, the error of the model is larger. Record more of these moments to find the cause.",
                percent(*share_of_time)
            ),
            Reason::SmallError { .. } => {
                " The remaining error is about a hundredth of each signal's own size, too small to act on.".to_string()
            }
            Reason::WithinInputs { .. } => {
                " The remaining error is within the range that noise and sampling of the inputs can cause.".to_string()
            }
            _ => String::new(),
        };
    }
    text
}

fn missing(machine: &str, diagnosis: &Diagnosis) -> String {
    let selected = diagnosis.selected();
    let alternatives = diagnosis.alternatives();
    let named = |candidate: &Candidate<'_>| {
        let others = alternatives.iter().filter(|(_, replaced)| *replaced == candidate.addition);
        let names: Vec<String> =
            std::iter::once(place_of(candidate)).chain(others.map(|(other, _)| place_of(other))).collect();
        words::list(&names, "or")
    };
    let names: Vec<String> = selected.iter().map(named).collect();
    let mut text = match names.as_slice() {
        [] => format!("An effect of the catalogue is missing in {machine}."),
        [only] => format!("Missing in {machine}: {only}."),
        several if alternatives.is_empty() => format!("Missing in {machine}: {}.", words::list(several, "and")),
        several => format!("Missing in {machine}: {}.", several.join("; and ")),
    };
    if !alternatives.is_empty() {
        text += " These recordings cannot tell the alternatives apart.";
    }
    let with = match (names.len(), alternatives.is_empty()) {
        (1, true) => "With it",
        (1, false) => "With the first of them",
        (_, true) => "With all of them",
        (_, false) => "With the first of each",
    };
    text += &format!(
        " {with} the mean NMSE on recordings that were not fitted {}.",
        change_with(diagnosis, diagnosis.supported())
    );
    text + left_in_balances(diagnosis)
}

/// Whether the supported effects leave more than noise, with a leading space.
fn left_in_balances(diagnosis: &Diagnosis) -> &'static str {
    match diagnosis.remainders.as_slice() {
        [] => "",
        all if all.iter().all(|one| one.is_noise) => " What remains is noise in every balance.",
        _ => " A little more than noise remains.",
    }
}

/// Change of the mean NMSE on the validation recordings with this hypothesis.
fn change_with(diagnosis: &Diagnosis, trial: &Trial) -> String {
    change_of_error([diagnosis.given(), trial].map(|one| one.error.unwrap_or(f64::NAN)))
}

fn unexplained(machine: &str, diagnosis: &Diagnosis) -> String {
    if let Some(text) = differing(machine, diagnosis) {
        return text;
    }
    let structural = diagnosis.verdict.structural_alternative();
    let selected = diagnosis.selected();
    let mut text = match structural {
        Some(_) => {
            let rivals: Vec<String> = diagnosis.verdict.set.iter().map(|&number| names_of(diagnosis, number)).collect();
            format!(
                "Something is missing in {machine}. These recordings do not distinguish {} from a structural property of the machine.",
                words::list(&rivals, "or")
            )
        }
        None if selected.is_empty() => {
            format!("Something is missing in {machine}, and no effect of the catalogue explains it.")
        }
        None => format!("Something is missing in {machine} that no effect of the catalogue explains completely."),
    };
    if structural.is_none() {
        text += &partly(diagnosis, &selected);
    }
    if let Some(left) = &diagnosis.unexplained {
        text += &format!(" The largest residual is in the {}", words::equation(&left.equation));
        text += &if left.follows_variable {
            format!("; {} of it follows the {}.", percent(left.share_of_residual), words::variable(&left.variable))
        } else {
            "; it follows no single variable.".to_string()
        };
    }
    text + &construction(diagnosis)
}

/// Parameters that drift over the recordings, or differ between their roles.
fn differing(machine: &str, diagnosis: &Diagnosis) -> Option<String> {
    let named = |parameters: &[Differing]| {
        let each =
            parameters.iter().map(|one| format!("{} {}", spoken(&one.meaning, &one.name), change_of(one.values)));
        words::list(&each.collect::<Vec<_>>(), "and")
    };
    match diagnosis.verdict.reasons.first()? {
        Reason::ParametersDrift { parameters } => Some(format!(
            "Parameters of {machine} drift over these recordings: {}, from the first half of each to the second. Constant parameters leave \
             little more than noise. A law of the oil temperature or of time may describe the drift.",
            named(parameters)
        )),
        Reason::MachineDiffers { parameters } => Some(format!(
            "{machine} itself seems to differ between the recordings for the fit and those for validation: {}. Each side leaves only noise \
             with parameters of its own.",
            named(parameters)
        )),
        _ => None,
    }
}

/// The part that the favoured hypothesis explains.
fn partly(diagnosis: &Diagnosis, selected: &[Candidate<'_>]) -> String {
    let Some(Reason::PartlyExplained { before, after, .. }) =
        diagnosis.verdict.reasons.iter().find(|reason| matches!(reason, Reason::PartlyExplained { .. }))
    else {
        return String::new();
    };
    let names: Vec<String> = selected.iter().map(place_of).collect();
    let (names, share) = (words::list(&names, "and"), 1.0 - after.max(0.0) / before);
    let change = change_with(diagnosis, diagnosis.best());
    let smaller = format!("the mean NMSE on recordings that were not fitted {change}");
    let left = percent(1.0 - share);
    match selected {
        [_] if diagnosis.unexplained.as_ref().is_some_and(|left| left.differs_in_form) => format!(
            " It is mostly {names}, in a form that differs from the catalogue's: {smaller}, and {left} of the misfit remains."
        ),
        [_] => format!(" With {names} {smaller}, but {left} of the misfit remains."),
        _ => format!(" Probably missing: {names}. With all of them {smaller}, but {left} of the misfit remains."),
    }
}

/// Structural effects that would explain the recordings, with a leading space.
fn construction(diagnosis: &Diagnosis) -> String {
    let Some(number) = diagnosis.verdict.structural_alternative() else { return String::new() };
    let trial = &diagnosis.trials[number];
    let command: Vec<String> =
        trial.additions.iter().map(|addition| format!("--add {}", addition.name(&trial.fit.model))).collect();
    format!(
        " With {} the mean NMSE {}. Recordings do not show whether the machine has this part. If it does, add it with `excavator refine \
         {}`.",
        names_of(diagnosis, number),
        change_with(diagnosis, trial),
        command.join(" ")
    )
}

/// Effects of a hypothesis in words.
fn names_of(diagnosis: &Diagnosis, number: usize) -> String {
    let trial = &diagnosis.trials[number];
    let name = |addition: &excavator_identification::search::Addition| {
        words::effect_at(addition.physics.card(), site_name(&trial.fit.model.machine, addition.site))
    };
    words::list(&trial.additions.iter().map(name).collect::<Vec<_>>(), "and")
}

/// "valve dead zone at the arm valve section".
pub(super) fn place_of(candidate: &Candidate<'_>) -> String {
    words::effect_at(candidate.addition.physics.card(), candidate.place())
}

fn undetermined(diagnosis: &Diagnosis) -> Option<String> {
    let given = &diagnosis.given().fit;
    let (undetermined, fitted) = (given.undetermined(), given.fitted.len());
    if 2 * undetermined.len() <= fitted {
        return None;
    }
    let names = given.model.parameter_names();
    let names: Vec<&str> = undetermined.iter().filter_map(|&index| Some(names.get(index)?.as_str())).collect();
    Some(format!(
        "These recordings determine few parameters: the 95 % intervals of {} of {fitted} parameters include zero ({}).",
        names.len(),
        names.join(", ")
    ))
}

/// Sentences on the nuisance effects that show in the model `last`, one for each kind.
fn nuisances(given: &Model, last: &Model) -> Vec<String> {
    let mut kinds: Vec<([&str; 2], Vec<String>)> = Vec::new();
    for effect in nuisances_shown(given, last) {
        let Some(Finding { sentences, value }) = effect.finding() else { continue };
        let value = format!("{}: {value}", site_name(&last.machine, effect.site));
        match kinds.iter_mut().find(|(known, _)| *known == sentences) {
            Some((_, values)) => values.push(value),
            None => kinds.push((sentences, vec![value])),
        }
    }
    let sentence = |(sentences, values): &([&str; 2], Vec<String>)| {
        let sentence = sentences[usize::from(values.len() > 1)];
        format!("{sentence} ({}). The fit takes this into account.", values.join("; "))
    };
    kinds.iter().map(sentence).collect()
}
