//! The six parameter services of a node, and `/parameter_events`.
//!
//! The library has them too, but bound to the service mapping of Fast DDS, without descriptions and without ranges.

use std::collections::HashSet;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use excavator_msgs::Time;
use futures::StreamExt;
use futures::future::BoxFuture;
use ros2_client::parameters::raw;
use ros2_client::rcl_interfaces::{
    DescribeParametersRequest, DescribeParametersResponse, GetParameterTypesRequest, GetParameterTypesResponse,
    GetParametersRequest, GetParametersResponse, ListParametersRequest, ListParametersResponse, ListParametersResult,
    SetParametersAtomicallyResponse, SetParametersRequest, SetParametersResponse,
};
use ros2_client::{Gid, Message, Name, QosProfile, ServiceMapping, ServiceTypeName};
use rustdds::DomainParticipant;
use serde::{Deserialize, Serialize};

use super::connection::{Closed, Connection, Endpoint, Install, Task};
use super::large_replies::{LargeReplies, readers_of, reply_topic};
use super::{Link, Mapping, Outlet, Parameter, Parameters, Range, RosClock, RosError, TopicQos, Value};

/// Requests that wait: rmw_qos_profile_services_default.
pub(super) const SERVICE_DEPTH: u32 = 10;

/// `rcl_interfaces/msg/ParameterEvent`.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct ParameterEvent {
    stamp: Time,
    node: String,
    new_parameters: Vec<raw::Parameter>,
    changed_parameters: Vec<raw::Parameter>,
    deleted_parameters: Vec<raw::Parameter>,
}

impl excavator_msgs::Message for ParameterEvent {
    const TYPE_NAME: &'static str = "rcl_interfaces/msg/ParameterEvent";
}

/// Offers the parameters of the link's node to other nodes.
///
/// # Errors
/// [`RosError::Endpoint`].
pub(super) fn offer(link: &Link, parameters: &Parameters, clock: &RosClock) -> Result<(), RosError> {
    let events = link.publish("/parameter_events", TopicQos::reliable(1000))?;
    let node = link.identity().full_name();
    let desk = Desk { node, parameters: parameters.clone(), events, clock: clock.clone() };
    let mapping = link.environment().mapping;
    link.add(Arc::new(Services { desk: Arc::new(desk), mapping, tasks: Mutex::default() }))
}

/// The library's word for a mapping.
pub(crate) fn service_mapping(mapping: Mapping) -> ServiceMapping {
    match mapping {
        Mapping::Cyclone => ServiceMapping::Cyclone,
        Mapping::Enhanced => ServiceMapping::Enhanced,
    }
}

/// Quality of service of requests and replies.
pub(crate) fn service_qos() -> QosProfile {
    QosProfile::publisher_default().history(ros2_client::qos::History::KeepLast { depth: SERVICE_DEPTH as usize })
}

/// Answers requests.
struct Desk {
    node: String,
    parameters: Parameters,
    events: Outlet<ParameterEvent>,
    clock: RosClock,
}

struct Services {
    desk: Arc<Desk>,
    mapping: Mapping,
    tasks: Mutex<Vec<Task>>,
}

impl Endpoint for Services {
    fn open(self: Arc<Self>, connection: &mut Connection) -> Result<Install, RosError> {
        let mut opening = Opening { services: &self, connection, counters: Vec::new() };
        opening.serve("get_parameters", "GetParameters", Desk::get)?;
        opening.serve("get_parameter_types", "GetParameterTypes", Desk::types)?;
        opening.serve("list_parameters", "ListParameters", Desk::list)?;
        opening.serve("describe_parameters", "DescribeParameters", Desk::describe)?;
        opening.serve("set_parameters", "SetParameters", Desk::set)?;
        opening.serve("set_parameters_atomically", "SetParametersAtomically", Desk::set_together)?;
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

/// Services that are being created; at each counter somebody will answer one kind of request.
struct Opening<'o> {
    services: &'o Services,
    connection: &'o mut Connection,
    counters: Vec<BoxFuture<'static, ()>>,
}

impl Opening<'_> {
    fn serve<Q, A>(&mut self, service: &str, type_name: &str, answer: fn(&Desk, Q) -> A) -> Result<(), RosError>
    where
        Q: Message + Clone + Send + Sync + 'static,
        A: Message + Send + Sync + 'static,
    {
        let failed = |reason: String| RosError::Endpoint { what: service.to_string(), reason };
        let name = Name::new(&self.services.desk.node, service).map_err(|error| failed(error.to_string()))?;
        let service_type = ServiceTypeName::new("rcl_interfaces", type_name);
        let server = self
            .connection
            .node()
            .create_server::<Q, A>(
                service_mapping(self.services.mapping),
                &name,
                &service_type,
                service_qos(),
                service_qos(),
            )
            .map_err(|error| failed(error.to_string()))?;
        let desk = Arc::clone(&self.services.desk);
        let full_name = format!("{}/{service}", desk.node);
        let dds_type = format!("rcl_interfaces::srv::dds_::{type_name}");
        let large =
            LargeReplies::open(self.connection, self.services.mapping, &full_name, &dds_type).map_err(failed)?;
        let reply_topic = reply_topic(&full_name);
        let mut clients = Clients { participant: self.connection.participant(), reply_topic, known: HashSet::new() };
        self.counters.push(Box::pin(async move {
            let mut requests = server.receive_request_stream();
            while let Some(request) = requests.next().await {
                // A request that cannot be decoded has nobody to be answered.
                if let Ok((id, request)) = request {
                    clients.wait_for(id.writer_gid).await;
                    let answer = answer(&desk, request);
                    // Whoever asks hears nothing when an answer cannot be sent, and asks again.
                    if large.send(id, &answer).is_none() {
                        let _ = server.async_send_response(id, answer).await;
                    }
                }
            }
        }));
        Ok(())
    }
}

/// Longest wait for a client's reader; rmw_fastrtps_cpp waits as long.
const READER: Duration = Duration::from_millis(100);
/// Time from the discovery of a reader until our writer sends to it.
const MATCHING: Duration = Duration::from_millis(10);

/// Clients whose reader of our replies is known to be there. A client may ask before we have discovered its reader, and a
/// reply that is sent then is lost.
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

impl Desk {
    fn get(&self, request: GetParametersRequest) -> GetParametersResponse {
        let value = |name: &String| raw_value(self.parameters.get(name).map(|parameter| parameter.value));
        GetParametersResponse { values: request.names.iter().map(value).collect() }
    }

    fn types(&self, request: GetParameterTypesRequest) -> GetParameterTypesResponse {
        let number = |name: &String| raw_value(self.parameters.get(name).map(|parameter| parameter.value)).ptype;
        GetParameterTypesResponse { values: request.names.iter().map(number).collect() }
    }

    fn list(&self, request: ListParametersRequest) -> ListParametersResponse {
        let names: Vec<String> = self
            .parameters
            .all()
            .iter()
            .map(|parameter| parameter.name.to_string())
            .filter(|name| listed(name, &request.prefixes, request.depth))
            .collect();
        let mut prefixes: Vec<String> =
            names.iter().filter_map(|name| name.rsplit_once('.').map(|(prefix, _)| prefix.to_string())).collect();
        prefixes.dedup();
        ListParametersResponse { result: ListParametersResult { names, prefixes } }
    }

    fn describe(&self, request: DescribeParametersRequest) -> DescribeParametersResponse {
        let values = request.names.iter().map(|name| descriptor(name, self.parameters.get(name))).collect();
        DescribeParametersResponse { values }
    }

    fn set(&self, request: SetParametersRequest) -> SetParametersResponse {
        let results = request.parameter.into_iter().map(|parameter| self.set_some(vec![parameter])).collect();
        SetParametersResponse { results }
    }

    fn set_together(&self, request: SetParametersRequest) -> SetParametersAtomicallyResponse {
        SetParametersAtomicallyResponse { result: self.set_some(request.parameter) }
    }

    fn set_some(&self, wanted: Vec<raw::Parameter>) -> raw::SetParametersResult {
        let mut values = Vec::new();
        for parameter in wanted {
            let Some(value) = value_of(parameter.value) else {
                let reason = format!("{} can neither be removed nor have that type", parameter.name);
                return raw::SetParametersResult { successful: false, reason };
            };
            values.push((parameter.name, value));
        }
        match self.parameters.set_all(values) {
            Ok(changed) => {
                self.announce(changed);
                raw::SetParametersResult { successful: true, reason: String::new() }
            }
            Err(reason) => raw::SetParametersResult { successful: false, reason },
        }
    }

    fn announce(&self, changed: Vec<(String, Value)>) {
        let changed_parameters =
            changed.into_iter().map(|(name, value)| raw::Parameter { name, value: raw_value(Some(value)) }).collect();
        let event = ParameterEvent {
            stamp: self.clock.now(),
            node: self.node.clone(),
            new_parameters: Vec::new(),
            changed_parameters,
            deleted_parameters: Vec::new(),
        };
        // Whoever wants to be sure asks the service.
        let _ = self.events.publish(event);
    }
}

/// Whether a list request asks for `name`: below one of the prefixes, at most `depth` dots deep (0 = any).
fn listed(name: &str, prefixes: &[String], depth: u64) -> bool {
    let shallow = |rest: &str| depth == 0 || (rest.matches('.').count() as u64) < depth;
    if prefixes.is_empty() {
        return shallow(name);
    }
    prefixes.iter().any(|prefix| name == prefix || name.strip_prefix(&format!("{prefix}.")).is_some_and(shallow))
}

fn descriptor(name: &str, parameter: Option<Parameter>) -> raw::ParameterDescriptor {
    let mut descriptor = raw::ParameterDescriptor {
        name: name.to_string(),
        r#type: raw::ParameterType::NOT_SET,
        description: String::new(),
        additional_constraints: String::new(),
        read_only: false,
        dynamic_typing: false,
        floating_point_range: Vec::new(),
        integer_range: Vec::new(),
    };
    let Some(parameter) = parameter else { return descriptor };
    descriptor.r#type = raw_value(Some(parameter.value.clone())).ptype;
    descriptor.description = parameter.description.to_string();
    descriptor.read_only = parameter.read_only;
    if let Some(Range { from, to }) = parameter.range {
        if matches!(parameter.value, Value::Integer(_) | Value::IntegerArray(_)) {
            descriptor.integer_range =
                vec![raw::IntegerRange { from_value: from as i64, to_value: to as i64, step: 1 }];
        } else {
            descriptor.floating_point_range =
                vec![raw::FloatingPointRange { from_value: from, to_value: to, step: 0.0 }];
        }
    }
    descriptor
}

fn raw_value(value: Option<Value>) -> raw::ParameterValue {
    use ros2_client::ParameterValue as Library;
    let value = match value {
        None => Library::NotSet,
        Some(Value::Boolean(value)) => Library::Boolean(value),
        Some(Value::Integer(value)) => Library::Integer(value),
        Some(Value::Double(value)) => Library::Double(value),
        Some(Value::String(value)) => Library::String(value),
        Some(Value::BooleanArray(values)) => Library::BooleanArray(values),
        Some(Value::IntegerArray(values)) => Library::IntegerArray(values),
        Some(Value::DoubleArray(values)) => Library::DoubleArray(values),
        Some(Value::StringArray(values)) => Library::StringArray(values),
    };
    value.into()
}

fn value_of(raw: raw::ParameterValue) -> Option<Value> {
    use ros2_client::ParameterValue as Library;
    match Library::from(raw) {
        Library::NotSet | Library::ByteArray(_) => None,
        Library::Boolean(value) => Some(Value::Boolean(value)),
        Library::Integer(value) => Some(Value::Integer(value)),
        Library::Double(value) => Some(Value::Double(value)),
        Library::String(value) => Some(Value::String(value)),
        Library::BooleanArray(values) => Some(Value::BooleanArray(values)),
        Library::IntegerArray(values) => Some(Value::IntegerArray(values)),
        Library::DoubleArray(values) => Some(Value::DoubleArray(values)),
        Library::StringArray(values) => Some(Value::StringArray(values)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_follow_prefix_and_depth() {
        let prefix = ["noise".to_string()];
        assert!(listed("noise.pressure", &prefix, 1));
        assert!(!listed("noise.pressure.cap", &prefix, 1));
        assert!(listed("noise.pressure.cap", &prefix, 0));
        assert!(!listed("noisette", &prefix, 0));
        assert!(listed("rate", &[], 1));
    }

    #[test]
    fn descriptions_carry_the_range() {
        let parameter = Parameter::new("rate", Value::Double(1e3), "samples per second [Hz]").within(1.0, 2000.0);
        let described = descriptor("rate", Some(parameter));
        assert_eq!(described.r#type, raw::ParameterType::DOUBLE);
        assert_eq!(described.floating_point_range.len(), 1);
        assert_eq!(descriptor("none", None).r#type, raw::ParameterType::NOT_SET);
    }

    #[test]
    fn values_survive_the_round_trip() {
        for value in [Value::Boolean(true), Value::Double(0.1), Value::StringArray(vec!["a".into()])] {
            assert_eq!(value_of(raw_value(Some(value.clone()))), Some(value));
        }
        assert_eq!(value_of(raw_value(None)), None);
    }
}
