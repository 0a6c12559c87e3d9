//! The node: the action in front, one thread that works behind.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

use super::server::{IdentifyAction, Job, News};
use super::types::{Feedback, Outcome};
use super::work::{Ended, identify};
use crate::error::VerbError;
use crate::ros::{Diagnostics, Health, Logger, RosArguments, Supervisor, TopicQos};

/// Longest time until the worker sees that the node ends.
const GLANCE: Duration = Duration::from_millis(200);

/// Runs the node until it is told to stop.
///
/// # Errors
/// [`VerbError`] when it cannot start.
pub fn run(ros: &RosArguments) -> Result<(), VerbError> {
    let supervisor = Supervisor::start_large("identification", ros, Vec::new())?;
    let model = supervisor.link.publish_latched("/arm/model", TopicQos::latched())?;
    let (jobs, work) = channel();
    let (told, news) = channel();
    let name = supervisor.link.identity().resolve("/identification/run")?;
    let mapping = supervisor.link.environment().mapping;
    supervisor.link.add(Arc::new(IdentifyAction::new(name, mapping, jobs, news, model)))?;
    let worker = Worker {
        work,
        told,
        diagnostics: supervisor.diagnostics.clone(),
        logger: supervisor.logger.clone(),
        stop: supervisor.stop_flag(),
    };
    // Not joined: work that is under way when the node is told to stop ends with the process.
    std::thread::spawn(move || worker.run());
    supervisor.run(|| {});
    supervisor.leave();
    Ok(())
}

struct Worker {
    work: Receiver<Job>,
    told: Sender<News>,
    diagnostics: Diagnostics,
    logger: Logger,
    stop: Arc<std::sync::atomic::AtomicBool>,
}

impl Worker {
    fn run(&self) {
        while !self.stop.load(Ordering::Relaxed) {
            self.diagnostics.tell("work", Health::Ok, "waiting for a goal", &[]);
            match self.work.recv_timeout(GLANCE) {
                Ok(job) if !job.cancelled.load(Ordering::Relaxed) => self.work_on(&job),
                Ok(_) | Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    fn work_on(&self, job: &Job) {
        self.diagnostics.tell("work", Health::Ok, "identifying", &[]);
        self.logger.info(format!("identifying {} from {} bags", short(&job.goal.model), job.goal.bags.len()));
        let tell = |stage: &str, progress: f64| {
            let feedback = Feedback { stage: stage.to_string(), progress };
            // Nobody hears it when the node is about to end.
            let _ = self.told.send(News::Progress { id: job.id, feedback });
        };
        let outcome = match identify(&job.goal, &job.cancelled, &tell) {
            Ok(outcome) => outcome,
            Err(Ended::Cancelled) => {
                self.logger.info("cancelled");
                return;
            }
            Err(Ended::Failed(error)) => Outcome { message: error.to_string(), ..Outcome::default() },
        };
        self.logger.info(outcome.message.clone());
        let _ = self.told.send(News::Ended { id: job.id, outcome });
    }
}

/// The first line of what may be a whole model.
fn short(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}
