//! `~/get_type_description`: describes the types of the node's topics (REP 2011).

use excavator_msgs::{TypeDescription, definitions};
use serde::{Deserialize, Serialize};

use super::services::{Service, offer_services};
use super::{Link, RosError};

/// Request of `type_description_interfaces/srv/GetTypeDescription`.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Request {
    type_name: String,
    /// Empty: whatever the hash is.
    type_hash: String,
    include_type_sources: bool,
}

impl ros2_client::Message for Request {}

/// Its response; nothing else counts where it is not `successful`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
struct Response {
    successful: bool,
    failure_reason: String,
    type_description: TypeDescription,
    type_sources: Vec<TypeSource>,
    extra_information: Vec<KeyValue>,
}

impl ros2_client::Message for Response {}

/// `type_description_interfaces/msg/TypeSource`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct TypeSource {
    type_name: String,
    encoding: String,
    raw_file_contents: String,
}

/// `type_description_interfaces/msg/KeyValue`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct KeyValue {
    key: String,
    value: String,
}

const GET: Service =
    Service { name: "get_type_description", package: "type_description_interfaces", kind: "GetTypeDescription" };

/// Offers the descriptions of all types that this project publishes or reads.
///
/// # Errors
/// [`RosError::Endpoint`].
pub(super) fn offer(link: &Link) -> Result<(), RosError> {
    offer_services(link, (), |opening| opening.serve(&GET, |(), request| answer(&request)))
}

fn answer(request: &Request) -> Response {
    let failed = |failure_reason: String| Response { failure_reason, ..Response::default() };
    let Some(type_description) = TypeDescription::of(&request.type_name) else {
        return failed(format!("{} is not used by this node", request.type_name.escape_debug()));
    };
    let hash = type_description.hash();
    if !request.type_hash.is_empty() && request.type_hash != hash {
        return failed(format!("the hash of {} is {hash} here", type_description.type_description.type_name));
    }
    let source = |name: &str| TypeSource {
        type_name: name.to_string(),
        encoding: "msg".to_string(),
        raw_file_contents: definitions::message_text(name).unwrap_or_default().to_string(),
    };
    let type_sources =
        if request.include_type_sources { type_description.names().map(source).collect() } else { vec![] };
    Response { successful: true, type_description, type_sources, ..Response::default() }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn asked(type_name: &str, type_hash: &str) -> Response {
        answer(&Request { type_name: type_name.into(), type_hash: type_hash.into(), include_type_sources: true })
    }

    #[test]
    fn a_type_is_described_with_its_sources() {
        let hash = TypeDescription::of("excavator_msgs/msg/ArmState").unwrap().hash();
        let response = asked("excavator_msgs/msg/ArmState", &hash);
        assert!(response.successful && response.failure_reason.is_empty());
        let names: Vec<&str> = response.type_sources.iter().map(|source| source.type_name.as_str()).collect();
        assert_eq!(names[0], "excavator_msgs/msg/ArmState");
        assert!(names.contains(&"excavator_msgs/msg/CylinderState") && names.contains(&"builtin_interfaces/msg/Time"));
        assert!(response.type_sources.iter().all(|source| !source.raw_file_contents.is_empty()));
    }

    #[test]
    fn an_unknown_type_and_another_hash_are_refused_with_the_reason() {
        assert!(asked("other_msgs/msg/Thing", "").failure_reason.contains("not used"));
        let response = asked("std_msgs/msg/String", "RIHS01_00");
        assert!(!response.successful && response.failure_reason.contains("RIHS01_df66"), "{response:?}");
    }
}
