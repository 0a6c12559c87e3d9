//! The gate's ROS interface: subscriptions in, openings out, diagnostics and log.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use excavator_msgs::OrificeCommand;
use excavator_msgs::common::Flag;

use super::content::Valve;
use super::gate::{Gate, Order, Settings};
use super::report::Report;
use super::slew::Wanted;
use super::source::Source;
use super::stamp::StampLimits;
use super::words::{CLOSED_BECAUSE, COMMAND_AGE, COMMANDED_BY, STOPPED_BY};
use super::writer::{AllowList, Writer};
use excavator_ros::{
    Diagnostics, Health, Logger, Parameters, Peers, RosError, Supervisor, TopicQos, system_nanoseconds,
};

/// Topic of the stop, before remapping.
const STOP_TOPIC: &str = "arm/stop";
/// Most writers whose names are cached. Beyond that the oldest entry is dropped.
const MOST_WRITERS: usize = 64;
/// Time after which a writer unknown to discovery is looked up again.
const LOOK_AGAIN: Duration = Duration::from_millis(200);
/// Time for which a valve that was closed for safety is shown as a warning.
const NEWS: Duration = Duration::from_secs(5);
/// Stands for "no simulated time".
const NONE: i64 = i64::MIN;

/// Receives the commands.
pub(crate) struct Desk {
    gate: Mutex<Gate>,
    report: Mutex<Report>,
    writers: Mutex<BTreeMap<[u8; 16], (Instant, Writer)>>,
    peers: Peers,
    parameters: Parameters,
    diagnostics: Diagnostics,
    logger: Logger,
    /// Time of a simulation that is the source of time, ns.
    simulated: AtomicI64,
    /// Full name of the topic on which this node publishes the machine's state.
    state_topic: String,
}

impl Desk {
    /// Opens the gate's topics. `valves` are those of the machine. `state_topic` is the topic on which this node publishes the
    /// machine's state: another publisher on it is either another machine, or a second driver of the same one.
    ///
    /// # Errors
    /// [`RosError`] for parameters that contradict each other, and topics that cannot be opened.
    pub fn open(supervisor: &Supervisor, valves: Vec<Valve>, state_topic: &str) -> Result<Arc<Self>, RosError> {
        let parameters = &supervisor.parameters;
        let sources = Source::parse_all(&parameters.texts("command_sources")).map_err(RosError::Parameter)?;
        let allowed = AllowList::parse(&parameters.texts("command_writers")).map_err(RosError::Parameter)?;
        let valves = limited(valves, &parameters.doubles("area_limits"))?;
        let settings = settings(parameters);
        let gate =
            Gate::new(valves, sources.clone(), allowed, settings, parameters.flag("neutral_at_start"), Instant::now());
        let desk = Arc::new(Desk {
            gate: Mutex::new(gate),
            report: Mutex::default(),
            writers: Mutex::default(),
            peers: Peers::of(&supervisor.link)?,
            parameters: parameters.clone(),
            diagnostics: supervisor.diagnostics.clone(),
            logger: supervisor.logger.clone(),
            simulated: AtomicI64::new(NONE),
            state_topic: supervisor.link.identity().resolve(state_topic)?,
        });
        desk.follow_parameters();
        for (index, source) in sources.iter().enumerate() {
            let listening = Arc::clone(&desk);
            supervisor.link.subscribe(&source.topic, TopicQos::reliable(10), move |command, received| {
                listening.take(&command, index, received.publisher.to_bytes16(), received.at);
            })?;
        }
        let listening = Arc::clone(&desk);
        supervisor.link.subscribe(STOP_TOPIC, TopicQos::reliable(10), move |stop: Flag, received| {
            listening.take_stop(stop.data, received.publisher.to_bytes16(), received.at);
        })?;
        Ok(desk)
    }

    /// Sets the time of a simulation, ns. Stamps of commands may refer to it.
    pub fn set_simulated_time(&self, nanoseconds: i64) {
        self.simulated.store(nanoseconds, Ordering::Relaxed);
    }

    /// Writes the current request for each valve into `wanted`.
    pub fn look(&self, wanted: &mut Vec<Wanted>) {
        let mut gate = self.gate();
        gate.advance(Instant::now());
        wanted.clear();
        wanted.extend(gate.wanted());
    }

    /// With `shut`, closes every valve and follows no commands; otherwise follows commands again.
    pub fn shut(&self, shut: bool) {
        self.gate().shut(shut, Instant::now());
    }

    fn take(&self, command: &OrificeCommand, source: usize, writer: [u8; 16], now: Instant) {
        let writer = self.writer(writer, now);
        let system = system_nanoseconds();
        let outcome = match self.simulated.load(Ordering::Relaxed) {
            NONE => self.gate().take(Order { command, source, writer: &writer }, now, &[system]),
            simulated => self.gate().take(Order { command, source, writer: &writer }, now, &[system, simulated]),
        };
        let mut report = self.report_lock();
        match outcome {
            Ok(()) => report.accept(),
            Err(refusal) => report.refuse(&refusal, &writer, now),
        }
    }

    fn take_stop(&self, stop: bool, writer: [u8; 16], now: Instant) {
        let writer = self.writer(writer, now);
        let before = {
            let mut gate = self.gate();
            let before = gate.stop.by(now);
            gate.stop.take(stop, &writer, |guid| self.peers.has_left(guid), now);
            before
        };
        if stop && before.is_none() {
            let line = || format!("{} stops the machine", writer.name());
            self.report_lock().say_once(format!("stop {:02x?}", writer.guid), line, now);
        }
    }

    /// A writer by its GUID, with the data of discovery.
    fn writer(&self, guid: [u8; 16], now: Instant) -> Writer {
        let mut writers = self.writers.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((looked, writer)) = writers.get(&guid)
            && (writer.node.is_some() || now.saturating_duration_since(*looked) < LOOK_AGAIN)
        {
            return writer.clone();
        }
        let writer = Writer { guid, node: self.peers.node_of(&guid), addresses: self.peers.addresses_of(&guid) };
        if writers.len() >= MOST_WRITERS {
            let oldest = writers.iter().min_by_key(|(_, (looked, _))| *looked).map(|(guid, _)| *guid);
            oldest.map(|oldest| writers.remove(&oldest));
        }
        writers.insert(guid, (now, writer.clone()));
        writer
    }

    /// Applies the parameters, and reports to diagnostics and log. Call it a few times per second. `limited` is the number of
    /// steps in which the rate of an opening was limited.
    pub fn report(&self, limited: u64) {
        self.follow_parameters();
        let now = Instant::now();
        self.tell_other_machines(now);
        let (lines, recent, accepted, refused, mut counts) = {
            let mut report = self.report_lock();
            let (refused, kinds) = report.refused();
            let accepted = report.accepted();
            let mut counts = vec![("accepted commands".to_string(), accepted.to_string())];
            counts.push(("refused commands".to_string(), refused.to_string()));
            counts.extend(kinds.map(|(kind, count)| (format!("refused: {kind}"), count.to_string())));
            let recent = report.recent_refusal(now).map(str::to_string);
            (report.take_lines(), recent, accepted, refused, counts)
        };
        lines.into_iter().for_each(|line| self.logger.warn(line));
        counts.push(("steps limited in rate".to_string(), limited.to_string()));
        let values: Vec<(&str, String)> = counts.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
        self.tell_owners(now, accepted, recent.is_some());
        match recent {
            Some(text) => self.diagnostics.tell("refusal", Health::Warning, text, &values),
            None if refused == 0 => self.diagnostics.tell("refusal", Health::Ok, "no command was refused", &values),
            None => self.diagnostics.tell("refusal", Health::Ok, "no command was refused lately", &values),
        }
    }

    /// Reports who commands which valve.
    fn tell_owners(&self, now: Instant, accepted: u64, refused: bool) {
        let (status, stopped) = {
            let gate = self.gate();
            (gate.status(now), gate.stop.by(now))
        };
        let commanded = status.iter().any(|valve| valve.owner.is_some());
        let mut values = Vec::new();
        let mut closed = None;
        for valve in &status {
            values.push((format!("{}{COMMANDED_BY}", valve.name), valve.owner.clone().unwrap_or_else(|| "-".into())));
            let age = valve.age.map_or("-".into(), |age| format!("{:.3}", age.as_secs_f64()));
            values.push((format!("{}{COMMAND_AGE}", valve.name), age));
            if let Some((reason, since)) = &valve.closed {
                values.push((format!("{}{CLOSED_BECAUSE}", valve.name), reason.clone()));
                let line = format!("{} is closed because {reason}; an area of 0 has to be commanded first", valve.name);
                // A valve that stays closed is not a warning for ever: the operator may have left for the night.
                let health = if *since < NEWS { Health::Warning } else { Health::Ok };
                closed = closed.filter(|(earlier, _)| *earlier >= health).or(Some((health, line)));
            }
        }
        let values: Vec<(&str, String)> = values.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
        let (health, message) = match (stopped, closed) {
            (Some(by), _) => (Health::Warning, format!("{STOPPED_BY}{by}")),
            (None, Some(closed)) => closed,
            (None, None) if refused && !commanded => {
                (Health::Warning, "commands come, and none is followed; \"refusal\" says why".to_string())
            }
            (None, None) if accepted == 0 => (Health::Ok, "no command yet, valves are closed".to_string()),
            (None, None) => (Health::Ok, "following commands".to_string()),
        };
        self.diagnostics.tell("commands", health, message, &values);
    }

    /// Warns about other publishers of the machine's state: each drives the same machine, or another one that follows the same
    /// commands.
    fn tell_other_machines(&self, now: Instant) {
        let others = self.peers.other_writers(&self.state_topic);
        let names: Vec<String> = others.iter().map(|guid| self.writer(*guid, now).name()).collect();
        if names.is_empty() {
            self.diagnostics.tell("machine", Health::Ok, format!("no other node publishes {}", self.state_topic), &[]);
            return;
        }
        let line = format!(
            "{} is also published by {}: two machines follow the same commands",
            self.state_topic,
            names.join(", ")
        );
        self.report_lock().say_once("other machine".to_string(), || line.clone(), now);
        self.diagnostics.tell("machine", Health::Warning, line, &[]);
    }

    fn follow_parameters(&self) {
        let mut gate = self.gate();
        gate.set(settings(&self.parameters));
        gate.stop.set_at_the_node(self.parameters.flag("stop"));
        let heartbeat = self.parameters.double("stop_heartbeat");
        gate.stop.require_heartbeat((heartbeat > 0.0).then(|| seconds(heartbeat)));
    }

    fn gate(&self) -> MutexGuard<'_, Gate> {
        self.gate.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn report_lock(&self) -> MutexGuard<'_, Report> {
        self.report.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn settings(parameters: &Parameters) -> Settings {
    let stamps = StampLimits {
        max_age: parameters.double("command_max_age"),
        accept_unstamped: parameters.flag("accept_unstamped"),
    };
    Settings { timeout: seconds(parameters.double("command_timeout")), stamps }
}

fn seconds(value: f64) -> Duration {
    Duration::try_from_secs_f64(value).unwrap_or_default()
}

/// The valves with the operator's limits. `limits` has one value per cylinder, or none.
fn limited(valves: Vec<Valve>, limits: &[f64]) -> Result<Vec<Valve>, RosError> {
    if limits.is_empty() {
        return Ok(valves);
    }
    if limits.len() != valves.len() {
        let reason = format!("area_limits has {} values and the machine {} cylinders", limits.len(), valves.len());
        return Err(RosError::Parameter(reason));
    }
    let limit = |(valve, limit): (Valve, &f64)| Valve { maximum_area: valve.maximum_area.min(*limit), ..valve };
    Ok(valves.into_iter().zip(limits).map(limit).collect())
}
