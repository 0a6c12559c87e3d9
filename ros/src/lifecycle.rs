//! A managed node: states and transitions of `lifecycle_msgs`, as used by `ros2 lifecycle` and launch files.
//!
//! Every node starts to work at once unless its parameter `managed` is set. A managed node waits, unconfigured, until
//! it is configured and activated. Only a managed node offers the services, since every client that may call them may
//! stop a machine.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ros2_client::Message;
use serde::{Deserialize, Serialize};

use super::services::{Opening, Service, offer_services};
use super::{Link, Logger, Outlet, Parameter, RosError, TopicQos, Value, system_nanoseconds};

/// `lifecycle_msgs/msg/State`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct State {
    id: u8,
    label: String,
}

/// `lifecycle_msgs/msg/Transition`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Transition {
    id: u8,
    label: String,
}

/// `lifecycle_msgs/msg/TransitionDescription`.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct TransitionDescription {
    transition: Transition,
    start_state: State,
    goal_state: State,
}

/// `lifecycle_msgs/msg/TransitionEvent`.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct TransitionEvent {
    timestamp: u64,
    transition: Transition,
    start_state: State,
    goal_state: State,
}

impl excavator_msgs::Message for TransitionEvent {
    const TYPE_NAME: &'static str = "lifecycle_msgs/msg/TransitionEvent";
}

/// A request without content: IDL has no empty structures.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Nothing {
    structure_needs_at_least_one_member: u8,
}
impl Message for Nothing {}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct ChangeState {
    transition: Transition,
}
impl Message for ChangeState {}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Changed {
    success: bool,
}
impl Message for Changed {}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct CurrentState {
    current_state: State,
}
impl Message for CurrentState {}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct AvailableStates {
    available_states: Vec<State>,
}
impl Message for AvailableStates {}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct AvailableTransitions {
    available_transitions: Vec<TransitionDescription>,
}
impl Message for AvailableTransitions {}

/// A primary state, with its number in `lifecycle_msgs/msg/State`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Primary {
    Unconfigured = 1,
    Inactive = 2,
    Active = 3,
    Finalized = 4,
}

impl Primary {
    const ALL: [Primary; 4] = [Primary::Unconfigured, Primary::Inactive, Primary::Active, Primary::Finalized];

    fn message(self) -> State {
        let label = match self {
            Primary::Unconfigured => "unconfigured",
            Primary::Inactive => "inactive",
            Primary::Active => "active",
            Primary::Finalized => "finalized",
        };
        State { id: self as u8, label: label.to_string() }
    }
}

/// Number, label, start and goal of each transition.
const TRANSITIONS: [(u8, &str, Primary, Primary); 7] = [
    (1, "configure", Primary::Unconfigured, Primary::Inactive),
    (2, "cleanup", Primary::Inactive, Primary::Unconfigured),
    (3, "activate", Primary::Inactive, Primary::Active),
    (4, "deactivate", Primary::Active, Primary::Inactive),
    (5, "shutdown", Primary::Unconfigured, Primary::Finalized),
    (6, "shutdown", Primary::Inactive, Primary::Finalized),
    (7, "shutdown", Primary::Active, Primary::Finalized),
];

/// State of a node, which decides what it may do; clones share it.
#[derive(Clone)]
pub struct Lifecycle {
    state: Arc<Mutex<Primary>>,
}

impl Lifecycle {
    /// The parameter that makes a node a managed one.
    pub fn parameter() -> Parameter {
        let meaning = "wait to be configured and activated, as a lifecycle node; nothing is published and nobody followed until then";
        Parameter::new("managed", Value::Boolean(false), meaning).read_only()
    }

    /// Starts a node that is active from the start or, if `managed`, waits for its transitions. A managed node that is
    /// shut down sets `stop`.
    ///
    /// # Errors
    /// [`RosError::Endpoint`].
    pub fn start(link: &Link, managed: bool, logger: &Logger, stop: Arc<AtomicBool>) -> Result<Self, RosError> {
        let first = if managed { Primary::Unconfigured } else { Primary::Active };
        let lifecycle = Lifecycle { state: Arc::new(Mutex::new(first)) };
        if managed {
            let events = link.publish("~/transition_event", TopicQos::reliable(10))?;
            let desk = Desk { lifecycle: lifecycle.clone(), events, logger: logger.clone(), stop };
            offer_services(link, desk, open)?;
        }
        Ok(lifecycle)
    }

    /// Whether the node publishes and executes commands.
    pub fn is_active(&self) -> bool {
        *self.lock() == Primary::Active
    }

    fn lock(&self) -> MutexGuard<'_, Primary> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

struct Desk {
    lifecycle: Lifecycle,
    events: Outlet<TransitionEvent>,
    logger: Logger,
    stop: Arc<AtomicBool>,
}

fn open(opening: &mut Opening<'_, Desk>) -> Result<(), RosError> {
    let service = |name, kind| Service { name, package: "lifecycle_msgs", kind };
    opening.serve(&service("change_state", "ChangeState"), Desk::change)?;
    opening.serve(&service("get_state", "GetState"), Desk::current)?;
    opening.serve(&service("get_available_states", "GetAvailableStates"), Desk::states)?;
    opening.serve(&service("get_available_transitions", "GetAvailableTransitions"), Desk::possible)?;
    opening.serve(&service("get_transition_graph", "GetAvailableTransitions"), Desk::graph)
}

impl Desk {
    fn change(&self, request: ChangeState) -> Changed {
        let Transition { id, label } = request.transition;
        let mut state = self.lifecycle.lock();
        // As in rcl_lifecycle: selected by number, or by label if the number is zero.
        let wanted = |(number, name, start, _): &&(u8, &str, Primary, Primary)| {
            *start == *state && (*number == id || (id == 0 && *name == label))
        };
        let Some(&(number, name, start, goal)) = TRANSITIONS.iter().find(wanted) else {
            self.logger.warn(format!("no transition {id} \"{label}\" from {}", state.message().label));
            return Changed { success: false };
        };
        *state = goal;
        drop(state);
        self.logger.info(format!("{name}: now {}", goal.message().label));
        let event = TransitionEvent {
            timestamp: u64::try_from(system_nanoseconds()).unwrap_or_default(),
            transition: Transition { id: number, label: name.to_string() },
            start_state: start.message(),
            goal_state: goal.message(),
        };
        // A lost event does no harm: clients can request the state.
        let _ = self.events.publish(event);
        if goal == Primary::Finalized {
            self.stop.store(true, Ordering::Relaxed);
        }
        Changed { success: true }
    }

    fn current(&self, _: Nothing) -> CurrentState {
        CurrentState { current_state: self.lifecycle.lock().message() }
    }

    fn states(&self, _: Nothing) -> AvailableStates {
        AvailableStates { available_states: Primary::ALL.map(Primary::message).to_vec() }
    }

    fn possible(&self, _: Nothing) -> AvailableTransitions {
        let state = *self.lifecycle.lock();
        AvailableTransitions { available_transitions: descriptions(|start| start == state) }
    }

    fn graph(&self, _: Nothing) -> AvailableTransitions {
        AvailableTransitions { available_transitions: descriptions(|_| true) }
    }
}

fn descriptions(from: impl Fn(Primary) -> bool) -> Vec<TransitionDescription> {
    let wanted = TRANSITIONS.iter().filter(|(_, _, start, _)| from(*start));
    wanted
        .map(|(id, label, start, goal)| TransitionDescription {
            transition: Transition { id: *id, label: label.to_string() },
            start_state: start.message(),
            goal_state: goal.message(),
        })
        .collect()
}
