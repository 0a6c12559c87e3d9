//! The connection of this process to the ROS graph, and the endpoints that outlive it.

use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use excavator_msgs::Message;
use ros2_client::{Context, Node, NodeName, NodeOptions};
use rustdds::{DomainParticipant, DomainParticipantBuilder, QosPolicies, Topic, TopicKind};
use tokio::runtime::Handle;

use super::dds_names::dds_topic;
use super::inlet::{Inlet, Received};
use super::{Environment, Latched, NodeIdentity, Outlet, RosError, TopicQos};

/// Something that runs as long as an endpoint is open.
pub(crate) type Task = tokio::task::JoinHandle<()>;

/// How long the old connection may take to go before it is left to itself.
const FAREWELL: Duration = Duration::from_secs(2);

/// Something that exists on a connection and is opened again on the next one.
pub(crate) trait Endpoint: Send + Sync {
    /// Creates the endpoint on a new connection.
    fn open(&self, connection: &mut Connection, runtime: &Handle) -> Result<(), RosError>;

    /// Gives up what belongs to the connection; the tasks are ended by the caller.
    fn close(&self) -> Vec<Task>;

    /// Full name and ROS type of the topic, where it is one.
    fn interface(&self) -> Option<(String, String)> {
        None
    }
}

/// One participant with its node.
pub(crate) struct Connection {
    // Dropped in this order: the node says good-bye through the context.
    node: Node,
    context: Context,
}

impl Connection {
    fn join(identity: &NodeIdentity, environment: &Environment) -> Result<Self, RosError> {
        let failed = |reason: String| RosError::Join { domain: environment.domain, reason };
        let participant = participant(environment).map_err(failed)?;
        let context = Context::from_domain_participant(participant).map_err(|error| failed(error.to_string()))?;
        let name = NodeName::new(identity.namespace(), identity.name()).map_err(|error| failed(error.to_string()))?;
        // Parameter services and log are ours: the library's are bound to one mapping and to its own spinner.
        let options = NodeOptions::new().enable_rosout(false).start_parameter_services(false);
        let node = context.new_node(name, options).map_err(|error| failed(error.to_string()))?;
        Ok(Connection { node, context })
    }

    pub(crate) fn node(&mut self) -> &mut Node {
        &mut self.node
    }

    pub(crate) fn participant(&self) -> DomainParticipant {
        self.context.domain_participant()
    }

    pub(crate) fn create_topic(&self, dds_name: &str, dds_type: &str, qos: &QosPolicies) -> Result<Topic, String> {
        self.participant()
            .create_topic(dds_name.to_string(), dds_type.to_string(), qos, TopicKind::NoKey)
            .map_err(|error| error.to_string())
    }
}

/// A participant in the domain and on the networks of the environment.
pub(super) fn participant(environment: &Environment) -> Result<DomainParticipant, String> {
    let builder = DomainParticipantBuilder::new(environment.domain);
    let builder = match environment.networks() {
        Some(networks) => builder.with_only_networks(networks),
        None => builder,
    };
    builder.build().map_err(|error| error.to_string())
}

/// The connection of this process to the ROS graph; clones share it.
#[derive(Clone)]
pub struct Link {
    shared: Arc<Shared>,
}

struct Shared {
    identity: NodeIdentity,
    environment: Environment,
    runtime: Handle,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    connection: Option<Connection>,
    endpoints: Vec<Arc<dyn Endpoint>>,
}

impl Link {
    pub(super) fn join(identity: NodeIdentity, environment: Environment, runtime: Handle) -> Result<Self, RosError> {
        let connection = Connection::join(&identity, &environment)?;
        let state = Mutex::new(State { connection: Some(connection), endpoints: Vec::new() });
        Ok(Link { shared: Arc::new(Shared { identity, environment, runtime, state }) })
    }

    /// Name and namespace of the node.
    pub fn identity(&self) -> &NodeIdentity {
        &self.shared.identity
    }

    /// Domain, range and mapping.
    pub fn environment(&self) -> &Environment {
        &self.shared.environment
    }

    pub(crate) fn runtime(&self) -> &Handle {
        &self.shared.runtime
    }

    /// A publisher.
    ///
    /// # Errors
    /// [`RosError::Name`], [`RosError::Endpoint`].
    pub fn publish<M: Message + Send + Sync + 'static>(
        &self,
        name: &str,
        qos: TopicQos,
    ) -> Result<Outlet<M>, RosError> {
        let outlet = Outlet::new(self.shared.identity.resolve(name)?, qos);
        self.add(Arc::new(outlet.clone()))?;
        Ok(outlet)
    }

    /// A publisher whose last message late joiners get.
    ///
    /// # Errors
    /// [`RosError::Name`], [`RosError::Endpoint`].
    pub fn publish_latched<M>(&self, name: &str, qos: TopicQos) -> Result<Latched<M>, RosError>
    where
        M: Message + Clone + Send + Sync + 'static,
    {
        let latched = Latched::new(Outlet::new(self.shared.identity.resolve(name)?, qos));
        self.add(Arc::new(latched.clone()))?;
        Ok(latched)
    }

    /// A subscription; `callback` runs on the thread of the link and must be brief. Returns the counter of messages
    /// that could not be decoded.
    ///
    /// # Errors
    /// [`RosError::Name`], [`RosError::Endpoint`].
    pub fn subscribe<M: Message + Send + Sync + 'static>(
        &self,
        name: &str,
        qos: TopicQos,
        callback: impl FnMut(M, Received) + Send + 'static,
    ) -> Result<Arc<AtomicU64>, RosError> {
        let inlet = Inlet::new(self.shared.identity.resolve(name)?, qos, Box::new(callback));
        let undecodable = inlet.undecodable();
        self.add(Arc::new(inlet))?;
        Ok(undecodable)
    }

    pub(crate) fn add(&self, endpoint: Arc<dyn Endpoint>) -> Result<(), RosError> {
        let mut state = self.lock();
        let State { connection, endpoints } = &mut *state;
        if let Some(connection) = connection {
            endpoint.open(connection, &self.shared.runtime)?;
        }
        endpoints.push(endpoint);
        Ok(())
    }

    /// Closes all endpoints for good, with what their callbacks hold. Must not be called from the runtime.
    pub(crate) fn forget_endpoints(&self) {
        let (endpoints, tasks) = {
            let mut state = self.lock();
            let endpoints = std::mem::take(&mut state.endpoints);
            let tasks: Vec<Task> = endpoints.iter().flat_map(|endpoint| endpoint.close()).collect();
            (endpoints, tasks)
        };
        self.end(tasks);
        drop(endpoints);
    }

    /// The participant of the connection, `None` while there is none.
    pub(crate) fn participant(&self) -> Option<DomainParticipant> {
        self.lock().connection.as_ref().map(Connection::participant)
    }

    /// Whether somebody on the graph reads a topic.
    pub(crate) fn has_readers(&self, name: &str) -> bool {
        let (Some(participant), Ok(name)) = (self.participant(), self.shared.identity.resolve(name)) else {
            return false;
        };
        let wanted = dds_topic(&name);
        participant.discovered_readers().iter().any(|reader| *reader.subscription_topic_data.topic_name() == wanted)
    }

    /// Topics and types of all endpoints.
    pub(super) fn interfaces(&self) -> Vec<(String, String)> {
        self.lock().endpoints.iter().filter_map(|endpoint| endpoint.interface()).collect()
    }

    /// Leaves the graph and joins it again with all endpoints. Must not be called from the runtime.
    ///
    /// # Errors
    /// [`RosError`]; the link is down then, and this can be tried again.
    pub(super) fn rebuild(&self) -> Result<(), RosError> {
        self.leave();
        let mut connection = Connection::join(&self.shared.identity, &self.shared.environment)?;
        let mut state = self.lock();
        for endpoint in &state.endpoints {
            endpoint.open(&mut connection, &self.shared.runtime)?;
        }
        state.connection = Some(connection);
        Ok(())
    }

    /// Leaves the graph: endpoints first, then the node, then the participant. Must not be called from the runtime.
    pub(super) fn leave(&self) {
        let (connection, tasks) = {
            let mut state = self.lock();
            let tasks: Vec<Task> = state.endpoints.iter().flat_map(|endpoint| endpoint.close()).collect();
            (state.connection.take(), tasks)
        };
        self.end(tasks);
        // A middleware whose threads have died can hang in its farewell; nobody may wait for that for ever.
        let (gone, wait) = std::sync::mpsc::channel();
        std::thread::spawn(move || {
            drop(connection);
            let _ = gone.send(());
        });
        let _ = wait.recv_timeout(FAREWELL);
    }

    fn end(&self, tasks: Vec<Task>) {
        tasks.iter().for_each(Task::abort);
        // A task holds its reader until it has seen the abort.
        self.shared.runtime.block_on(async {
            let all = futures::future::join_all(tasks);
            let _ = tokio::time::timeout(FAREWELL, all).await;
        });
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        self.shared.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
