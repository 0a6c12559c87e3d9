//! Opens an untrusted database so that it can only return its rows.
//!
//! A database can contain code: views, triggers, virtual tables and computed columns. A bag needs none of them. Their
//! functions are disabled (`trusted_schema`), only plain tables are queried, and each query has a step limit after
//! which SQLite aborts.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use rusqlite::config::DbConfig;
use rusqlite::limits::Limit as SqliteLimit;
use rusqlite::{Connection, OpenFlags};
use thiserror::Error;

use crate::limits::{Limit, LimitError, ReadLimits};

/// Steps of the SQLite virtual machine between two checks of the step count.
const STEPS_AT_ONCE: i32 = 10_000;
/// Maximum length of a query, bytes; much more than any of ours.
const LONGEST_QUESTION: i32 = 1 << 16;

/// Why a query fails.
#[derive(Debug, Error)]
pub(super) enum SqliteFault {
    #[error(transparent)]
    Sqlite(#[from] rusqlite::Error),
    #[error(transparent)]
    Limit(#[from] LimitError),
    #[error("no such table: {0}")]
    NoTable(&'static str),
    #[error("{table} is a {kind}, not a table: no recorder writes that")]
    NotATable { table: &'static str, kind: String },
    #[error("the column {column} of {table} is computed: no recorder writes that")]
    Computed { table: &'static str, column: String },
}

/// A connection on which every query has a limited number of steps.
#[derive(Debug)]
pub(super) struct Bounded {
    connection: Connection,
    /// Steps since the last query started.
    steps: Arc<AtomicU64>,
    limits: ReadLimits,
}

impl Bounded {
    /// Opens a database for reading. It may be truncated, or have a leftover journal that only a writer may roll back.
    pub fn open(path: &Path, limits: &ReadLimits) -> Result<Bounded, SqliteFault> {
        let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
        let first = Connection::open_with_flags(path, flags).map_err(SqliteFault::from);
        match first.and_then(|connection| Bounded::prepared(connection, limits)) {
            Err(SqliteFault::Sqlite(_)) => {
                let name = format!("file:{}?immutable=1", uri_path(path));
                let flags = flags | OpenFlags::SQLITE_OPEN_URI;
                Bounded::prepared(Connection::open_with_flags(name, flags)?, limits)
            }
            other => other,
        }
    }

    /// Configures the connection and checks that it responds.
    fn prepared(mut connection: Connection, limits: &ReadLimits) -> Result<Bounded, SqliteFault> {
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_TRUSTED_SCHEMA, false)?;
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_TRIGGER, false)?;
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_VIEW, false)?;
        connection.set_limit(SqliteLimit::SQLITE_LIMIT_LENGTH, i32::try_from(limits.message).unwrap_or(i32::MAX))?;
        connection.set_limit(SqliteLimit::SQLITE_LIMIT_SQL_LENGTH, LONGEST_QUESTION)?;
        connection.set_limit(SqliteLimit::SQLITE_LIMIT_ATTACHED, 0)?;
        let steps = Arc::new(AtomicU64::new(0));
        let (counted, most) = (Arc::clone(&steps), limits.steps);
        let step = STEPS_AT_ONCE.unsigned_abs().into();
        let give_up = move || counted.fetch_add(step, Ordering::Relaxed).saturating_add(step) > most;
        connection.progress_handler(STEPS_AT_ONCE, Some(give_up))?;
        // Nothing is written. This pragma makes SQLite read a file that is shorter than its header declares.
        connection.pragma_update(None, "writable_schema", true)?;
        let bounded = Bounded { connection, steps, limits: *limits };
        bounded.ask(|connection| connection.query_row("SELECT 1 FROM sqlite_master LIMIT 1", [], |_| Ok(()))).or_else(
            |fault| match fault {
                SqliteFault::Sqlite(rusqlite::Error::QueryReturnedNoRows) => Ok(()),
                other => Err(other),
            },
        )?;
        Ok(bounded)
    }

    /// The limits of this connection.
    pub fn limits(&self) -> &ReadLimits {
        &self.limits
    }

    /// Runs a query, limited to [`ReadLimits::steps`].
    pub fn ask<T>(&self, question: impl FnOnce(&Connection) -> rusqlite::Result<T>) -> Result<T, SqliteFault> {
        self.steps.store(0, Ordering::Relaxed);
        question(&self.connection).map_err(|error| match error {
            rusqlite::Error::SqliteFailure(failure, _) if failure.code == rusqlite::ErrorCode::OperationInterrupted => {
                let found = self.steps.load(Ordering::Relaxed);
                LimitError { limit: Limit::Steps, found, allowed: self.limits.steps }.into()
            }
            other => SqliteFault::Sqlite(other),
        })
    }

    /// Whether the table exists.
    ///
    /// # Errors
    /// [`SqliteFault::NotATable`] for a view or a virtual table, [`SqliteFault::Computed`] for computed columns.
    pub fn is_table(&self, table: &'static str) -> Result<bool, SqliteFault> {
        // Uses the table list that SQLite derived from the schema, not the text in the schema.
        let wanted = "SELECT type FROM pragma_table_list WHERE schema = 'main' AND name = ?1 LIMIT 1";
        let kind = self.ask(|connection| {
            let mut statement = connection.prepare(wanted)?;
            let mut rows = statement.query([table])?;
            rows.next()?.map(|row| row.get::<_, String>(0)).transpose()
        })?;
        match kind.as_deref() {
            None => return Ok(false),
            Some("table") => {}
            Some(other) => return Err(SqliteFault::NotATable { table, kind: other.to_string() }),
        }
        let computed = self.ask(|connection| {
            let mut statement =
                connection.prepare("SELECT name FROM pragma_table_xinfo(?1) WHERE hidden <> 0 LIMIT 1")?;
            let mut rows = statement.query([table])?;
            rows.next()?.map(|row| row.get::<_, String>(0)).transpose()
        })?;
        computed.map_or(Ok(true), |column| Err(SqliteFault::Computed { table, column }))
    }
}

/// A path encoded for a `file:` URI.
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
