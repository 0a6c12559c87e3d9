//! Formula effects as a user meets them: on a measured seal, and on recordings with laws that no catalogue has.

use crate::common;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

const REPOSITORY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// Runs a line of a page in `folder`; gives standard output.
fn run(line: &str, folder: &Path) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_excavator"));
    let path = format!("{}:{}", program.parent().unwrap().display(), std::env::var("PATH").unwrap());
    let output = Command::new("bash")
        .args(["-euc", line])
        .current_dir(folder)
        .env("PATH", path)
        .env("REPO", std::fs::canonicalize(REPOSITORY).unwrap())
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{line}\n{errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// The law of the page on own physics, fitted to the seal of the samples.
#[test]
fn a_refined_model_contains_its_formula() {
    let folder = tempfile::tempdir().unwrap();
    let page = std::fs::read_to_string(format!("{REPOSITORY}/docs/own-physics.md")).unwrap();
    let law = page.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    std::fs::write(folder.path().join("seal.toml"), law).unwrap();
    run("cp $REPO/bags/samples/seal-friction/* .", folder.path());
    run(
        "excavator refine --model rig.toml --catalogue seal.toml --add seal_friction --identification O-ring_1bar.csv \
         --validation O-ring_7bar.csv --map map.toml -o own.toml && rm seal.toml",
        folder.path(),
    );
    let model = std::fs::read_to_string(folder.path().join("own.toml")).unwrap();
    assert!(model.contains("[[formula]]") && model.starts_with("format = 2"));
    run("excavator compare --model own.toml --bag O-ring_3bar.csv --map map.toml", folder.path());
}

#[test]
fn a_wrong_sign_is_seen_before_a_fit() {
    let folder = tempfile::tempdir().unwrap();
    let file = |formula: &str| {
        format!(
            "[[formula]]\nname = \"drag\"\nacts_on = \"piston_force\"\nformula = \"{formula}\"\n\
             parameters.k = {{ unit = \"N s2/m2\", start = [100.0] }}\n"
        )
    };
    let check = |formula: &str| {
        std::fs::write(folder.path().join("drag.toml"), file(formula)).unwrap();
        run("excavator effects --check drag.toml || true", folder.path())
    };
    assert!(check("-k*v*abs(v)").contains("dissipates"));
    assert!(check("k*v*abs(v)").contains("PUTS ENERGY IN"));
    assert!(check("k*v*v").contains("a loss never puts energy in"));
    assert!(check("-k*v^3/(abs(v) - v)").contains("not finite"));
    assert!(check("-k*v*v*v/abs(v)").contains("not finite where v = 0"));
    assert!(check("-k*v*v*sqrt(abs(v)/v)*0").contains("PROBLEM"));
}

fn practice() -> Option<PathBuf> {
    let folder = common::shared()?.join("practice-laws");
    let found = folder.join("answers.json").exists();
    if !found {
        println!("skipped: {} is not here", folder.display());
    }
    found.then_some(folder)
}

/// The laws of the practice recordings, as their users would write them.
const LAWS: &str = r#"
[[formula]]
name = "distance_friction"
acts_on = "piston_force"
formula = "-k*abs(s)*sign(v)"
parameters.k = { unit = "N/m", maximum = 1e6, start = [1000.0] }

[[formula]]
name = "load_damping"
acts_on = "piston_force"
formula = "-k*v*abs(p_cap - p_rod)"
parameters.k = { unit = "N s/(m Pa)", maximum = 1.0, start = [1e-3] }

[[formula]]
name = "turbulent_leak"
acts_on = "piston_leak"
formula = "k*(p_cap - p_rod)*abs(p_cap - p_rod)"
parameters.k = { unit = "m3/(s Pa2)", maximum = 1e-12, start = [1e-18] }

[[formula]]
name = "pressed_opening"
acts_on = "opening"
formula = "u*(1 - k*p_pump)"
parameters.k = { unit = "1/Pa", maximum = 1e-5, start = [1e-9, 1e-8, 1e-7] }
"#;

/// Named first and alone, the coefficient within 5 %, the squared error at least ten times smaller.
fn is_named(case: &str, law: &str) {
    let Some(practice) = practice() else { return };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("laws.toml"), LAWS).unwrap();
    let data = std::fs::canonicalize(practice.join(case)).unwrap();
    run(
        &format!(
            "excavator diagnose --model zx30u-arm --catalogue laws.toml --identification {0}/identification \
             --validation {0}/validation --json found.json",
            data.display()
        ),
        folder.path(),
    );
    let read = |path: &Path| -> Value { serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap() };
    let found = read(&folder.path().join("found.json"));
    let truth = read(&practice.join("answers.json"))[case]["k"].as_f64().unwrap();
    assert_eq!(found["verdict"], "missing_effect", "{case}");
    let effects = found["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{case}: {effects:?}");
    let first = &found["candidates"][0];
    assert_eq!((&first["effect"], &first["tied_with_first"]), (&law.into(), &false.into()), "{case}");
    let value = first["parameters"][0]["value"].as_f64().unwrap();
    assert!((value / truth - 1.0).abs() < 0.05, "{case}: {value}, true {truth}");
    let error = |key: &str| first[key].as_f64().unwrap();
    assert!(error("validation_error_after") < 0.1 * error("validation_error_before"), "{case}");
}

#[test]
#[ignore = "two minutes; tests/run --long"]
fn a_law_of_the_user_is_named_like_a_built_in_one() {
    is_named("q00", "distance_friction");
    is_named("q01", "load_damping");
    is_named("q02", "turbulent_leak");
    is_named("q03", "pressed_opening");
}

/// A built-in effect written as a formula has its scores, so that the two tie.
#[test]
#[ignore = "half a minute; tests/run --long"]
fn a_formula_of_a_built_in_effect_ties_with_it() {
    let Some(shared) = common::shared() else { return };
    let folder = tempfile::tempdir().unwrap();
    let own = std::fs::read_to_string(format!("{REPOSITORY}/model/tests/data/own-effects.toml")).unwrap();
    let twin = own.split("[[formula]]").find(|text| text.contains("\"own_valve_dead_zone\"")).unwrap();
    std::fs::write(folder.path().join("twin.toml"), format!("[[formula]]{twin}")).unwrap();
    let data = std::fs::canonicalize(shared.join("practice/p01")).unwrap();
    run(
        &format!(
            "excavator diagnose --model zx30u-arm --catalogue twin.toml --identification {0}/identification \
             --validation {0}/validation --json found.json",
            data.display()
        ),
        folder.path(),
    );
    let found: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("found.json")).unwrap()).unwrap();
    let candidates = found["candidates"].as_array().unwrap();
    let [one, other] = [&candidates[0], &candidates[1]];
    let mut names = [one["effect"].as_str().unwrap(), other["effect"].as_str().unwrap()];
    names.sort_unstable();
    assert_eq!(names, ["own_valve_dead_zone", "valve_dead_zone"]);
    let error = |candidate: &Value| candidate["validation_error_after"].as_f64().unwrap();
    assert!((error(one) / error(other) - 1.0).abs() < 1e-3, "{} {}", error(one), error(other));
    assert!(other["tied_with_first"].as_bool().unwrap());
}
