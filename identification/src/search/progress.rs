//! How far a search has come.

use std::sync::Mutex;

/// Share of what is left that one milestone takes. How many moves a search makes is not known before; most make two to four.
const SHARE: f64 = 0.4;

/// Passes on what is done, with a fraction that never falls. How many steps there will be is not known: each milestone takes a share of
/// what is left.
pub(super) struct Milestones<'a> {
    progress: &'a (dyn Fn(&str, f64) + Sync),
    /// Fraction at the last milestone, and the largest reported.
    reached: Mutex<(f64, f64)>,
}

impl<'a> Milestones<'a> {
    pub fn new(progress: &'a (dyn Fn(&str, f64) + Sync)) -> Self {
        Milestones { progress, reached: Mutex::new((0.0, 0.0)) }
    }

    /// What is being done, and the fraction of it that is done.
    pub fn tell(&self, what: &str, done: f64) {
        let Ok(mut reached) = self.reached.lock() else { return };
        let now = reached.0 + done.clamp(0.0, 1.0) * SHARE * (1.0 - reached.0);
        reached.1 = reached.1.max(now);
        (self.progress)(what, reached.1);
    }

    /// One more step is done.
    pub fn pass(&self) {
        if let Ok(mut reached) = self.reached.lock() {
            reached.0 += SHARE * (1.0 - reached.0);
        }
    }
}
