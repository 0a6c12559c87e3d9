//! The tables of a SQLite3 bag: how its topics and messages are asked for.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use rusqlite::types::ValueRef;
use rusqlite::{Connection, OpenFlags};

use crate::raw_messages::Topic;

/// One row of the table of messages.
#[derive(Debug)]
pub(super) struct Row {
    pub id: i64,
    pub topic: i64,
    pub timestamp: i64,
    /// `None` when the column holds no bytes.
    pub data: Option<Vec<u8>>,
}

/// Opens a database for reading, also one that was cut, or whose writer left a journal behind that only a writer may
/// play back.
pub(super) fn connect(path: &Path) -> rusqlite::Result<Connection> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    match Connection::open_with_flags(path, flags).and_then(prepared) {
        Ok(connection) => Ok(connection),
        Err(_) => {
            let name = format!("file:{}?immutable=1", uri_path(path));
            prepared(Connection::open_with_flags(name, flags | OpenFlags::SQLITE_OPEN_URI)?)
        }
    }
}

/// Sets the connection up and makes sure that it answers.
fn prepared(connection: Connection) -> rusqlite::Result<Connection> {
    // Nothing is written. This is the switch by which SQLite reads a file that is shorter than its header says.
    connection.pragma_update(None, "writable_schema", true)?;
    connection.query_row("SELECT count(*) FROM sqlite_master", [], |_| Ok(()))?;
    Ok(connection)
}

/// A path as it stands in a `file:` address.
fn uri_path(path: &Path) -> String {
    let mut text = String::new();
    for character in path.to_string_lossy().chars() {
        match character {
            '%' => text.push_str("%25"),
            '?' => text.push_str("%3f"),
            '#' => text.push_str("%23"),
            other => text.push(other),
        }
    }
    text
}

/// The topics by their numbers, with the definitions that databases since version 4 have.
pub(super) fn topics(connection: &Connection) -> rusqlite::Result<HashMap<i64, Arc<Topic>>> {
    let definitions = definitions(connection).unwrap_or_default();
    let has_qos = has_column(connection, "topics", "offered_qos_profiles")?;
    let qos = if has_qos { "offered_qos_profiles" } else { "''" };
    let mut statement =
        connection.prepare(&format!("SELECT id, name, type, serialization_format, {qos} FROM topics"))?;
    let topics = statement.query_map([], |row| {
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
        Ok((row.get(0)?, Arc::new(topic)))
    })?;
    topics.collect()
}

/// Encoding and text of each type's definition.
fn definitions(connection: &Connection) -> rusqlite::Result<HashMap<String, (String, String)>> {
    let mut statement =
        connection.prepare("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions")?;
    let rows =
        statement.query_map([], |row| Ok((text(row.get_ref(0)?), (text(row.get_ref(1)?), text(row.get_ref(2)?)))))?;
    rows.collect()
}

fn has_column(connection: &Connection, table: &str, column: &str) -> rusqlite::Result<bool> {
    let wanted = "SELECT count(*) FROM pragma_table_info(?1) WHERE name = ?2";
    connection.query_row(wanted, [table, column], |row| row.get::<_, i64>(0)).map(|count| count > 0)
}

fn text(value: ValueRef) -> String {
    match value {
        ValueRef::Text(bytes) | ValueRef::Blob(bytes) => String::from_utf8_lossy(bytes).into_owned(),
        _ => String::new(),
    }
}

/// Hands the rows from number `first` on to `take`, in their order, until it returns `false`; then `Ok(false)`, and
/// `Ok(true)` after the last row. By row number, not by time: that is the order of the table itself, so nothing is
/// sorted and a broken index does no harm.
pub(super) fn rows_from(
    connection: &Connection,
    first: i64,
    mut take: impl FnMut(Row) -> bool,
) -> rusqlite::Result<bool> {
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
        // A broken tree can lead back to where it has been: without this, reading it would never end.
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
}

/// The largest row number.
pub(super) fn last_row(connection: &Connection) -> rusqlite::Result<Option<i64>> {
    connection.query_row("SELECT max(rowid) FROM messages", [], |row| row.get(0))
}
