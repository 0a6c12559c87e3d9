//! The controller's node.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use excavator_model::Model;
use excavator_model::document::parse;
use excavator_model::effects::Catalogue;
use excavator_msgs::common::{JointState, Text};
use excavator_msgs::{ArmState, Header, OrificeCommand};

use super::law::{Gains, JointLaw, Wanted};
use crate::arm_state::joint_name;
use crate::error::NodeError;
use crate::models::{chosen_model, model_parameter};
use excavator_ros::{
    Diagnostics, Health, Logger, Outlet, Pace, Parameter, Parameters, RosArguments, RosClock, Supervisor, TopicQos,
    Value,
};

/// Time between two diagnostics messages.
const REPORT: Duration = Duration::from_millis(500);

/// All parameters, with units, ranges and defaults.
pub fn parameters() -> Vec<Parameter> {
    let double = |name, value, description| Parameter::new(name, Value::Double(value), description);
    vec![
        model_parameter(),
        double("rate", 100.0, "commands per second [Hz]; several within the time for which one holds, 0.1 s")
            .within(20.0, 1000.0)
            .read_only(),
        double("position_gain", 4.0, "joint rate per position error [1/s]: a quarter of the arm's own frequency")
            .within(0.0, 100.0),
        double("integral_gain", 4.0, "opening per missing travel, both as shares of full [1/s]").within(0.0, 100.0),
        double("command_timeout", 0.5, "time after which a joint command counts no more [s]; trajectories come faster")
            .within(0.01, 10.0),
    ]
}

/// Runs the controller until a stop is requested.
///
/// # Errors
/// [`NodeError`] when it cannot start.
pub fn run(ros: &RosArguments) -> Result<(), NodeError> {
    let supervisor = Supervisor::start("joint_controller", ros, parameters())?;
    let heard = Arc::new(Mutex::new(Heard::default()));
    if let Some(model) = chosen_model(&supervisor.parameters)? {
        lock(&heard).model = Some(Ok(model));
    } else {
        let listening = Arc::clone(&heard);
        supervisor.link.subscribe("arm/model", TopicQos::latched(), move |text: Text, _| {
            lock(&listening).model =
                Some(parse("arm/model", &text.data, &Catalogue::built_in()).map_err(|e| e.to_string()));
        })?;
    }
    let listening = Arc::clone(&heard);
    supervisor.link.subscribe("arm/state", TopicQos::reliable(50), move |state: ArmState, _| {
        lock(&listening).state = Some(state);
    })?;
    let listening = Arc::clone(&heard);
    supervisor.link.subscribe(
        "robot_joint_commands",
        TopicQos::reliable(10),
        move |command: JointState, received| {
            lock(&listening).take(&command, received.at);
        },
    )?;
    let controller = Controller {
        heard: &heard,
        commands: supervisor.link.publish("arm/orifice_command", TopicQos::reliable(10))?,
        joints: supervisor.link.publish("robot_joint_states", TopicQos::reliable(10))?,
        parameters: &supervisor.parameters,
        clock: &supervisor.clock,
        diagnostics: &supervisor.diagnostics,
        logger: &supervisor.logger,
    };
    let stop = supervisor.stop_flag();
    std::thread::scope(|scope| {
        scope.spawn(|| controller.run(&stop));
        supervisor.run(|| {});
        stop.store(true, Ordering::Relaxed);
    });
    supervisor.leave();
    Ok(())
}

fn lock(heard: &Mutex<Heard>) -> MutexGuard<'_, Heard> {
    heard.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The latest messages.
#[derive(Default)]
struct Heard {
    /// A model that has not been processed yet.
    model: Option<Result<Model, String>>,
    state: Option<ArmState>,
    wanted: BTreeMap<String, Wanted>,
    at: Option<Instant>,
}

impl Heard {
    fn take(&mut self, command: &JointState, now: Instant) {
        let value = |values: &[f64], index: usize| values.get(index).copied().unwrap_or(f64::NAN);
        self.wanted = command
            .name
            .iter()
            .enumerate()
            .map(|(index, name)| {
                let wanted =
                    Wanted { position: value(&command.position, index), rate: value(&command.velocity, index) };
                (name.clone(), wanted)
            })
            .collect();
        self.at = Some(now);
    }
}

struct Controller<'c> {
    heard: &'c Mutex<Heard>,
    commands: Outlet<OrificeCommand>,
    joints: Outlet<JointState>,
    parameters: &'c Parameters,
    clock: &'c RosClock,
    diagnostics: &'c Diagnostics,
    logger: &'c Logger,
}

/// A machine under control.
struct Machine {
    names: Vec<String>,
    laws: Vec<Option<JointLaw>>,
    /// Whether the last command may have left a valve open.
    is_commanding: bool,
}

impl Controller<'_> {
    fn run(&self, stop: &AtomicBool) {
        let mut pace = Pace::new(self.parameters.double("rate"));
        let (mut machine, mut reported) = (None, None);
        while !stop.load(Ordering::Relaxed) {
            if let Some(model) = lock(self.heard).model.take() {
                machine = self.machine(model);
            }
            let word = match &mut machine {
                Some(machine) => self.turn(machine),
                None => (Health::Warning, "no model yet: give -p model:= or publish arm/model"),
            };
            if reported.is_none_or(|at: Instant| at.elapsed() >= REPORT) {
                reported = Some(Instant::now());
                self.diagnostics.tell("joints", word.0, word.1, &[]);
            }
            pace.wait();
        }
        if let Some(machine) = &mut machine {
            self.close(machine);
        }
    }

    fn machine(&self, model: Result<Model, String>) -> Option<Machine> {
        let built = model.and_then(|model| Ok((JointLaw::of(&model)?, model)));
        match built {
            Ok((laws, model)) => {
                self.diagnostics.set_hardware(&model.machine.name);
                self.logger.info(format!("controlling {}", model.machine.name));
                let names = model.machine.cylinders.iter().map(|cylinder| cylinder.name.clone()).collect();
                Some(Machine { names, laws, is_commanding: false })
            }
            Err(reason) => {
                self.logger.error(reason);
                None
            }
        }
    }

    /// One cycle of the loop: publishes joint states, and openings while commands come.
    fn turn(&self, machine: &mut Machine) -> (Health, &'static str) {
        let (state, wanted, at) = {
            let mut heard = lock(self.heard);
            (heard.state.take(), heard.wanted.clone(), heard.at)
        };
        let timeout = Duration::try_from_secs_f64(self.parameters.double("command_timeout")).unwrap_or_default();
        let is_commanded = at.is_some_and(|at| at.elapsed() <= timeout);
        let Some(state) = state else {
            return if is_commanded { (Health::Warning, "no arm/state") } else { (Health::Ok, "waiting") };
        };
        let gains = Gains {
            position: self.parameters.double("position_gain"),
            integral: self.parameters.double("integral_gain"),
        };
        let header = Header { stamp: self.clock.now(), frame_id: String::new() };
        let mut joints = JointState {
            header: Header { stamp: state.header.stamp, ..header.clone() },
            name: Vec::new(),
            position: Vec::new(),
            velocity: Vec::new(),
            effort: Vec::new(),
        };
        let mut command = OrificeCommand { header, names: Vec::new(), areas: Vec::new() };
        let time = state.header.stamp.nanoseconds() as f64 * 1e-9;
        for (name, law) in machine.names.iter().zip(&mut machine.laws) {
            let Some(measured) = state.cylinders.iter().find(|cylinder| cylinder.name == *name) else { continue };
            let Some(law) = law else { continue };
            let joint = joint_name(name);
            let idle = Wanted { position: f64::NAN, rate: f64::NAN };
            let asked = wanted.get(&joint).copied().filter(|_| is_commanded);
            let (area, rate) = law.step(asked.unwrap_or(idle), gains, measured.joint_angle, time);
            joints.name.push(joint);
            joints.position.push(measured.joint_angle);
            joints.velocity.push(rate);
            if asked.is_some() {
                command.names.push(name.clone());
                command.areas.push(area);
            }
        }
        // A refusal is ignored: the next cycle publishes both topics again.
        let _ = self.joints.publish(joints);
        if !command.names.is_empty() {
            if !std::mem::replace(&mut machine.is_commanding, true) {
                // A valve that was closed for safety requires an area of zero first.
                let areas = vec![0.0; command.names.len()];
                let _ = self.commands.publish(OrificeCommand { areas, ..command.clone() });
            }
            let _ = self.commands.publish(command);
            return (Health::Ok, "following joint commands");
        }
        self.close(machine);
        (Health::Ok, "waiting for joint commands")
    }

    /// Closes the opened valves, once.
    fn close(&self, machine: &mut Machine) {
        if !std::mem::take(&mut machine.is_commanding) {
            return;
        }
        machine.laws.iter_mut().flatten().for_each(JointLaw::rest);
        let with_valve = machine.names.iter().zip(&machine.laws).filter(|(_, law)| law.is_some());
        let names: Vec<String> = with_valve.map(|(name, _)| name.clone()).collect();
        let header = Header { stamp: self.clock.now(), frame_id: String::new() };
        let areas = vec![0.0; names.len()];
        // A refusal is ignored: the simulator closes the valves itself when the command times out.
        let _ = self.commands.publish(OrificeCommand { header, names, areas });
    }
}
