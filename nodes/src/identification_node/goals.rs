//! The state machine of goals.

use std::collections::BTreeMap;

use excavator_msgs::Time;

use super::types::{GoalId, GoalInfo, Outcome};

/// Finished goals whose result is kept for late requests.
const KEPT: usize = 20;

/// State of a goal, with the numbers of `action_msgs/msg/GoalStatus`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Status {
    Executing = 2,
    Succeeded = 4,
    Canceled = 5,
    Aborted = 6,
}

/// Answer to a cancel request, with the numbers of `action_msgs/srv/CancelGoal`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CancelAnswer {
    Accepted = 0,
    UnknownGoal = 2,
    Terminated = 3,
}

#[derive(Debug, Clone)]
struct Known {
    accepted: Time,
    status: Status,
    outcome: Outcome,
    /// Count of goals accepted before.
    number: u64,
}

/// All known goals.
#[derive(Debug, Default)]
pub(super) struct Goals {
    known: BTreeMap<GoalId, Known>,
    accepted: u64,
}

impl Goals {
    /// Accepts a new goal; `false` if its identity is taken.
    pub fn accept(&mut self, id: GoalId, now: Time) -> bool {
        if self.known.contains_key(&id) {
            return false;
        }
        let known =
            Known { accepted: now, status: Status::Executing, outcome: Outcome::default(), number: self.accepted };
        self.known.insert(id, known);
        self.accepted += 1;
        self.forget();
        true
    }

    /// Whether the goal is still to be worked on.
    pub fn is_executing(&self, id: &GoalId) -> bool {
        self.known.get(id).is_some_and(|known| known.status == Status::Executing)
    }

    /// Ends a goal; `false` if it has already ended or is unknown.
    pub fn finish(&mut self, id: &GoalId, status: Status, outcome: Outcome) -> bool {
        match self.known.get_mut(id) {
            Some(known) if known.status == Status::Executing => {
                known.status = status;
                known.outcome = outcome;
                true
            }
            _ => false,
        }
    }

    /// The goals that a cancel request matches: by identity, by time of acceptance, or all. The caller ends them.
    pub fn to_cancel(&self, request: GoalInfo) -> (CancelAnswer, Vec<GoalInfo>) {
        let (any_id, any_time) = (request.goal_id == GoalId::default(), request.stamp == Time::default());
        let meant = |(id, known): &(&GoalId, &Known)| {
            let by_id = !any_id && **id == request.goal_id;
            let by_time = !any_time && known.accepted <= request.stamp;
            by_id || by_time || (any_id && any_time)
        };
        let executing: Vec<GoalInfo> = self
            .known
            .iter()
            .filter(|(_, known)| known.status == Status::Executing)
            .filter(meant)
            .map(|(id, known)| GoalInfo { goal_id: *id, stamp: known.accepted })
            .collect();
        let answer = if !executing.is_empty() {
            CancelAnswer::Accepted
        } else if !any_id && self.known.contains_key(&request.goal_id) {
            CancelAnswer::Terminated
        } else {
            CancelAnswer::UnknownGoal
        };
        (answer, executing)
    }

    /// The result of a goal: `None` while it is in progress, status 0 if the goal is unknown.
    pub fn result(&self, id: &GoalId) -> Option<(i8, Outcome)> {
        match self.known.get(id) {
            Some(known) if known.status == Status::Executing => None,
            Some(known) => Some((known.status as i8, known.outcome.clone())),
            None => Some((0, Outcome { message: "there is no such goal".to_string(), ..Outcome::default() })),
        }
    }

    /// Identity, time of acceptance and status of every goal.
    pub fn statuses(&self) -> Vec<(GoalInfo, i8)> {
        let info =
            |(id, known): (&GoalId, &Known)| (GoalInfo { goal_id: *id, stamp: known.accepted }, known.status as i8);
        self.known.iter().map(info).collect()
    }

    fn forget(&mut self) {
        while self.known.len() > KEPT {
            let finished = self.known.iter().filter(|(_, known)| known.status != Status::Executing);
            let Some(oldest) = finished.min_by_key(|(_, known)| known.number).map(|(id, _)| *id) else { return };
            self.known.remove(&oldest);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AT: Time = Time { sec: 10, nanosec: 0 };
    const NEVER: Time = Time { sec: 0, nanosec: 0 };

    fn id(number: u8) -> GoalId {
        [number; 16]
    }

    #[test]
    fn a_result_is_there_when_the_goal_has_ended() {
        let mut goals = Goals::default();
        assert!(goals.accept(id(1), AT));
        assert!(!goals.accept(id(1), AT));
        assert_eq!(goals.result(&id(1)), None);
        assert!(goals.finish(&id(1), Status::Succeeded, Outcome::default()));
        assert!(!goals.finish(&id(1), Status::Aborted, Outcome::default()));
        assert_eq!(goals.result(&id(1)).map(|(status, _)| status), Some(4));
        assert_eq!(goals.result(&id(9)).map(|(status, _)| status), Some(0));
    }

    #[test]
    fn cancel_requests_mean_what_the_design_says() {
        let mut goals = Goals::default();
        goals.accept(id(1), AT);
        goals.accept(id(2), Time { sec: 20, nanosec: 0 });
        let count = |goal_id, stamp| {
            let (answer, list) = goals.to_cancel(GoalInfo { goal_id, stamp });
            (answer, list.len())
        };
        assert_eq!(count(id(2), NEVER), (CancelAnswer::Accepted, 1));
        assert_eq!(count(id(0), NEVER), (CancelAnswer::Accepted, 2));
        assert_eq!(count(id(0), Time { sec: 15, nanosec: 0 }), (CancelAnswer::Accepted, 1));
        assert_eq!(count(id(2), Time { sec: 15, nanosec: 0 }), (CancelAnswer::Accepted, 2));
        assert_eq!(count(id(7), NEVER), (CancelAnswer::UnknownGoal, 0));
        goals.finish(&id(2), Status::Canceled, Outcome::default());
        let again = goals.to_cancel(GoalInfo { goal_id: id(2), stamp: NEVER });
        assert_eq!(again, (CancelAnswer::Terminated, Vec::new()));
    }

    #[test]
    fn old_results_are_forgotten_but_never_work() {
        let mut goals = Goals::default();
        goals.accept(id(0xff), AT);
        for number in 0..100 {
            goals.accept(id(number), AT);
            goals.finish(&id(number), Status::Succeeded, Outcome::default());
        }
        assert!(goals.statuses().len() <= KEPT + 1);
        assert!(goals.is_executing(&id(0xff)));
    }
}
