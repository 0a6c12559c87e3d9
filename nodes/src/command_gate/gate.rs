//! Decides who owns which valve, for how long, and when a valve may open again.

use std::time::{Duration, Instant};

use excavator_msgs::OrificeCommand;

use super::content::{self, Valve};
use super::refusal::Refusal;
use super::slew::Wanted;
use super::source::Source;
use super::stamp::{self, StampLimits};
use super::stop::Stop;
use super::writer::{AllowList, Writer};

/// Share of the largest area below which a command counts as zero: covers the noise of a lever in neutral behind its dead band.
const NEUTRAL_SHARE: f64 = 1e-3;

/// Settings that may change while the gate is in use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Settings {
    /// Time for which a command is valid.
    pub timeout: Duration,
    /// Limits for the stamps of commands.
    pub stamps: StampLimits,
}

/// A command and its origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Order<'o> {
    /// The command.
    pub command: &'o OrificeCommand,
    /// Index of its source.
    pub source: usize,
    /// Who wrote it.
    pub writer: &'o Writer,
}

#[derive(Debug, Clone)]
struct Owner {
    writer: [u8; 16],
    name: String,
    source: usize,
    confirmed: Instant,
}

/// One valve: who commands it, and why it is held closed, if it is.
#[derive(Debug, Clone, Default)]
struct Slot {
    area: f64,
    owner: Option<Owner>,
    closed: Option<Closed>,
}

#[derive(Debug, Clone)]
struct Closed {
    because: String,
    at: Instant,
}

/// Status of a valve, for display.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ValveStatus {
    /// Name of its cylinder.
    pub name: String,
    /// Who commands it: node and source.
    pub owner: Option<String>,
    /// Age of the owner's last command.
    pub age: Option<Duration>,
    /// Why it stays closed until an area of 0 is commanded, and since when.
    pub closed: Option<(String, Duration)>,
}

/// Decides which commands are followed. The caller passes the time: the steady clock for leases, and the clocks of stamps.
#[derive(Debug, Clone)]
pub(super) struct Gate {
    valves: Vec<Valve>,
    slots: Vec<Slot>,
    sources: Vec<Source>,
    allowed: AllowList,
    settings: Settings,
    /// Whether no commands are followed, because the node waits to be activated, or ends.
    shut: bool,
    /// The stop.
    pub stop: Stop,
}

impl Gate {
    /// A gate for these valves and sources. With `neutral_at_start`, each valve requires a command with an area of 0 before it
    /// opens for the first time.
    pub fn new(
        valves: Vec<Valve>,
        sources: Vec<Source>,
        allowed: AllowList,
        settings: Settings,
        neutral_at_start: bool,
        now: Instant,
    ) -> Self {
        let closed = neutral_at_start.then(|| Closed { because: "this node has just started".to_string(), at: now });
        let slots = vec![Slot { closed, ..Slot::default() }; valves.len()];
        Gate { valves, slots, sources, allowed, settings, shut: false, stop: Stop::default() }
    }

    /// Replaces the settings.
    pub fn set(&mut self, settings: Settings) {
        self.settings = settings;
    }

    /// Checks and applies a command that arrived at `now`. `clocks` (ns since the epoch) are those that its stamp may refer to.
    ///
    /// # Errors
    /// [`Refusal`]; the gate is unchanged then.
    pub fn take(&mut self, order: Order<'_>, now: Instant, clocks: &[i64]) -> Result<(), Refusal> {
        self.advance(now);
        if !self.allowed.allows(order.writer) {
            return Err(Refusal::NotAllowed { writer: order.writer.name() });
        }
        stamp::check(order.command.header.stamp, clocks, self.settings.stamps)?;
        let areas = content::check(order.command, &self.valves)?;
        if self.shut {
            return Err(Refusal::NotActive);
        }
        if let Some(by) = self.stop.by(now) {
            return Err(Refusal::Stopped { by });
        }
        areas.iter().try_for_each(|&(valve, area)| self.may_open(order, valve, area))?;
        self.follow(order, &areas, now);
        Ok(())
    }

    fn may_open(&self, order: Order<'_>, valve: usize, area: f64) -> Result<(), Refusal> {
        let (slot, name) = (&self.slots[valve], &self.valves[valve].name);
        if let Some(owner) = &slot.owner
            && owner.writer != order.writer.guid
            && self.priority(order.source) <= self.priority(owner.source)
        {
            return Err(Refusal::Owned { name: name.clone(), owner: owner.name.clone() });
        }
        match &slot.closed {
            Some(closed) if area.abs() > NEUTRAL_SHARE * self.valves[valve].maximum_area => {
                Err(Refusal::NeutralFirst { name: name.clone(), reason: closed.because.clone() })
            }
            _ => Ok(()),
        }
    }

    fn priority(&self, source: usize) -> i32 {
        self.sources.get(source).map_or(i32::MIN, |source| source.priority)
    }

    /// Applies the areas of the named valves, and renews the lease of every valve that this writer owns. A valve that the
    /// command does not name keeps its last area.
    fn follow(&mut self, order: Order<'_>, areas: &[(usize, f64)], now: Instant) {
        for slot in &mut self.slots {
            if let Some(owner) = slot.owner.as_mut().filter(|owner| owner.writer == order.writer.guid) {
                owner.confirmed = now;
            }
        }
        for &(valve, area) in areas {
            let owner =
                Owner { writer: order.writer.guid, name: order.writer.name(), source: order.source, confirmed: now };
            self.slots[valve] = Slot { area, owner: Some(owner), closed: None };
        }
    }

    /// Closes the valves whose lease has expired at `now`, or all of them while the machine is stopped.
    pub fn advance(&mut self, now: Instant) {
        let stopped_by = self.stop.by(now);
        for slot in &mut self.slots {
            if let Some(by) = &stopped_by {
                slot.close(now, || format!("the machine was stopped by {by}"));
                continue;
            }
            let expired = slot.owner.as_ref().filter(|owner| owner.age(now) > self.settings.timeout);
            if let Some(name) = expired.map(|owner| owner.name.clone()) {
                slot.close(now, || format!("the lease of {name} has run out"));
            }
        }
    }

    /// The current request for each valve, after [`Gate::advance`].
    pub fn wanted(&self) -> impl Iterator<Item = Wanted> {
        self.slots.iter().map(|slot| match slot.owner {
            Some(_) => Wanted { area: slot.area, closing: false },
            None => Wanted { area: 0.0, closing: true },
        })
    }

    /// With `shut`, closes every valve and follows no commands; otherwise follows commands again.
    pub fn shut(&mut self, shut: bool, now: Instant) {
        if shut {
            self.slots.iter_mut().for_each(|slot| slot.close(now, || "this node was not active".to_string()));
        }
        self.shut = shut;
    }

    /// Status of every valve: who commands it, and why it is closed.
    pub fn status(&self, now: Instant) -> Vec<ValveStatus> {
        let told = |owner: &Owner| {
            let source = self.sources.get(owner.source).map_or("", |source| source.name.as_str());
            format!("{} (source {source}, priority {})", owner.name, self.priority(owner.source))
        };
        let with_valve = self.valves.iter().zip(&self.slots).filter(|(valve, _)| !valve.name.is_empty());
        with_valve
            .map(|(valve, slot)| ValveStatus {
                name: valve.name.clone(),
                owner: slot.owner.as_ref().map(told),
                age: slot.owner.as_ref().map(|owner| owner.age(now)),
                closed: slot
                    .closed
                    .as_ref()
                    .map(|closed| (closed.because.clone(), now.saturating_duration_since(closed.at))),
            })
            .collect()
    }
}

impl Owner {
    fn age(&self, now: Instant) -> Duration {
        now.saturating_duration_since(self.confirmed)
    }
}

impl Slot {
    /// Closes the valve. The first reason is kept until the valve opens again.
    fn close(&mut self, now: Instant, because: impl FnOnce() -> String) {
        let was_open = self.owner.take().is_some();
        self.area = 0.0;
        if was_open || self.closed.is_none() {
            self.closed = Some(Closed { because: because(), at: now });
        }
    }
}

#[cfg(test)]
#[path = "gate_tests.rs"]
mod tests;
