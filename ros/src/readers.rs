//! The readers of one topic: one, or a second beside it while the first is doubted.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use super::arrivals::{Arrivals, Step, Writer};
use super::connection::{Closed, Task, Tended};

/// Readers of one topic, with their tasks.
#[derive(Default)]
pub(super) struct Readers {
    arrivals: Mutex<Arrivals>,
    tasks: Mutex<Vec<(u64, Task)>>,
}

impl Readers {
    /// Number of a new reader.
    pub fn enter(&self) -> u64 {
        self.arrivals().enter(Instant::now())
    }

    /// Keeps the task of a reader.
    pub fn install(&self, number: u64, task: Task) {
        self.tasks().push((number, task));
    }

    /// Notes a sample of a reader. Returns whether it is to be delivered: the other reader may have delivered it already.
    pub fn take(&self, reader: u64, writer: Writer, sequence: i64) -> bool {
        self.arrivals().take(reader, writer, sequence, Instant::now())
    }

    /// Releases all readers.
    pub fn close(&self) -> Closed {
        self.arrivals().reset();
        Closed::tasks(self.tasks().drain(..).map(|(_, task)| task))
    }

    /// Opens, closes or replaces readers of `topic`; see [`Arrivals::tend`].
    pub fn tend(&self, topic: &str, present: &mut dyn FnMut() -> BTreeSet<Writer>) -> Tended {
        let step = self.arrivals().tend(Instant::now(), present);
        match step {
            Step::Wait => Tended::Nothing,
            Step::Open => Tended::Open,
            Step::Close(reader) => Tended::Closed(self.without(reader)),
            Step::Replace(reader) => Tended::Replaced(topic.to_string(), self.without(reader)),
        }
    }

    fn without(&self, reader: u64) -> Closed {
        let mut tasks = self.tasks();
        let (gone, kept) = tasks.drain(..).partition(|(number, _)| *number == reader);
        *tasks = kept;
        let gone: Vec<(u64, Task)> = gone;
        Closed::tasks(gone.into_iter().map(|(_, task)| task))
    }

    fn arrivals(&self) -> std::sync::MutexGuard<'_, Arrivals> {
        self.arrivals.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn tasks(&self) -> std::sync::MutexGuard<'_, Vec<(u64, Task)>> {
        self.tasks.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
