//! The node: the action server, and one worker thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

use super::desk::{Desk, News};
use super::library::{Library, QUOTED};
use super::printable::printable;
use super::queue::{Job, Queue};
use super::server::IdentifyAction;
use super::types::{Feedback, Outcome};
use super::work::{Bounds, Ended, identify, out_of_time};
use crate::error::NodeError;
use excavator_ros::{Health, Logger, Parameter, RosArguments, RosError, Supervisor, TopicQos, Value};

/// Longest time until the worker notices that the node ends.
const GLANCE: Duration = Duration::from_millis(200);
/// Characters of a model's name in the log.
const NAMED: usize = 80;

/// All parameters, with units, ranges and defaults.
pub fn parameters() -> Vec<Parameter> {
    let text = |name, description| Parameter::new(name, Value::String(String::new()), description).read_only();
    vec![
        text("model_folder", "folder below which goals may name model files; empty: goals read no model files"),
        text("bag_folder", "folder below which goals may name bags; empty: goals read no bags"),
        // Ten minutes of recordings at 1 kHz with an added effect take some minutes. Ten times that means a stuck goal.
        Parameter::new("time_limit", Value::Double(1800.0), "longest work on a goal [s]")
            .within(0.1, 86_400.0)
            .read_only(),
        Parameter::new(
            "publish_result",
            Value::Boolean(false),
            "publish the model of a goal that succeeded on /arm/model, where the energy monitor takes its model from",
        )
        .read_only(),
    ]
}

/// Runs the node until a stop is requested.
///
/// # Errors
/// [`NodeError`] when it cannot start.
pub fn run(ros: &RosArguments) -> Result<(), NodeError> {
    let supervisor = Supervisor::start_large("identification", ros, parameters())?;
    let given = &supervisor.parameters;
    let library = Library::new(&given.text("model_folder"), &given.text("bag_folder")).map_err(RosError::Parameter)?;
    let time_limit = Duration::try_from_secs_f64(given.double("time_limit")).unwrap_or(GLANCE);
    let model = match given.flag("publish_result") {
        true => Some(supervisor.link.publish_latched("arm/model", TopicQos::latched())?),
        false => None,
    };
    let queue = Arc::new(Queue::default());
    let (told, news) = channel();
    let name = supervisor.link.identity().resolve("/identification/run")?;
    let mapping = supervisor.link.environment().mapping;
    let desk = Desk::new(Arc::clone(&queue), news, model, time_limit, &supervisor);
    supervisor.link.add(Arc::new(IdentifyAction::new(name, mapping, desk)))?;
    let stop = supervisor.stop_flag();
    let worker = Worker { queue, told, logger: supervisor.logger.clone(), library, time_limit, stop };
    supervisor.diagnostics.tell("work", Health::Ok, "waiting for a goal", &[]);
    // The thread is not joined: work in progress at the stop ends with the process.
    std::thread::spawn(move || worker.run());
    supervisor.run(|| {});
    supervisor.leave();
    Ok(())
}

struct Worker {
    queue: Arc<Queue>,
    told: Sender<News>,
    logger: Logger,
    library: Library,
    time_limit: Duration,
    stop: Arc<AtomicBool>,
}

impl Worker {
    fn run(&self) {
        while !self.stop.load(Ordering::Relaxed) {
            match self.queue.pop(GLANCE) {
                Some(job) if !job.cancelled.load(Ordering::Relaxed) => self.work_on(&job),
                Some(_) | None => {}
            }
        }
    }

    // A send fails only when the node is about to end.
    fn work_on(&self, job: &Job) {
        let _ = self.told.send(News::Began { id: job.id });
        let said = AtomicBool::new(false);
        let tell = |stage: &str, progress: f64| {
            // Logged only once a bag is being used: goals that fail earlier can arrive a thousand times per second, and the
            // desk limits the log lines about them.
            if stage != "reading the model" && stage != "reading" && !said.swap(true, Ordering::Relaxed) {
                let model = printable(job.goal.model.lines().next().unwrap_or_default(), NAMED);
                self.logger.info(format!("identifying {model} from {} bags", job.goal.bags.len()));
            }
            let feedback = Feedback { stage: stage.to_string(), progress };
            let _ = self.told.send(News::Progress { id: job.id, feedback });
        };
        let deadline = Instant::now() + self.time_limit;
        let bounds = Bounds { library: &self.library, cancelled: &job.cancelled, deadline };
        let failed = |message: String| Outcome { message, ..Outcome::default() };
        let outcome = match identify(&job.goal, &bounds, &tell) {
            Ok(outcome) => outcome,
            Err(Ended::Cancelled) => {
                let _ = self.told.send(News::Left { id: job.id });
                return;
            }
            Err(Ended::TimedOut) => failed(out_of_time(self.time_limit)),
            Err(Ended::Unusable(reason)) => failed(reason.to_string()),
            Err(Ended::Failed(error)) => failed(printable(&self.library.without_folder(&error.to_string()), QUOTED)),
        };
        let _ = self.told.send(News::Ended { id: job.id, outcome });
    }
}
