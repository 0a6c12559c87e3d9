//! Runs the process of a node: start, watch, rebuild, stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use nix::sys::signal::Signal;
use tokio::runtime::Runtime;

use super::dds_names::{dds_topic, dds_type};
use super::guard::GuardError;
use super::health::{Ours, Watch};
use super::memory::{Memory, resident};
use super::middleware_log::{complaints, count_complaints};
use super::parameter_file::read_for;
use super::{
    Diagnostics, Environment, Health, Lifecycle, Link, Logger, NodeIdentity, Parameter, Parameters, RosArguments,
    RosClock, RosError, Signals,
};
use super::{parameter_services, type_descriptions};

/// Period of the supervision: a dead thread or a returned peer is found within this time.
const TICK: Duration = Duration::from_millis(250);
/// Pause after a rebuild that failed or did not help.
const PAUSE: Duration = Duration::from_secs(2);

/// Largest sample in fragments for recorder and player, bytes, unless the environment sets the limit: a point cloud of
/// a lidar has 1 to 6 MB, an uncompressed image of 1920 by 1080 6.2 MB.
const LARGE_SAMPLE: u32 = 1 << 23;

/// Everything that the process of a node has besides its own work.
pub struct Supervisor {
    /// Connection to the graph.
    pub link: Link,
    /// Parameters, declared and overridden.
    pub parameters: Parameters,
    /// ROS time.
    pub clock: RosClock,
    /// State of the parts.
    pub diagnostics: Diagnostics,
    /// Log.
    pub logger: Logger,
    signals: Signals,
    stop: Arc<AtomicBool>,
    /// Memory before the node joined the graph, MB, if it is watched.
    memory_at_start: Option<u64>,
    // Last, so that it outlives everything that runs on it.
    _runtime: Background,
}

/// The runtime of the link. Tasks that hang when the process ends are abandoned.
struct Background(Option<Runtime>);

impl Drop for Background {
    fn drop(&mut self) {
        if let Some(runtime) = self.0.take() {
            runtime.shutdown_background();
        }
    }
}

impl Supervisor {
    /// Joins the graph as the node that the program calls `default_name`.
    ///
    /// # Errors
    /// [`RosError`]: wrong arguments, environment or parameter values; a domain that cannot be joined.
    pub fn start(default_name: &str, arguments: &RosArguments, declared: Vec<Parameter>) -> Result<Self, RosError> {
        let environment = Environment::read(arguments.enclave.as_deref())?;
        Self::start_in(environment, default_name, arguments, declared, true)
    }

    /// The same for a node that handles large samples or needs much memory itself: its memory is not watched.
    ///
    /// # Errors
    /// As [`Supervisor::start`].
    pub fn start_large(
        default_name: &str,
        arguments: &RosArguments,
        declared: Vec<Parameter>,
    ) -> Result<Self, RosError> {
        let environment = Environment::read(arguments.enclave.as_deref())?.with_samples_of(LARGE_SAMPLE);
        Self::start_in(environment, default_name, arguments, declared, false)
    }

    fn start_in(
        environment: Environment,
        default_name: &str,
        arguments: &RosArguments,
        declared: Vec<Parameter>,
        watch_memory: bool,
    ) -> Result<Self, RosError> {
        let memory_at_start = watch_memory.then(resident).flatten();
        let signals = Signals::block()?;
        count_complaints();
        let identity = NodeIdentity::new(default_name, &arguments.remaps)?;
        let mut overrides = Vec::new();
        for file in &arguments.parameter_files {
            overrides.extend(read_for(file, &identity)?);
        }
        let for_us =
            |node: &Option<String>| node.as_deref().is_none_or(|node| node == default_name || node == identity.name());
        let given = arguments.parameters.iter().filter(|given| for_us(&given.node));
        overrides.extend(given.map(|given| (given.name.clone(), given.value.clone())));
        let (parameters, mut warnings) = Parameters::declare(declared, &overrides)?;
        warnings.extend(environment.warnings.iter().chain(&arguments.ignored).cloned());
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .thread_name("link")
            .enable_time()
            .build()
            .map_err(|source| RosError::System { action: "start the runtime", source })?;
        let link = Link::join(identity, environment, runtime.handle().clone())?;
        let runtime = Background(Some(runtime));
        let logger = Logger::new(&link, arguments)?;
        let clock = RosClock::of(&link, parameters.flag("use_sim_time"))?;
        let diagnostics = Diagnostics::new(&link, &clock)?;
        parameter_services::offer(&link, &parameters, &clock)?;
        type_descriptions::offer(&link)?;
        match link.guard() {
            Some(Err(GuardError::SwitchedOff)) | None | Some(Ok(_)) => {}
            Some(Err(reason)) => warnings.push(format!("packets are not checked: {reason}")),
        }
        warnings.into_iter().for_each(|warning| logger.warn(warning));
        let stop = Arc::new(AtomicBool::new(false));
        Ok(Supervisor {
            link,
            parameters,
            clock,
            diagnostics,
            logger,
            signals,
            stop,
            memory_at_start,
            _runtime: runtime,
        })
    }

    /// Lifecycle of a node. Its parameter `managed` states whether it is a managed node.
    ///
    /// # Errors
    /// [`RosError::Endpoint`].
    pub fn lifecycle(&self) -> Result<Lifecycle, RosError> {
        Lifecycle::start(&self.link, self.parameters.flag("managed"), &self.logger, self.stop_flag())
    }

    /// The flag that ends the process. It is set by a signal, or by a node that has finished its work.
    pub fn stop_flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stop)
    }

    /// Watches the link until the stop flag is set. `on_user_signal` is called for SIGUSR1.
    pub fn run(&self, mut on_user_signal: impl FnMut()) {
        let mut watch = self.watch(self.memory_at_start);
        let mut quiet_until = Instant::now();
        let (mut rebuilds, mut replaced) = (0, 0);
        let mut pending = None;
        while !self.stop.load(Ordering::Relaxed) {
            match self.signals.wait(TICK) {
                Some(Signal::SIGUSR1) => on_user_signal(),
                Some(signal) => {
                    self.logger.info(format!("{signal}, stopping"));
                    self.stop.store(true, Ordering::Relaxed);
                    return;
                }
                None => {}
            }
            if let Err(error) = self.clock.follow(&self.link, self.parameters.flag("use_sim_time")) {
                self.logger.error(error.to_string());
            }
            for topic in self.link.tend() {
                replaced += 1;
                self.logger.warn(format!("the reader of {topic} had lost a writer that still sends: it is replaced"));
            }
            let seen = match &mut watch {
                Some(watch) => watch.look(&self.ours()),
                None => super::health::Observations::default(),
            };
            seen.notes.into_iter().for_each(|note| self.logger.warn(note));
            pending = seen.fault.or(pending);
            if Instant::now() < quiet_until {
                continue;
            }
            if let Some(fault) = pending.take() {
                self.diagnostics.tell("link", Health::Warning, format!("{fault}: rebuilding the link"), &[]);
                self.logger.warn(format!("{fault}: rebuilding the link"));
            } else if watch.is_some() && self.link.participant().is_some() {
                self.tell_link(watch.as_ref(), rebuilds, replaced);
                continue;
            }
            drop(watch.take());
            rebuilds += 1;
            quiet_until = Instant::now() + PAUSE;
            match self.link.rebuild() {
                // Another rebuild would not release what this one has left.
                Ok(()) => watch = self.watch(self.memory_at_start.and_then(|_| resident())),
                Err(error) => self.logger.error(format!("{error}; trying again")),
            }
        }
    }

    /// Leaves the graph cleanly.
    pub fn leave(self) {
        self.link.leave();
    }

    fn watch(&self, memory: Option<u64>) -> Option<Watch> {
        let (participant, threads, probe) = self.link.alive()?;
        Some(Watch::new(self.link.environment().clone(), participant, threads, probe, memory.map(Memory::new)))
    }

    /// Topics and services of this node.
    fn ours(&self) -> Ours {
        Ours::new(&self.link.identity().full_name(), self.link.interfaces().into_iter().map(|(topic, _)| topic))
    }

    fn tell_link(&self, watch: Option<&Watch>, rebuilds: u32, replaced: u32) {
        let Some(watch) = watch else { return };
        let (malformed, others) = complaints();
        let (guard, refused) = match self.link.guard() {
            Some(Ok(guard)) => (guard.to_string(), guard.dropped()),
            Some(Err(reason)) => (format!("none: {reason}"), 0),
            None => ("none".to_string(), 0),
        };
        let values = [
            ("peers", watch.peers().to_string()),
            ("lost peers", watch.lost().to_string()),
            ("times rebuilt", rebuilds.to_string()),
            ("readers replaced", replaced.to_string()),
            ("packet guard", guard),
            ("packets refused or lost by the kernel", refused.to_string()),
            ("malformed packets", malformed.to_string()),
            ("other complaints of the middleware", others.to_string()),
        ];
        let foreign = self.foreign_types();
        if let Some(problem) = foreign.first() {
            self.diagnostics.tell("link", Health::Warning, problem.clone(), &values);
        } else {
            self.diagnostics.tell("link", Health::Ok, "joined", &values);
        }
    }

    /// Our topics that another node publishes with a different type. The middleware matches by topic name alone.
    fn foreign_types(&self) -> Vec<String> {
        let Some(participant) = self.link.participant() else { return Vec::new() };
        let writers = participant.discovered_writers();
        let mut found = Vec::new();
        for (topic, ros_type) in self.link.interfaces() {
            let (dds_name, dds_type) = (dds_topic(&topic), dds_type(&ros_type));
            let other = writers
                .iter()
                .map(|writer| &writer.publication_topic_data)
                .find(|data| data.topic_name == dds_name && data.type_name != dds_type);
            if let Some(other) = other {
                found.push(format!("{topic} is also published as {}, not {ros_type}", other.type_name));
            }
        }
        found
    }
}
