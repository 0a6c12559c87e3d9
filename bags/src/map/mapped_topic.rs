//! One topic of a bag from which signals are read.

use std::path::Path;
use std::sync::Arc;

use rosbag2::cdr::CdrError;
use rosbag2::dynamic::{Definitions, FieldPath, Kind, Layout, Selector};
use rosbag2::{RawMessage, RawMessages, Topic};

use super::assemble::Input;
use super::clock_source::Stamp;
use super::conversion::Conversion;
use super::error::MapError;
use super::wanted::Wanted;
use crate::BagError;
use crate::can::{DataFrame, Database, FrameReader, Identifier, Place};
use crate::reading::ReadReport;

/// One topic from which signals are read.
#[derive(Default)]
pub(super) struct MappedTopic<'m> {
    pub name: String,
    fields: Vec<MappedField<'m>>,
    clock_stamp: StampReader,
    /// Stamps of its messages, ns. For CAN frames one list per wanted identifier, since a bus carries more than the
    /// mapped frames.
    stamps: Vec<(Option<Identifier>, Vec<i64>)>,
    /// The definition for which the selectors were resolved, with its layout.
    layout: Option<(Arc<Topic>, Layout)>,
    frames: Option<FrameReader>,
    seen: u64,
    undecodable: u64,
    first_undecodable: Option<BagError>,
    /// Frames of a wanted message that are too short for its signals.
    short_frames: u64,
}

struct MappedField<'m> {
    wanted: Wanted<'m>,
    conversion: Conversion,
    stamp: StampReader,
    at: At,
    samples: Vec<(i64, f64)>,
}

/// The position of the number.
enum At {
    /// In a field of the message.
    Field(FieldPath, Option<Selector>),
    /// In the data of a CAN frame.
    Frame(Box<Place>),
}

impl<'m> MappedTopic<'m> {
    pub fn new(name: &str) -> MappedTopic<'m> {
        MappedTopic { name: name.to_string(), ..MappedTopic::default() }
    }

    /// Adds a field, or a signal of a frame.
    ///
    /// # Errors
    /// [`MapError::NoDbc`], [`MapError::Dbc`], and those of the conversion.
    pub fn want(&mut self, wanted: Wanted<'m>, database: Option<&Database>) -> Result<(), MapError> {
        let Some(field) = wanted.from.field.clone() else { return Ok(()) };
        let label = || wanted.label.clone();
        let (at, unit) = match &wanted.from.message {
            None => (At::Field(field, None), None),
            Some(message) => {
                let database = database.ok_or_else(|| MapError::NoDbc { place: label() })?;
                let dbc = |reason| MapError::Dbc { place: format!("{}: dbc", label()), reason };
                let place = database.place(message, &field.to_string()).map_err(dbc)?;
                let unit = Some(place.unit().to_string()).filter(|unit| !unit.trim().is_empty());
                (At::Frame(Box::new(place)), unit)
            }
        };
        let conversion = wanted.conversion(unit.as_deref())?;
        self.fields.push(MappedField { wanted, conversion, stamp: StampReader::default(), at, samples: Vec::new() });
        Ok(())
    }

    /// Sets which stamp is used if this topic is the clock.
    pub fn set_clock_stamp(&mut self, policy: &Stamp) {
        self.clock_stamp = StampReader { policy: policy.clone(), selector: None };
    }

    /// The stamps of the topic; for CAN frames those of the most frequent wanted frame.
    pub fn stamps(&self) -> &[i64] {
        self.stamps.iter().map(|(_, stamps)| &stamps[..]).max_by_key(|stamps| stamps.len()).unwrap_or_default()
    }

    /// The samples read.
    pub fn into_inputs(self) -> impl Iterator<Item = Input<'m>> {
        self.fields.into_iter().map(|field| Input::read(field.wanted, field.conversion, field.samples))
    }

    /// Reads the numbers of one message. Returns the bytes of memory that they take.
    ///
    /// # Errors
    /// Errors of [`MappedTopic::prepare`]; a message that cannot be read is only counted.
    pub fn take(&mut self, path: &Path, message: &RawMessage, extra: &Definitions) -> Result<u64, BagError> {
        if !self.layout.as_ref().is_some_and(|(topic, _)| Arc::ptr_eq(topic, &message.topic)) {
            self.prepare(path, &message.topic, extra)?;
        }
        let index = self.seen;
        self.seen += 1;
        let taken = self.read(message).unwrap_or_else(|error| {
            self.undecodable += 1;
            self.first_undecodable.get_or_insert_with(|| BagError::Undecodable {
                path: path.to_path_buf(),
                topic: self.name.to_string(),
                index,
                bytes: message.data.len(),
                reason: error.to_string(),
            });
            0
        });
        Ok((taken * size_of::<(i64, f64)>()) as u64)
    }

    /// Resolves every field in the topic definition of this file.
    fn prepare(&mut self, path: &Path, topic: &Arc<Topic>, extra: &Definitions) -> Result<(), BagError> {
        if topic.message_encoding != "cdr" {
            let (path, format) = (path.to_path_buf(), topic.message_encoding.clone());
            return Err(rosbag2::Error::UnsupportedSerialization { path, topic: self.name.to_string(), format }.into());
        }
        let layout = Layout::of_topic(topic, extra)
            .map_err(|source| MapError::Layout { topic: self.name.to_string(), source })?;
        self.frames = FrameReader::of(&layout).ok();
        for mapped in &mut self.fields {
            let signal = mapped.wanted.label.clone();
            let wrong = |source| MapError::Field { signal: signal.clone(), topic: topic.name.clone(), source };
            match &mut mapped.at {
                At::Field(field, selector) => *selector = Some(Selector::number(&layout, field).map_err(wrong)?),
                At::Frame(_) if self.frames.is_none() => {
                    let (topic, type_name) = (topic.name.clone(), topic.type_name.clone());
                    return Err(MapError::NoFrames { place: signal.clone(), topic, type_name }.into());
                }
                At::Frame(_) => {}
            }
            mapped.stamp = StampReader { policy: mapped.wanted.from.stamp.clone(), selector: None };
            mapped.stamp.prepare(&layout).map_err(wrong)?;
        }
        self.clock_stamp.prepare(&layout).map_err(|source| MapError::Field {
            signal: "[clock]".to_string(),
            topic: topic.name.clone(),
            source,
        })?;
        self.layout = Some((Arc::clone(topic), layout));
        Ok(())
    }

    /// Reads nothing from a message that does not fit its definition completely. Returns how many numbers and times
    /// were read.
    fn read(&mut self, message: &RawMessage) -> Result<usize, CdrError> {
        let Some((_, layout)) = &self.layout else {
            return Ok(0);
        };
        layout.check(&message.data)?;
        let is_of_frames = self.fields.iter().any(|field| matches!(field.at, At::Frame(_)));
        let frame = match (&self.frames, is_of_frames) {
            (Some(reader), true) => reader.read(layout, &message.data)?,
            _ => None,
        };
        let mut is_wanted = !is_of_frames;
        let mut is_short = false;
        let mut taken = 0;
        for mapped in &mut self.fields {
            let number = match (&mapped.at, &frame) {
                (At::Field(_, Some(selector)), _) => {
                    is_wanted = true;
                    selector.read(layout, &message.data)?
                }
                (At::Frame(place), Some(DataFrame { identifier, data })) if place.identifier() == *identifier => {
                    is_wanted = true;
                    let number = place.is_selected(data).then(|| place.value(data));
                    is_short |= number == Some(None);
                    number.flatten()
                }
                _ => None,
            };
            if let Some(number) = number {
                let stamp = mapped.stamp.read(layout, message)?.saturating_add(mapped.wanted.shift());
                mapped.samples.push((stamp, number));
                taken += 1;
            }
        }
        self.short_frames += u64::from(is_short);
        if is_wanted {
            let stamp = self.clock_stamp.read(layout, message)?;
            let of = frame.filter(|_| is_of_frames).map(|frame| frame.identifier);
            match self.stamps.iter_mut().find(|(known, _)| *known == of) {
                Some((_, stamps)) => stamps.push(stamp),
                None => self.stamps.push((of, vec![stamp])),
            }
            taken += 1;
        }
        Ok(taken)
    }

    /// Adds what could not be decoded to the report; a topic without any readable message is an error.
    ///
    /// # Errors
    /// [`BagError::NoMessages`], [`BagError::NoTopic`], [`BagError::Undecodable`].
    pub fn finish(&mut self, messages: &RawMessages, report: &mut ReadReport) -> Result<(), BagError> {
        if self.seen == 0 {
            let (path, topic) = (messages.path().to_path_buf(), self.name.to_string());
            let existing: Vec<String> = messages.topics().iter().map(|topic| topic.name.clone()).collect();
            return Err(if existing.contains(&topic) {
                let damage = report.damage.iter().map(ToString::to_string).collect();
                BagError::NoMessages { path, topic, damage }
            } else {
                BagError::NoTopic { path, topic, existing }
            });
        }
        if let Some(error) = self.first_undecodable.take() {
            if self.undecodable == self.seen {
                return Err(error);
            }
            report.undecodable += self.undecodable;
            report.first_undecodable.get_or_insert_with(|| error.to_string());
        }
        if self.short_frames > 0 {
            let (topic, count) = (&self.name, self.short_frames);
            report.notes.push(format!("{topic}: {count} frames are shorter than their message in the DBC file"));
        }
        Ok(())
    }
}

/// Which stamp of a message is used.
#[derive(Debug, Clone, Default)]
struct StampReader {
    policy: Stamp,
    selector: Option<Selector>,
}

impl StampReader {
    fn prepare(&mut self, layout: &Layout) -> Result<(), rosbag2::dynamic::PathError> {
        self.selector = match &self.policy {
            Stamp::Log => None,
            Stamp::Auto if !has_header(layout) => None,
            Stamp::Auto | Stamp::Header => Some(Selector::time(layout, &"header.stamp".parse()?)?),
            Stamp::Field(path) => Some(Selector::time(layout, &path.parse()?)?),
        };
        Ok(())
    }

    fn read(&self, layout: &Layout, message: &RawMessage) -> Result<i64, CdrError> {
        let log_time = i64::try_from(message.log_time).unwrap_or(i64::MAX);
        let Some(selector) = &self.selector else {
            return Ok(log_time);
        };
        let stamp = selector.read_time(layout, &message.data)?;
        let unset = self.policy == Stamp::Auto && stamp == Some(0);
        Ok(stamp.filter(|_| !unset).unwrap_or(log_time))
    }
}

fn has_header(layout: &Layout) -> bool {
    let members = layout.structure(0).map_or(&[][..], |structure| &structure.members);
    members.iter().any(|member| {
        member.name == "header"
            && matches!(member.kind, Kind::Struct(number)
                if layout.structure(number).is_some_and(|structure| structure.name == "std_msgs/Header"))
    })
}
