//! For how long a command holds.
//!
//! An operator's program that hangs, or a network that fails, must not leave a valve open. So each accepted command is a
//! lease: as long as it is renewed in time the areas hold, and when it runs out the valves close by a ramp. Time is the
//! steady clock of this machine at the arrival of the command; stamps in the command play no part.

use std::time::{Duration, Instant};

/// Commanded areas with the time at which they were last confirmed.
#[derive(Debug, Clone)]
pub struct Lease {
    timeout: Duration,
    areas: Vec<f64>,
    confirmed: Option<Instant>,
}

/// Areas to be set now.
#[derive(Debug, Clone, PartialEq)]
pub struct Openings {
    /// One per valve, m².
    pub areas: Vec<f64>,
    /// Whether a lease has run out (not: whether there never was one).
    pub expired: bool,
}

impl Lease {
    /// No command yet: `valves` closed valves.
    pub fn new(valves: usize, timeout: Duration) -> Self {
        Lease { timeout, areas: vec![0.0; valves], confirmed: None }
    }

    /// Changes the time for which a command holds.
    pub fn set_timeout(&mut self, timeout: Duration) {
        self.timeout = timeout;
    }

    /// Takes an accepted command that arrived at `now`. Valves that it does not name keep their last command, unless
    /// that has run out: what was closed for safety does not open by itself.
    pub fn renew(&mut self, areas: &[(usize, f64)], now: Instant) {
        if self.is_expired(now) {
            self.areas.fill(0.0);
        }
        for &(valve, area) in areas {
            if let Some(slot) = self.areas.get_mut(valve) {
                *slot = area;
            }
        }
        self.confirmed = Some(now);
    }

    /// Closes everything at once, for the end of a program.
    pub fn revoke(&mut self) {
        self.areas.fill(0.0);
        self.confirmed = None;
    }

    /// What is asked of the valves at `now`.
    pub fn openings(&self, now: Instant) -> Openings {
        let expired = self.is_expired(now);
        let areas = if expired { vec![0.0; self.areas.len()] } else { self.areas.clone() };
        Openings { areas, expired }
    }

    /// Age of the last command at `now`.
    pub fn age(&self, now: Instant) -> Option<Duration> {
        self.confirmed.map(|confirmed| now.saturating_duration_since(confirmed))
    }

    fn is_expired(&self, now: Instant) -> bool {
        self.age(now).is_some_and(|age| age > self.timeout)
    }
}

/// The area after `step` seconds on the way from `area` to `wanted` where a lease has run out: towards closed at no more
/// than `maximum_rate` (m²/s). Oil that is stopped at once hits like a hammer.
pub fn ramp(area: f64, wanted: f64, maximum_rate: f64, step: f64) -> f64 {
    let most = maximum_rate * step;
    area + (wanted - area).clamp(-most, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMEOUT: Duration = Duration::from_millis(100);

    #[test]
    fn a_command_holds_until_its_lease_runs_out() {
        let start = Instant::now();
        let mut lease = Lease::new(2, TIMEOUT);
        assert_eq!(lease.openings(start), Openings { areas: vec![0.0, 0.0], expired: false });
        lease.renew(&[(1, 5e-5)], start);
        assert_eq!(lease.openings(start + TIMEOUT), Openings { areas: vec![0.0, 5e-5], expired: false });
        let late = start + TIMEOUT + Duration::from_nanos(1);
        assert_eq!(lease.openings(late), Openings { areas: vec![0.0, 0.0], expired: true });
    }

    #[test]
    fn unnamed_valves_keep_their_command_as_long_as_the_lease_is_renewed() {
        let start = Instant::now();
        let mut lease = Lease::new(2, TIMEOUT);
        lease.renew(&[(0, 1e-5)], start);
        for step in 1..50 {
            lease.renew(&[(1, 2e-5)], start + step * Duration::from_millis(50));
        }
        assert_eq!(lease.openings(start + Duration::from_millis(2450)).areas, [1e-5, 2e-5]);
    }

    #[test]
    fn what_has_run_out_does_not_open_again_by_itself() {
        let start = Instant::now();
        let mut lease = Lease::new(2, TIMEOUT);
        lease.renew(&[(0, 1e-5)], start);
        let later = start + Duration::from_secs(1);
        lease.renew(&[(1, 2e-5)], later);
        assert_eq!(lease.openings(later).areas, [0.0, 2e-5]);
    }

    #[test]
    fn a_revoked_lease_is_closed() {
        let start = Instant::now();
        let mut lease = Lease::new(1, TIMEOUT);
        lease.renew(&[(0, 1e-5)], start);
        lease.revoke();
        assert_eq!(lease.openings(start).areas, [0.0]);
    }

    #[test]
    fn the_ramp_arrives_and_does_not_overshoot() {
        let mut area = 1e-4;
        // Fifty steps to close, and one for what rounding leaves.
        for _ in 0..51 {
            let next = ramp(area, 0.0, 2e-3, 1e-3);
            assert!(next <= area && next >= 0.0);
            area = next;
        }
        assert_eq!(area, 0.0);
        assert_eq!(ramp(-1e-6, 0.0, 2e-3, 1e-3), 0.0);
    }
}
