//! One line per case, and the summary.

use comfy_table::{Table, presets};

use crate::answer::Outcome;
use crate::cases::{Case, Sort};
use crate::scoring::{Estimate, Evidence, Score, median};

/// A case with its score, or why it has none.
pub type Judged = (Case, Result<Score, String>);

/// The line of one case.
pub fn line(case: &Case, evidence: &Evidence, score: &Score) -> String {
    let [identification, validation] = evidence.change.map(|change| 100.0 * change.share());
    let hidden = if case.hidden.is_empty() {
        "nothing".to_string()
    } else {
        let truth: Vec<String> = case.truth().iter().map(|(name, value)| format!("{name}={value:.3e}")).collect();
        let strength = case.strength.name();
        let limits = if case.hidden.iter().any(|kind| !kind.identifiable) { ", cannot be seen" } else { "" };
        let share = format!("changes {identification:.2}/{validation:.2} %");
        format!("{} {strength} ({share}; {}{limits})", case.secret(), truth.join(" "))
    };
    let error =
        score.coefficient_error.map_or(String::new(), |error| format!(", coefficients off by {:.1} %", 100.0 * error));
    format!(
        "{:>4}  {:18}  hidden {hidden}\n      {}\n      NMSE {:.2e} -> {:.2e}{error}, covered {}/{}, {:.0} s",
        case.number,
        score.outcome.name(),
        score.answer.words(),
        score.nmse[0],
        score.nmse[1],
        score.estimates.iter().filter(|estimate| estimate.is_covered()).count(),
        score.estimates.len(),
        score.seconds,
    )
}

/// The summary of all cases.
pub fn summary(judged: &[Judged]) -> String {
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN);
    table.set_header([
        "what is hidden",
        "cases",
        "detected",
        "right name",
        "tied",
        "wrong name",
        "called unexplained",
        "missed",
    ]);
    let mut groups: Vec<(String, Vec<&Score>)> = Vec::new();
    for (case, score) in judged {
        let Ok(score) = score else { continue };
        for name in groups_of(case) {
            match groups.iter_mut().find(|(group, _)| *group == name) {
                Some((_, scores)) => scores.push(score),
                None => groups.push((name, vec![score])),
            }
        }
    }
    groups.sort_by(|a, b| a.0.cmp(&b.0));
    for (name, scores) in &groups {
        let count = |wanted: &[Outcome]| scores.iter().filter(|score| wanted.contains(&score.outcome)).count();
        let detected = scores.len() - count(&[Outcome::Missed]);
        let cells = [
            name.clone(),
            scores.len().to_string(),
            detected.to_string(),
            count(&[Outcome::Right]).to_string(),
            count(&[Outcome::Tied, Outcome::Partial]).to_string(),
            count(&[Outcome::WrongName]).to_string(),
            count(&[Outcome::CalledUnexplained]).to_string(),
            count(&[Outcome::Missed]).to_string(),
        ];
        if !name.starts_with(SILENT) {
            table.add_row(cells);
        }
    }
    format!("{table}\n{}", figures(judged))
}

/// First letters of groups in which nothing can be seen: their figures are those of false alarms.
const SILENT: &str = "nothing";

fn groups_of(case: &Case) -> Vec<String> {
    let strength = case.strength.name();
    match case.sort {
        Sort::Nothing => vec![SILENT.to_string()],
        Sort::Single if !case.hidden.iter().all(|kind| kind.identifiable) => vec![format!("{SILENT} to see")],
        Sort::Single => vec![format!("1 effect, {strength}"), format!("1 effect, all"), format!("  {}", case.secret())],
        Sort::Pair => vec![format!("2 effects, {strength}"), "2 effects, all".to_string()],
        Sort::Several => vec![format!("{} effects", case.hidden.len()), "several effects, all".to_string()],
        Sort::Beside => vec!["two effects beside one outside the catalogue (right = unexplained)".to_string()],
        Sort::Unknown => {
            vec![
                format!("outside the catalogue, {strength} (right = unexplained)"),
                "outside the catalogue, all (right = unexplained)".into(),
            ]
        }
    }
}

/// The figures under the table.
fn figures(judged: &[Judged]) -> String {
    let scores: Vec<(&Case, &Score)> =
        judged.iter().filter_map(|(case, score)| Some((case, score.as_ref().ok()?))).collect();
    let silent = |case: &Case| case.hidden.iter().all(|kind| !kind.identifiable);
    let silent_cases = scores.iter().filter(|(case, _)| silent(case)).count();
    let alarms = scores.iter().filter(|(_, score)| score.outcome == Outcome::FalseAlarm).count();
    let mut errors: Vec<f64> = scores.iter().filter_map(|(_, score)| score.coefficient_error).collect();
    let named = errors.len();
    let error = median(&mut errors).map_or("none".to_string(), |error| format!("{:.1} %", 100.0 * error));
    let good = |outcome: Outcome| matches!(outcome, Outcome::Right | Outcome::Tied);
    let models: Vec<&Score> = scores.iter().map(|(_, score)| *score).filter(|score| good(score.outcome)).collect();
    let estimates: Vec<Estimate> = models.iter().flat_map(|score| score.estimates.iter().copied()).collect();
    let covered = estimates.iter().filter(|estimate| estimate.is_covered()).count();
    let intervals = estimates.len();
    let mut seconds: Vec<f64> = scores.iter().map(|(_, score)| score.seconds).collect();
    let longest = seconds.iter().copied().fold(0.0, f64::max);
    let middle = median(&mut seconds).unwrap_or(f64::NAN);
    let failed = judged.len() - scores.len();
    let hidden: usize = scores.iter().map(|(case, _)| case.nameable().count()).sum();
    let is_hidden = |case: &Case, name: &String| case.nameable().any(|kind| kind.answer == name);
    let named_of = |(case, score): &(&Case, &Score)| -> [usize; 2] {
        let right = score.answer.names().iter().filter(|name| is_hidden(case, name)).count();
        [right, score.answer.names().len() - right]
    };
    let [right, wrong] =
        scores.iter().map(named_of).fold([0, 0], |sum, [right, wrong]| [sum[0] + right, sum[1] + wrong]);
    format!(
        "false alarms where nothing can be seen: {alarms} of {silent_cases}\n\
         hidden effects named: {right} of {hidden}; wrong names: {wrong}\n\
         coefficient error, median of {named} cases: {error}\n\
         95 % intervals of base parameters that contain the truth, in {} rightly answered cases: {covered} of {intervals}\n\
         {}\n\
         seconds per diagnosis: median {middle:.0}, longest {longest:.0}; cases without a score: {failed}",
        models.len(),
        by_parameter(&estimates)
    )
}

/// How often the interval of each base parameter holds the truth, and how far off it is.
fn by_parameter(estimates: &[Estimate]) -> Table {
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN);
    table.set_header(["parameter", "in the interval", "error, median", "bias, median", "bias, standard errors"]);
    let mut names: Vec<&str> = estimates.iter().map(|estimate| estimate.name).collect();
    names.sort_unstable();
    names.dedup();
    for name in names {
        let own: Vec<&Estimate> = estimates.iter().filter(|estimate| estimate.name == name).collect();
        let middle = |of: &dyn Fn(&Estimate) -> f64| {
            median(&mut own.iter().map(|estimate| of(estimate)).collect::<Vec<f64>>()).unwrap_or(f64::NAN)
        };
        table.add_row([
            name.to_string(),
            format!("{} of {}", own.iter().filter(|estimate| estimate.is_covered()).count(), own.len()),
            format!("{:.2} %", 100.0 * middle(&|estimate| estimate.relative_error.abs())),
            format!("{:+.2} %", 100.0 * middle(&|estimate| estimate.relative_error)),
            format!("{:+.1}", middle(&|estimate| estimate.standardised_error)),
        ]);
    }
    table
}
