//! The topics of one file, from its schema and channel records.

use std::collections::HashMap;
use std::sync::Arc;

use mcap::McapError;
use mcap::records::{Record, op};
use thiserror::Error;

use super::record::parsed;
use crate::limits::{Limit, LimitError, ReadLimits};
use crate::raw_message::Topic;

/// Schemas and topics by their ids in the file.
#[derive(Debug)]
pub(super) struct Registry {
    schemas: HashMap<u16, Arc<Schema>>,
    topics: HashMap<u16, Arc<Topic>>,
    /// Bytes of all definitions registered, including replaced ones: messages may still hold them.
    bytes: u64,
    limits: ReadLimits,
}

/// Why a definition is rejected.
#[derive(Debug, Error)]
pub(super) enum DefinitionFault {
    #[error(transparent)]
    Mcap(#[from] McapError),
    #[error(transparent)]
    TooLarge(#[from] LimitError),
}

#[derive(Debug, PartialEq, Eq)]
struct Schema {
    name: String,
    encoding: String,
    text: String,
}

impl Registry {
    pub fn new(limits: &ReadLimits) -> Registry {
        Registry { schemas: HashMap::new(), topics: HashMap::new(), bytes: 0, limits: *limits }
    }

    /// The topic with this id.
    pub fn topic(&self, channel: u16) -> Option<&Arc<Topic>> {
        self.topics.get(&channel)
    }

    /// Every topic defined so far.
    pub fn topics(&self) -> impl Iterator<Item = &Arc<Topic>> {
        self.topics.values()
    }

    /// Registers a schema or channel record; other opcodes are ignored. A repeated definition keeps the first [`Arc`],
    /// so that messages of one topic share it; a different one replaces it.
    pub fn define(&mut self, opcode: u8, content: &[u8]) -> Result<(), DefinitionFault> {
        if opcode != op::SCHEMA && opcode != op::CHANNEL {
            return Ok(());
        }
        match parsed(opcode, content)? {
            Record::Schema { header, data } => {
                let schema = Schema {
                    name: header.name,
                    encoding: header.encoding,
                    text: String::from_utf8_lossy(&data).into_owned(),
                };
                if self.schemas.get(&header.id).is_none_or(|known| **known != schema) {
                    self.count(schema.text.len(), &schema.name)?;
                    self.schemas.insert(header.id, Arc::new(schema));
                }
            }
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id);
                let topic = Topic {
                    name: channel.topic,
                    type_name: schema.map(|schema| schema.name.clone()).unwrap_or_default(),
                    schema_encoding: schema.map(|schema| schema.encoding.clone()).unwrap_or_default(),
                    schema: schema.map(|schema| schema.text.clone()).unwrap_or_default(),
                    message_encoding: channel.message_encoding,
                    offered_qos_profiles: channel.metadata.get("offered_qos_profiles").cloned().unwrap_or_default(),
                };
                if self.topics.get(&channel.id).is_none_or(|known| **known != topic) {
                    self.count(topic.schema.len() + topic.offered_qos_profiles.len(), &topic.name)?;
                    self.topics.insert(channel.id, Arc::new(topic));
                }
            }
            _ => {}
        }
        Ok(())
    }
    /// Counts a definition; every topic has its own copy of the definition of its type.
    fn count(&mut self, text: usize, name: &str) -> Result<(), LimitError> {
        let bytes = self.bytes + (text + name.len()) as u64;
        Limit::Definitions.check(bytes, self.limits.definitions)?;
        self.bytes = bytes;
        Ok(())
    }
}
