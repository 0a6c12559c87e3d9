//! The connection of this process to the ROS graph, and the endpoints that outlive it.

use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex, PoisonError};

use excavator_msgs::Message;
use ros2_client::Gid;
use rustdds::DomainParticipant;
use tokio::runtime::Handle;

use super::connection::{Closed, Connection, Endpoint, Install, Task, Tended};
use super::dds_names::dds_topic;
use super::guard::{Guard, GuardError};
use super::inlet::{Inlet, Received};
use super::patience::{BUILDING, FAREWELL, let_go, within};
use super::probe::Probe;
use super::threads::Threads;
use super::{Environment, Latched, NodeIdentity, Outlet, RosError, TopicQos};

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
        let (connection, _) = build(&identity, &environment, Vec::new())?;
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

    /// The runtime for tasks of the link.
    pub fn runtime(&self) -> &Handle {
        &self.shared.runtime
    }

    /// Creates a publisher.
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

    /// Creates a publisher whose last message is sent to late joiners.
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

    /// Creates a subscription. `callback` runs on the thread of the link and must be brief. Returns the counter of
    /// messages that could not be decoded.
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

    /// Opens an endpoint, now and on every later connection. If the middleware fails meanwhile, the endpoint waits for
    /// the next connection.
    ///
    /// # Errors
    /// [`RosError::Endpoint`]: the endpoint cannot be opened, and later connections do not open it either.
    pub fn add(&self, endpoint: Arc<dyn Endpoint>) -> Result<(), RosError> {
        let mut state = self.lock();
        if let Some(connection) = state.connection.take() {
            let opening = Arc::clone(&endpoint);
            if let Some((connection, opened)) = within(BUILDING, move || connection.with(opening)) {
                match opened {
                    Ok(install) => install(&self.shared.runtime),
                    Err(_) if connection.threads().died().is_some() => {}
                    Err(error) => {
                        state.connection = Some(connection);
                        return Err(error);
                    }
                }
                state.connection = Some(connection);
            }
        }
        state.endpoints.push(endpoint);
        Ok(())
    }

    /// Looks after the readers: one that is deaf to a writer that goes on is replaced. Returns the topics of these. Must
    /// not be called from the runtime.
    pub(super) fn tend(&self) -> Vec<String> {
        let (endpoints, participant) = {
            let state = self.lock();
            (state.endpoints.clone(), state.connection.as_ref().map(Connection::participant))
        };
        let Some(participant) = participant else { return Vec::new() };
        let mut present = || {
            let writers = participant.discovered_writers();
            writers.iter().map(|data| Gid::from(data.publication_topic_data.key).to_bytes16()).collect()
        };
        let mut replaced = Vec::new();
        for endpoint in endpoints {
            match endpoint.tend(&mut present) {
                Tended::Nothing => {}
                Tended::Open => self.open_beside(endpoint),
                Tended::Closed(closed) => self.end(closed.tasks),
                Tended::Replaced(topic, closed) => {
                    self.end(closed.tasks);
                    replaced.push(topic);
                }
            }
        }
        replaced
    }

    /// Opens an endpoint once more. If the middleware fails meanwhile, the watch finds that.
    fn open_beside(&self, endpoint: Arc<dyn Endpoint>) {
        let mut state = self.lock();
        let Some(connection) = state.connection.take() else { return };
        let Some((connection, opened)) = within(BUILDING, move || connection.with(endpoint)) else { return };
        if let Ok(install) = opened {
            install(&self.shared.runtime);
        }
        state.connection = Some(connection);
    }

    /// Closes all endpoints permanently and drops their callbacks. Must not be called from the runtime.
    pub fn forget_endpoints(&self) {
        let (endpoints, closed) = {
            let mut state = self.lock();
            let endpoints = std::mem::take(&mut state.endpoints);
            let closed = close(&endpoints);
            (endpoints, closed)
        };
        self.end(closed.tasks);
        let_go((closed.remains, endpoints));
    }

    /// The participant of the connection, `None` while there is none.
    pub fn participant(&self) -> Option<DomainParticipant> {
        self.lock().connection.as_ref().map(Connection::participant)
    }

    /// The participant of the connection, its threads and its probe (returned only once); `None` while there is no
    /// connection.
    pub(super) fn alive(&self) -> Option<(DomainParticipant, Threads, Option<Probe>)> {
        let mut state = self.lock();
        let connection = state.connection.as_mut()?;
        Some((connection.participant(), connection.threads(), connection.take_probe()))
    }

    /// The filter in front of the sockets of the middleware, or the reason why there is none; `None` while there is no
    /// connection.
    pub(super) fn guard(&self) -> Option<Result<Guard, GuardError>> {
        self.lock().connection.as_ref().map(Connection::guard)
    }

    /// Whether a topic has readers on the graph.
    pub fn has_readers(&self, name: &str) -> bool {
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
    /// [`RosError`]. The link is then down, and the call can be repeated.
    pub(super) fn rebuild(&self) -> Result<(), RosError> {
        self.leave();
        // Calls that add an endpoint wait for the lock until the new connection exists.
        let mut state = self.lock();
        let (connection, installs) = build(&self.shared.identity, &self.shared.environment, state.endpoints.clone())?;
        installs.into_iter().for_each(|install| install(&self.shared.runtime));
        state.connection = Some(connection);
        Ok(())
    }

    /// Leaves the graph: endpoints first, then the node, then the participant. Must not be called from the runtime.
    pub(super) fn leave(&self) {
        let (connection, closed) = {
            let mut state = self.lock();
            let closed = close(&state.endpoints);
            (state.connection.take(), closed)
        };
        self.end(closed.tasks);
        let_go((closed.remains, connection));
    }

    fn end(&self, tasks: Vec<Task>) {
        tasks.iter().for_each(Task::abort);
        // A task keeps its reader until it has processed the abort.
        self.shared.runtime.block_on(async {
            let all = futures::future::join_all(tasks);
            let _ = tokio::time::timeout(FAREWELL, all).await;
        });
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        self.shared.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Releases everything that belongs to the connection.
fn close(endpoints: &[Arc<dyn Endpoint>]) -> Closed {
    let mut closed = Closed::default();
    closed.extend(endpoints.iter().map(|endpoint| endpoint.close()));
    closed
}

/// Creates a connection with endpoints that are not installed yet.
fn build(
    identity: &NodeIdentity,
    environment: &Environment,
    endpoints: Vec<Arc<dyn Endpoint>>,
) -> Result<(Connection, Vec<Install>), RosError> {
    let (identity, environment, domain) = (identity.clone(), environment.clone(), environment.domain);
    let built = within(BUILDING, move || {
        let mut connection = Connection::join(&identity, &environment)?;
        let installs: Result<_, RosError> =
            endpoints.into_iter().map(|endpoint| endpoint.open(&mut connection)).collect();
        Ok((connection, installs?))
    });
    let reason = || format!("the middleware does not answer within {} s", BUILDING.as_secs());
    built.unwrap_or_else(|| Err(RosError::Join { domain, reason: reason() }))
}
