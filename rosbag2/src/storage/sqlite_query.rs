//! Queries the tables of a SQLite3 bag for topics and messages.

use std::collections::HashMap;
use std::sync::Arc;

use rusqlite::types::ValueRef;

use super::sqlite_connection::{Bounded, SqliteFault};
use crate::limits::{Limit, LimitError, ReadLimits};
use crate::raw_message::Topic;

/// One row of the table of messages.
#[derive(Debug)]
pub(super) struct Row {
    pub id: i64,
    pub topic: i64,
    pub timestamp: i64,
    /// `None` if the column is not a blob.
    pub data: Option<Vec<u8>>,
}

/// The topics by id, with their definitions, which databases since version 4 have.
pub(super) fn topics(database: &Bounded) -> Result<HashMap<i64, Arc<Topic>>, SqliteFault> {
    for table in ["topics", "messages"] {
        if !database.is_table(table)? {
            return Err(SqliteFault::NoTable(table));
        }
    }
    let definitions = definitions(database)?;
    let has_qos = "SELECT count(*) FROM pragma_table_info('topics') WHERE name = 'offered_qos_profiles'";
    let has_qos = database.ask(|connection| connection.query_row(has_qos, [], |row| row.get::<_, i64>(0)))? > 0;
    let qos = if has_qos { "offered_qos_profiles" } else { "''" };
    let question = format!("SELECT id, name, type, serialization_format, {qos} FROM topics LIMIT ?1");
    let mut room = Room::of(database);
    database
        .ask(|connection| {
            let mut topics = HashMap::new();
            let mut statement = connection.prepare(&question)?;
            let mut rows = statement.query([room.most_rows()])?;
            while let Some(row) = rows.next()? {
                let type_name = text(row.get_ref(2)?);
                let (schema_encoding, schema) = definitions.get(&type_name).cloned().unwrap_or_default();
                let topic = Topic {
                    name: text(row.get_ref(1)?),
                    message_encoding: text(row.get_ref(3)?),
                    offered_qos_profiles: text(row.get_ref(4)?),
                    type_name,
                    schema_encoding,
                    schema,
                };
                if !room.takes(&[&topic.name, &topic.offered_qos_profiles, &topic.type_name, &topic.schema]) {
                    break;
                }
                topics.insert(row.get(0)?, Arc::new(topic));
            }
            Ok(topics)
        })
        .and_then(|topics| room.checked(topics))
}

/// Encoding and text of each type's definition; empty for databases before version 4.
fn definitions(database: &Bounded) -> Result<HashMap<String, (String, String)>, SqliteFault> {
    if !database.is_table("message_definitions")? {
        return Ok(HashMap::new());
    }
    let question = "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions LIMIT ?1";
    let mut room = Room::of(database);
    let found = database.ask(|connection| {
        let mut definitions = HashMap::new();
        let mut statement = connection.prepare(question)?;
        let mut rows = statement.query([room.most_rows()])?;
        while let Some(row) = rows.next()? {
            let [name, encoding, definition] = [text(row.get_ref(0)?), text(row.get_ref(1)?), text(row.get_ref(2)?)];
            if !room.takes(&[&name, &definition]) {
                break;
            }
            definitions.insert(name, (encoding, definition));
        }
        Ok(definitions)
    });
    match found {
        Ok(definitions) => room.checked(definitions),
        // Without definitions the messages are still readable: their types may be known.
        Err(SqliteFault::Sqlite(_)) => Ok(HashMap::new()),
        Err(other) => Err(other),
    }
}

/// The remaining limits for the rows of a table of definitions.
struct Room {
    limits: ReadLimits,
    rows: usize,
    bytes: u64,
    fault: Option<LimitError>,
}

impl Room {
    fn of(database: &Bounded) -> Room {
        Room { limits: *database.limits(), rows: 0, bytes: 0, fault: None }
    }

    /// Rows to query: one more than allowed, to detect that there are more.
    fn most_rows(&self) -> i64 {
        i64::try_from(self.limits.fields).unwrap_or(i64::MAX).saturating_add(1)
    }

    /// Counts a row of texts; `false` if a limit is exceeded.
    fn takes(&mut self, texts: &[&String]) -> bool {
        let length = |text: &&String| text.len() as u64;
        self.rows += 1;
        self.bytes = self.bytes.saturating_add(texts.iter().map(length).sum());
        let checked = Limit::Fields
            .check(self.rows as u64, self.limits.fields as u64)
            .and_then(|()| Limit::Definitions.check(self.bytes, self.limits.definitions));
        self.fault = checked.err();
        self.fault.is_none()
    }

    fn checked<T>(&self, found: T) -> Result<T, SqliteFault> {
        self.fault.map_or(Ok(found), |fault| Err(fault.into()))
    }
}

fn text(value: ValueRef) -> String {
    match value {
        ValueRef::Text(bytes) | ValueRef::Blob(bytes) => String::from_utf8_lossy(bytes).into_owned(),
        _ => String::new(),
    }
}

/// Passes the rows from id `first` on to `take`, in order, until it returns `false`; then returns `Ok(false)`, or
/// `Ok(true)` after the last row. Ordered by row id, not by time: that is the order of the table itself, so nothing is
/// sorted and a damaged index has no effect.
pub(super) fn rows_from(
    database: &Bounded,
    first: i64,
    mut take: impl FnMut(Row) -> bool,
) -> Result<bool, SqliteFault> {
    database.ask(|connection| {
        let mut statement = connection
            .prepare_cached("SELECT rowid, topic_id, timestamp, data FROM messages WHERE rowid >= ?1 ORDER BY rowid")?;
        let mut rows = statement.query([first])?;
        let mut least = first;
        while let Some(row) = rows.next()? {
            let data = match row.get_ref(3)? {
                ValueRef::Blob(bytes) | ValueRef::Text(bytes) => Some(bytes.to_vec()),
                _ => None,
            };
            let number = |column: usize| row.get_ref(column).map(|value| value.as_i64().unwrap_or(-1));
            let row = Row { id: number(0)?, topic: number(1)?, timestamp: number(2)?, data };
            // A damaged B-tree can contain a cycle: without this check, reading would never end.
            if row.id < least {
                let corrupt = rusqlite::ffi::Error::new(rusqlite::ffi::SQLITE_CORRUPT);
                return Err(rusqlite::Error::SqliteFailure(corrupt, Some("its rows are out of order".to_string())));
            }
            least = row.id.saturating_add(1);
            if !take(row) {
                return Ok(false);
            }
        }
        Ok(true)
    })
}

/// The largest row id.
pub(super) fn last_row(database: &Bounded) -> Result<Option<i64>, SqliteFault> {
    database.ask(|connection| connection.query_row("SELECT max(rowid) FROM messages", [], |row| row.get(0)))
}
