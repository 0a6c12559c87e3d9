//! What the program finds by itself against what the true structure leaves, fitted to the same recordings.

use std::path::Path;

use crate::common::{excavator, json, shared};
use serde_json::Value;

const SIGNALS: [&str; 5] =
    ["arm.displacement", "arm.velocity", "arm.cap_pressure", "arm.rod_pressure", "pump_pressure"];

fn refine(case: &Path, how: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let (identification, validation) = (case.join("identification"), case.join("validation"));
    let mut words = vec!["refine", "--model", "zx30u-arm", "--json", "-", "-o", "better.toml"];
    words.extend(["--identification", identification.to_str().unwrap()]);
    words.extend(["--validation", validation.to_str().unwrap()]);
    words.extend(how);
    json(&excavator(folder.path(), &words))
}

fn nmse(step: &Value, signal: &str) -> f64 {
    step["signals"][signal]["nmse"].as_f64().unwrap()
}

/// On every practice case, errors after `refine --auto` are within twice those of the true structure.
#[test]
#[ignore = "minutes; tests/run --long"]
fn refined_errors_are_within_twice_those_of_the_true_structure() {
    let Some(shared) = shared() else { return };
    let answers: Value =
        serde_json::from_str(&std::fs::read_to_string(shared.join("practice/answers.json")).unwrap()).unwrap();
    println!("NMSE on the validation recording: before -> refined | true structure fitted");
    for case in ["p00", "p01", "p02", "p03", "p04", "p05", "p06", "p07", "p08"] {
        let hidden: Vec<&str> =
            answers[case]["effects"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
        let folder = shared.join("practice").join(case);
        let automatic = refine(&folder, &["--auto"]);
        let steps = automatic["steps"].as_array().unwrap();
        let truth = if hidden.is_empty() {
            automatic.clone()
        } else {
            refine(&folder, &[&["--add"], hidden.as_slice()].concat())
        };
        let best = truth["steps"].as_array().unwrap().last().unwrap();
        print!("{case} {}:", if hidden.is_empty() { "nothing".to_string() } else { hidden.join(" and ") });
        for signal in SIGNALS {
            let (before, after) = (nmse(&steps[0], signal), nmse(steps.last().unwrap(), signal));
            print!("  {signal} {before:.1e} -> {after:.1e} | {:.1e}", nmse(best, signal));
            assert!(after <= 2.0 * nmse(best, signal), "{case} {signal}: {after:e}, true structure {best:#}");
        }
        println!();
    }
}
