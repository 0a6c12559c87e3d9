//! Progress of a search.

use std::sync::Mutex;

/// Share of the remaining progress that one milestone takes. The number of moves of a search is not known beforehand;
/// most searches make two to four.
const SHARE: f64 = 0.4;

/// Reports progress with a fraction that never decreases. The number of steps is not known, so each milestone takes a
/// share of the remainder.
pub(super) struct Milestones<'a> {
    progress: &'a (dyn Fn(&str, f64) + Sync),
    /// Fraction at the last milestone, and the largest reported.
    reached: Mutex<(f64, f64)>,
}

impl<'a> Milestones<'a> {
    pub fn new(progress: &'a (dyn Fn(&str, f64) + Sync)) -> Self {
        Milestones { progress, reached: Mutex::new((0.0, 0.0)) }
    }

    /// Reports the current activity and its completed fraction.
    pub fn tell(&self, what: &str, done: f64) {
        let Ok(mut reached) = self.reached.lock() else { return };
        let now = reached.0 + done.clamp(0.0, 1.0) * SHARE * (1.0 - reached.0);
        reached.1 = reached.1.max(now);
        (self.progress)(what, reached.1);
    }

    /// Completes a step.
    pub fn pass(&self) {
        if let Ok(mut reached) = self.reached.lock() {
            reached.0 += SHARE * (1.0 - reached.0);
        }
    }
}
