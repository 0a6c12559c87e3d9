//! `excavator start`

use std::path::{Path, PathBuf};

use clap::FromArgMatches;
use excavator_bags::map::{Origin, read_recording_or_mapped};
use excavator_bags::table::Table;
use excavator_study::sheet::Sheet;

use crate::cli::{Arguments, StartArguments, Verb};
use crate::error::VerbError;
use crate::manual;
use crate::next_step::steps_follow;
use crate::ros_words::RosWords;
use crate::terminal::{command, print, print_text, width};

/// From the tables of a bench and its data sheet to a verdict. Every step is a verb, printed so that it can be repeated.
pub fn run(arguments: &StartArguments) -> Result<(), VerbError> {
    let sheet = Sheet::read(&arguments.sheet)?;
    if sheet.option("drive").is_none() && sheet.option("drop").is_some() {
        return valve_test(arguments, &sheet);
    }
    if sheet.option("drive").as_deref() == Some("position") {
        return position_test(arguments);
    }
    std::fs::create_dir_all(&arguments.to).map_err(VerbError::write(&arguments.to))?;
    print(&format!(
        "From {} and {} to a verdict. Every step is a command that can be repeated; its files go to {}.",
        counted(arguments.data.len(), "recording"),
        arguments.sheet.display(),
        arguments.to.display()
    ));
    steps_follow(true);
    let Files { model, map, steady, report, study } = Files::in_folder(&arguments.to);
    step(
        "a model from the data sheet",
        Words::verb("model").word("new").words(sheet.words()).path("-o", &model).forced(arguments),
    )?;
    let first = arguments.data.first().map(PathBuf::as_path).unwrap_or(Path::new(""));
    let is_mapped = Table::is_table(first);
    if is_mapped {
        step(
            "a map of the columns",
            Words::verb("import")
                .file(first)
                .word("--guess")
                .path("--model", &model)
                .path("--sheet", &arguments.sheet)
                .path("-o", &map)
                .forced(arguments),
        )?;
    }
    let mapped = |words: Words| if is_mapped { words.path("--map", &map) } else { words };
    let all = arguments.data.iter().fold(Words::verb("characterise"), |words, data| words.file(data));
    step(
        "what steady stretches tell, without a simulation",
        mapped(all.path("--model", &model)).path("-o", &steady).forced(arguments),
    )?;
    let [fitted, judging] = parts(&arguments.data, is_mapped.then_some(&*map))?;
    let compared = judging.first().cloned().unwrap_or_default();
    step(
        "the model beside the measurement",
        mapped(Words::verb("compare").path("--model", &steady).path("--bag", &compared)),
    )?;
    steps_follow(false);
    let diagnose = Words::verb("diagnose").path("--model", &steady).files("--identification", &fitted);
    let diagnose = mapped(diagnose.files("--validation", &judging)).word("--leave-out-stops");
    step("what the model lacks", diagnose.path("--report", &report).path("--save", &study).forced(arguments))
}

fn counted(number: usize, one: &str) -> String {
    if number == 1 { format!("{number} {one}") } else { format!("{number} {one}s") }
}

/// What the steps write.
struct Files {
    model: PathBuf,
    map: PathBuf,
    steady: PathBuf,
    report: PathBuf,
    study: PathBuf,
}

impl Files {
    fn in_folder(folder: &Path) -> Self {
        let file = |name: &str| folder.join(name);
        Files {
            model: file("model.toml"),
            map: file("map.toml"),
            steady: file("steady.toml"),
            report: file("report.html"),
            study: file("study.json"),
        }
    }
}

/// Recordings for the fit and for validation: all but the last, and the last. A single one is cut in halves.
fn parts(data: &[PathBuf], map: Option<&Path>) -> Result<[Vec<PathBuf>; 2], VerbError> {
    match data.split_last() {
        Some((only, [])) => {
            let (recording, _) = read_recording_or_mapped(only, Origin { map, namespace: None })?;
            let middle = (5.0 * recording.duration()).round() / 10.0;
            let half = |part: String| PathBuf::from(format!("{}@{part}", only.display()));
            Ok([vec![half(format!("..{middle}"))], vec![half(format!("{middle}.."))]])
        }
        Some((last, others)) => Ok([others.to_vec(), vec![last.clone()]]),
        None => Ok([Vec::new(), Vec::new()]),
    }
}

/// A table of a static valve test has its own verb.
fn valve_test(arguments: &StartArguments, sheet: &Sheet) -> Result<(), VerbError> {
    print("The data sheet is that of a static valve test: flow against input at a known pressure drop.");
    arguments.data.iter().try_for_each(|data| {
        let words = Words::verb("model").word("valve").path("--table", data).words(sheet.words());
        step("the static test of a valve", words)
    })
}

/// A drive under its own position controller has reference and position only.
fn position_test(arguments: &StartArguments) -> Result<(), VerbError> {
    print("The data sheet is that of a drive under its own position controller: reference and position, no pressures.");
    let words = Words::verb("model").word("position");
    let words = match arguments.data.split_last() {
        Some((last, [])) => words.files("--identification", std::slice::from_ref(last)),
        Some((last, others)) => {
            words.files("--identification", others).files("--validation", std::slice::from_ref(last))
        }
        None => words,
    };
    step("a model from reference to position", words)
}

/// A command under construction.
struct Words(Vec<String>);

impl Words {
    fn verb(verb: &str) -> Self {
        Words(vec!["excavator".to_string(), verb.to_string()])
    }

    fn word(self, word: &str) -> Self {
        self.words([word.to_string()])
    }

    fn words(mut self, words: impl IntoIterator<Item = String>) -> Self {
        self.0.extend(words);
        self
    }

    fn file(self, path: &Path) -> Self {
        self.words([path.display().to_string()])
    }

    fn path(self, option: &str, path: &Path) -> Self {
        self.word(option).file(path)
    }

    fn files(self, option: &str, paths: &[PathBuf]) -> Self {
        paths.iter().fold(self.word(option), |words, path| words.file(path))
    }

    fn forced(self, arguments: &StartArguments) -> Self {
        if arguments.overwriting.force { self.word("--force") } else { self }
    }
}

/// Prints a command and runs it.
fn step(what: &str, words: Words) -> Result<(), VerbError> {
    print(&format!("\n{}{}:", what[..1].to_uppercase(), &what[1..]));
    print_text(&command(&words.0, width()));
    let parsed = manual::command().try_get_matches_from(&words.0);
    let arguments = parsed.and_then(|found| Arguments::from_arg_matches(&found));
    let refused = |refusal: clap::Error| {
        let reason = refusal.to_string();
        let line = reason.lines().next().unwrap_or_default().trim_start_matches("error: ");
        VerbError::Sheet(format!("{line}; keys of a data sheet are the options of `excavator model new`"))
    };
    match arguments.map_err(refused)?.verb {
        Verb::Start(_) => Ok(()),
        verb => super::run(verb, &RosWords::split(&[])?.0),
    }
}
