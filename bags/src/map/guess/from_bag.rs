//! Finds the candidates in a bag.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use rosbag2::dynamic::{FieldPath, Index, Layout, Selector, numeric_leaves};
use rosbag2::{RawMessages, Topic};

use super::super::clock_source::ClockSource;
use super::super::signal::SignalKind;
use super::super::unit::{Dimension, Unit};
use super::candidate::{Candidate, Found, Origin, words};
use crate::can::FrameReader;
use crate::{BagError, own_definitions};

/// Maximum number of fields examined per topic.
const FIELD_LIMIT: usize = 64;
/// Maximum number of messages examined per topic.
const MESSAGE_LIMIT: usize = 20_000;
/// Parts of paths that are never signals.
const NO_SIGNALS: [&str; 10] =
    ["header", "stamp", "covariance", "variance", "seq", "layout", "nanosec", "orientation", "quaternion", "angular"];
/// Types that never carry signals of a cylinder.
const NO_SIGNAL_TYPES: [&str; 5] = ["Imu", "BatteryState", "Log", "DiagnosticArray", "Clock"];

/// The data of one topic read so far.
struct Seen {
    layout: Layout,
    fields: Vec<(FieldPath, Selector)>,
    time: Vec<f64>,
    values: Vec<Vec<f64>>,
}

/// The fields that may be signals, the clock, and topics of CAN frames, which are opaque without their DBC file.
pub(super) fn candidates(path: &Path) -> Result<Found, BagError> {
    let mut frames: Vec<String> = Vec::new();
    let mut topics: HashMap<String, (Arc<Topic>, Option<Seen>)> = HashMap::new();
    let mut start = None;
    for message in RawMessages::open(path)? {
        let message = message?;
        let start = *start.get_or_insert(message.log_time);
        let topic = Arc::clone(&message.topic);
        let (_, seen) = topics.entry(topic.name.clone()).or_insert_with(|| {
            let seen = look_at(&topic, &message.data).filter(|seen| {
                let is_of_frames = FrameReader::of(&seen.layout).is_ok();
                if is_of_frames {
                    frames.push(format!(
                        "{} (CAN frames: the map needs `dbc`, and each signal its `message`)",
                        topic.name
                    ));
                }
                !is_of_frames
            });
            (topic, seen)
        });
        let Some(seen) = seen.as_mut().filter(|seen| seen.time.len() < MESSAGE_LIMIT) else { continue };
        if seen.layout.check(&message.data).is_err() {
            continue;
        }
        seen.time.push((message.log_time as f64 - start as f64) / 1e9);
        for ((_, selector), values) in seen.fields.iter().zip(&mut seen.values) {
            values.push(selector.read(&seen.layout, &message.data).ok().flatten().unwrap_or(f64::NAN));
        }
    }
    let mut topics: Vec<(Arc<Topic>, Seen)> =
        topics.into_values().filter_map(|(topic, seen)| Some((topic, seen?))).collect();
    topics.sort_by(|(a, _), (b, _)| a.name.cmp(&b.name));
    let fastest = topics.iter().max_by_key(|(_, seen)| seen.time.len()).map(|(topic, _)| topic.name.clone());
    let clock = ClockSource { topic: fastest, ..ClockSource::default() };
    let candidates = topics.into_iter().flat_map(|(topic, seen)| of_topic(&topic, seen)).collect();
    let clock = (clock, "the topic with numbers that has most messages".to_string());
    Ok(Found { candidates, clock, unreadable: frames })
}

/// Layout and fields of a topic; `None` if its type is unknown.
fn look_at(topic: &Topic, message: &[u8]) -> Option<Seen> {
    if NO_SIGNAL_TYPES.contains(&topic.type_name.rsplit('/').next().unwrap_or_default()) {
        return None;
    }
    let layout = Layout::of_topic(topic, own_definitions()).ok()?;
    layout.check(message).ok()?;
    let leaves = numeric_leaves(&layout, message).ok()?;
    let fields: Vec<(FieldPath, Selector)> = leaves
        .into_iter()
        .filter(|path| !path.steps().iter().any(|step| NO_SIGNALS.iter().any(|part| step.field.contains(part))))
        .take(FIELD_LIMIT)
        .filter_map(|path| {
            let selector = Selector::number(&layout, &path).ok()?;
            Some((path, selector))
        })
        .collect();
    let values = vec![Vec::new(); fields.len()];
    (!fields.is_empty()).then_some(Seen { layout, fields, time: Vec::new(), values })
}

fn of_topic(topic: &Topic, seen: Seen) -> Vec<Candidate> {
    let fields = seen.fields.into_iter().zip(seen.values);
    fields
        .map(|((field, _), values)| {
            let text = field.to_string();
            let (dimension, unit) = by_type(&topic.type_name, &text);
            // The definition requires absolute pressures in Pa; values that are all below 1 kPa show that the bag does
            // not follow it.
            let is_fluid = topic.type_name.ends_with("/FluidPressure") && values.iter().any(|&value| value > 1e3);
            let unit = match unit.and_then(Unit::named) {
                Some(unit) => Some((unit, format!("{} is defined so", topic.type_name))),
                None if is_fluid => {
                    let why = "FluidPressure is defined in Pa and absolute; if it is, add offset = \"-1 atm\"";
                    Some((Unit::si(Dimension::Pressure), why.to_string()))
                }
                None => None,
            };
            Candidate {
                words: words(&format!("{} {}", topic.name, spoken(&field))),
                origin: Origin::Field { topic: topic.name.clone(), field },
                unit,
                dimension,
                time: seen.time.clone(),
                values,
                filled: 1.0,
            }
        })
        .collect()
}

/// Dimension of a field of a common type, and its unit if that is fixed.
fn by_type(type_name: &str, field: &str) -> (Option<Dimension>, Option<&'static str>) {
    let name = type_name.rsplit('/').next().unwrap_or_default();
    if type_name.starts_with("excavator_msgs/") {
        // Our own type, in SI; its fields have the names of the signals.
        let last = field.rsplit('.').next().unwrap_or_default();
        let kind = SignalKind::ALL.into_iter().find(|kind| kind.name() == last);
        let dimension = kind.map(SignalKind::dimension).or(last.starts_with("areas").then_some(Dimension::Area));
        return (dimension, dimension.map(Dimension::si_unit));
    }
    match (name, field.split(['[', '.']).next().unwrap_or_default()) {
        ("FluidPressure", _) => (Some(Dimension::Pressure), None),
        ("Temperature", _) => (Some(Dimension::Temperature), Some("degC")),
        // A prismatic joint is in m, a revolute one in rad: only the numbers can distinguish them.
        ("JointState", "velocity") => (Some(Dimension::Velocity), None),
        ("JointState", "effort") => (Some(Dimension::Force), None),
        ("WrenchStamped" | "Wrench", _) if field.contains("force") => (Some(Dimension::Force), Some("N")),
        _ => (None, None),
    }
}

/// The names in a path, without indices, which carry no information.
fn spoken(field: &FieldPath) -> String {
    let names = field.steps().iter().map(|step| match &step.index {
        Some(Index::Named { value, .. }) => format!("{} {value}", step.field),
        _ => step.field.clone(),
    });
    names.collect::<Vec<_>>().join(" ")
}
