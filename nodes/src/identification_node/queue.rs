//! The queue of goals for the worker.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::types::{Goal, GoalId};

/// Most goals in the queue. An operator queues a handful; more suggest a faulty client.
pub(super) const MOST_WAITING: usize = 8;

/// Work to be done.
#[derive(Debug)]
pub(super) struct Job {
    pub id: GoalId,
    pub goal: Goal,
    pub cancelled: Arc<AtomicBool>,
}

/// A bounded queue between the action and the worker.
#[derive(Debug, Default)]
pub(super) struct Queue {
    jobs: Mutex<VecDeque<Job>>,
    filled: Condvar,
}

impl Queue {
    fn lock(&self) -> MutexGuard<'_, VecDeque<Job>> {
        self.jobs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the queue has no room for another job.
    pub fn is_full(&self) -> bool {
        self.lock().len() >= MOST_WAITING
    }

    /// Appends a job; `false` if there is no room.
    pub fn push(&self, job: Job) -> bool {
        let mut jobs = self.lock();
        let room = jobs.len() < MOST_WAITING;
        if room {
            jobs.push_back(job);
            self.filled.notify_one();
        }
        room
    }

    /// Removes the jobs that were cancelled while they waited, so that they do not take up room.
    pub fn drop_cancelled(&self) {
        self.lock().retain(|job| !job.cancelled.load(Ordering::Relaxed));
    }

    /// The next job. Waits at most `patience`.
    pub fn pop(&self, patience: Duration) -> Option<Job> {
        let waited = self.filled.wait_timeout_while(self.lock(), patience, |jobs| jobs.is_empty());
        waited.unwrap_or_else(PoisonError::into_inner).0.pop_front()
    }

    /// Number of queued jobs.
    pub fn len(&self) -> usize {
        self.lock().len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(number: u8) -> Job {
        let goal = Goal { model: String::new(), bags: Vec::new(), effects: Vec::new() };
        Job { id: [number; 16], goal, cancelled: Arc::default() }
    }

    #[test]
    fn the_queue_is_bounded_and_cancelled_jobs_leave_it() {
        let queue = Queue::default();
        let flags: Vec<_> = (0..20)
            .filter_map(|number| {
                let job = job(number);
                let flag = Arc::clone(&job.cancelled);
                queue.push(job).then_some(flag)
            })
            .collect();
        assert_eq!((flags.len(), queue.len(), queue.is_full()), (MOST_WAITING, MOST_WAITING, true));
        flags[0].store(true, Ordering::Relaxed);
        queue.drop_cancelled();
        assert_eq!(queue.len(), MOST_WAITING - 1);
        assert_eq!(queue.pop(Duration::ZERO).map(|job| job.id), Some([1; 16]));
        assert!(Queue::default().pop(Duration::from_millis(1)).is_none());
    }
}
