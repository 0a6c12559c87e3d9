//! Summarises the error of a model on a recording in plain sentences.

use excavator_identification::validation::{Baselines, Comparison, PhaseShare, SignalComparison, WrongUnit};

use super::beside::Beside;
use super::numbers::{percent, significant};

/// Share of a signal's error that one phase of motion must hold to be mentioned.
const MOST_OF_IT: f64 = 0.8;

/// An error in a signal of mostly noise is mentioned if it is this many times that of the noise.
const MORE_THAN_NOISE: f64 = 2.0;

/// Summary of a comparison: how much of the recording the model explains, how good that is, and where it is worst.
pub fn comparison_sentence(comparison: &Comparison, baselines: &Baselines) -> String {
    let machine = &comparison.machine.name;
    let mean = comparison.mean_error();
    let number = |value: f64| significant(value, 3);
    let mut sentences = vec![if mean < 1.0 {
        format!("{machine} explains {} of the variance that was measured: mean NMSE {}.", explained(mean), number(mean))
    } else {
        format!("{machine} does not follow what was measured: mean NMSE {}, where 1 is a constant.", number(mean))
    }];
    let known = [
        ("sensor noise alone", baselines.mean(|one| one.noise)),
        ("a linear ARX model fitted to this recording", baselines.mean(|one| one.arx)),
    ];
    let known: Vec<String> = known
        .into_iter()
        .filter(|(_, value)| value.is_finite())
        .map(|(name, value)| format!("{name} has {}", number(value)))
        .collect();
    if !known.is_empty() {
        sentences.push(format!("For comparison, {}.", known.join(", ")));
    }
    // Not a signal whose error is the noise of its instrument.
    let is_more = |signal: &&SignalComparison| {
        let (error, noise) = (signal.error.normalised(), signal.error.normalised_noise());
        signal.error.tells() || error > MORE_THAN_NOISE * noise
    };
    let signals = comparison.signals.iter().filter(is_more);
    let worst = signals.max_by(|a, b| a.error.normalised().total_cmp(&b.error.normalised()));
    sentences.extend(worst.filter(|_| comparison.signals.len() > 1).map(worst_sentence));
    sentences.extend(WrongUnit::of(comparison).map(|hint| wrong_unit_sentence(&hint)));
    sentences.join(" ")
}

/// Asks whether a unit was confused.
fn wrong_unit_sentence(hint: &WrongUnit) -> String {
    let WrongUnit { signals, recorded, read } = hint;
    let (last, others) = (signals.last().map_or("", String::as_str), &signals[..signals.len().saturating_sub(1)]);
    format!(
        "Check the unit of {} and {last}: their size is that of pressures in {recorded} that are read in {read}.",
        others.join(", ")
    )
}

/// Share of the variance that the model explains at a mean NMSE. It is never all of it.
fn explained(nmse: f64) -> String {
    match 100.0 * (1.0 - nmse) {
        share if share >= 99.95 => "more than 99.9 %".to_string(),
        share if share >= 99.0 => format!("{share:.1} %"),
        share => percent(share / 100.0),
    }
}

/// Summary of the additional data on the same recording.
pub fn others_sentence(comparison: &Comparison, other: Beside<'_>) -> String {
    let (own, its) = (comparison.mean_error(), other.comparison().mean_error());
    let error = significant(its, 3);
    match other {
        Beside::Model(_) if its < own => format!("The other model is closer: mean NMSE {error}."),
        Beside::Model(_) => format!("The other model is not closer: mean NMSE {error}."),
        Beside::Run(run) if !run.has_same_commands() => {
            format!(
                "The commands of the second run differ, so its mean NMSE of {error} does not measure repeatability."
            )
        }
        Beside::Run(_) if its < own => {
            format!("A second run of the machine has mean NMSE {error}: a perfect model could come that close.")
        }
        Beside::Run(_) => format!(
            "A second run of the machine has mean NMSE {error}, more than the model: the machine does not repeat itself better."
        ),
    }
}

fn worst_sentence(signal: &SignalComparison) -> String {
    let most = |share: &&PhaseShare| share.of_error >= MOST_OF_IT && share.of_error > share.of_time;
    let when = signal.phases.iter().find(most).map_or_else(String::new, |share| {
        format!(", {} of it while the piston is {}", percent(share.of_error), share.phase)
    });
    format!(
        "The largest error is in {} (NMSE {}){when}.",
        spoken(&signal.name),
        significant(signal.error.normalised(), 3)
    )
}

/// "arm.cap_pressure" in words: the cap pressure of arm.
fn spoken(signal: &str) -> String {
    match signal.split_once('.') {
        Some((part, quantity)) => format!("the {} of {part}", quantity.replace('_', " ")),
        None => format!("the {}", signal.replace('_', " ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_of_the_variance_is_never_explained() {
        assert_eq!(explained(0.251), "75 %");
        assert_eq!(explained(0.00298), "99.7 %");
        assert_eq!(explained(1e-6), "more than 99.9 %");
    }
}
