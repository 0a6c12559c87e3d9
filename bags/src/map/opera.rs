//! The built-in map `opera`: excavators of the open interface OPERA, by their COM3 frames or by its topics.
//!
//! Signals are found by names inside the messages, because topics, order and units differ between machines, gateways and simulators.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;

use rosbag2::Topic;
use rosbag2::dynamic::{FieldPath, Index, Layout, Selector, numeric_leaves};

use super::clock_source::{ClockSource, Stamp};
use super::document::TopicMap;
use super::error::MapError;
use super::messages::Messages;
use super::named::NamedColumn;
use super::signal::{SignalKind, SignalName};
use super::signal_source::{Resampling, SignalSource};
use crate::can::{Database, FrameReader};
use crate::{BagError, own_definitions};

/// Name of the map.
pub const OPERA: &str = "opera";
/// The built-in DBC file of its frames.
const COM3: &str = "com3";
/// Messages of each topic that are looked at, and messages of all of them.
const LOOKED_AT: usize = 50;
const MOST: usize = 50_000;
/// Pressures that are all below this are in MPa, whatever the type of the message says: a hydraulic system with less has no pressure.
const LARGEST_MPA: f64 = 100.0;
/// Axes that have a signal of their own.
const AXES: [&str; 4] = ["swing", "boom", "arm", "bucket"];

/// What a name inside a message stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Meaning {
    Joint(&'static str),
    /// Pressure in the chamber that extends the cylinder, or in the other one. Port a of the swing motor counts as the first: with
    /// it the machine swings to the right.
    Chamber(&'static str, bool),
    /// Pilot pressure that opens the valve to that chamber.
    Pilot(&'static str, bool),
    OilTemperature,
}

impl Meaning {
    /// The meaning of a name in frames, in the frame of a pressure, as a label of an array, or of a joint.
    fn of(name: &str) -> Option<Meaning> {
        // A simulator writes `arm_crowed_main_pressure`.
        let name = name.rsplit('/').next().unwrap_or(name).to_lowercase().replace("crowed", "crowd");
        if name == "hydraulic_oil_temp" {
            return Some(Meaning::OilTemperature);
        }
        let axis = AXES.into_iter().find(|axis| name.starts_with(&format!("{axis}_")))?;
        let rest = &name[axis.len() + 1..];
        if ["joint", "relative_angle"].contains(&rest) {
            return Some(Meaning::Joint(axis));
        }
        let rest = rest.strip_suffix("_pressure").or_else(|| rest.strip_suffix("_prs"))?;
        let extends = |side: &str| match side {
            "up" | "crowd" | "right" => Some(true),
            "down" | "dump" | "left" => Some(false),
            _ => None,
        };
        if let Some(side) = rest.strip_suffix("_pilot") {
            return Some(Meaning::Pilot(axis, extends(side)?));
        }
        match rest {
            "cylinder_bottom" | "motor_a" => Some(Meaning::Chamber(axis, true)),
            "cylinder_rod" | "motor_b" => Some(Meaning::Chamber(axis, false)),
            _ => Some(Meaning::Chamber(axis, extends(rest.strip_suffix("_main")?)?)),
        }
    }

    /// The signal; `None` for a pilot pressure, of which two make one.
    fn signal(self) -> Option<SignalName> {
        let (cylinder, kind) = match self {
            Meaning::Joint(axis) => (Some(axis.to_string()), SignalKind::JointAngle),
            Meaning::Chamber(axis, true) => (Some(axis.to_string()), SignalKind::CapPressure),
            Meaning::Chamber(axis, false) => (Some(axis.to_string()), SignalKind::RodPressure),
            Meaning::OilTemperature => (None, SignalKind::OilTemperature),
            Meaning::Pilot(..) => return None,
        };
        Some(SignalName { cylinder, kind })
    }

    /// Name of a pilot pressure in formulas, as COM3 calls it.
    fn name(axis: &str, extends: bool) -> String {
        let sides = match axis {
            "boom" => ["down", "up"],
            "swing" => ["left", "right"],
            _ => ["dump", "crowd"],
        };
        format!("{axis}_{}_pilot_pressure", sides[usize::from(extends)])
    }
}

/// Where a meaning is found.
#[derive(Debug, Clone, PartialEq)]
struct Found {
    topic: String,
    field: FieldPath,
    message: Option<String>,
    unit: Option<&'static str>,
    stamp: Stamp,
    /// Messages of the topic that were looked at.
    messages: usize,
}

/// The map of the bag or log at `path`. Of several machines, `namespace` says which.
///
/// # Errors
/// Those of reading a bag; [`BagError::SeveralMachines`]; [`MapError::NoOpera`].
pub(super) fn map(path: &Path, namespace: Option<&str>) -> Result<TopicMap, BagError> {
    let looks = look(path)?;
    let database = Database::read(Path::new(COM3)).map_err(|reason| MapError::Dbc { place: COM3.into(), reason })?;
    let frames: Vec<(Meaning, Found)> =
        looks.iter().flat_map(|look| look.frames(&database)).flatten().collect::<Vec<_>>();
    let by_frames = !frames.is_empty();
    let found = if by_frames { frames } else { looks.iter().flat_map(Look::fields).collect() };
    // Frames have no namespace.
    let found = if by_frames { found } else { of_one_machine(path, found, namespace)? };
    let mut chosen: BTreeMap<Meaning, Found> = BTreeMap::new();
    for (meaning, found) in found {
        match chosen.get(&meaning) {
            Some(known) if known.messages >= found.messages => {}
            _ => {
                chosen.insert(meaning, found);
            }
        }
    }
    if chosen.is_empty() {
        let topics = looks.iter().map(|look| look.topic.name.clone()).collect();
        return Err(MapError::NoOpera { path: path.to_path_buf(), topics }.into());
    }
    Ok(document(&chosen, by_frames))
}

fn document(chosen: &BTreeMap<Meaning, Found>, by_frames: bool) -> TopicMap {
    let mut map = TopicMap {
        description: "excavator with the interface OPERA".to_string(),
        dbc: by_frames.then(|| COM3.into()),
        ..TopicMap::default()
    };
    let clock = chosen.iter().find(|(meaning, _)| matches!(meaning, Meaning::Joint(_))).or(chosen.iter().next());
    if let Some((_, found)) = clock {
        map.clock = ClockSource { topic: Some(found.topic.clone()), stamp: found.stamp.clone(), ..Default::default() };
    }
    for (meaning, found) in chosen {
        let Found { topic, field, message, unit, stamp, .. } = found.clone();
        let unit = unit.map(str::to_string);
        match (meaning.signal(), meaning) {
            (Some(signal), _) => map.signals.push(SignalSource {
                topic: Some(topic),
                field: Some(field),
                message,
                unit,
                stamp,
                // It comes more slowly than all else.
                resample: (*meaning == Meaning::OilTemperature).then_some(Resampling::Hold),
                ..SignalSource::new(signal)
            }),
            (None, Meaning::Pilot(axis, extends)) => {
                let unit = unit.or(Some("MPa".to_string()));
                let column =
                    NamedColumn { topic: Some(topic), field: Some(field), message, unit, stamp, ..Default::default() };
                map.names.insert(Meaning::name(axis, *extends), column);
            }
            (None, _) => {}
        }
    }
    for axis in AXES {
        let [against, towards] = [false, true].map(|extends| Meaning::name(axis, extends));
        let formula = match (map.names.contains_key(&towards), map.names.contains_key(&against)) {
            (true, true) => format!("{towards} - {against}"),
            (true, false) => towards,
            (false, true) => format!("-{against}"),
            (false, false) => continue,
        };
        let signal = SignalName { cylinder: Some(axis.to_string()), kind: SignalKind::OrificeCommand };
        let (formula, unit) = (Some(formula), Some("Pa".to_string()));
        map.signals.push(SignalSource { formula, unit, ..SignalSource::new(signal) });
    }
    map
}

/// Keeps what one machine publishes.
fn of_one_machine(
    path: &Path,
    found: Vec<(Meaning, Found)>,
    namespace: Option<&str>,
) -> Result<Vec<(Meaning, Found)>, BagError> {
    let of = |topic: &str| topic.rsplit_once('/').map_or("", |(parent, _)| parent).to_string();
    let mut namespaces: Vec<String> = found.iter().map(|(_, found)| of(&found.topic)).collect();
    namespaces.sort();
    namespaces.dedup();
    let wanted = match (namespace, namespaces.as_slice()) {
        (Some(namespace), _) => format!("/{}", namespace.trim_matches('/')).trim_end_matches('/').to_string(),
        (None, [] | [_]) => return Ok(found),
        (None, _) => return Err(BagError::SeveralMachines { path: path.to_path_buf(), namespaces }),
    };
    Ok(found.into_iter().filter(|(_, found)| of(&found.topic) == wanted).collect())
}

/// The first messages of one topic.
struct Look {
    topic: Arc<Topic>,
    layout: Layout,
    messages: Vec<bytes::Bytes>,
}

fn look(path: &Path) -> Result<Vec<Look>, BagError> {
    let mut looks: HashMap<String, Option<Look>> = HashMap::new();
    for message in Messages::open(path)?.take(MOST) {
        let message = message?;
        let look = looks.entry(message.topic.name.clone()).or_insert_with(|| {
            let topic = Arc::clone(&message.topic);
            let layout = Layout::of_topic(&topic, own_definitions()).ok()?;
            Some(Look { topic, layout, messages: Vec::new() })
        });
        let Some(look) = look else { continue };
        // Many messages of a bus pass before each has come.
        let limit = if FrameReader::of(&look.layout).is_ok() { MOST } else { LOOKED_AT };
        if look.messages.len() < limit && look.layout.check(&message.data).is_ok() {
            look.messages.push(message.data);
        }
    }
    let mut looks: Vec<Look> = looks.into_values().flatten().collect();
    looks.sort_by(|a, b| a.topic.name.cmp(&b.topic.name));
    Ok(looks)
}

impl Look {
    /// Signals of the frames of COM3 that came.
    fn frames(&self, database: &Database) -> Option<Vec<(Meaning, Found)>> {
        let reader = FrameReader::of(&self.layout).ok()?;
        let frames = self.messages.iter().filter_map(|message| reader.read(&self.layout, message).ok().flatten());
        let mut came: Vec<_> = frames.map(|frame| frame.identifier).collect();
        came.sort_unstable_by_key(|identifier| (identifier.extended, identifier.number));
        came.dedup();
        let found = database.all_signals().into_iter().filter_map(|(message, signal)| {
            let meaning = Meaning::of(&signal)?;
            let place = database.place(&message, &signal).ok()?;
            came.iter().any(|&identifier| place.is_in(identifier)).then_some(())?;
            let field = signal.parse().ok()?;
            let (topic, messages) = (self.topic.name.clone(), self.messages.len());
            Some((meaning, Found { topic, field, message: Some(message), unit: None, stamp: Stamp::Auto, messages }))
        });
        Some(found.collect())
    }

    /// Signals among the fields, by name.
    fn fields(&self) -> Vec<(Meaning, Found)> {
        let mut paths: Vec<FieldPath> = Vec::new();
        for message in &self.messages {
            for path in numeric_leaves(&self.layout, message).unwrap_or_default() {
                if !paths.contains(&path) {
                    paths.push(path);
                }
            }
        }
        let found = paths.into_iter().filter_map(|path| Some((self.meaning(&path)?, path)));
        let found: Vec<(Meaning, FieldPath)> = found.collect();
        let largest = found.iter().filter(|(meaning, _)| !matches!(meaning, Meaning::Joint(_)));
        let largest = largest.map(|(_, path)| self.largest(path)).fold(0.0, f64::max);
        found
            .into_iter()
            .map(|(meaning, field)| {
                let unit = match meaning {
                    Meaning::Joint(_) | Meaning::OilTemperature => None,
                    // A FluidPressure is in Pa by its definition, an array in MPa by the gateway that writes it.
                    _ if largest > LARGEST_MPA => Some("Pa"),
                    _ if largest > 0.0 || !self.topic.type_name.contains("FluidPressure") => Some("MPa"),
                    _ => Some("Pa"),
                };
                let (topic, messages, stamp) = (self.topic.name.clone(), self.messages.len(), self.stamp(&field));
                (meaning, Found { topic, field, message: None, unit, stamp, messages })
            })
            .collect()
    }

    fn meaning(&self, path: &FieldPath) -> Option<Meaning> {
        let mut names = path.steps().iter().rev().filter_map(|step| match &step.index {
            Some(Index::Named { value, .. }) => Some((step.field.as_str(), value)),
            _ => None,
        });
        let (field, name) = names.next()?;
        let meaning = Meaning::of(name)?;
        let is_value = match meaning {
            Meaning::Joint(_) => field == "position",
            _ => field == "data" || path.steps().last().is_some_and(|step| step.field == "fluid_pressure"),
        };
        is_value.then_some(meaning)
    }

    fn largest(&self, path: &FieldPath) -> f64 {
        let Ok(selector) = Selector::number(&self.layout, path) else { return 0.0 };
        let values = self.messages.iter().filter_map(|message| selector.read(&self.layout, message).ok().flatten());
        values.fold(0.0, |most: f64, value| most.max(value.abs()))
    }

    /// The stamp beside an element of an array, if the message itself has none and this one is set.
    fn stamp(&self, field: &FieldPath) -> Stamp {
        let [array, _] = field.steps() else { return Stamp::Auto };
        let beside = FieldPath::from_steps(vec![array.clone()]).map(|array| format!("{array}.header.stamp"));
        let is_set = |path: &String| {
            let selector = path.parse().ok().and_then(|path| Selector::time(&self.layout, &path).ok());
            selector.is_some_and(|selector| {
                let stamps = self.messages.iter().map(|message| selector.read_time(&self.layout, message));
                stamps.filter_map(Result::ok).flatten().any(|stamp| stamp != 0)
            })
        };
        beside.filter(is_set).map_or(Stamp::Auto, Stamp::Field)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_all_sources_are_understood() {
        for (name, meaning) in [
            ("boom_joint", Some(Meaning::Joint("boom"))),
            ("swing_relative_angle", Some(Meaning::Joint("swing"))),
            ("bucket_end_joint", None),
            ("arm_cylinder_bottom_pressure", Some(Meaning::Chamber("arm", true))),
            ("arm_crowed_main_pressure", Some(Meaning::Chamber("arm", true))),
            ("arm_dump_main_pressure", Some(Meaning::Chamber("arm", false))),
            ("swing_motor_b_pressure", Some(Meaning::Chamber("swing", false))),
            ("boom_down_pilot_pressure", Some(Meaning::Pilot("boom", false))),
            ("zx200/bucket_crowd_pilot_prs", Some(Meaning::Pilot("bucket", true))),
            ("boom_up", None),
            ("boom_cylinder_rod_flow_rate", None),
            ("right_track_forward_pilot_prs", None),
            ("hydraulic_oil_temp", Some(Meaning::OilTemperature)),
        ] {
            assert_eq!(Meaning::of(name), meaning, "{name}");
        }
    }
}
