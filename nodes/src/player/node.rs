//! The player's node.

use std::collections::{BTreeSet, HashMap};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use excavator_msgs::Time;
use excavator_msgs::common::Clock;
use rosbag2::{Durability, History, Qos, RawMessage, RawMessages, Reliability, Topic};
use rustdds::policy;
use rustdds::{QosPolicies, QosPolicyBuilder};

use super::commands::{is_command, left_out_line, stamped_now};
use super::keys::Keys;
use super::schedule::Schedule;
use crate::error::NodeError;
use excavator_ros::raw::RawOutlet;
use excavator_ros::{Health, Outlet, PublishError, RosArguments, Supervisor, TopicQos};

/// Longest sleep between two checks for pause and stop.
const GLANCE: Duration = Duration::from_millis(20);
/// Time for readers to receive the last messages.
const FAREWELL: Duration = Duration::from_secs(2);

/// What is played, and how.
#[derive(Debug, Clone)]
pub struct PlayOptions {
    /// Bag.
    pub bag: PathBuf,
    /// How many times as fast as it was.
    pub rate: f64,
    /// Whether it begins again at the end.
    pub repeat: bool,
    /// Seconds that are left out at the beginning.
    pub start_offset: f64,
    /// Topics to play; if empty, all but commands.
    pub topics: Vec<String>,
    /// How many times per second bag time is published on `/clock`, if at all.
    pub clock: Option<f64>,
    /// Time for readers to appear before the first message, s.
    pub delay: f64,
    /// Whether it begins paused.
    pub start_paused: bool,
}

/// Plays until the bag ends or a stop is requested. Topics are published under other names by the remappings of `ros`.
///
/// # Errors
/// [`NodeError`] if the bag cannot be read or the graph cannot be joined.
pub fn run(options: &PlayOptions, ros: &RosArguments) -> Result<(), NodeError> {
    // Problems with the bag are reported before the node joins the graph.
    let bag = RawMessages::open(&options.bag)?;
    drop(bag);
    let supervisor = Supervisor::start_large("bag_player", ros, Vec::new())?;
    let clock = match options.clock {
        Some(_) => Some(supervisor.link.publish("/clock", TopicQos::reliable(10))?),
        None => None,
    };
    let pause = Arc::new(AtomicBool::new(options.start_paused));
    let keys = Keys::listen(Arc::clone(&pause));
    let stop = supervisor.stop_flag();
    let outcome = std::thread::scope(|scope| {
        let playing = scope.spawn(|| {
            let mut player = Player {
                supervisor: &supervisor,
                options,
                pause: &pause,
                stop: &stop,
                clock,
                outlets: HashMap::new(),
                left_out: BTreeSet::new(),
                counts: Counts::default(),
                next_tick: 0,
            };
            let outcome = player.play();
            stop.store(true, Ordering::Relaxed);
            outcome.map(|()| player.counts)
        });
        supervisor.run(|| {
            pause.fetch_xor(true, Ordering::Relaxed);
        });
        playing.join()
    });
    drop(keys);
    let result = match outcome {
        Ok(Ok(counts)) => {
            let Counts { played, refused, unplayable } = counts;
            supervisor.logger.info(format!("{played} messages played, {refused} refused, {unplayable} not playable"));
            Ok(())
        }
        Ok(Err(error)) => Err(error),
        Err(_) => Ok(()),
    };
    supervisor.leave();
    result
}

#[derive(Debug, Default, Clone, Copy)]
struct Counts {
    played: u64,
    refused: u64,
    unplayable: u64,
}

struct Player<'p> {
    supervisor: &'p Supervisor,
    options: &'p PlayOptions,
    pause: &'p AtomicBool,
    stop: &'p AtomicBool,
    clock: Option<Outlet<Clock>>,
    outlets: HashMap<String, Arc<RawOutlet>>,
    /// Command topics that were not requested by name.
    left_out: BTreeSet<String>,
    counts: Counts,
    /// Bag time of the next `/clock`, ns.
    next_tick: u64,
}

impl Player<'_> {
    fn play(&mut self) -> Result<(), NodeError> {
        for topic in RawMessages::open(&self.options.bag)?.topics() {
            self.open(&topic)?;
        }
        if !self.left_out.is_empty() {
            self.supervisor.logger.warn(left_out_line(&self.left_out));
        }
        // Discovery takes up to a tenth of a second. Without this pause readers would miss the beginning.
        self.rest(Duration::from_secs_f64(self.options.delay));
        loop {
            self.once()?;
            if !self.options.repeat || self.stopped() {
                break;
            }
        }
        for outlet in self.outlets.values() {
            outlet.wait_for_readers(FAREWELL);
        }
        Ok(())
    }

    /// One pass over the bag.
    fn once(&mut self) -> Result<(), NodeError> {
        let offset = (self.options.start_offset * 1e9) as u64;
        let mut schedule: Option<Schedule> = None;
        let mut begin = None;
        let mut messages = RawMessages::open(&self.options.bag)?;
        for message in messages.by_ref() {
            let message = message?;
            let start = *begin.get_or_insert(message.log_time.saturating_add(offset));
            if message.log_time < start {
                continue;
            }
            let schedule = schedule.get_or_insert_with(|| {
                self.next_tick = start;
                Schedule::new(start, self.options.rate, Instant::now())
            });
            if !self.wait(schedule, message.log_time) {
                return Ok(());
            }
            self.send(message)?;
        }
        for damage in messages.damage() {
            self.supervisor.logger.warn(damage.to_string());
        }
        Ok(())
    }

    /// Waits until the message is due; `false` if a stop is requested.
    fn wait(&mut self, schedule: &mut Schedule, due: u64) -> bool {
        loop {
            if self.stopped() {
                return false;
            }
            let now = Instant::now();
            let paused = self.pause.load(Ordering::Relaxed);
            if paused != schedule.is_paused() {
                schedule.set_paused(paused, now);
                let word = if paused { "paused" } else { "playing" };
                self.supervisor.logger.info(word);
                self.supervisor.diagnostics.tell("player", Health::Ok, word, &[]);
            }
            self.tick(schedule.bag_time(now));
            match schedule.until(due, now) {
                Some(Duration::ZERO) => return true,
                Some(left) => std::thread::sleep(left.min(GLANCE).min(self.until_tick(schedule, now))),
                None => std::thread::sleep(GLANCE),
            }
        }
    }

    fn until_tick(&self, schedule: &Schedule, now: Instant) -> Duration {
        match self.clock {
            Some(_) => schedule.until(self.next_tick, now).unwrap_or(GLANCE).max(Duration::from_micros(100)),
            None => GLANCE,
        }
    }

    /// Publishes bag time at the requested rate.
    fn tick(&mut self, bag_time: u64) {
        let (Some(clock), Some(rate)) = (&self.clock, self.options.clock) else { return };
        if bag_time < self.next_tick {
            return;
        }
        let period = (1e9 / rate) as u64;
        self.next_tick = self.next_tick.saturating_add(period).max(bag_time.saturating_sub(period));
        let time = i64::try_from(bag_time).ok().and_then(Time::from_nanoseconds).unwrap_or_default();
        // The next tick follows.
        let _ = clock.publish(Clock { clock: time });
    }

    fn send(&mut self, message: RawMessage) -> Result<(), NodeError> {
        if !self.wanted(&message.topic) {
            return Ok(());
        }
        if !self.outlets.contains_key(&message.topic.name) {
            // Needed only for a bag without a summary, whose topics appear one by one.
            self.open(&message.topic)?;
        }
        let Some(outlet) = self.outlets.get(&message.topic.name) else { return Ok(()) };
        let data = match self.clock {
            // Receivers that use the clock of the bag also accept its stamps.
            Some(_) => message.data,
            None => stamped_now(message.data, &message.topic.type_name, self.supervisor.clock.now()),
        };
        match outlet.publish(data) {
            Ok(()) => self.counts.played += 1,
            Err(PublishError::Failed(reason)) => {
                if self.counts.unplayable == 0 {
                    self.supervisor.logger.warn(format!("{}: {reason}", message.topic.name));
                }
                self.counts.unplayable += 1;
            }
            Err(_) => self.counts.refused += 1,
        }
        Ok(())
    }

    fn wanted(&self, topic: &Topic) -> bool {
        let asked_for = self.options.topics.contains(&topic.name);
        let named = asked_for || (self.options.topics.is_empty() && !is_command(&topic.name, &topic.type_name));
        // Two sources of `/clock` would contradict each other.
        named && !(topic.name == "/clock" && self.clock.is_some())
    }

    fn open(&mut self, topic: &Topic) -> Result<(), NodeError> {
        if self.options.topics.is_empty() && is_command(&topic.name, &topic.type_name) {
            self.left_out.insert(topic.name.clone());
        }
        if !self.wanted(topic) || self.outlets.contains_key(&topic.name) {
            return Ok(());
        }
        let name = self.supervisor.link.identity().resolve(&topic.name)?;
        let qos = offered(topic.qos().first().copied());
        let outlet = RawOutlet::open(&self.supervisor.link, &name, &topic.type_name, qos)?;
        self.supervisor.logger.info(format!("playing {} as {name} ({})", topic.name, topic.type_name));
        self.outlets.insert(topic.name.clone(), outlet);
        Ok(())
    }

    fn rest(&self, time: Duration) {
        let end = Instant::now() + time;
        while !self.stopped() && Instant::now() < end {
            std::thread::sleep(GLANCE.min(end.saturating_duration_since(Instant::now())));
        }
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// Offers the QoS that the recorder was offered.
fn offered(recorded: Option<Qos>) -> QosPolicies {
    let qos = recorded.unwrap_or(Qos::reliable(10));
    if qos.reliability == Reliability::Reliable && qos.durability == Durability::Volatile {
        let depth = if let History::KeepLast(depth) = qos.history { depth.max(10) } else { 1000 };
        return TopicQos::reliable(depth).to_dds();
    }
    let reliability = match qos.reliability {
        Reliability::Reliable => policy::Reliability::Reliable { max_blocking_time: rustdds::Duration::ZERO },
        Reliability::BestEffort => policy::Reliability::BestEffort,
    };
    let durability = match qos.durability {
        Durability::Volatile => policy::Durability::Volatile,
        Durability::TransientLocal => policy::Durability::TransientLocal,
    };
    let depth = if let History::KeepLast(depth) = qos.history { depth.max(1) } else { 1 };
    QosPolicyBuilder::new()
        .reliability(reliability)
        .durability(durability)
        .history(policy::History::KeepLast { depth: i32::try_from(depth).unwrap_or(i32::MAX) })
        .build()
}
