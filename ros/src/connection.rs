//! One connection to the ROS graph, and everything that exists only as long as the connection.

use std::any::Any;
use std::collections::BTreeSet;
use std::sync::Arc;

use ros2_client::{Context, Node, NodeName, NodeOptions};
use rustdds::{DomainParticipant, DomainParticipantBuilder, QosPolicies, Topic, TopicKind};
use tokio::runtime::Handle;

use super::arrivals::Writer;
use super::farewell::Farewell;
use super::guard::{Before, Guard, GuardError};
use super::probe::Probe;
use super::threads::Threads;
use super::{Environment, NodeIdentity, RosError, Security};

/// A task that runs as long as an endpoint is open.
pub type Task = tokio::task::JoinHandle<()>;

/// Installs what was created on a new connection. Creating may hang; installing must not.
pub type Install = Box<dyn FnOnce(&Handle) + Send>;

/// What remains of a closed endpoint.
#[derive(Default)]
#[must_use = "tasks must be ended, and what remains be dropped where that may hang"]
pub struct Closed {
    /// Tasks to abort.
    pub tasks: Vec<Task>,
    /// Values to drop. Dropping may hang.
    pub remains: Vec<Box<dyn Any + Send>>,
}

impl Closed {
    /// Only tasks.
    pub fn tasks(tasks: impl IntoIterator<Item = Task>) -> Self {
        Closed { tasks: tasks.into_iter().collect(), remains: Vec::new() }
    }

    /// Only a writer, if there was one.
    pub fn writer<W: Send + 'static>(writer: Option<W>) -> Self {
        let boxed = writer.map(|writer| Box::new(writer) as Box<dyn Any + Send>);
        Closed { tasks: Vec::new(), remains: boxed.into_iter().collect() }
    }
}

impl Extend<Closed> for Closed {
    fn extend<I: IntoIterator<Item = Closed>>(&mut self, others: I) {
        for other in others {
            self.tasks.extend(other.tasks);
            self.remains.extend(other.remains);
        }
    }
}

/// What an endpoint needs.
pub enum Tended {
    /// Nothing.
    Nothing,
    /// To be opened once more, beside itself.
    Open,
    /// Its second reader is closed.
    Closed(Closed),
    /// Its first reader was deaf and is closed; the topic.
    Replaced(String, Closed),
}

/// An endpoint that exists on a connection and is opened again on the next one.
pub trait Endpoint: Send + Sync {
    /// Creates the endpoint on a new connection. It is not used before it is installed: a connection may turn out to be
    /// dead when the next one already exists.
    fn open(self: Arc<Self>, connection: &mut Connection) -> Result<Install, RosError>;

    /// Releases everything that belongs to the connection.
    fn close(&self) -> Closed;

    /// Checks a reader against the writers on the graph. It may ask to be opened once more beside itself, or give back
    /// what it does not need any more.
    fn tend(&self, _present: &mut dyn FnMut() -> BTreeSet<Writer>) -> Tended {
        Tended::Nothing
    }

    /// Full name and ROS type of the topic, if the endpoint is a topic.
    fn interface(&self) -> Option<(String, String)> {
        None
    }
}

/// One participant with its node.
pub struct Connection {
    // Dropped in this order: the node leaves the graph through the context.
    probe: Option<Probe>,
    node: Node,
    context: Context,
    threads: Threads,
    guard: Result<Guard, GuardError>,
    // Last: it sends its message after the participant has gone.
    farewell: Farewell,
}

impl Drop for Connection {
    fn drop(&mut self) {
        self.farewell.prepare(&self.context.domain_participant());
    }
}

impl Connection {
    pub(super) fn join(identity: &NodeIdentity, environment: &Environment) -> Result<Self, RosError> {
        let failed = |reason: String| RosError::Join { domain: environment.domain, reason };
        let (participant, threads) = Threads::started_by(|| participant(environment));
        let (participant, guard) = participant.map_err(failed)?;
        // Before all other endpoints; see `probe.rs`.
        let probe = Some(Probe::open(&participant).map_err(failed)?);
        let context = Context::from_domain_participant(participant).map_err(|error| failed(error.to_string()))?;
        let name = NodeName::new(identity.namespace(), identity.name()).map_err(|error| failed(error.to_string()))?;
        // Parameter services and log are our own: those of the library are bound to one mapping and to its own spinner.
        let options = NodeOptions::new().enable_rosout(false).start_parameter_services(false);
        let node = context.new_node(name, options).map_err(|error| failed(error.to_string()))?;
        Ok(Connection { node, context, threads, guard, probe, farewell: Farewell::new(environment) })
    }

    /// Creates an endpoint on this connection; the connection is returned with it.
    pub(super) fn with(mut self, endpoint: Arc<dyn Endpoint>) -> (Self, Result<Install, RosError>) {
        let opened = endpoint.open(&mut self);
        (self, opened)
    }

    /// The node, to create endpoints with.
    pub fn node(&mut self) -> &mut Node {
        &mut self.node
    }

    /// A handle to the participant.
    pub fn participant(&self) -> DomainParticipant {
        self.context.domain_participant()
    }

    /// The threads of the participant.
    pub(super) fn threads(&self) -> Threads {
        self.threads.clone()
    }

    /// The first endpoints of the connection, for its watch. Returned only once.
    pub(super) fn take_probe(&mut self) -> Option<Probe> {
        self.probe.take()
    }

    /// The filter in front of the sockets of the participant, or the reason why there is none.
    pub(super) fn guard(&self) -> Result<Guard, GuardError> {
        self.guard.clone()
    }

    /// Creates a topic from its name and type in DDS.
    ///
    /// # Errors
    /// The error message of the middleware.
    pub fn create_topic(&self, dds_name: &str, dds_type: &str, qos: &QosPolicies) -> Result<Topic, String> {
        self.participant()
            .create_topic(dds_name.to_string(), dds_type.to_string(), qos, TopicKind::NoKey)
            .map_err(|error| error.to_string())
    }
}

/// Creates a participant in the domain and on the networks of the environment. The filter is attached to its sockets
/// before it can have met a peer.
pub(super) fn participant(environment: &Environment) -> Result<(DomainParticipant, Result<Guard, GuardError>), String> {
    let builder = DomainParticipantBuilder::new(environment.domain);
    let builder = match environment.networks() {
        Some(networks) => builder.with_only_networks(networks),
        None => builder,
    };
    let builder = match &environment.security {
        Security::Off => builder,
        Security::Enclave(folder) => secured(builder, folder)?,
    };
    let before = Before::look();
    let participant = builder.build().map_err(|error| error.to_string())?;
    Ok((participant, Guard::attach(&before, environment)))
}

#[cfg(feature = "security")]
#[allow(clippy::unnecessary_wraps)]
fn secured(builder: DomainParticipantBuilder, enclave: &std::path::Path) -> Result<DomainParticipantBuilder, String> {
    // SROS2 does not encrypt keys.
    let files = rustdds::DomainParticipantSecurityConfigFiles::with_ros_default_names(enclave, String::new());
    Ok(builder.builtin_security(files))
}

#[cfg(not(feature = "security"))]
fn secured(_: DomainParticipantBuilder, enclave: &std::path::Path) -> Result<DomainParticipantBuilder, String> {
    Err(format!("this build has no DDS Security for {}", enclave.display()))
}
