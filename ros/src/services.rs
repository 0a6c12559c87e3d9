//! Services of a node. They are opened again on every connection.
//!
//! The library has servers too, but each is bound to the mapping that it was created for, and a reply may be lost if
//! the client was not yet discovered.

use std::collections::HashSet;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use futures::StreamExt;
use futures::future::BoxFuture;
use ros2_client::{Gid, Message, Name, QosProfile, ServiceMapping, ServiceTypeName};
use rustdds::DomainParticipant;

use super::connection::{Closed, Connection, Endpoint, Install, Task};
use super::large_replies::{LargeReplies, readers_of, reply_topic};
use super::qos::SERVICE_DEPTH;
use super::{Link, Mapping, RosError};

/// The mapping as a type of the library.
pub fn service_mapping(mapping: Mapping) -> ServiceMapping {
    match mapping {
        Mapping::Cyclone => ServiceMapping::Cyclone,
        Mapping::Enhanced => ServiceMapping::Enhanced,
    }
}

/// QoS of requests and replies.
pub fn service_qos() -> QosProfile {
    QosProfile::publisher_default().history(ros2_client::qos::History::KeepLast { depth: SERVICE_DEPTH as usize })
}

/// A service: its name relative to the node, and its type.
pub(super) struct Service {
    pub name: &'static str,
    pub package: &'static str,
    pub kind: &'static str,
}

/// Offers services below the node's name. `desk` answers the requests, `open` creates the services.
///
/// # Errors
/// [`RosError::Endpoint`].
pub(super) fn offer_services<D: Send + Sync + 'static>(
    link: &Link,
    desk: D,
    open: fn(&mut Opening<'_, D>) -> Result<(), RosError>,
) -> Result<(), RosError> {
    let (mapping, node) = (link.environment().mapping, link.identity().full_name());
    link.add(Arc::new(Services { node, desk: Arc::new(desk), open, mapping, tasks: Mutex::default() }))
}

struct Services<D> {
    node: String,
    desk: Arc<D>,
    open: fn(&mut Opening<'_, D>) -> Result<(), RosError>,
    mapping: Mapping,
    tasks: Mutex<Vec<Task>>,
}

impl<D: Send + Sync + 'static> Endpoint for Services<D> {
    fn open(self: Arc<Self>, connection: &mut Connection) -> Result<Install, RosError> {
        let mut opening = Opening { services: &self, connection, counters: Vec::new() };
        (self.open)(&mut opening)?;
        let counters = opening.counters;
        Ok(Box::new(move |runtime| {
            let tasks = counters.into_iter().map(|counter| runtime.spawn(counter)).collect();
            *self.tasks.lock().unwrap_or_else(PoisonError::into_inner) = tasks;
        }))
    }

    fn close(&self) -> Closed {
        Closed::tasks(std::mem::take(&mut *self.tasks.lock().unwrap_or_else(PoisonError::into_inner)))
    }
}

/// Services that are being created. Each counter is a task that answers the requests of one service.
pub(super) struct Opening<'o, D> {
    services: &'o Services<D>,
    connection: &'o mut Connection,
    counters: Vec<BoxFuture<'static, ()>>,
}

impl<D: Send + Sync + 'static> Opening<'_, D> {
    /// Creates one service.
    pub fn serve<Q, A>(&mut self, service: &Service, answer: fn(&D, Q) -> A) -> Result<(), RosError>
    where
        Q: Message + Clone + Send + Sync + 'static,
        A: Message + Send + Sync + 'static,
    {
        let Service { name: short, package, kind } = *service;
        let failed = |reason: String| RosError::Endpoint { what: short.to_string(), reason };
        let mapping = self.services.mapping;
        let name = Name::new(&self.services.node, short).map_err(|error| failed(error.to_string()))?;
        let server = self
            .connection
            .node()
            .create_server::<Q, A>(
                service_mapping(mapping),
                &name,
                &ServiceTypeName::new(package, kind),
                service_qos(),
                service_qos(),
            )
            .map_err(|error| failed(error.to_string()))?;
        let desk = Arc::clone(&self.services.desk);
        let full_name = format!("{}/{short}", self.services.node);
        let dds_type = format!("{package}::srv::dds_::{kind}");
        let large = LargeReplies::open(self.connection, mapping, &full_name, &dds_type).map_err(failed)?;
        let reply_topic = reply_topic(&full_name);
        let mut clients = Clients { participant: self.connection.participant(), reply_topic, known: HashSet::new() };
        self.counters.push(Box::pin(async move {
            let mut requests = server.receive_request_stream();
            while let Some(request) = requests.next().await {
                // A request that cannot be decoded has no client to answer.
                if let Ok((id, request)) = request {
                    clients.wait_for(id.writer_gid).await;
                    let answer = answer(&desk, request);
                    // If an answer cannot be sent, the client times out and asks again.
                    if large.send(id, &answer).is_none() {
                        let _ = server.async_send_response(id, answer).await;
                    }
                }
            }
        }));
        Ok(())
    }
}

/// Longest wait for the reader of a client, the same as in rmw_fastrtps_cpp.
const READER: Duration = Duration::from_millis(100);
/// Time from the discovery of a reader until our writer sends to it.
const MATCHING: Duration = Duration::from_millis(10);

/// Clients whose reply reader has been discovered. A client may send a request before we have discovered its reader. A
/// reply sent at that time is lost.
struct Clients {
    participant: DomainParticipant,
    reply_topic: String,
    known: HashSet<Gid>,
}

impl Clients {
    async fn wait_for(&mut self, client: Gid) {
        if !self.known.insert(client) {
            return;
        }
        let start = Instant::now();
        while start.elapsed() < READER && readers_of(client, &self.reply_topic, &self.participant).is_empty() {
            tokio::time::sleep(MATCHING / 2).await;
        }
        tokio::time::sleep(MATCHING).await;
    }
}
