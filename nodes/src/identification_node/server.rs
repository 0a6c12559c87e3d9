//! The action on the ROS graph: three services and two topics.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use excavator_msgs::Time;
use ros2_client::action::{
    ActionServer, ActionServerQosPolicies, CancelGoalResponse, GetResultResponse, GoalStatusEnum, SendGoalResponse,
};
use ros2_client::action_msgs::{CancelGoalResponseEnum, GoalStatus, GoalStatusArray};
use ros2_client::qos::{Durability, History, QosProfile, Reliability, WhenFull};
use ros2_client::{ActionTypeName, Name};
use rosbag2::cdr;

use super::desk::Desk;
use super::goals::CancelAnswer;
use super::types::{Feedback, Goal, GoalId, GoalInfo, Outcome};
use excavator_ros::connection::{Closed, Connection, Endpoint, Install, Task};
use excavator_ros::{LargeReplies, Mapping, RosError, service_mapping, service_qos, system_nanoseconds};

/// Polling period for requests. No client waits for identification in milliseconds.
const LOOK: Duration = Duration::from_millis(10);
/// Most requests of one kind taken per poll, so that a flood of one kind does not delay the others.
const AT_ONCE: usize = 64;

type Server = ActionServer<Goal, Outcome, Feedback>;

/// The action; its goals outlive the connection.
pub(super) struct IdentifyAction {
    name: String,
    mapping: Mapping,
    desk: Arc<Mutex<Desk>>,
    task: Mutex<Option<Task>>,
}

impl IdentifyAction {
    /// The action `name` (full name), answered by the desk.
    pub fn new(name: String, mapping: Mapping, desk: Desk) -> Self {
        IdentifyAction { name, mapping, desk: Arc::new(Mutex::new(desk)), task: Mutex::new(None) }
    }
}

impl Endpoint for IdentifyAction {
    fn open(self: Arc<Self>, connection: &mut Connection) -> Result<Install, RosError> {
        let failed = |reason: String| RosError::Endpoint { what: self.name.clone(), reason };
        let (namespace, base) = self.name.rsplit_once('/').unwrap_or(("", &self.name));
        let namespace = if namespace.is_empty() { "/" } else { namespace };
        let name = Name::new(namespace, base).map_err(|error| failed(error.to_string()))?;
        let reliable = Reliability::Reliable { when_full: WhenFull::Fail };
        let feedback = QosProfile::publisher_default().reliability(reliable).history(History::KeepLast { depth: 10 });
        let status = feedback.clone().durability(Durability::TransientLocal).history(History::KeepLast { depth: 1 });
        let qos = ActionServerQosPolicies {
            goal_service: service_qos(),
            result_service: service_qos(),
            cancel_service: service_qos(),
            feedback_publisher: feedback,
            status_publisher: status,
        };
        let type_name = ActionTypeName::new("excavator_msgs", "Identify");
        let server: Server = connection
            .node()
            .create_action_server(service_mapping(self.mapping), &name, &type_name, qos)
            .map_err(|error| failed(error.to_string()))?;
        let service = format!("{}/_action/get_result", self.name);
        let large =
            LargeReplies::open(connection, self.mapping, &service, "excavator_msgs::action::dds_::Identify_GetResult");
        let large = large.map_err(failed)?;
        let desk = Arc::clone(&self.desk);
        let serving = async move {
            loop {
                look(&mut desk.lock().unwrap_or_else(PoisonError::into_inner), &server, &large);
                tokio::time::sleep(LOOK).await;
            }
        };
        Ok(Box::new(move |runtime| {
            *self.task.lock().unwrap_or_else(PoisonError::into_inner) = Some(runtime.spawn(serving));
        }))
    }

    fn close(&self) -> Closed {
        Closed::tasks(self.task.lock().unwrap_or_else(PoisonError::into_inner).take())
    }
}

// A response that cannot be sent is lost. The client has to repeat its request, as with any ROS service.
fn look(desk: &mut Desk, server: &Server, large: &LargeReplies) {
    let mut changed = false;
    // Cancel requests come first: cancelled goals make room for new ones.
    let cancels = std::iter::from_fn(|| server.receive_cancel_request().ok().flatten());
    for (request, wanted) in cancels.take(AT_ONCE) {
        // The field of this type is private in the library. The serialized bytes equal those of our type.
        let info = cdr::encode(&wanted).and_then(|bytes| cdr::decode::<GoalInfo>(&bytes));
        let Ok(info) = info else { continue };
        let (answer, meant) = desk.cancel(info);
        changed |= !meant.is_empty();
        let _ = server.send_cancel_response(request, cancel_response(answer, &meant));
    }
    let goals = std::iter::from_fn(|| server.receive_goal().ok().flatten());
    for (request, wanted) in goals.take(AT_ONCE) {
        let now = Time::from_nanoseconds(system_nanoseconds()).unwrap_or_default();
        let accepted = desk.take(*wanted.goal_id.uuid.as_bytes(), wanted.goal, now);
        changed |= accepted;
        let _ = server.send_goal_response(request, SendGoalResponse { accepted, stamp: library_time(now) });
    }
    let questions = std::iter::from_fn(|| server.receive_result_request().ok().flatten());
    for (request, wanted) in questions.take(AT_ONCE) {
        desk.ask(request, *wanted.goal_id.uuid.as_bytes());
    }
    let heard = desk.listen();
    changed |= heard.ended;
    for (id, feedback) in heard.progress {
        let _ = server.send_feedback(library_id(id), feedback);
    }
    for (request, status, result) in desk.answers() {
        let answer = GetResultResponse { status: library_status(status), result };
        if large.send(request, &answer).is_none() {
            let _ = server.send_result(request, answer);
        }
    }
    if changed {
        let _ = server.send_goal_statuses(statuses(desk));
    }
}

fn statuses(desk: &Desk) -> GoalStatusArray {
    let status_list = desk
        .statuses()
        .into_iter()
        .map(|(info, status)| GoalStatus { goal_info: library_info(info), status: library_status(status) })
        .collect();
    GoalStatusArray { status_list }
}

fn cancel_response(answer: CancelAnswer, meant: &[GoalInfo]) -> CancelGoalResponse {
    CancelGoalResponse {
        return_code: match answer {
            CancelAnswer::Accepted => CancelGoalResponseEnum::None,
            CancelAnswer::UnknownGoal => CancelGoalResponseEnum::UnknownGoal,
            CancelAnswer::Terminated => CancelGoalResponseEnum::GoalTerminated,
        },
        goals_canceling: meant.iter().copied().map(library_info).collect(),
    }
}

fn library_info(info: GoalInfo) -> ros2_client::action::GoalInfo {
    ros2_client::action::GoalInfo { goal_id: library_id(info.goal_id), stamp: library_time(info.stamp) }
}

fn library_id(id: GoalId) -> ros2_client::action::GoalId {
    ros2_client::action::GoalId { uuid: uuid::Uuid::from_bytes(id) }
}

fn library_time(time: Time) -> ros2_client::builtin_interfaces::Time {
    ros2_client::builtin_interfaces::Time::from_nanos(time.nanoseconds())
}

fn library_status(status: i8) -> GoalStatusEnum {
    match status {
        2 => GoalStatusEnum::Executing,
        4 => GoalStatusEnum::Succeeded,
        5 => GoalStatusEnum::Canceled,
        6 => GoalStatusEnum::Aborted,
        _ => GoalStatusEnum::Unknown,
    }
}
