//! A new user's way through the program: every screen begins with a sentence and ends with the command that comes next, which is
//! pasted into a shell as it stands.

use std::path::{Path, PathBuf};
use std::process::Command;

use excavator_bags::{Topics, read_recording, write_recording};
use rosbag2::WriteOptions;
use serde_json::Value;

fn samples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../bags/samples/hidden-law").canonicalize().unwrap()
}

/// What a command line prints in `folder`; it must succeed.
fn shell(line: &str, folder: &Path) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_excavator")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let done = Command::new("sh").args(["-c", line]).current_dir(folder).env("PATH", path).output().unwrap();
    assert!(done.status.success(), "{line}\n{}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).unwrap()
}

/// The last command that a screen offers.
fn next(screen: &str) -> String {
    let (_, after) = screen.rsplit_once("\nNext, ").unwrap_or_else(|| panic!("no next step in\n{screen}"));
    let (_, command) = after.split_once(":\n").unwrap();
    command.trim().to_string()
}

/// The first seconds of both samples: a search through all of them takes two minutes.
fn shortened(folder: &Path) {
    for (name, duration) in [("identification", 8.0), ("validation", 5.0)] {
        let (recording, _) = read_recording(&samples().join(name), &Topics::default()).unwrap();
        let start = recording.time[0];
        let part = recording.part(start, start + duration);
        write_recording(&folder.join(name), &part, &Topics::default(), &WriteOptions::default()).unwrap();
    }
}

/// "falls from A to B (C times smaller)" of a sentence.
fn change(sentence: &str) -> &str {
    let start = sentence.find("falls from").unwrap_or_else(|| panic!("no change of error in: {sentence}"));
    let end = start + sentence[start..].find(')').unwrap() + 1;
    &sentence[start..end]
}

#[test]
fn quiet_says_nothing_and_verbose_more() {
    let folder = tempfile::tempdir().unwrap();
    let compare = |word: &str| {
        shell(
            &format!("excavator compare {word} --model zx30u-arm --bag {}/validation", samples().display()),
            folder.path(),
        )
    };
    assert_eq!(compare("--quiet"), "");
    let (normal, verbose) = (compare(""), compare("--verbose"));
    assert!(!normal.contains("autocorrelation") && verbose.contains("autocorrelation"));
    // What was asked for as text is written all the same.
    assert!(shell("excavator model urdf --model zx30u-arm --quiet", folder.path()).contains("<robot"));
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    #[test]
    fn each_screen_leads_to_the_next() {
        let folder = tempfile::tempdir().unwrap();
        shortened(folder.path());
        let mut command = "excavator info identification".to_string();
        let mut verbs = Vec::new();
        for _ in 0..4 {
            let screen = shell(&command, folder.path());
            verbs.push(command.split_whitespace().nth(1).unwrap().to_string());
            command = next(&screen);
        }
        assert_eq!(verbs, ["info", "compare", "diagnose", "propose"], "then {command}");
    }

    #[test]
    fn a_saved_diagnosis_is_added_without_another_search() {
        let folder = tempfile::tempdir().unwrap();
        let data = samples();
        std::fs::write(
            folder.path().join("law.toml"),
            "[[formula]]\nname = \"load_damping\"\nacts_on = \"piston_force\"\nformula = \"-k*v*abs(p_cap - p_rod)\"\n\
             parameters.k = { unit = \"N s/(m Pa)\", maximum = 1.0, start = [1e-3] }\n",
        )
        .unwrap();
        let diagnose = format!(
            "excavator diagnose --model zx30u-arm --catalogue law.toml --identification {0}/identification --validation {0}/validation \
             --save found.json --json scores.json --report page.html",
            data.display()
        );
        let screen = shell(&diagnose, folder.path());
        let sentence = screen.lines().next().unwrap();
        assert!(sentence.starts_with("Missing in zx30u-arm: load damping at the arm cylinder."), "{sentence}");
        let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
        assert!(page.contains(change(sentence)), "the page says another number than\n{sentence}");

        let refine = next(&screen);
        assert_eq!(refine, "excavator refine --diagnosis found.json -o refined.toml");
        let refined = shell(&refine, folder.path());
        assert_eq!(change(refined.lines().next().unwrap()), change(sentence));
        let model = std::fs::read_to_string(folder.path().join("refined.toml")).unwrap();
        assert!(model.contains("load_damping") && model.contains("added load_damping@arm"), "{model}");

        // The comparison that comes next has the number of the sentence, and so has the JSON of the diagnosis.
        let compare = format!("{} --json compared.json", next(&refined));
        shell(&compare, folder.path());
        let read = |name: &str| -> Value {
            serde_json::from_str(&std::fs::read_to_string(folder.path().join(name)).unwrap()).unwrap()
        };
        let after = read("compared.json")["mean_nmse"].as_f64().unwrap();
        let said: f64 = change(sentence).split_whitespace().nth(4).unwrap().parse().unwrap();
        assert!((said / after - 1.0).abs() < 0.01, "{said} was said, {after} is compared");
        let error = read("scores.json")["validation_error"]["after"].as_f64().unwrap();
        assert!((error / after - 1.0).abs() < 1e-3, "{error} is in the JSON, {after} is compared");
    }
}
