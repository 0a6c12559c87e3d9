//! `excavator info`

use std::path::Path;

use comfy_table::Cell;
use excavator_bags::can::is_frame_log;
use excavator_bags::map::{Dimension, Origin, TopicMap, read_signals};
use excavator_bags::table::Table as DataTable;
use excavator_bags::{BagError, ColumnInfo, MappedUnit, SignalsInfo, TableInfo, own_definitions};
use excavator_model::display::PressureUnit;
use excavator_model::document::{BUILT_IN, built_in};
use excavator_study::numbers::number;
use rosbag2::{BagInfo, Timing, info_with};
use serde_json::{Value, json};

use crate::cli::InfoArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs, write_json};
use crate::next_step::{NextStep, print_next};
use crate::terminal::{print, right, table};

/// Smallest clock offset that is reported, s: networks and recorders add less.
const NOTABLE_DELAY: f64 = 0.1;

/// Median delay below which stamps are those of another clock, s: nothing is logged before it is made, but some recorders
/// round log times to milliseconds.
const IMPOSSIBLE_DELAY: f64 = -0.002;

pub fn run(arguments: &InfoArguments) -> Result<(), VerbError> {
    let path = &arguments.bag;
    let inputs = Inputs::recordings([path], arguments.map.as_deref());
    files::check(&[arguments.result.output()], &inputs, arguments.result.overwriting)?;
    let is_log = is_frame_log(path);
    let is_table = DataTable::is_table(path) && !is_log;
    if is_table && arguments.map.is_none() && TopicMap::beside(path).is_none() {
        return table_without_map(arguments);
    }
    let origin = Origin { map: arguments.map.as_deref(), namespace: arguments.namespace.as_deref() };
    // Two passes over the bag, one per thread.
    let (bag, signals) = std::thread::scope(|scope| {
        let signals = scope.spawn(|| read_signals(path, origin));
        let is_bag = !is_table && !is_log;
        let bag = is_bag.then(|| info_with(path, own_definitions())).transpose();
        (bag, signals.join())
    });
    let bag = bag?;
    let signals = signals.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    if arguments.result.is_shown() {
        match (&bag, &signals) {
            (Some(bag), _) => show_bag(bag),
            (None, Ok((signals, _))) => {
                let (path, samples) = (path.display(), signals.samples);
                let kind = if is_log { "log of CAN frames" } else { "table" };
                print(&format!("The {kind} {path} has {samples} samples in {:.2} s.", signals.duration));
            }
            (None, Err(_)) => (),
        }
        match &signals {
            Ok((signals, report)) => {
                show_signals(signals, &report.mapped);
                // Damage belongs to the bag, and has been reported already.
                for note in report.notes.iter().chain(bag.is_none().then(|| report.problems()).iter().flatten()) {
                    print(&format!("note: {note}"));
                }
            }
            Err(error) => print(&format!("signals: none read: {error}")),
        }
        match &signals {
            Ok((signals, _)) => print_next(&next(arguments, signals)),
            Err(error) if is_foreign(error) => print_next(&guess(path)),
            Err(_) => (),
        }
    }
    if arguments.result.json.is_some() {
        let signals = signals.as_ref().map(|(signals, _)| signals);
        write_json(&to_json(bag.as_ref(), &signals)?, &arguments.result)?;
    }
    // A bag without our topics is not a failure; an unreadable table or map is.
    match signals {
        Err(error) if bag.is_none() || arguments.map.is_some() => Err(error.into()),
        _ => Ok(()),
    }
}

/// Shows the columns of a table. Without a map it is unknown which signals they are.
fn table_without_map(arguments: &InfoArguments) -> Result<(), VerbError> {
    let info = TableInfo::read(&arguments.bag)?;
    if arguments.result.is_shown() {
        let most = info.columns.iter().map(|column| column.rows).max().unwrap_or_default();
        let (path, columns) = (arguments.bag.display(), info.columns.len());
        print(&format!("The table {path} has {most} rows, {columns} columns and no map."));
        let mut rows = table(&["column", "from", "to", "unit", "not measured"]);
        for column in &info.columns {
            rows.add_row([
                Cell::new(&column.values.name),
                right(bound(column, column.values.least)),
                right(bound(column, column.values.most)),
                Cell::new(column.unit.as_deref().unwrap_or_default()),
                right(share(column.values.missing)),
            ]);
        }
        print(&rows.to_string());
        print(&format!("clock: {}", info.clock));
        info.notes.iter().for_each(|note| print(&format!("note: {note}")));
        print("signals: none; a map says which column is which signal");
        print_next(&guess(&arguments.bag));
    }
    write_json(&serde_json::to_value(&info)?, &arguments.result)
}

/// One end of a column's range.
fn bound(column: &ColumnInfo, value: f64) -> String {
    match jiff::Timestamp::from_microsecond((1e6 * value) as i64) {
        _ if !value.is_finite() => "-".to_string(),
        Ok(stamp) if column.dates => stamp.to_string(),
        _ => number(value),
    }
}

fn share(missing: f64) -> String {
    if missing == 0.0 { String::new() } else { format!("{:.1} %", 100.0 * missing) }
}

/// Whether a bag has foreign topics.
fn is_foreign(error: &BagError) -> bool {
    matches!(error, BagError::NoTopic { .. } | BagError::WrongType { .. })
}

/// The next command for foreign data, whose signals are unknown.
fn guess(data: &Path) -> NextStep {
    let step = NextStep::new("let the program propose a map", "import").word("--guess");
    step.word(data.display().to_string()).new_file("-o", "map.toml")
}

fn to_json(bag: Option<&BagInfo>, signals: &Result<&SignalsInfo, &BagError>) -> Result<Value, VerbError> {
    let mut value = match bag {
        Some(bag) => serde_json::to_value(bag)?,
        None => json!({}),
    };
    value["signals"] = match signals {
        Ok(signals) => serde_json::to_value(signals)?,
        Err(error) => json!({"error": error.to_string()}),
    };
    Ok(value)
}

fn show_bag(bag: &BagInfo) {
    let start = bag.start.and_then(|start| i64::try_from(start / 1_000_000).ok());
    let start = start.and_then(|start| jiff::Timestamp::from_millisecond(start).ok());
    print(&format!(
        "The bag {} has {} messages in {:.2} s{}: {} in {}.",
        bag.path.display(),
        bag.message_count,
        bag.duration,
        start.map_or(String::new(), |start| format!(" from {start}")),
        size(bag.size),
        if bag.files.len() == 1 { "one file".to_string() } else { format!("{} files", bag.files.len()) },
    ));
    let mut topics = table(&["topic", "type", "messages", "rate Hz", "jitter ms", "gaps", "longest gap"]);
    for topic in &bag.topics {
        let timing = topic.timing.as_ref();
        let of = |text: &dyn Fn(&Timing) -> String| right(timing.map_or("-".to_string(), text));
        topics.add_row([
            Cell::new(&topic.name),
            Cell::new(topic.type_name.replacen("/msg/", "/", 1)),
            right(topic.message_count),
            right(topic.mean_rate().map_or("-".to_string(), |rate| format!("{rate:.1}"))),
            of(&|timing| format!("{:.2}", 1e3 * timing.jitter)),
            of(&|timing| timing.gaps.to_string()),
            of(&|timing| match timing.gaps {
                0 => "-".to_string(),
                _ => format!("{} at {:.2} s", seconds(timing.longest_interval), timing.longest_interval_at),
            }),
        ]);
    }
    print(&topics.to_string());
    for problem in &bag.problems {
        print(&format!("problem: {problem}"));
    }
    for lost in &bag.lost {
        let read = bag.topics.iter().find(|topic| topic.name == lost.topic).map(|topic| topic.message_count);
        print(&format!("problem: {}", lost.text(read)));
    }
    for topic in &bag.topics {
        for line in topic.timing.iter().flat_map(clock_problems) {
            print(&format!("clock of {}: {line}", topic.name));
        }
    }
}

/// Problems with the times of a topic, one line each.
fn clock_problems(timing: &Timing) -> Vec<String> {
    let mut lines = Vec::new();
    if timing.log_times_backwards > 0 {
        lines.push(format!("log time steps backwards {} times", timing.log_times_backwards));
    }
    let Some(stamps) = &timing.stamps else { return lines };
    if stamps.zero > 0 {
        lines.push(format!("{} stamps are zero, never set", stamps.zero));
        return lines;
    }
    if stamps.backwards > 0 {
        lines.push(format!("stamps step backwards {} times", stamps.backwards));
    }
    if stamps.repeated > 0 {
        lines.push(format!("{} stamps repeat the one before", stamps.repeated));
    }
    let (least, most) = stamps.delay_range;
    if stamps.median_delay.abs() > NOTABLE_DELAY || stamps.median_delay < IMPOSSIBLE_DELAY {
        let side = if stamps.median_delay > 0.0 { "after" } else { "before" };
        lines.push(format!(
            "messages were logged {} {side} their stamps ({} to {}): {}",
            seconds(stamps.median_delay.abs()),
            seconds(least),
            seconds(most),
            if stamps.median_delay > 0.0 { "they arrived late, or the clocks differ" } else { "the clocks differ" }
        ));
    } else if most - least > NOTABLE_DELAY {
        lines.push(format!("log time minus stamp varies from {} to {}", seconds(least), seconds(most)));
    }
    lines
}

/// Suggests a model for the recording: a built-in one if it has these cylinders, else a new one.
fn next(arguments: &InfoArguments, signals: &SignalsInfo) -> NextStep {
    let mut cylinders: Vec<&str> =
        signals.measured.iter().filter_map(|signal| Some(signal.name.split_once('.')?.0)).collect();
    cylinders.sort_unstable();
    cylinders.dedup();
    let has_these = |name: &&str| {
        built_in(name).is_ok_and(|model| {
            let mut own: Vec<&str> = model.machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
            own.sort_unstable();
            own == cylinders
        })
    };
    match BUILT_IN.iter().map(|(name, _)| *name).find(has_these) {
        Some(model) => {
            let step = NextStep::new("compare a model with it", "compare").word("--model").word(model);
            let step = step.path("--bag", &arguments.bag);
            arguments.map.iter().fold(step, |step, map| step.path("--map", map))
        }
        None => NextStep::new("describe the machine", "model").word("new").new_file("-o", "machine.toml"),
    }
}

fn show_signals(signals: &SignalsInfo, mapped: &[MappedUnit]) {
    print(&format!("signals: {} samples in {:.2} s", signals.samples, signals.duration));
    let mut rows = table(&["signal", "from", "to", "unit", "not measured"]);
    for signal in &signals.measured {
        let (factor, unit) = display_unit(&signal.name, mapped);
        rows.add_row([
            Cell::new(&signal.name),
            right(number(factor * signal.least)),
            right(number(factor * signal.most)),
            Cell::new(unit),
            right(share(signal.missing)),
        ]);
    }
    print(&rows.to_string());
    for equation in &signals.equations {
        let name = &equation.equation;
        match (equation.missing.as_slice(), equation.constant.join(", ")) {
            ([], constant) if constant.is_empty() => print(&format!("{name}: can be identified")),
            ([], constant) => print(&format!("{name}: can be identified on a machine with constant {constant}")),
            (missing, _) => print(&format!("{name}: needs {}", missing.join(", "))),
        }
    }
}

/// Factor from SI, and the unit in which such a signal is displayed. The input of a valve has the unit that the map gives it.
pub(super) fn display_unit(name: &str, mapped: &[MappedUnit]) -> (f64, &'static str) {
    let pressure = (PressureUnit::shown().factor(), PressureUnit::shown().symbol());
    if name.ends_with(".orifice_area") || name.ends_with(".orifice_command") {
        let given = mapped.iter().find(|mapped| mapped.signal.to_string() == name).map(|mapped| mapped.dimension);
        match given {
            None | Some(Dimension::Area) => {}
            Some(Dimension::Pressure) => return pressure,
            Some(other) => return (1.0, other.si_unit()),
        }
    }
    match name.rsplit('.').next().unwrap_or_default() {
        "displacement" => (1e3, "mm"),
        "velocity" => (1e3, "mm/s"),
        "joint_angle" => (180.0 / std::f64::consts::PI, "deg"),
        "orifice_area" | "orifice_command" => (1e6, "mm2"),
        "rod_force" => (1.0, "N"),
        "pump_flow" => (60_000.0, "l/min"),
        "oil_temperature" => (1.0, "degC"),
        _ => pressure,
    }
}

fn size(bytes: u64) -> String {
    match bytes {
        0..1_000_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

fn seconds(value: f64) -> String {
    if value.abs() < 1.0 { format!("{:.1} ms", 1e3 * value) } else { format!("{value:.2} s") }
}
