//! One topic of a bag from which signals are read.

use std::path::Path;
use std::sync::Arc;

use rosbag2::cdr::CdrError;
use rosbag2::dynamic::{Definitions, FieldPath, Layout, Selector};
use rosbag2::{RawMessage, Topic};

use super::assemble::Input;
use super::channels::{Beside, Channels};
use super::clock_source::Stamp;
use super::conversion::Conversion;
use super::error::MapError;
use super::least_delays::LeastDelays;
use super::message_times::{Auto, MessageTimes, StampReader, header_selector};
use super::messages::Messages;
use super::wanted::Wanted;
use crate::BagError;
use crate::can::{DataFrame, Database, FrameReader, Identifier, OtherSender, Place, Senders};
use crate::reading::ReadReport;

/// One topic from which signals are read.
#[derive(Default)]
pub(super) struct MappedTopic<'m> {
    pub name: String,
    fields: Vec<MappedField<'m>>,
    clock_stamp: StampReader,
    /// Stamps in the headers, if the type has one.
    header: Option<Selector>,
    /// How long after their stamps the messages were received.
    delays: LeastDelays,
    /// Messages without stamp: of a type without header, or with a stamp of zero.
    unstamped: u64,
    auto: Auto,
    /// Stamps of its messages, ns. For CAN frames one list per wanted identifier, since a bus carries more than the
    /// mapped frames.
    stamps: Vec<(Option<Identifier>, Vec<i64>)>,
    /// The channels of the topic, in the order of the bag, and the number of the one of the last message.
    channels: Vec<Arc<Topic>>,
    channel: usize,
    /// The definition for which the selectors were resolved, with its layout.
    layout: Option<(Arc<Topic>, Layout)>,
    frames: Option<FrameReader>,
    seen: u64,
    undecodable: u64,
    first_undecodable: Option<BagError>,
    /// Frames of a wanted message that are too short for its signals.
    short_frames: u64,
    senders: Senders,
}

struct MappedField<'m> {
    wanted: Wanted<'m>,
    conversion: Conversion,
    stamp: StampReader,
    at: At,
    samples: Vec<(i64, f64)>,
    channels: Channels,
    /// Messages without its element.
    absent: u64,
    /// Values outside the range of the DBC file, such as the codes for a fault and for what is not available.
    out_of_range: u64,
}

/// How a signal, or the clock, is stamped.
pub(super) struct StampUse<'t> {
    pub policy: &'t Stamp,
    /// Added to the stamps, ns.
    pub shift: i64,
}

/// The position of the number.
enum At {
    /// In a field of the message.
    Field(FieldPath, Option<Selector>),
    /// In the data of a CAN frame.
    Frame(Box<Place>),
}

impl<'m> MappedTopic<'m> {
    /// A topic whose stamps are read with this meaning of [`Stamp::Auto`].
    pub fn new(name: &str, auto: Auto) -> MappedTopic<'m> {
        MappedTopic { name: name.to_string(), auto, ..MappedTopic::default() }
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
        let stamp = StampReader::new(&wanted.from.stamp, self.auto);
        let channels = Channels::default();
        self.fields.push(MappedField {
            wanted,
            conversion,
            stamp,
            at,
            samples: Vec::new(),
            channels,
            absent: 0,
            out_of_range: 0,
        });
        Ok(())
    }

    /// Sets which stamp is used if this topic is the clock.
    pub fn set_clock_stamp(&mut self, policy: &Stamp) {
        self.clock_stamp = StampReader::new(policy, self.auto);
    }

    /// The signals and names that are read from it.
    pub fn labels(&self) -> Vec<String> {
        self.fields.iter().map(|field| field.wanted.label.clone()).collect()
    }

    /// Log time minus stamp of its messages.
    pub fn delays(&self) -> &LeastDelays {
        &self.delays
    }

    /// Messages whose only time is the log time.
    pub fn unstamped(&self) -> u64 {
        self.unstamped
    }

    /// For each signal, the channels beside another one with more values.
    pub fn beside_others(&self) -> Vec<(String, Beside)> {
        let of = |field: &MappedField| {
            let label = field.wanted.label.clone();
            field.channels.beside_others().into_iter().map(move |beside| (label.clone(), beside)).collect::<Vec<_>>()
        };
        self.fields.iter().flat_map(of).collect()
    }

    /// Leaves the values of a signal out that come through these channels.
    pub fn leave_out(&mut self, left_out: &[(String, usize)]) {
        for field in &mut self.fields {
            let own = left_out.iter().filter(|(label, _)| *label == field.wanted.label);
            field.channels.left_out = own.map(|(_, number)| *number).collect();
        }
    }

    /// How each of its signals with samples is stamped, and the topic itself if it is the clock.
    pub fn stamp_uses(&self, is_clock: bool) -> Vec<StampUse<'_>> {
        let with_samples = self.fields.iter().filter(|field| !field.samples.is_empty());
        let signals = with_samples.map(|field| StampUse { policy: field.stamp.policy(), shift: field.wanted.shift() });
        let clock = StampUse { policy: self.clock_stamp.policy(), shift: 0 };
        signals.chain(is_clock.then_some(clock)).collect()
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
        self.find_channel(&message.topic);
        let is_prepared =
            |(topic, _): &(Arc<Topic>, Layout)| Arc::ptr_eq(topic, &message.topic) || *topic == message.topic;
        if !self.layout.as_ref().is_some_and(is_prepared) {
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

    /// Sets the number of the channel; publishers that a recorder tells apart have channels of their own.
    fn find_channel(&mut self, topic: &Arc<Topic>) {
        if self.channels.get(self.channel).is_some_and(|current| Arc::ptr_eq(current, topic)) {
            return;
        }
        self.channel = self.channels.iter().position(|known| Arc::ptr_eq(known, topic)).unwrap_or_else(|| {
            self.channels.push(Arc::clone(topic));
            self.channels.len() - 1
        });
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
            mapped.stamp.prepare(&layout).map_err(wrong)?;
        }
        let of_clock = |source| MapError::Field { signal: "[clock]".to_string(), topic: topic.name.clone(), source };
        self.clock_stamp.prepare(&layout).map_err(of_clock)?;
        self.header = header_selector(&layout).map_err(of_clock)?;
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
        let times = MessageTimes::of(self.header.as_ref(), layout, message)?;
        let is_of_frames = self.fields.iter().any(|field| matches!(field.at, At::Frame(_)));
        let frame = match (&self.frames, is_of_frames) {
            (Some(reader), true) => reader.read(layout, &message.data)?,
            _ => None,
        };
        // The message of the DBC file that the frame carries, by this topic's own sender of it.
        let known = frame.and_then(|frame| {
            self.fields.iter().find_map(|field| match &field.at {
                At::Frame(place) if place.is_in(frame.identifier) => Some(place.identifier()),
                _ => None,
            })
        });
        if let (Some(frame), Some(known)) = (frame, known)
            && !self.senders.takes(known, frame.identifier, times.log)
        {
            return Ok(0);
        }
        let mut is_wanted = !is_of_frames;
        let mut is_short = false;
        let (mut taken, mut left_out) = (0, 0);
        for mapped in &mut self.fields {
            let number = match (&mapped.at, &frame) {
                (At::Field(_, Some(selector)), _) => {
                    is_wanted = true;
                    let number = selector.read(layout, &message.data)?;
                    mapped.absent += u64::from(number.is_none());
                    number
                }
                (At::Frame(place), Some(DataFrame { identifier, data })) if place.is_in(*identifier) => {
                    is_wanted = true;
                    let number = place.is_selected(data).then(|| place.value(data));
                    is_short |= number == Some(None);
                    let is_possible =
                        |value: &f64| place.range().is_none_or(|(least, most)| (least..=most).contains(value));
                    mapped.out_of_range += u64::from(number.flatten().is_some_and(|value| !is_possible(&value)));
                    number.flatten().filter(is_possible)
                }
                _ => None,
            };
            if let Some(number) = number {
                if mapped.channels.left_out.contains(&self.channel) {
                    left_out += 1;
                    continue;
                }
                mapped.channels.note(self.channel, times.log);
                let stamp = mapped.stamp.read(times, layout, message)?.saturating_add(mapped.wanted.shift());
                mapped.samples.push((stamp, number));
                taken += 1;
            }
        }
        self.short_frames += u64::from(is_short);
        // A message of which all is left out is no sample of the clock either.
        if is_wanted && (taken > 0 || left_out == 0) {
            match times.set_header() {
                Some(stamp) => self.delays.note(times.log, stamp),
                None => self.unstamped += 1,
            }
            let stamp = self.clock_stamp.read(times, layout, message)?;
            let of = known.filter(|_| is_of_frames);
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
    pub fn finish(&mut self, messages: &Messages, report: &mut ReadReport) -> Result<(), BagError> {
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
        for field in &self.fields {
            let (label, topic, seen) = (&field.wanted.label, &self.name, self.seen);
            if field.out_of_range > 0 {
                let count = field.out_of_range;
                report.notes.push(format!(
                    "{label}: {count} values outside the range of the DBC file are not measured: codes for a fault or a missing sensor"
                ));
            }
            if (1..seen).contains(&field.absent) {
                let count = field.absent;
                report.notes.push(format!(
                    "{label}: {count} of {seen} messages of {topic} have no such element: another publisher writes other names on it"
                ));
            }
        }
        for OtherSender { used, other, frames } in self.senders.others() {
            report.notes.push(format!(
                "{}: two senders of one message, addresses 0x{used:02X} and 0x{other:02X}; the first is used, {frames} frames of others are left out",
                self.name
            ));
        }
        Ok(())
    }
}
