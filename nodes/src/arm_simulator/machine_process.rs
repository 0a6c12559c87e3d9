//! Runs the machine in a process of its own.
//!
//! The network can kill a process that uses it: by exhausted memory, or an abort in the middleware. A valve must not stay open
//! because of that. So the machine with its valves runs in a second process that no packet reaches. It executes the orders of
//! the node that started it, sample by sample, through a socket pair and under a lease of its own. If the node dies, the valves
//! close at once. If the node hangs, they close when the lease expires.

use std::io::{Read, Write};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use excavator_msgs::ArmState;
use rosbag2::cdr;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::command_gate::Wanted;
use crate::error::NodeError;

/// Longest time for an answer of the machine. A model that takes longer for one sample is stuck.
const LONGEST_ANSWER: Duration = Duration::from_secs(10);
/// Largest message, bytes: the text of a model with tables.
const LARGEST: usize = 64 << 20;

/// How the machine is set up, said once.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Setup {
    /// The model as TOML text.
    pub model: String,
    /// Name that its log lines have.
    pub name: String,
    /// Piston displacements at the start, m.
    pub start_displacement: Vec<f64>,
    /// Time between two samples, s of the machine.
    pub period: f64,
    /// Time between two samples on the wall, s.
    pub wall_period: f64,
    /// Pressure of a supply that is kept from outside, Pa; 0: as the machine says.
    pub supply_pressure: f64,
    /// Least time from closed to fully open, s.
    pub opening_time: f64,
    /// Time from fully open to closed for safety, s.
    pub closing_time: f64,
}

/// What the node asks for, once per sample.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Order {
    /// Orifice area per valve, m².
    pub areas: Vec<f64>,
    /// Whether the valve closes for safety, per valve.
    pub closing: Vec<bool>,
    /// Samples to advance: more than one if the node was late.
    pub samples: u32,
    /// Time without an order after which the valves close, s.
    pub lease: f64,
    /// Oil temperature that is reported, degC.
    pub oil_temperature: f64,
}

/// What the machine answers.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Answer {
    /// The state, as perfect instruments see it; stamped by the node.
    pub state: ArmState,
    /// Samples of the machine's time so far, also those that it went on by alone.
    pub samples: u64,
    /// When it was so by the system's clock, ns since the epoch. A node that was stopped in between reads it later.
    pub sampled_at: i64,
    /// Joint rates, rad/s or m/s.
    pub joint_rates: Vec<f64>,
    /// Whether every valve is closed.
    pub closed: bool,
    /// Steps in which the rate of an opening was limited, so far.
    pub limited: u64,
    /// Why the machine was set up again since the last answer; empty: it was not.
    pub failures: Vec<String>,
}

/// The first answer: empty, or why the machine cannot be set up.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Ready {
    /// Why it is not; empty: it is.
    pub failure: String,
}

/// Why the two processes cannot communicate.
#[derive(Debug, thiserror::Error)]
pub(super) enum TalkError {
    /// The other process has ended, or does not answer in time.
    #[error(transparent)]
    Broken(#[from] std::io::Error),
    /// The bytes received are not a valid message.
    #[error("{0}")]
    Nonsense(String),
}

/// Sends one message.
pub(super) fn send<M: Serialize>(stream: &mut UnixStream, message: &M) -> Result<(), TalkError> {
    let content = cdr::encode(message).map_err(|error| TalkError::Nonsense(error.to_string()))?;
    let length = u32::try_from(content.len()).map_err(|error| TalkError::Nonsense(error.to_string()))?;
    // In one write, so that the reader never sees half a message if this process is killed.
    let mut bytes = length.to_le_bytes().to_vec();
    bytes.extend(content);
    Ok(stream.write_all(&bytes)?)
}

/// Receives one message.
pub(super) fn receive<M: DeserializeOwned>(stream: &mut UnixStream) -> Result<M, TalkError> {
    let mut length = [0; 4];
    stream.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length) as usize;
    if length > LARGEST {
        return Err(TalkError::Nonsense(format!("a message of {length} bytes, more than {LARGEST}")));
    }
    let mut content = vec![0; length];
    stream.read_exact(&mut content)?;
    cdr::decode(&content).map_err(|error| TalkError::Nonsense(error.to_string()))
}

/// The node's end.
pub(super) struct MachineProcess {
    child: Child,
    stream: UnixStream,
    order: Order,
}

impl MachineProcess {
    /// Starts the process and sets the machine up. Signals that this thread blocks stay blocked in the new process: a Ctrl-C in
    /// the terminal ends the node, and the node closes the valves.
    ///
    /// # Errors
    /// [`NodeError::Machine`] if the model or the start is faulty; [`NodeError::System`].
    pub fn start(setup: &Setup) -> Result<Self, NodeError> {
        let (stream, theirs) = UnixStream::pair()?;
        let child = Command::new(std::env::current_exe()?)
            .arg("machine")
            .stdin(Stdio::from(OwnedFd::from(theirs)))
            .stdout(Stdio::null())
            .spawn()?;
        stream.set_read_timeout(Some(LONGEST_ANSWER))?;
        let order = Order { areas: vec![], closing: vec![], samples: 1, lease: 0.0, oil_temperature: 0.0 };
        let mut process = MachineProcess { child, stream, order };
        let talked = send(&mut process.stream, setup).and_then(|()| receive::<Ready>(&mut process.stream));
        let ready = talked.map_err(|error| process.ended(&error))?;
        if ready.failure.is_empty() { Ok(process) } else { Err(NodeError::Machine(ready.failure)) }
    }

    /// Simulates the given number of samples with these openings.
    ///
    /// # Errors
    /// [`NodeError::Machine`] when the process has ended or does not answer.
    pub fn go_on(
        &mut self,
        wanted: &[Wanted],
        samples: u64,
        lease: Duration,
        oil_temperature: f64,
    ) -> Result<Answer, NodeError> {
        self.order.areas.clear();
        self.order.areas.extend(wanted.iter().map(|wanted| wanted.area));
        self.order.closing.clear();
        self.order.closing.extend(wanted.iter().map(|wanted| wanted.closing));
        self.order.samples = u32::try_from(samples).unwrap_or(u32::MAX);
        self.order.lease = lease.as_secs_f64();
        self.order.oil_temperature = oil_temperature;
        let talked = send(&mut self.stream, &self.order).and_then(|()| receive(&mut self.stream));
        talked.map_err(|error| self.ended(&error))
    }

    fn ended(&mut self, error: &TalkError) -> NodeError {
        let status =
            self.child.try_wait().ok().flatten().map_or_else(|| error.to_string(), |status| status.to_string());
        NodeError::Machine(format!("the process of the simulated machine has failed: {status}"))
    }
}

impl Drop for MachineProcess {
    fn drop(&mut self) {
        // The machine ends when its stream closes, after the closing ramp.
        let _ = self.stream.shutdown(std::net::Shutdown::Both);
        let start = Instant::now();
        while matches!(self.child.try_wait(), Ok(None)) {
            if start.elapsed() > LONGEST_ANSWER {
                let _ = self.child.kill();
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}
