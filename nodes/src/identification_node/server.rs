//! The action on the graph: three services and two topics.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use excavator_bags::cdr;
use excavator_msgs::Time;
use excavator_msgs::common::Text;
use ros2_client::action::{
    ActionServer, ActionServerQosPolicies, CancelGoalResponse, GetResultResponse, GoalStatusEnum, SendGoalResponse,
};
use ros2_client::action_msgs::{CancelGoalResponseEnum, GoalStatus, GoalStatusArray};
use ros2_client::qos::{Durability, History, QosProfile, Reliability, WhenFull};
use ros2_client::{ActionTypeName, Name, RmwRequestId};

use super::goals::{CancelAnswer, Goals, Status};
use super::types::{Feedback, Goal, GoalId, GoalInfo, Outcome};
use crate::ros::connection::{Closed, Connection, Endpoint, Install, Task};
use crate::ros::{LargeReplies, Latched, Mapping, RosError, service_mapping, service_qos, system_nanoseconds};

/// Pace of looking for requests. Nobody waits for identification in milliseconds.
const LOOK: Duration = Duration::from_millis(10);

type Server = ActionServer<Goal, Outcome, Feedback>;

/// Work to be done.
pub(super) struct Job {
    pub id: GoalId,
    pub goal: Goal,
    pub cancelled: Arc<AtomicBool>,
}

/// News from the work.
pub(super) enum News {
    Progress { id: GoalId, feedback: Feedback },
    Ended { id: GoalId, outcome: Outcome },
}

/// The action; its goals outlive the connection.
pub(super) struct IdentifyAction {
    name: String,
    mapping: Mapping,
    desk: Arc<Mutex<Desk>>,
    task: Mutex<Option<Task>>,
}

struct Desk {
    goals: Goals,
    cancels: HashMap<GoalId, Arc<AtomicBool>>,
    waiting: Vec<(RmwRequestId, GoalId)>,
    jobs: Sender<Job>,
    news: Receiver<News>,
    model: Latched<Text>,
}

impl IdentifyAction {
    /// The action `name` (full name); `jobs` are worked on elsewhere, `news` come from there.
    pub fn new(name: String, mapping: Mapping, jobs: Sender<Job>, news: Receiver<News>, model: Latched<Text>) -> Self {
        let goals = Goals::default();
        let desk = Desk { goals, cancels: HashMap::new(), waiting: Vec::new(), jobs, news, model };
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
                desk.lock().unwrap_or_else(PoisonError::into_inner).look(&server, &large);
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

// Whoever asks hears nothing when an answer cannot be sent, and asks again: that is how services are.
impl Desk {
    fn look(&mut self, server: &Server, large: &LargeReplies) {
        let mut changed = false;
        while let Ok(Some((request, wanted))) = server.receive_goal() {
            let id = *wanted.goal_id.uuid.as_bytes();
            let now = Time::from_nanoseconds(system_nanoseconds()).unwrap_or_default();
            let accepted = self.goals.accept(id, now);
            if accepted {
                let cancelled = Arc::new(AtomicBool::new(false));
                self.cancels.insert(id, Arc::clone(&cancelled));
                let _ = self.jobs.send(Job { id, goal: wanted.goal, cancelled });
                changed = true;
            }
            let _ = server.send_goal_response(request, SendGoalResponse { accepted, stamp: library_time(now) });
        }
        while let Ok(Some((request, wanted))) = server.receive_cancel_request() {
            // The library keeps the field of this type to itself; its bytes are the same as ours.
            let info = cdr::encode(&wanted).and_then(|bytes| cdr::decode::<GoalInfo>(&bytes));
            let Ok(info) = info else { continue };
            let (answer, meant) = self.goals.to_cancel(info);
            for goal in &meant {
                if let Some(flag) = self.cancels.remove(&goal.goal_id) {
                    flag.store(true, Ordering::Relaxed);
                }
                let outcome = Outcome { message: "cancelled".to_string(), ..Outcome::default() };
                changed |= self.goals.finish(&goal.goal_id, Status::Canceled, outcome);
            }
            let _ = server.send_cancel_response(request, cancel_response(answer, &meant));
        }
        while let Ok(Some((request, wanted))) = server.receive_result_request() {
            self.waiting.push((request, *wanted.goal_id.uuid.as_bytes()));
        }
        while let Ok(news) = self.news.try_recv() {
            match news {
                News::Progress { id, feedback } if self.goals.is_executing(&id) => {
                    let _ = server.send_feedback(library_id(id), feedback);
                }
                News::Progress { .. } => {}
                News::Ended { id, outcome } => changed |= self.end(id, outcome),
            }
        }
        let goals = &self.goals;
        self.waiting.retain(|(request, id)| match goals.result(id) {
            None => true,
            Some((status, result)) => {
                let answer = GetResultResponse { status: library_status(status), result };
                if large.send(*request, &answer).is_none() {
                    let _ = server.send_result(*request, answer);
                }
                false
            }
        });
        if changed {
            let _ = server.send_goal_statuses(self.statuses());
        }
    }

    fn end(&mut self, id: GoalId, outcome: Outcome) -> bool {
        self.cancels.remove(&id);
        let status = if outcome.success { Status::Succeeded } else { Status::Aborted };
        let text = outcome.model.clone();
        let ended = self.goals.finish(&id, status, outcome);
        if ended && status == Status::Succeeded {
            let _ = self.model.publish(Text { data: text });
        }
        ended
    }

    fn statuses(&self) -> GoalStatusArray {
        let status_list = self
            .goals
            .statuses()
            .into_iter()
            .map(|(info, status)| GoalStatus { goal_info: library_info(info), status: library_status(status) })
            .collect();
        GoalStatusArray { status_list }
    }
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
