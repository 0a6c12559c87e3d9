//! The program's verbs as a user runs them: a process each, with wall time, time of processors and memory.

use std::path::{Path, PathBuf};

use excavator_blind::cases::Sort;
use serde_json::Value;

use crate::clock::{Cost, cost_of};
use crate::figures::{Group, Run};
use crate::recordings::{Pair, blind_pair, hours, long};
use crate::truth::largest_error;

/// The program under test and where it writes.
pub struct Program<'p> {
    /// The binary.
    pub path: PathBuf,
    /// A folder for recordings and results.
    pub folder: &'p Path,
}

/// Diagnoses of the four sorts of machine.
///
/// # Errors
/// In words, where a recording cannot be made or the program fails.
pub fn diagnoses(program: &Program<'_>) -> Result<Group, String> {
    let sorts = [
        (Sort::Nothing, "nothing hidden"),
        (Sort::Single, "one effect"),
        (Sort::Pair, "two effects"),
        (Sort::Unknown, "an effect of no catalogue"),
    ];
    let mut runs = Vec::new();
    for (sort, name) in sorts {
        let pair = blind_pair(program.folder, sort)?;
        let (cost, result) = program.json("diagnose", &on_pair(&pair))?;
        runs.push(run_of(name, &cost, format!("hidden: {}; {}", pair.secret, verdict_of(&result))));
    }
    Ok(Group {
        name: "diagnose, 38 s + 20 s at 500 Hz".into(),
        what: "Machines of the blind benchmark, all effects of the catalogue as candidates.".into(),
        result: "verdict".into(),
        runs,
    })
}

/// Every offline verb on one long recording.
///
/// # Errors
/// In words, where the recording cannot be made or the program fails.
pub fn long_recording(program: &Program<'_>, seconds: f64, rate: f64) -> Result<Group, String> {
    every_verb(program, &long(program.folder, seconds, rate)?, seconds, rate)
}

/// Every offline verb on a week at 100 Hz.
///
/// # Errors
/// As [`long_recording`].
pub fn week(program: &Program<'_>) -> Result<Group, String> {
    const HOURS: usize = 7 * 24;
    every_verb(program, &hours(program.folder, HOURS, 100.0)?, 3600.0 * HOURS as f64, 100.0)
}

fn every_verb(program: &Program<'_>, bag: &Path, seconds: f64, rate: f64) -> Result<Group, String> {
    let text = bag.display().to_string();
    let mut runs = Vec::new();
    let (cost, result) = program.json("info", std::slice::from_ref(&text))?;
    runs.push(run_of("info", &cost, format!("{} messages", result["message_count"])));
    let on_bag = ["--model", "zx30u-arm", "--bag", &text].map(String::from);
    if rate < LEAST_RATE_OF_ENERGY {
        runs.push(Run::untimed("energy", "wants 200 samples per second for its slopes"));
    } else {
        let (cost, result) = program.json("energy", &on_bag)?;
        runs.push(run_of("energy", &cost, residual_of(&result)));
    }
    let (cost, result) = program.json("identify", &on_bag)?;
    runs.push(run_of("identify", &cost, format!("largest error {:.1} of its 95 % margin", largest_error(&result)?)));
    let (cost, result) = program.json("compare", &on_bag)?;
    runs.push(run_of("compare", &cost, format!("NMSE of displacement {:.2e}", nmse_of(&result))));
    let halves = [format!("{text}@0..{:.0}", 0.7 * seconds), format!("{text}@{:.0}..{seconds:.0}", 0.7 * seconds)];
    let [identification, validation] = halves;
    let arguments = ["--model", "zx30u-arm", "--identification", &identification, "--validation", &validation];
    let (cost, result) = program.json("diagnose", &arguments.map(String::from))?;
    runs.push(run_of(
        "diagnose, first 70 % against the rest",
        &cost,
        format!("hidden: nothing; {}", verdict_of(&result)),
    ));
    Ok(Group {
        name: format!("{} at {rate:.0} Hz", length_of(seconds)),
        what: "An arm that moves all the time, with noise of instruments; the given model has the published parameters, five of which are \
               8 to 15 % from the truth."
            .into(),
        result: "result".into(),
        runs,
    })
}

/// Samples per second that slopes over 20 ms need.
const LEAST_RATE_OF_ENERGY: f64 = 200.0;

/// "1 h", "10 min", "20 s".
pub fn length_of(seconds: f64) -> String {
    match seconds {
        long if long >= 3600.0 => format!("{:.0} h", long / 3600.0),
        middle if middle >= 60.0 => format!("{:.0} min", middle / 60.0),
        short => format!("{short:.0} s"),
    }
}

impl Program<'_> {
    /// Runs a verb and reads its result.
    ///
    /// # Errors
    /// In words, where it fails or its result is no JSON.
    pub fn json(&self, verb: &str, arguments: &[String]) -> Result<(Cost, Value), String> {
        let result = self.folder.join("result.json");
        let written = ["--json", &result.display().to_string(), "--force"].map(String::from);
        // info replaces nothing that it did not write.
        let written = if verb == "info" { &written[..2] } else { &written[..] };
        // The result of the verb before is not that of this one.
        let _ = std::fs::remove_file(&result);
        let arguments: Vec<String> =
            std::iter::once(verb.to_string()).chain(arguments.iter().cloned()).chain(written.iter().cloned()).collect();
        let cost = cost_of(&self.path, &arguments)?;
        let text = std::fs::read_to_string(&result).map_err(|error| format!("{verb}: {error}"))?;
        Ok((cost, serde_json::from_str(&text).map_err(|error| format!("{verb}: {error}"))?))
    }
}

fn on_pair(pair: &Pair) -> Vec<String> {
    let [identification, validation] = [&pair.identification, &pair.validation].map(|path| path.display().to_string());
    ["--model", "zx30u-arm", "--identification", &identification, "--validation", &validation]
        .map(String::from)
        .to_vec()
}

fn run_of(name: &str, cost: &Cost, result: String) -> Run {
    Run {
        name: name.into(),
        seconds: Some(cost.seconds),
        processor_seconds: Some(cost.processor_seconds),
        peak_megabytes: Some(cost.peak_megabytes),
        result,
    }
}

/// The verdict and the candidates that it names, as in "found: valve_lag".
fn verdict_of(result: &Value) -> String {
    let verdict = result["verdict"].as_str().unwrap_or("no verdict");
    let names = |list: &str| -> Vec<String> {
        let effects = result[list].as_array().into_iter().flatten().filter_map(|one| one["effect"].as_str());
        effects.map(str::to_string).collect()
    };
    let (together, candidates) = (names("together"), names("candidates"));
    let found = if together.is_empty() { candidates.into_iter().take(1).collect() } else { together };
    let is_found = verdict == "missing_effect" && !found.is_empty();
    format!("found: {}", if is_found { found.join("+") } else { verdict.to_string() })
}

/// What the ledger does not account for, as a share of what was dissipated: what was supplied may come back.
fn residual_of(result: &Value) -> String {
    let arm = &result["energy"]["cylinders"]["arm"];
    match (arm["residual"].as_f64(), arm["dissipation"].as_f64()) {
        (Some(residual), Some(dissipated)) => {
            format!("residual {:.1} % of the energy dissipated", 100.0 * (residual / dissipated).abs())
        }
        _ => "no ledger".into(),
    }
}

fn nmse_of(result: &Value) -> f64 {
    result["signals"]["arm.displacement"]["nmse"].as_f64().unwrap_or(f64::NAN)
}
