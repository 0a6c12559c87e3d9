//! The simulator's node.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use excavator_model::document::to_text;
use excavator_model::effects::Catalogue;
use excavator_model::{Model, urdf};
use excavator_msgs::common::{Clock, JointState, Text};
use excavator_msgs::{ArmState, Time};

use super::declared::parameters;
use super::machine_process::{MachineProcess, Setup};
use super::sensors::{Instrument, Quality, SIGNALS, Sensors};
use super::stamps::Stamps;
use super::valve_limits;
use crate::arm_state::{FRAME, joint_state};
use crate::command_gate::{Desk, Valve};
use crate::error::NodeError;
use excavator_ros::{
    Diagnostics, Health, Latched, Lifecycle, Logger, Outlet, Pace, Parameters, RosArguments, RosError, Supervisor,
    TopicQos,
};
use excavator_study::model_named;

/// Rate of `/joint_states`, Hz: what RViz and robot_state_publisher need.
const JOINT_STATES_RATE: f64 = 50.0;
/// Rate of `/clock`, Hz of simulated time.
const CLOCK_RATE: f64 = 250.0;
/// Time between two reads of the parameters, and between two diagnostics messages.
const REPORT: Duration = Duration::from_millis(200);

/// Most samples that are caught up after a stall. A machine that was suspended for hours continues from its last state.
const MOST_MISSED: u64 = 10_000;

/// Runs the simulator until a stop is requested.
///
/// # Errors
/// [`NodeError`] when it cannot start.
pub fn run(arguments: &RosArguments) -> Result<(), NodeError> {
    let supervisor = Supervisor::start("arm_simulator", arguments, parameters())?;
    let model = model_named(&supervisor.parameters.text("model"), &Catalogue::built_in())?;
    supervisor.diagnostics.set_hardware(&model.machine.name);
    let not_measured = supervisor.parameters.texts("not_measured");
    if let Some(unknown) = not_measured.iter().find(|name| !SIGNALS.contains(&name.as_str())) {
        let reason = format!("not_measured: \"{unknown}\" is none of {}", SIGNALS.join(", "));
        return Err(RosError::Parameter(reason).into());
    }
    let outlets = Outlets {
        state: supervisor.link.publish("arm/state", TopicQos::reliable(50))?,
        joints: supervisor.link.publish("joint_states", TopicQos::reliable(10))?,
        model: supervisor.link.publish_latched("arm/model", TopicQos::latched())?,
        description: supervisor.link.publish_latched("robot_description", TopicQos::latched())?,
        clock: has_own_clock(&supervisor.parameters)
            .then(|| supervisor.link.publish("/clock", TopicQos::reliable(10)))
            .transpose()?,
    };
    // The machine starts before its commands are subscribed: a model that cannot be set up must not accept any.
    let machine = MachineProcess::start(&setup(&model, &supervisor)?)?;
    let desk = Desk::open(&supervisor, valves(&model), "arm/state")?;
    // Latched: late subscribers receive these as well.
    let _ = outlets.model.publish(Text { data: to_text(&model)? });
    let _ = outlets.description.publish(Text { data: urdf(&model.machine) });
    let stop = supervisor.stop_flag();
    let lifecycle = supervisor.lifecycle()?;
    let simulation = Simulation {
        lifecycle: &lifecycle,
        model: &model,
        parameters: &supervisor.parameters,
        diagnostics: &supervisor.diagnostics,
        logger: &supervisor.logger,
        outlets: &outlets,
        desk: &desk,
        stop: &stop,
    };
    let outcome = std::thread::scope(|scope| {
        let running = scope.spawn(|| simulation.run(machine));
        supervisor.run(|| {});
        // The simulation closes its valves before it ends.
        running.join().unwrap_or(Ok(()))
    });
    supervisor.leave();
    outcome
}

/// Whether this node is the source of time. With `use_sim_time` some node must be, and that is the simulator.
fn has_own_clock(parameters: &Parameters) -> bool {
    parameters.flag("publish_clock") || parameters.flag("use_sim_time") || parameters.double("speed") != 1.0
}

struct Outlets {
    state: Outlet<ArmState>,
    joints: Outlet<JointState>,
    model: Latched<Text>,
    description: Latched<Text>,
    clock: Option<Outlet<Clock>>,
}

/// The valves that can be commanded. A cylinder without a valve keeps its place, so that indices agree. Its name is empty, so
/// that no command can address it.
fn valves(model: &Model) -> Vec<Valve> {
    let limits = valve_limits(model);
    let with_limits = model.machine.cylinders.iter().zip(limits);
    with_limits
        .map(|(cylinder, maximum_area)| {
            let name = if cylinder.chambers.is_some() { cylinder.name.clone() } else { String::new() };
            Valve { name, maximum_area }
        })
        .collect()
}

fn setup(model: &Model, supervisor: &Supervisor) -> Result<Setup, NodeError> {
    let parameters = &supervisor.parameters;
    let (rate, speed) = (parameters.double("rate"), parameters.double("speed"));
    Ok(Setup {
        model: to_text(model)?,
        name: supervisor.link.identity().name().to_string(),
        start_displacement: parameters.doubles("start_displacement"),
        period: 1.0 / rate,
        wall_period: 1.0 / (rate * speed),
        supply_pressure: parameters.double("supply_pressure"),
        opening_time: parameters.double("opening_time"),
        closing_time: parameters.double("closing_time"),
    })
}

fn seconds(value: f64) -> Duration {
    Duration::try_from_secs_f64(value).unwrap_or(Duration::ZERO)
}

struct Simulation<'r> {
    lifecycle: &'r Lifecycle,
    model: &'r Model,
    parameters: &'r Parameters,
    diagnostics: &'r Diagnostics,
    logger: &'r Logger,
    outlets: &'r Outlets,
    desk: &'r Desk,
    stop: &'r AtomicBool,
}

impl Simulation<'_> {
    /// Runs the loop. Sets the stop flag in every case when it ends.
    fn run(&self, machine: MachineProcess) -> Result<(), NodeError> {
        let outcome = self.steps(machine);
        self.stop.store(true, Ordering::Relaxed);
        outcome
    }

    fn steps(&self, mut machine: MachineProcess) -> Result<(), NodeError> {
        let parameters = self.parameters;
        let (rate, speed) = (parameters.double("rate"), parameters.double("speed"));
        let (period, frame) = (1.0 / rate, parameters.text(FRAME));
        let seed = u64::try_from(parameters.integer("seed")).unwrap_or_default();
        let mut sensors = Sensors::new(seed, parameters.texts("not_measured"));
        let mut clock = SampleClock::new(period, self.outlets.clock.is_some());
        // The schedule begins with the first sample, so that a slow first sample does not delay the others.
        let mut pace: Option<Pace> = None;
        let mut settings = Settings::read(parameters);
        let mut reported = Instant::now();
        let mut counts = Counts::default();
        let mut wanted = Vec::new();
        let (mut samples, mut known, mut is_shut) = (1, 0, false);
        let every = |target: f64| ((rate / target).round() as u64).max(1);
        let (joints_every, clock_every) = (every(JOINT_STATES_RATE), every(CLOCK_RATE));
        self.logger.info(format!("{} at {rate} Hz, speed {speed}", self.model.machine.name));
        for sample in 0_u64.. {
            let stopping = self.stop.load(Ordering::Relaxed);
            let is_active = self.lifecycle.is_active();
            if (stopping || !is_active) != is_shut {
                is_shut = !is_shut;
                self.desk.shut(is_shut);
            }
            self.desk.look(&mut wanted);
            let answer = machine.go_on(&wanted, samples, settings.command_timeout, settings.oil_temperature)?;
            let pace = pace.get_or_insert_with(|| Pace::new(rate * speed));
            for failure in &answer.failures {
                counts.failures += 1;
                self.logger.error(format!("{failure}; the machine is set up again at rest"));
            }
            counts.limited = answer.limited;
            let mut state = answer.state;
            let stamp = clock.stamp(answer.samples, answer.sampled_at);
            // If the machine continued without orders, nothing is published until this loop has caught up with it.
            let publishes = is_active && answer.samples > known;
            known = answer.samples;
            state.header.stamp = stamp;
            state.header.frame_id.clone_from(&frame);
            if self.outlets.clock.is_some() {
                self.desk.set_simulated_time(stamp.nanoseconds());
            }
            if sample % clock_every == 0
                && let Some(outlet) = &self.outlets.clock
            {
                let _ = outlet.publish(Clock { clock: stamp });
            }
            let joints = (sample % joints_every == 0).then(|| joint_state(&state, answer.joint_rates));
            if publishes && sensors.measure(&mut state, &settings.quality) {
                // The outlet counts refusals; they are reported below.
                let _ = self.outlets.state.publish(state);
            }
            if let Some(joints) = joints.filter(|_| publishes) {
                let _ = self.outlets.joints.publish(joints);
            }
            if reported.elapsed() >= REPORT {
                reported = Instant::now();
                settings = Settings::read(parameters);
                self.report(pace, &clock, &counts);
            }
            if stopping && answer.closed {
                return Ok(());
            }
            pace.wait();
            // Machine time continues while this process was not scheduled.
            samples = 1 + pace.take_missed().min(MOST_MISSED);
        }
        Ok(())
    }

    fn report(&self, pace: &Pace, clock: &SampleClock, counts: &Counts) {
        let state = &self.outlets.state;
        let values = [
            ("published states", state.published().to_string()),
            ("refused states", state.refused().to_string()),
            ("schedule restarts", pace.late().to_string()),
            ("jumps of the clock", clock.jumps.to_string()),
            ("times set up again", counts.failures.to_string()),
        ];
        let (health, message) = if !self.lifecycle.is_active() {
            (Health::Ok, "not active")
        } else if counts.failures > 0 {
            (Health::Warning, "the machine was set up again")
        } else {
            (Health::Ok, "running")
        };
        self.diagnostics.tell("simulation", health, message, &values);
        self.desk.report(counts.limited);
    }
}

/// Counts that the machine has reported so far.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    failures: u64,
    limited: u64,
}

/// Parameters that may change while the simulator runs.
struct Settings {
    quality: Quality,
    oil_temperature: f64,
    command_timeout: Duration,
}

impl Settings {
    fn read(parameters: &Parameters) -> Self {
        let number = |name: &str| parameters.double(name);
        let instrument = |noise: &str, quantum: &str| Instrument { noise: number(noise), quantum: number(quantum) };
        let quality = Quality {
            displacement: instrument("displacement_noise", "displacement_quantum"),
            joint_angle: instrument("joint_angle_noise", "joint_angle_quantum"),
            velocity: Instrument { noise: number("velocity_noise"), quantum: 0.0 },
            pressure: instrument("pressure_noise", "pressure_quantum"),
            orifice_area: Instrument { noise: number("orifice_area_noise"), quantum: 0.0 },
            dropout_probability: number("dropout_probability"),
            loss_probability: number("loss_probability"),
        };
        Settings {
            quality,
            oil_temperature: number("oil_temperature"),
            command_timeout: seconds(number("command_timeout")),
        }
    }
}

/// Source of the stamps.
struct SampleClock {
    /// Time between samples, ns.
    period: i64,
    /// Whether this node is the source of time: then it counts from zero.
    is_own: bool,
    stamps: Stamps,
    jumps: u64,
}

impl SampleClock {
    fn new(period: f64, own: bool) -> Self {
        let period = (period * 1e9).round() as i64;
        SampleClock { period, is_own: own, stamps: Stamps::new(period), jumps: 0 }
    }

    /// Stamp of this sample, which was taken when the system clock showed `clock` (ns).
    fn stamp(&mut self, sample: u64, clock: i64) -> Time {
        let nanoseconds = if self.is_own {
            self.period.saturating_mul(i64::try_from(sample).unwrap_or(i64::MAX))
        } else {
            let (stamp, jumped) = self.stamps.stamp(sample, clock);
            self.jumps += u64::from(jumped);
            stamp
        };
        Time::from_nanoseconds(nanoseconds).unwrap_or_default()
    }
}
