//! The six parameter services of a node, and `/parameter_events`.
//!
//! The library has them too, but bound to the service mapping of Fast DDS and without descriptions and ranges.

use excavator_msgs::Time;
use ros2_client::parameters::raw;
use ros2_client::rcl_interfaces::{
    DescribeParametersRequest, DescribeParametersResponse, GetParameterTypesRequest, GetParameterTypesResponse,
    GetParametersRequest, GetParametersResponse, ListParametersRequest, ListParametersResponse, ListParametersResult,
    SetParametersAtomicallyResponse, SetParametersRequest, SetParametersResponse,
};
use serde::{Deserialize, Serialize};

use super::services::{Service, offer_services};
use super::{Link, Outlet, Parameter, Parameters, Range, RosClock, RosError, TopicQos, Value};

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

/// Offers the parameters of the node to other nodes.
///
/// # Errors
/// [`RosError::Endpoint`].
pub(super) fn offer(link: &Link, parameters: &Parameters, clock: &RosClock) -> Result<(), RosError> {
    let events = link.publish("/parameter_events", TopicQos::reliable(1000))?;
    let node = link.identity().full_name();
    let desk = Desk { node, parameters: parameters.clone(), events, clock: clock.clone() };
    offer_services(link, desk, |opening| {
        opening.serve(&GET, Desk::get)?;
        opening.serve(&TYPES, Desk::types)?;
        opening.serve(&LIST, Desk::list)?;
        opening.serve(&DESCRIBE, Desk::describe)?;
        opening.serve(&SET, Desk::set)?;
        opening.serve(&SET_TOGETHER, Desk::set_together)
    })
}

const fn service(name: &'static str, kind: &'static str) -> Service {
    Service { name, package: "rcl_interfaces", kind }
}

const GET: Service = service("get_parameters", "GetParameters");
const TYPES: Service = service("get_parameter_types", "GetParameterTypes");
const LIST: Service = service("list_parameters", "ListParameters");
const DESCRIBE: Service = service("describe_parameters", "DescribeParameters");
const SET: Service = service("set_parameters", "SetParameters");
const SET_TOGETHER: Service = service("set_parameters_atomically", "SetParametersAtomically");

/// Answers requests.
struct Desk {
    node: String,
    parameters: Parameters,
    events: Outlet<ParameterEvent>,
    clock: RosClock,
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
        // Events may be lost. Clients that need the exact value call the service.
        let _ = self.events.publish(event);
    }
}

/// Whether a list request includes `name`: below one of the prefixes, at most `depth` levels deep (0 = any).
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
