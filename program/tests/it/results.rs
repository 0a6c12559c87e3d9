//! What `--json` writes is what the schemas of the results say, and the schemas are those of the program.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{complaint, excavator, json};
use boon::{Compiler, Schemas};
use excavator_identification::results;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

const REPOSITORY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

fn sample(name: &str) -> String {
    Path::new(REPOSITORY).join("bags/samples").join(name).display().to_string()
}

/// Whether a result is as the schema of that name says.
fn is_valid(name: &str, result: &Value) -> Result<(), String> {
    let file = format!("{name}.schema.json");
    let text = fs::read_to_string(Path::new(REPOSITORY).join("config/results").join(&file)).unwrap();
    let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
    compiler.add_resource(&file, serde_json::from_str(&text).unwrap()).unwrap();
    let schema = compiler.compile(&file, &mut schemas).unwrap();
    schemas.validate(result, schema).map_err(|error| format!("{error:#}"))
}

/// Checks what a command printed as JSON against its schema, and that nothing of it is lost when it is read and written.
fn checked<T: Serialize + DeserializeOwned>(name: &str, folder: &Path, words: &[&str]) -> Value {
    let found = json(&excavator(folder, &[words, &["--json", "-"]].concat()));
    is_valid(name, &found).unwrap_or_else(|error| panic!("{}: {error}", words.join(" ")));
    let read: T = serde_json::from_value(found.clone()).unwrap();
    assert_eq!(serde_json::to_value(read).unwrap(), found, "{}", words.join(" "));
    found
}

#[test]
fn schemas_are_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let output = excavator(folder.path(), &["manual", "schemas", "--to", "schemas"]);
    assert!(output.status.success(), "{}", complaint(&output));
    let files = |folder: PathBuf| {
        let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files
    };
    let stored = files(Path::new(REPOSITORY).join("config/results"));
    let written = files(folder.path().join("schemas"));
    let names = |files: &[PathBuf]| files.iter().map(|file| file.file_name().unwrap().to_owned()).collect::<Vec<_>>();
    let advice = "write config/results anew: excavator manual schemas --to config/results";
    assert_eq!(names(&stored), names(&written), "{advice}");
    for (one, other) in stored.iter().zip(&written) {
        assert!(fs::read_to_string(one).unwrap() == fs::read_to_string(other).unwrap(), "{}: {advice}", one.display());
    }
}

#[test]
fn energy_and_characteristics_of_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    let bag = sample("hidden-law/validation");
    checked::<results::Energy>("energy", folder.path(), &["energy", "--model", "zx30u-arm", "--bag", &bag]);
    for bag in ["hidden-law/validation", "arm-swing"].map(sample) {
        let words = ["characterise", "--model", "zx30u-arm", &bag];
        checked::<results::Characterisation>("characterise", folder.path(), &words);
    }
    let [table, map, rig] =
        ["O-ring_3bar.csv", "map.toml", "rig.toml"].map(|name| sample(&format!("seal-friction/{name}")));
    let words = ["characterise", &table, "--map", &map, "--model", &rig];
    checked::<results::Characterisation>("characterise", folder.path(), &words);
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    #[test]
    fn verdicts_and_what_follows_from_them() {
        let folder = tempfile::tempdir().unwrap();
        // Halves of one recording: the form of a verdict does not depend on what it says.
        let [identification, validation] = ["@..5", "@5..10"].map(|part| sample("hidden-law/validation") + part);
        let recordings = ["--model", "zx30u-arm", "--identification", &identification, "--validation", &validation];
        let of = |words: &[&'static str]| [words, &recordings[..]].concat();
        let found = checked::<results::Diagnosis>("diagnose", folder.path(), &of(&["diagnose"]));
        assert!(found["missing_power"][0]["source"].is_string());
        checked::<results::Proposals>("propose", folder.path(), &of(&["propose"]));
        let words = of(&["refine", "--add", "hose_loss", "-o", "refined.toml"]);
        let found = checked::<results::Refinement>("refine", folder.path(), &words);
        assert_eq!(found["model"], "refined.toml");
    }

    #[test]
    fn designs() {
        let folder = tempfile::tempdir().unwrap();
        let words = ["design", "--model", "zx30u-arm", "--duration", "20", "-o"];
        let between = [&words[..], &["pair.toml", "--between", "valve_lag@arm,sensor_delay@arm"]].concat();
        let found = checked::<results::Separation>("design-separation", folder.path(), &between);
        assert_eq!(found["profile"], "pair.toml");
        let parameter = [&words[..], &["parameter.toml", "--parameter", "arm.inertia"]].concat();
        let found = checked::<results::Determination>("design-determination", folder.path(), &parameter);
        assert_eq!(found["parameter"], "arm.inertia");
    }

    #[test]
    fn parameters_and_errors_of_a_recording() {
        let folder = tempfile::tempdir().unwrap();
        let (bag, other) = (sample("hidden-law/identification"), sample("hidden-law/validation"));
        for method in ["weak-form", "least-squares", "output-error"] {
            let words = ["identify", "--model", "zx30u-arm", "--method", method, "--bag", &bag];
            let found = checked::<results::Identification>("identify", folder.path(), &words);
            assert!(!found["parameters"].as_array().unwrap().is_empty());
        }
        let words = ["compare", "--model", "zx30u-arm", "--bag", &bag, "--against", "zx30u-arm", "--repeat", &other];
        let compared = checked::<results::Comparison>("compare", folder.path(), &words);
        assert_eq!(compared["against"]["mean_nmse"], compared["mean_nmse"]);

        // A key less is no result.
        let mut less = compared;
        less.as_object_mut().unwrap().remove("mean_nmse");
        assert!(is_valid("compare", &less).is_err());
    }
}
