//! Reads the messages of one SQLite3 file in the order in which they were written.

use std::collections::{HashMap, VecDeque};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bytes::Bytes;

use super::sqlite_connection::{Bounded, SqliteFault};
use super::sqlite_query::{Row, rows_from, topics};
use super::sqlite_skip::next_readable;
use crate::container::{Damage, DamageKind, DamageList};
use crate::limits::ReadLimits;
use crate::raw_message::{RawMessage, Topic};

/// Rows per query: enough that the cost of the query is small compared with reading.
const BATCH_ROWS: usize = 1000;
/// Bytes of messages after which a batch ends: a few images take as much as a thousand states.
const BATCH_BYTES: usize = 1 << 20;

/// One open database.
#[derive(Debug)]
pub(super) struct SqliteFile {
    name: PathBuf,
    connection: Bounded,
    topics: HashMap<i64, Arc<Topic>>,
    batch: VecDeque<Row>,
    /// Rows with smaller numbers have been read.
    next_row: i64,
    damage: DamageList,
    last_log_time: Option<u64>,
    /// Number and bytes of messages without data, or whose topic is not in the table of topics.
    unknown: (u64, u64),
    finished: bool,
}

impl SqliteFile {
    /// Opens the database at `path`; messages call it `name`. `Err` contains the reason why nothing can be read.
    pub fn open(path: &Path, name: &Path, limits: &ReadLimits) -> Result<SqliteFile, String> {
        let connection = Bounded::open(path, limits).map_err(|error| error.to_string())?;
        let topics = topics(&connection).map_err(|error| format!("its table of topics cannot be read: {error}"))?;
        let mut file = SqliteFile {
            name: name.to_path_buf(),
            connection,
            topics,
            batch: VecDeque::new(),
            next_row: i64::MIN,
            damage: DamageList::default(),
            last_log_time: None,
            unknown: (0, 0),
            finished: false,
        };
        if let Some(missing) = missing_end(path) {
            file.note(std::fs::metadata(path).map_or(0, |metadata| metadata.len()), missing, DamageKind::CutDatabase);
        }
        Ok(file)
    }

    /// All topics of the file.
    pub fn topics(&self) -> impl Iterator<Item = &Arc<Topic>> {
        self.topics.values()
    }

    /// The damage found so far.
    pub fn damage(&self) -> &[Damage] {
        self.damage.as_slice()
    }

    /// The next message, `None` at the end.
    pub fn next_message(&mut self) -> Option<RawMessage> {
        loop {
            let Some(row) = self.batch.pop_front() else {
                if self.finished {
                    return None;
                }
                self.fill();
                continue;
            };
            let length = row.data.as_ref().map_or(0, Vec::len) as u64;
            let (Some(topic), Some(data)) = (self.topics.get(&row.topic), row.data) else {
                self.unknown.0 += 1;
                self.unknown.1 += length;
                continue;
            };
            let log_time = u64::try_from(row.timestamp).unwrap_or_default();
            self.last_log_time = Some(log_time);
            return Some(RawMessage {
                topic: Arc::clone(topic),
                sequence: 0,
                log_time,
                publish_time: log_time,
                data: Bytes::from(data),
            });
        }
    }

    /// Reads the next batch; on failure, skips the unreadable rows.
    fn fill(&mut self) {
        let (batch, mut bytes) = (&mut self.batch, 0);
        let result = rows_from(&self.connection, self.next_row, |row| {
            bytes += row.data.as_ref().map_or(0, Vec::len);
            batch.push_back(row);
            batch.len() < BATCH_ROWS && bytes < BATCH_BYTES
        });
        match (self.batch.back().map(|row| row.id.checked_add(1)), result) {
            (Some(Some(next)), Ok(false) | Err(_)) => self.next_row = next,
            (Some(None), _) | (_, Ok(_)) => self.finish(),
            // The query exceeded its limit, so no next readable row can be searched for.
            (None, Err(error @ SqliteFault::Limit(_))) => {
                let reason = error.to_string();
                self.note(0, 0, DamageKind::LostRows { first: self.next_row.max(1), messages: None, reason });
                self.finish();
            }
            (None, Err(error)) => self.skip(&error.to_string()),
        }
    }

    fn skip(&mut self, reason: &str) {
        // Writers number rows from 1, so nothing else can be lost before the first row.
        let first = self.next_row.max(1);
        let next = next_readable(&self.connection, first.saturating_sub(1));
        let lost = next.map(|next| u64::try_from(next.saturating_sub(first)).unwrap_or_default());
        self.note(0, 0, DamageKind::LostRows { first, messages: lost, reason: reason.to_string() });
        match next {
            Some(next) => self.next_row = next,
            None => self.finish(),
        }
    }

    fn finish(&mut self) {
        let (messages, bytes) = std::mem::take(&mut self.unknown);
        if messages > 0 {
            self.note(0, bytes, DamageKind::UnknownTopic { messages });
        }
        // The part that was cut off came after everything that could be read.
        for damage in self.damage.as_mut_slice() {
            if damage.is_truncation() {
                damage.readable_until = self.last_log_time;
            }
        }
        self.finished = true;
    }

    fn note(&mut self, offset: u64, lost_bytes: u64, kind: DamageKind) {
        let file = self.name.clone();
        self.damage.push(Damage { file, offset, lost_bytes, readable_until: self.last_log_time, kind });
    }
}

/// Number of bytes by which the file is shorter than its header declares, if it is.
fn missing_end(path: &Path) -> Option<u64> {
    use std::io::Read;
    let mut header = Vec::new();
    let file = std::fs::File::open(path).ok()?;
    let length = file.metadata().ok()?.len();
    file.take(100).read_to_end(&mut header).ok()?;
    let field = |at: usize| header.get(at..at + 4)?.try_into().ok().map(u32::from_be_bytes);
    let page_size = match header.get(16..18)? {
        [0, 1] => 1 << 16,
        &[high, low] => u64::from(u16::from_be_bytes([high, low])),
        _ => return None,
    };
    // SQLite uses the size in the header only if both counters agree (file format, 1.3.7).
    let (pages, changed, valid_for) = (u64::from(field(28)?), field(24)?, field(92)?);
    (changed == valid_for).then(|| (pages * page_size).saturating_sub(length)).filter(|&missing| missing > 0)
}
