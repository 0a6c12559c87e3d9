//! `blind`: draws cases, asks the diagnosis, prints how it did.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use excavator_blind::cases::{Case, Sort, Wish};
use excavator_blind::instruments::Instruments;
use excavator_blind::laws::propose_for;
use excavator_blind::plant::{CATALOGUE, FOREIGN, Kind, kind};
use excavator_blind::replay::{Stored, replayed};
use excavator_blind::scoring::{Score, Secret, make, score};
use excavator_blind::storing::store;
use excavator_blind::strength::Strength;
use excavator_blind::table::{Judged, line, summary};
use excavator_model::simulation::Profile;

/// Blind benchmark of the diagnosis: an independent simulator hides effects
#[derive(Parser)]
#[command(name = "blind")]
struct Words {
    /// Seed of the cases
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of cases
    #[arg(long, default_value_t = 10)]
    cases: u64,
    /// Number of the first case: seed and number give a case again, if the same filters are given
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// Only this sort of secret
    #[arg(long)]
    kind: Option<SortName>,
    /// Only this effect; repeat it to go round through several
    #[arg(long)]
    effect: Vec<String>,
    /// Only this strength
    #[arg(long)]
    strength: Option<StrengthName>,
    /// Factor on all sensor noise
    #[arg(long, default_value_t = 1.0)]
    noise: f64,
    /// Time in s by which the spool's samples are ahead of all others (half an interval is 0.001)
    #[arg(long, default_value_t = 0.0)]
    spool_lead: f64,
    /// Samples per second: 500 over a whole number
    #[arg(long, default_value_t = 500.0)]
    rate: f64,
    /// Bits of the converters
    #[arg(long, default_value_t = 16)]
    bits: u32,
    /// Leave out the small unmodelled extras (ripple, warming, hose stubs)
    #[arg(long)]
    without_extras: bool,
    /// Move the machines by the first profile of this file (`excavator design` writes such) in both recordings
    #[arg(long)]
    profile: Option<PathBuf>,
    /// Store each case in this folder, as two bags and an answer
    #[arg(long)]
    write: Option<PathBuf>,
    /// Store the scores of each case in this folder, for --replay
    #[arg(long)]
    scores: Option<PathBuf>,
    /// Judge the scores stored in these folders again, without a fit; with --against a table of what changed
    #[arg(long, num_args = 1..)]
    replay: Vec<PathBuf>,
    /// Verdicts of an earlier replay to compare with; written there where there are none
    #[arg(long, requires = "replay")]
    against: Option<PathBuf>,
    /// With --replay, draw how often named effects were there against the stated probability, as SVG
    #[arg(long, requires = "replay")]
    diagram: Option<PathBuf>,
    /// Ask for laws, and try the first on a third recording
    #[arg(long)]
    propose: bool,
    /// Take this effect out of model and catalogue before asking for laws; "own" is what the case hides
    #[arg(long, requires = "propose")]
    without: Vec<String>,
    /// Draw and store the cases without asking the diagnosis
    #[arg(long)]
    only_draw: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum SortName {
    Nothing,
    Single,
    Pair,
    Unknown,
    Several,
    Beside,
}

#[derive(Clone, Copy, ValueEnum)]
enum StrengthName {
    Weak,
    Medium,
    Strong,
}

fn main() -> ExitCode {
    let words = Words::parse();
    if !words.replay.is_empty() {
        return match replayed(&words.replay, words.against.as_deref(), words.diagram.as_deref()) {
            Ok(text) => {
                say(&text);
                ExitCode::SUCCESS
            }
            Err(reason) => {
                eprintln!("{reason}");
                ExitCode::FAILURE
            }
        };
    }
    let mut effects: Vec<&'static Kind> = Vec::new();
    for name in &words.effect {
        let Some(kind) = kind(name) else {
            let names: Vec<&str> = CATALOGUE.iter().chain(FOREIGN).map(|kind| kind.name).collect();
            eprintln!("no effect \"{name}\"; there are {}", names.join(", "));
            return ExitCode::from(2);
        };
        effects.push(kind);
    }
    let sort = words.kind.map(|sort| match sort {
        SortName::Nothing => Sort::Nothing,
        SortName::Single => Sort::Single,
        SortName::Pair => Sort::Pair,
        SortName::Unknown => Sort::Unknown,
        SortName::Several => Sort::Several,
        SortName::Beside => Sort::Beside,
    });
    let strength = words.strength.map(|strength| match strength {
        StrengthName::Weak => Strength::Weak,
        StrengthName::Medium => Strength::Medium,
        StrengthName::Strong => Strength::Strong,
    });
    if let Some(sort) = sort
        && let Some(kind) = effects.iter().find(|kind| !fits(sort, kind))
    {
        eprintln!("{} is no secret of the sort {sort:?}; leave out --kind or name another effect", kind.name);
        return ExitCode::from(2);
    }
    let profile = match words.profile.as_deref().map(read_profile).transpose() {
        Ok(profile) => profile,
        Err(reason) => {
            eprintln!("{reason}");
            return ExitCode::from(2);
        }
    };
    judge_all(&words, &Wish { sort, effects, strength, without_extras: words.without_extras }, profile.as_ref())
}

fn read_profile(path: &Path) -> Result<Profile, String> {
    /// Only the profiles count: commands come at the recorder's rate.
    #[derive(serde::Deserialize)]
    struct File {
        profiles: Vec<Profile>,
    }
    let failed = |reason: String| format!("{}: {reason}", path.display());
    let text = std::fs::read_to_string(path).map_err(|error| failed(error.to_string()))?;
    let file: File = toml::from_str(&text).map_err(|error| failed(error.to_string()))?;
    let profile = file.profiles.into_iter().next().ok_or_else(|| failed("no [[profiles]]".into()))?;
    profile.check().map_err(|error| failed(error.to_string()))?;
    Ok(profile)
}

/// Whether an effect can be the secret of this sort.
fn fits(sort: Sort, kind: &Kind) -> bool {
    let foreign = FOREIGN.iter().any(|other| other.name == kind.name);
    match sort {
        Sort::Nothing | Sort::Several | Sort::Beside => false,
        Sort::Single | Sort::Pair => !foreign,
        Sort::Unknown => foreign,
    }
}

/// Prints a line; false where nobody reads any more.
fn say(line: &str) -> bool {
    writeln!(std::io::stdout(), "{line}").is_ok()
}

fn judge_all(words: &Words, wish: &Wish, profile: Option<&Profile>) -> ExitCode {
    let mut judged: Vec<Judged> = Vec::new();
    for number in words.first..words.first.saturating_add(words.cases) {
        let mut case = Case::draw(words.seed, number, wish);
        if let Some(profile) = profile {
            case.follow(profile);
        }
        let (line, result) = match judge(words, &mut case) {
            Ok(answer) => answer,
            Err(reason) => {
                eprintln!("{reason}");
                return ExitCode::FAILURE;
            }
        };
        judged.extend(result.map(|result| (case, result)));
        if !say(&line) {
            return ExitCode::SUCCESS;
        }
    }
    if !words.only_draw && !words.propose {
        say(&format!("\n{}", summary(&judged)));
    }
    ExitCode::SUCCESS
}

/// Line and result of a case, no result where it is only drawn.
///
/// # Errors
/// In words, where the case cannot be stored.
fn judge(words: &Words, case: &mut Case) -> Result<(String, Option<Result<Score, String>>), String> {
    let (number, secret, strength) = (case.number, case.secret(), case.strength.name());
    let failed =
        |what: &str, error: String| (format!("{number:>4}  {what}: {secret} {strength}: {error}"), Some(Err(error)));
    let instruments = Instruments {
        noise: words.noise,
        spool_lead: words.spool_lead,
        rate: words.rate,
        bits: words.bits,
        ..Instruments::default()
    };
    let evidence = match make(case, &instruments) {
        Ok(evidence) => evidence,
        Err(error) => return Ok(failed("no recording", error.to_string())),
    };
    if let Some(folder) = &words.write {
        store(folder, case, &evidence).map_err(|error| error.to_string())?;
    }
    if words.only_draw {
        let [identification, validation] = evidence.change.map(|change| 100.0 * change.share());
        let truth = case.truth();
        let line =
            format!("{number:>4}  {secret} {strength}: changes {identification:.2}/{validation:.2} %, {truth:?}");
        return Ok((line, None));
    }
    if words.propose {
        let own = case.hidden.iter().map(|kind| kind.answer.to_string());
        let names: Vec<String> = words.without.iter().filter(|name| *name != "own").cloned().collect();
        let names: Vec<String> =
            if names.len() < words.without.len() { names.into_iter().chain(own).collect() } else { names };
        let line = match propose_for(case, &evidence, words.noise, &names) {
            Ok(found) => {
                let alarm = if found.is_false_alarm(case) { " FALSE ALARM" } else { "" };
                format!("{number:>4}  {secret} {strength}: {}{alarm}; {:?}", found.words(), case.truth())
            }
            Err(error) => format!("{number:>4}  {secret} {strength}: no law: {error}"),
        };
        return Ok((line, None));
    }
    Ok(match score(case, &evidence) {
        Ok(score) => {
            if let Some(folder) = &words.scores {
                let (secret, scores) = (Secret::of(case), score.scores.clone());
                let source = format!("{}-{number:03}-{}", words.seed, secret.words.replace(' ', "-"));
                Stored { source, secret, scores }.thinned().write(folder).map_err(|error| error.to_string())?;
            }
            (line(case, &evidence, &score), Some(Ok(score)))
        }
        Err(error) => failed("no score", error.to_string()),
    })
}
