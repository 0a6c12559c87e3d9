//! Handles goals, cancel requests and result requests, without the transport.

use std::collections::{HashMap, VecDeque};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

use excavator_msgs::Time;
use excavator_msgs::common::Text;
use ros2_client::RmwRequestId;

use super::goals::{CancelAnswer, Goals, Status};
use super::queue::{Job, MOST_WAITING, Queue};
use super::refusals::Refusals;
use super::types::{Feedback, Goal, GoalId, GoalInfo, Outcome};
use super::work::out_of_time;
use excavator_ros::{Diagnostics, Health, Latched, Logger, Supervisor};

/// Most pending result requests: a few for each goal. When more arrive, the oldest is dropped.
const MOST_QUESTIONS: usize = 256;
/// Time beyond the limit after which a goal is ended even if the worker has not reached a point where it checks the time.
const GRACE: Duration = Duration::from_secs(10);

/// Messages from the worker.
#[derive(Debug)]
pub(super) enum News {
    Began {
        id: GoalId,
    },
    Progress {
        id: GoalId,
        feedback: Feedback,
    },
    Ended {
        id: GoalId,
        outcome: Outcome,
    },
    /// The worker has abandoned a cancelled goal.
    Left {
        id: GoalId,
    },
}

/// What the worker has reported.
#[derive(Debug, Default)]
pub(super) struct Heard {
    pub progress: Vec<(GoalId, Feedback)>,
    /// Whether the status of a goal has changed.
    pub ended: bool,
}

/// All goals, and the pending requests for their results.
pub(super) struct Desk {
    goals: Goals,
    cancels: HashMap<GoalId, Arc<AtomicBool>>,
    questions: VecDeque<(RmwRequestId, GoalId)>,
    queue: Arc<Queue>,
    news: Receiver<News>,
    /// Publishes results as the model in use; `None` if results are not published.
    model: Option<Latched<Text>>,
    time_limit: Duration,
    /// The goal in progress, its start, and whether it is overdue.
    working: Option<(GoalId, Instant, bool)>,
    refusals: Refusals,
    failures: Refusals,
    diagnostics: Diagnostics,
    logger: Logger,
}

impl Desk {
    /// A desk that puts jobs into `queue` and receives reports on them from `news`.
    pub fn new(
        queue: Arc<Queue>,
        news: Receiver<News>,
        model: Option<Latched<Text>>,
        time_limit: Duration,
        supervisor: &Supervisor,
    ) -> Self {
        Desk {
            goals: Goals::default(),
            cancels: HashMap::new(),
            questions: VecDeque::new(),
            queue,
            news,
            model,
            time_limit,
            working: None,
            refusals: Refusals::default(),
            failures: Refusals::default(),
            diagnostics: supervisor.diagnostics.clone(),
            logger: supervisor.logger.clone(),
        }
    }

    /// Accepts a new goal, or rejects it and logs the reason.
    pub fn take(&mut self, id: GoalId, goal: Goal, now: Time) -> bool {
        let refused = if let Err(reason) = goal.check_size() {
            Some(reason)
        } else if self.queue.is_full() {
            Some(format!("{MOST_WAITING} goals are waiting already; cancel some, or wait"))
        } else if !self.goals.accept(id, now) {
            Some("its identity is taken".to_string())
        } else {
            None
        };
        if let Some(reason) = refused {
            self.refusals.log(&self.logger, &format!("a goal is refused: {reason}"));
            self.tell();
            return false;
        }
        let cancelled = Arc::new(AtomicBool::new(false));
        self.cancels.insert(id, Arc::clone(&cancelled));
        self.queue.push(Job { id, goal, cancelled });
        self.tell();
        true
    }

    /// Cancels the goals that a request matches.
    pub fn cancel(&mut self, request: GoalInfo) -> (CancelAnswer, Vec<GoalInfo>) {
        let (answer, meant) = self.goals.to_cancel(request);
        for goal in &meant {
            if let Some(flag) = self.cancels.remove(&goal.goal_id) {
                flag.store(true, Ordering::Relaxed);
            }
            let outcome = Outcome { message: "cancelled".to_string(), ..Outcome::default() };
            self.goals.finish(&goal.goal_id, Status::Canceled, outcome);
        }
        self.queue.drop_cancelled();
        (answer, meant)
    }

    /// Stores a result request. The oldest is dropped if there are too many.
    pub fn ask(&mut self, request: RmwRequestId, id: GoalId) {
        if self.questions.len() >= MOST_QUESTIONS {
            self.questions.pop_front();
        }
        self.questions.push_back((request, id));
    }

    /// Processes the worker's messages.
    pub fn listen(&mut self) -> Heard {
        let mut heard = Heard::default();
        while let Ok(news) = self.news.try_recv() {
            match news {
                News::Began { id } => self.working = Some((id, Instant::now(), false)),
                News::Progress { id, feedback } if self.goals.is_executing(&id) => heard.progress.push((id, feedback)),
                News::Progress { .. } => continue,
                News::Ended { id, outcome } => {
                    self.leave(id);
                    heard.ended |= self.end(id, outcome);
                }
                News::Left { id } => self.leave(id),
            }
            self.tell();
        }
        heard.ended |= self.end_overdue();
        heard
    }

    /// The result requests that can be answered now.
    pub fn answers(&mut self) -> Vec<(RmwRequestId, i8, Outcome)> {
        let goals = &self.goals;
        let mut answers = Vec::new();
        self.questions.retain(|(request, id)| match goals.result(id) {
            None => true,
            Some((status, outcome)) => {
                answers.push((*request, status, outcome));
                false
            }
        });
        answers
    }

    /// Identity, time of acceptance and status of every goal.
    pub fn statuses(&self) -> Vec<(GoalInfo, i8)> {
        self.goals.statuses()
    }

    fn leave(&mut self, id: GoalId) {
        self.working = self.working.filter(|(working, ..)| *working != id);
    }

    fn end(&mut self, id: GoalId, outcome: Outcome) -> bool {
        self.cancels.remove(&id);
        let status = if outcome.success { Status::Succeeded } else { Status::Aborted };
        let (text, message) = (outcome.model.clone(), outcome.message.clone());
        let ended = self.goals.finish(&id, status, outcome);
        if !ended {
            return false;
        }
        if status == Status::Aborted {
            self.failures.log(&self.logger, &message);
            return true;
        }
        self.logger.info(message);
        if let Some(model) = &self.model {
            // A latched topic keeps the newest message; the next result replaces it.
            let _ = model.publish(Text { data: text });
        }
        true
    }

    /// Ends a goal that is overdue. The worker checks the time only between rounds, and a large recording makes a round long.
    fn end_overdue(&mut self) -> bool {
        let Some((id, since, false)) = self.working else { return false };
        if since.elapsed() < self.time_limit + GRACE {
            return false;
        }
        self.working = Some((id, since, true));
        if let Some(flag) = self.cancels.get(&id) {
            flag.store(true, Ordering::Relaxed);
        }
        let ended = self.end(id, Outcome { message: out_of_time(self.time_limit), ..Outcome::default() });
        self.tell();
        ended
    }

    fn tell(&self) {
        let values = [
            ("waiting goals", self.queue.len().to_string()),
            ("refused goals", self.refusals.total().to_string()),
            ("failed goals", self.failures.total().to_string()),
        ];
        let (health, message) = match self.working {
            None => (Health::Ok, "waiting for a goal"),
            Some((_, _, false)) => (Health::Ok, "identifying"),
            Some((_, _, true)) => (Health::Warning, "a goal is over its time and its work has not ended yet"),
        };
        self.diagnostics.tell("work", health, message, &values);
    }
}
