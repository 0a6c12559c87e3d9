//! The times of one message, and which of them a signal uses.

use rosbag2::RawMessage;
use rosbag2::cdr::CdrError;
use rosbag2::dynamic::{Kind, Layout, PathError, Selector};

use super::clock_source::Stamp;

/// What [`Stamp::Auto`] stands for in one reading of a bag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Auto {
    /// The stamp in the header where there is one that is not zero, else the log time.
    #[default]
    Header,
    /// The log time of every message: the one clock that all topics have.
    Log,
}

/// When a message was received, and when its header says that it was made, ns.
#[derive(Debug, Clone, Copy)]
pub(super) struct MessageTimes {
    pub log: i64,
    /// `None` for a type without header.
    pub header: Option<i64>,
}

impl MessageTimes {
    /// `header` selects the stamp in the header.
    pub fn of(header: Option<&Selector>, layout: &Layout, message: &RawMessage) -> Result<MessageTimes, CdrError> {
        let log = i64::try_from(message.log_time).unwrap_or(i64::MAX);
        let header = header.map_or(Ok(None), |selector| selector.read_time(layout, &message.data))?;
        Ok(MessageTimes { log, header })
    }

    /// The stamp in the header, unless it was never set.
    pub fn set_header(&self) -> Option<i64> {
        self.header.filter(|&stamp| stamp != 0)
    }
}

/// Selects the stamp in the header of a type that has one.
pub(super) fn header_selector(layout: &Layout) -> Result<Option<Selector>, PathError> {
    let members = layout.structure(0).map_or(&[][..], |structure| &structure.members);
    let has_header = members.iter().any(|member| {
        member.name == "header"
            && matches!(member.kind, Kind::Struct(number)
                if layout.structure(number).is_some_and(|structure| structure.name == "std_msgs/Header"))
    });
    if has_header { Ok(Some(Selector::time(layout, &"header.stamp".parse()?)?)) } else { Ok(None) }
}

/// Which time of a message is used.
#[derive(Debug, Clone, Default)]
pub(super) struct StampReader {
    policy: Stamp,
    auto: Auto,
    /// For a time that is not the usual one of the header.
    selector: Option<Selector>,
}

impl StampReader {
    pub fn new(policy: &Stamp, auto: Auto) -> StampReader {
        StampReader { policy: policy.clone(), auto, selector: None }
    }

    pub fn policy(&self) -> &Stamp {
        &self.policy
    }

    /// Resolves the time in a definition.
    pub fn prepare(&mut self, layout: &Layout) -> Result<(), PathError> {
        self.selector = match &self.policy {
            Stamp::Log | Stamp::Auto => None,
            Stamp::Header => Some(Selector::time(layout, &"header.stamp".parse()?)?),
            Stamp::Field(path) => Some(Selector::time(layout, &path.parse()?)?),
        };
        Ok(())
    }

    pub fn read(&self, times: MessageTimes, layout: &Layout, message: &RawMessage) -> Result<i64, CdrError> {
        match (&self.selector, &self.policy, self.auto) {
            (Some(selector), ..) => Ok(selector.read_time(layout, &message.data)?.unwrap_or(times.log)),
            (None, Stamp::Auto, Auto::Header) => Ok(times.set_header().unwrap_or(times.log)),
            (None, ..) => Ok(times.log),
        }
    }
}
