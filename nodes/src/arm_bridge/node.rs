//! The bridge on the graph.

use std::net::UdpSocket;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use excavator_msgs::common::{FluidPressure, JointState};
use excavator_msgs::{ArmState, Header};

use super::datagram::decode;
use super::description::{Description, JointField, TopicKind, TopicSource, Udp};
use super::signals::{Fault, Signals};
use crate::error::VerbError;
use crate::ros::{
    Diagnostics, Health, Outlet, Pace, Parameter, RosArguments, RosClock, RosError, Supervisor, TopicQos, Value,
};

/// Longest time until a listening thread sees that the node ends.
const GLANCE: Duration = Duration::from_millis(100);
/// Time between two words to diagnostics.
const REPORT: Duration = Duration::from_millis(200);
/// Rate of `/joint_states`, Hz.
const JOINT_STATES_RATE: f64 = 50.0;

/// Runs the bridge until it is told to stop.
///
/// # Errors
/// [`VerbError`] when it cannot start.
pub fn run(ros: &RosArguments) -> Result<(), VerbError> {
    let file =
        Parameter::new("description", Value::String(String::new()), "file (.toml) that says where signals come from");
    let supervisor = Supervisor::start("arm_bridge", ros, vec![file.read_only()])?;
    let path = supervisor.parameters.text("description");
    if path.is_empty() {
        let reason = "no signals: give the file that describes them with -p description:=FILE.toml".to_string();
        return Err(RosError::Parameter(reason).into());
    }
    let description = Description::read(Path::new(&path)).map_err(RosError::Parameter)?;
    let signals = Arc::new(Mutex::new(Signals::new(description.treatments())));
    let refused = Arc::new(AtomicU64::new(0));
    let mut first = 0;
    let mut sockets = Vec::new();
    for udp in &description.udp {
        let socket = UdpSocket::bind(("0.0.0.0", udp.port))
            .and_then(|socket| socket.set_read_timeout(Some(GLANCE)).map(|()| socket))
            .map_err(|error| RosError::Endpoint {
                what: format!("UDP port {}", udp.port),
                reason: error.to_string(),
            })?;
        sockets.push((socket, udp, first));
        first += udp.fields.len();
    }
    for (index, source) in description.topics.iter().enumerate() {
        subscribe(&supervisor, source, first + index, &signals)?;
    }
    let publisher = Publisher {
        rate: description.rate,
        signals: &signals,
        states: supervisor.link.publish("/arm/state", TopicQos::reliable(50))?,
        joints: supervisor.link.publish("/joint_states", TopicQos::reliable(10))?,
        clock: &supervisor.clock,
        diagnostics: &supervisor.diagnostics,
        refused: &refused,
        // A bridge that reads /joint_states must not answer itself.
        echoes: description.topics.iter().any(|source| source.topic == "/joint_states"),
    };
    let stop = supervisor.stop_flag();
    std::thread::scope(|scope| {
        for (socket, udp, first) in &sockets {
            let (signals, refused, stop) = (&signals, &refused, &stop);
            scope.spawn(move || listen(socket, udp, *first, signals, refused, stop));
        }
        scope.spawn(|| publisher.run(&stop));
        supervisor.run(|| {});
    });
    supervisor.leave();
    Ok(())
}

fn lock(signals: &Mutex<Signals>) -> std::sync::MutexGuard<'_, Signals> {
    signals.lock().unwrap_or_else(PoisonError::into_inner)
}

fn listen(
    socket: &UdpSocket,
    layout: &Udp,
    first: usize,
    signals: &Mutex<Signals>,
    refused: &AtomicU64,
    stop: &AtomicBool,
) {
    // One byte more than any datagram can have shows those that are too long.
    let mut buffer = vec![0; 65_536];
    while !stop.load(Ordering::Relaxed) {
        // Errors are the time-out, or a network that is down: both are looked at again.
        let Ok(length) = socket.recv(&mut buffer) else { continue };
        let now = Instant::now();
        match decode(&buffer[..length], layout) {
            Some(values) => {
                let mut signals = lock(signals);
                for (index, value) in values.into_iter().enumerate() {
                    signals.take(first + index, value, now);
                }
            }
            None => {
                refused.fetch_add(1, Ordering::Relaxed);
            }
        }
    }
}

fn subscribe(
    supervisor: &Supervisor,
    source: &TopicSource,
    index: usize,
    signals: &Arc<Mutex<Signals>>,
) -> Result<(), RosError> {
    let signals = Arc::clone(signals);
    // Best effort hears every publisher, and an old value is of no use.
    let qos = TopicQos::best_effort(10);
    match source.kind {
        TopicKind::JointState => {
            let (joint, field) = (source.joint.clone(), source.field);
            supervisor.link.subscribe(&source.topic, qos, move |state: JointState, received| {
                let values = match field {
                    JointField::Position => &state.position,
                    JointField::Velocity => &state.velocity,
                    JointField::Effort => &state.effort,
                };
                let position = state.name.iter().position(|name| *name == joint);
                if let Some(value) = position.and_then(|position| values.get(position)) {
                    lock(&signals).take(index, *value, received.at);
                }
            })?;
        }
        TopicKind::FluidPressure => {
            supervisor.link.subscribe(&source.topic, qos, move |state: FluidPressure, received| {
                lock(&signals).take(index, state.fluid_pressure, received.at);
            })?;
        }
    }
    Ok(())
}

struct Publisher<'p> {
    rate: f64,
    signals: &'p Mutex<Signals>,
    states: Outlet<ArmState>,
    joints: Outlet<JointState>,
    clock: &'p RosClock,
    diagnostics: &'p Diagnostics,
    refused: &'p AtomicU64,
    echoes: bool,
}

impl Publisher<'_> {
    fn run(&self, stop: &AtomicBool) {
        let mut pace = Pace::new(self.rate);
        let mut reported: Option<Instant> = None;
        let joints_every = ((self.rate / JOINT_STATES_RATE).round() as u64).max(1);
        for round in 0_u64.. {
            if stop.load(Ordering::Relaxed) {
                return;
            }
            let now = Instant::now();
            let (state, faults) = lock(self.signals).state(self.clock.now(), now);
            if round % joints_every == 0 && !self.echoes {
                let _ = self.joints.publish(joint_state(&state));
            }
            // Refusals are counted by the outlet and told below.
            let _ = self.states.publish(state);
            if reported.is_none_or(|reported| reported.elapsed() >= REPORT) {
                reported = Some(now);
                self.report(&faults);
            }
            pace.wait();
        }
    }

    fn report(&self, faults: &[(usize, Fault)]) {
        let words: Vec<(String, String)> = faults
            .iter()
            .map(|(index, fault)| {
                let word = match fault {
                    Fault::Never => "never came".to_string(),
                    Fault::Stale(age) => format!("stale for {age:.2} s"),
                    Fault::OutOfRange(value) => format!("out of range: {value}"),
                };
                (lock(self.signals).name(*index).to_string(), word)
            })
            .collect();
        let mut values: Vec<(&str, String)> = words.iter().map(|(name, word)| (name.as_str(), word.clone())).collect();
        values.push(("refused datagrams", self.refused.load(Ordering::Relaxed).to_string()));
        values.push(("refused states", self.states.refused().to_string()));
        let names: Vec<&str> = words.iter().map(|(name, _)| name.as_str()).collect();
        let (health, message) = match names.as_slice() {
            [] => (Health::Ok, "all signals are measured".to_string()),
            names => (Health::Warning, format!("not measured: {}", names.join(", "))),
        };
        self.diagnostics.tell("signals", health, message, &values);
    }
}

fn joint_state(state: &ArmState) -> JointState {
    JointState {
        header: Header { stamp: state.header.stamp, frame_id: String::new() },
        name: state.cylinders.iter().map(|cylinder| format!("{}_joint", cylinder.name)).collect(),
        position: state.cylinders.iter().map(|cylinder| cylinder.joint_angle).collect(),
        velocity: Vec::new(),
        effort: Vec::new(),
    }
}
