//! Collects the received messages for the page.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use excavator_msgs::common::DiagnosticArray;
use excavator_msgs::{ArmState, CylinderEnergy, EnergyState, OrificeCommand};
use serde_json::{Map, Value, json};
use tokio::sync::watch;

use super::bounded::{self, MOST_SHOWN};
use super::gates;
use super::machine::{self, Machine};

/// Frames kept for a page that opens later: half a minute at 25 Hz.
const HISTORY: usize = 750;
/// Most bytes of these frames: half a minute of a machine with three cylinders has 3 MB.
const HISTORY_BYTES: usize = 8 << 20;
/// Most parts of nodes whose health is kept.
const MOST_PARTS: usize = 200;
/// Most alarms in a frame; the page shows the first eight.
const MOST_ALARMS: usize = 16;
/// Time without a message after which a part no longer counts as present.
const FORGOTTEN: Duration = Duration::from_secs(10);
/// Time without a message after which a command gate is no longer shown. A gate reports every second.
const GATE_SILENT: Duration = Duration::from_secs(3);
/// Most command gates in a frame.
const MOST_GATES: usize = 4;
/// Time without a state after which an alarm is raised.
const SILENT: Duration = Duration::from_secs(2);

/// The received content, shared between the subscriptions and the server.
pub struct Board {
    content: Mutex<Content>,
    newest: watch::Sender<Arc<str>>,
}

#[derive(Default)]
struct Content {
    /// Namespace of the nodes that are shown: `left/`, or empty.
    namespace: String,
    machine: Machine,
    number: u64,
    states: u64,
    balances: u64,
    state: Option<(ArmState, Instant)>,
    command: Option<(OrificeCommand, Instant)>,
    energy: Option<EnergyState>,
    /// Sums of the powers received since the last frame.
    powers: Powers,
    health: BTreeMap<String, Part>,
    history: VecDeque<Arc<str>>,
    /// Bytes of the history.
    size: usize,
}

#[derive(Default)]
struct Powers {
    count: f64,
    machine: [f64; 3],
    cylinders: BTreeMap<String, CylinderPowers>,
}

#[derive(Default)]
struct CylinderPowers {
    count: usize,
    sums: [f64; 4],
    terms: BTreeMap<String, f64>,
}

struct Part {
    level: u8,
    message: String,
    values: Vec<(String, String)>,
    heard: Instant,
}

impl Default for Board {
    fn default() -> Self {
        Board { content: Mutex::default(), newest: watch::channel(Arc::from("{}")).0 }
    }
}

impl Board {
    /// A board of the nodes in a namespace. Another namespace is another machine.
    pub fn in_namespace(namespace: &str) -> Self {
        let board = Board::default();
        let name = namespace.trim_matches('/');
        if !name.is_empty() {
            board.lock().namespace = format!("{name}/");
        }
        board
    }

    fn lock(&self) -> MutexGuard<'_, Content> {
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Stores a state of the arm.
    pub fn take_state(&self, state: ArmState) {
        let state = bounded::state(state);
        let mut content = self.lock();
        content.states += 1;
        content.state = Some((state, Instant::now()));
    }

    /// Stores a command.
    pub fn take_command(&self, command: OrificeCommand) {
        self.lock().command = Some((bounded::command(command), Instant::now()));
    }

    /// Adds a balance of the energy monitor.
    pub fn take_energy(&self, energy: EnergyState) {
        let energy = bounded::energy(energy);
        let mut content = self.lock();
        content.balances += 1;
        content.powers.add(&energy);
        content.energy = Some(energy);
    }

    /// Stores the health of parts of nodes.
    pub fn take_health(&self, array: DiagnosticArray) {
        let mut content = self.lock();
        for status in array.status.into_iter().take(MOST_PARTS).map(bounded::status) {
            if content.health.len() >= MOST_PARTS && !content.health.contains_key(&status.name) {
                content.forget_oldest();
            }
            let values = status.values.into_iter().map(|entry| (entry.key, entry.value)).collect();
            let part = Part { level: status.level, message: status.message, values, heard: Instant::now() };
            content.health.insert(status.name, part);
        }
    }

    /// Stores a robot description. Only browsers parse it.
    pub fn take_description(&self, description: String) {
        self.lock().machine.describe(description);
    }

    /// Stores the scales of a model, given as text. An unreadable text is ignored.
    pub fn take_model(&self, text: &str) {
        // Parsed before the lock is taken, so that a large model does not delay the frames.
        if let Some(scales) = machine::scales(text) {
            self.lock().machine.scale(scales);
        }
    }

    /// The robot description and the scales of the cylinders, as JSON.
    pub fn machine(&self) -> String {
        self.lock().machine.to_json().to_string()
    }

    /// Makes a frame of the current content and publishes it to the pages.
    pub fn frame(&self) -> Arc<str> {
        let mut content = self.lock();
        content.number += 1;
        let frame: Arc<str> = Arc::from(content.to_json().to_string());
        content.powers = Powers::default();
        content.history.push_back(Arc::clone(&frame));
        content.size += frame.len();
        while content.history.len() > HISTORY || content.size > HISTORY_BYTES {
            let Some(oldest) = content.history.pop_front() else { break };
            content.size -= oldest.len();
        }
        drop(content);
        self.newest.send_replace(Arc::clone(&frame));
        frame
    }

    /// The frames of the last half minute, oldest first.
    pub fn history(&self) -> Vec<Arc<str>> {
        self.lock().history.iter().cloned().collect()
    }

    /// Returns a receiver of the newest frame.
    pub fn subscribe(&self) -> watch::Receiver<Arc<str>> {
        self.newest.subscribe()
    }
}

impl Powers {
    fn add(&mut self, energy: &EnergyState) {
        self.count += 1.0;
        let machine = [energy.pump_power, energy.bypass_loss, energy.metering_loss];
        self.machine.iter_mut().zip(machine).for_each(|(sum, power)| *sum += power);
        for cylinder in &energy.cylinders {
            if self.cylinders.len() >= MOST_SHOWN && !self.cylinders.contains_key(&cylinder.name) {
                continue;
            }
            let CylinderPowers { count, sums, terms } = self.cylinders.entry(cylinder.name.clone()).or_default();
            // A balance without a rate, as at the ends of gaps, would make all sums NaN.
            if !powers_of(cylinder).iter().all(|power| power.is_finite()) {
                continue;
            }
            *count += 1;
            sums.iter_mut().zip(powers_of(cylinder)).for_each(|(sum, power)| *sum += power);
            for term in &cylinder.terms {
                if terms.len() >= MOST_SHOWN && !terms.contains_key(&term.effect) {
                    continue;
                }
                *terms.entry(term.effect.clone()).or_default() += term.power;
            }
        }
    }
}

fn powers_of(cylinder: &CylinderEnergy) -> [f64; 4] {
    [cylinder.hamiltonian_rate, cylinder.supply, cylinder.dissipation, cylinder.balance_residual]
}

/// JSON has no NaN. Seven digits are more than a plot shows.
fn finite(value: f64) -> Value {
    if value.is_finite() { json!(format!("{value:.6e}").parse::<f64>().unwrap_or(value)) } else { Value::Null }
}

/// Seconds since `then`, rounded to a hundredth.
fn age(then: Option<Instant>) -> Value {
    finite(then.map_or(f64::NAN, |then| (then.elapsed().as_secs_f64() * 100.0).round() / 100.0))
}

/// The clock of this machine. Pages show its times in their own time zone.
fn milliseconds_since_epoch() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(since.as_millis()).unwrap_or_default()
}

impl Content {
    /// Drops the part with the oldest message to make room. Nodes report every second, so a part that still exists comes back.
    fn forget_oldest(&mut self) {
        let oldest = self.health.iter().min_by_key(|(_, part)| part.heard).map(|(name, _)| name.clone());
        if let Some(name) = oldest {
            self.health.remove(&name);
        }
    }

    fn to_json(&self) -> Value {
        let (stamp, silent) = match &self.state {
            Some((state, heard)) => (state.header.stamp.nanoseconds() as f64 * 1e-9, heard.elapsed() > SILENT),
            None => (f64::NAN, true),
        };
        let measured =
            |field: fn(&ArmState) -> f64| finite(self.state.as_ref().map_or(f64::NAN, |(state, _)| field(state)));
        json!({
            "number": self.number,
            "time": milliseconds_since_epoch(),
            "machine": self.machine.version(),
            "stamp": if stamp.is_finite() { json!(stamp) } else { Value::Null },
            "states": self.states,
            "balances": self.balances,
            "state_age": age(self.state.as_ref().map(|(_, heard)| *heard)),
            "command_age": age(self.command.as_ref().map(|(_, heard)| *heard)),
            "pump_pressure": measured(|state| state.pump_pressure),
            "oil_temperature": measured(|state| state.oil_temperature),
            "cylinders": self.cylinders(),
            "gates": self.gates(),
            "powers": self.powers(),
            "alarms": self.alarms(silent),
        })
    }

    /// The content of the command gates: who commands each valve, which are closed and why, and who has stopped the machine.
    fn gates(&self) -> Vec<Value> {
        let heard = self.health.iter().filter(|(_, part)| part.heard.elapsed() < GATE_SILENT);
        heard
            .filter_map(|(name, part)| {
                let node = gates::node_of(name, &self.namespace)?;
                Some(gates::gate(node, &part.message, &part.values))
            })
            .take(MOST_GATES)
            .collect()
    }

    fn cylinders(&self) -> Map<String, Value> {
        let Some((state, _)) = &self.state else { return Map::new() };
        state
            .cylinders
            .iter()
            .map(|own| {
                let command = self.command.as_ref().and_then(|(command, _)| {
                    let index = command.names.iter().position(|name| *name == own.name)?;
                    command.areas.get(index).copied()
                });
                let numbers = json!({
                    "joint_angle": finite(own.joint_angle),
                    "displacement": finite(own.displacement), "velocity": finite(own.velocity),
                    "cap_pressure": finite(own.cap_pressure), "rod_pressure": finite(own.rod_pressure),
                    "orifice_area": finite(own.orifice_area), "command": finite(command.unwrap_or(f64::NAN)),
                });
                (own.name.clone(), numbers)
            })
            .collect()
    }

    /// Means since the last frame; `null` where no balance came.
    fn powers(&self) -> Value {
        let Some(energy) = &self.energy else { return Value::Null };
        if self.powers.count == 0.0 {
            return Value::Null;
        }
        let [pump, bypass, metering] = self.powers.machine.map(|sum| finite(sum / self.powers.count));
        let cylinders: Map<String, Value> = energy
            .cylinders
            .iter()
            .filter_map(|own| {
                let CylinderPowers { count, sums, terms } = self.powers.cylinders.get(&own.name)?;
                let count = *count as f64;
                let [rate, supply, dissipation, residual] = sums.map(|sum| finite(sum / count));
                let terms: Map<String, Value> =
                    terms.iter().map(|(effect, sum)| (effect.clone(), finite(sum / count))).collect();
                let numbers = json!({
                    "kinetic": finite(own.kinetic), "potential": finite(own.potential),
                    "cap_internal": finite(own.cap_internal), "rod_internal": finite(own.rod_internal),
                    "hamiltonian": finite(own.hamiltonian), "hamiltonian_rate": rate, "supply": supply,
                    "dissipation": dissipation, "residual": residual, "terms": terms,
                });
                Some((own.name.clone(), numbers))
            })
            .collect();
        json!({"pump_power": pump, "bypass_loss": bypass, "metering_loss": metering, "cylinders": cylinders})
    }

    /// All parts with warnings or errors, worst first.
    fn alarms(&self, silent: bool) -> Vec<Value> {
        let mut alarms = Vec::new();
        if silent {
            alarms.push(json!({"level": 2, "part": "dashboard", "message": "no states on /arm/state", "values": {}}));
        }
        let unwell = self.health.iter().filter(|(_, part)| part.level > 0 && part.heard.elapsed() < FORGOTTEN);
        for (name, part) in unwell {
            let values: Map<String, Value> =
                part.values.iter().map(|(key, value)| (key.clone(), Value::from(value.clone()))).collect();
            alarms.push(json!({"level": part.level, "part": name, "message": part.message, "values": values}));
        }
        alarms.sort_by_key(|alarm| std::cmp::Reverse(alarm["level"].as_u64()));
        alarms.truncate(MOST_ALARMS);
        alarms
    }
}

#[cfg(test)]
#[path = "board_tests.rs"]
mod tests;
