//! `excavator effects --check`

use std::path::PathBuf;

use excavator_model::formula::{Checked, Law, ROWS, check, variables};
use excavator_model::{Model, ModelEffect, addition_name, site_name};
use excavator_study::numbers::number;

use crate::cli::OwnEffects;
use crate::error::VerbError;
use crate::sources;
use crate::terminal::{chart, print};

/// Checks every law in these files on the machine of a model, and draws it.
///
/// # Errors
/// [`VerbError::Laws`] if a law has a problem.
pub fn run(files: &[PathBuf], model: &str) -> Result<(), VerbError> {
    let model = sources::model(&crate::cli::ModelChoice {
        model: model.to_string(),
        own: OwnEffects { catalogue: files.to_vec() },
    })?;
    let laws = model.catalogue.iter().filter(|physics| physics.formula().is_some()).count();
    let what = if laws == 1 { "law is" } else { "laws are" };
    print(&format!("{laws} {what} checked over the range of {}.\n", model.machine.name));
    let mut wrong = 0;
    for physics in model.catalogue.iter().filter(|physics| physics.formula().is_some()) {
        let sites = model.free_sites(physics);
        if sites.is_empty() {
            print(&format!("{}: {} has no place for it\n", physics.card().name, model.machine.name));
        }
        for site in sites {
            let with = model.with_effect(physics, site)?;
            let number = with.effects.len() - 1;
            if let Some(checked) = check(&with, number) {
                show(&with, &with.effects[number], &checked);
                wrong += usize::from(!checked.problems.is_empty());
            }
        }
    }
    match wrong {
        0 => {
            print(&format!("{laws} checked, no problem found"));
            Ok(())
        }
        _ => Err(VerbError::Laws { wrong }),
    }
}

fn show(model: &Model, effect: &ModelEffect, checked: &Checked) {
    let unit = effect.physics.formula().and_then(|text| Law::read(text).ok()).map_or("", |law| law.row().card().unit);
    let values: Vec<String> = effect
        .parameters
        .iter()
        .map(|one| {
            format!("{} = {} {}", one.card.name, number(one.value), one.card.unit).trim_end_matches(" -").to_string()
        })
        .collect();
    print(&format!(
        "{}  {}",
        addition_name(effect.name(), site_name(&model.machine, effect.site)),
        effect.physics.card().equation
    ));
    if !values.is_empty() {
        print(&format!("  with {}", values.join(", ")));
    }
    for problem in &checked.problems {
        print(&format!("  PROBLEM: {problem}"));
    }
    let [low, high] = checked.range;
    if low <= high {
        print(&format!("  {} to {} {unit} over the range of {}", number(low), number(high), model.machine.name));
    }
    if let Some([takes, gives]) = checked.power {
        let share = |share: f64| format!("{:.0} %", 100.0 * share);
        print(&match (takes > 0.0, gives > 0.0) {
            (_, false) => "  dissipates: it takes energy out wherever it acts".to_string(),
            (false, true) => "  PUTS ENERGY IN wherever it acts; is its sign right?".to_string(),
            (true, true) => format!(
                "  takes energy out in {} of the states and puts some in in {}; a loss never puts energy in",
                share(takes),
                share(gives)
            ),
        });
    }
    for curve in &checked.curves {
        print(&format!("  over {}, the rest at usual values", curve.variable));
        for line in chart(&curve.points, unit, curve.unit) {
            print(&format!("    {line}"));
        }
    }
    print("");
}

/// Prints what formulas may contain.
pub fn language() {
    print("A formula may use what stands here.");
    print("acts_on");
    for row in &ROWS {
        print(&format!("  {:24} {:6} {}", row.name, row.unit, row.meaning));
    }
    print("variables (another cylinder's as in boom.v)");
    for [name, unit, meaning] in variables() {
        print(&format!("  {name:24} {unit:6} {meaning}"));
    }
    print(LANGUAGE);
}

const LANGUAGE: &str = "\
operators
  + - * / ^                -x^2 is -(x^2), 2^3^2 is 2^(3^2)
functions
  abs sqrt exp ln log10 sin cos tan tanh atan min max
  sign(x) step(x)          rounded where x changes its sign, as friction and flow of the equations are
  root(x)                  sign(x)*sqrt(abs(x)), with a finite slope at zero
  clamp(x, low, high)      smoothstep(x, begin, end)
  if(a < b, then, else)    with <, <=, > or >=
  table(x, [x0, x1, ...], [y0, y1, ...])   a monotone cubic; give its values a unit by a parameter";
