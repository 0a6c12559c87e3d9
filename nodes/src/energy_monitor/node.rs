//! The energy monitor's node.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use excavator_model::Model;
use excavator_model::document::parse;
use excavator_model::effects::Catalogue;
use excavator_model::energy::monitor::{Monitor, Settings, Watch, WatchSettings, Window};
use excavator_model::equations::System;
use excavator_msgs::common::Text;
use excavator_msgs::{ArmState, EnergyState};

use super::convert::{message, trimmed};
use super::incoming::{Counts, Inbox, Incoming, inbox};
use super::ledger::{Ledger, Tally, judge_windows};
use crate::arm_state::sample;
use crate::error::NodeError;
use crate::models::{chosen_model, model_parameter};
use excavator_ros::{
    Diagnostics, Health, Logger, Outlet, Parameter, Parameters, RosArguments, Supervisor, TopicQos, Value,
};

/// Time without a state after which the queued states are evaluated with the windows available.
const IDLE: Duration = Duration::from_millis(500);
/// Time between two diagnostics messages.
const REPORT: Duration = Duration::from_millis(500);
/// Time without a state after which a warning is given.
const SILENT: Duration = Duration::from_secs(2);

/// All parameters, with units, ranges and defaults.
pub fn parameters() -> Vec<Parameter> {
    let double = |name, value, description| Parameter::new(name, Value::Double(value), description);
    vec![
        model_parameter(),
        double("half_width", 0.01, "half width of the window of derivatives, which is also their delay [s]")
            .within(0.001, 0.5)
            .read_only(),
        double("gap", 0.1, "time without a state that separates what comes after from what was before [s]")
            .within(0.002, 10.0)
            .read_only(),
        double("watch_window", 1.0, "time over which unexplained power is averaged [s]").within(0.1, 60.0).read_only(),
        double("ledger_window", 10.0, "time after time that the ledger is judged equation by equation [s]")
            .within(2.0, 600.0)
            .read_only(),
        double("significance", 5.0, "standard errors beyond which unexplained power is told")
            .within(1.0, 100.0)
            .read_only(),
    ]
}

/// Runs the monitor until a stop is requested.
///
/// # Errors
/// [`NodeError`] when it cannot start.
pub fn run(ros: &RosArguments) -> Result<(), NodeError> {
    let supervisor = Supervisor::start("energy_monitor", ros, parameters())?;
    let model = chosen_model(&supervisor.parameters)?;
    let outlet = supervisor.link.publish("arm/energy", TopicQos::reliable(50))?;
    let (door, incoming) = inbox();
    let states = door.clone();
    supervisor.link.subscribe("arm/state", TopicQos::reliable(1000), move |state: ArmState, _| states.state(state))?;
    let counts = door.counts();
    if model.is_none() {
        supervisor.link.subscribe("arm/model", TopicQos::latched(), move |text: Text, _| door.model(text.data))?;
    }
    let stop = supervisor.stop_flag();
    let desk = Desk {
        incoming,
        outlet,
        parameters: &supervisor.parameters,
        diagnostics: &supervisor.diagnostics,
        logger: &supervisor.logger,
        counts: &counts,
        stop: &stop,
    };
    std::thread::scope(|scope| {
        scope.spawn(move || desk.work(model));
        supervisor.run(|| {});
    });
    supervisor.leave();
    Ok(())
}

struct Desk<'d> {
    incoming: Inbox,
    outlet: Outlet<EnergyState>,
    parameters: &'d Parameters,
    diagnostics: &'d Diagnostics,
    logger: &'d Logger,
    counts: &'d Counts,
    stop: &'d AtomicBool,
}

impl Desk<'_> {
    fn work(&self, given: Option<Model>) {
        let mut model = given;
        while !self.stop.load(Ordering::Relaxed) {
            let current = match model.take() {
                Some(model) => model,
                None => match self.wait_for_model() {
                    Some(model) => model,
                    None => continue,
                },
            };
            self.logger.info(format!("following {}", current.machine.name));
            self.diagnostics.set_hardware(&current.machine.name);
            model = self.follow(&current);
        }
    }

    /// Waits for a model. States that arrive before it are dropped, because their energy is unknown.
    fn wait_for_model(&self) -> Option<Model> {
        match self.incoming.recv_timeout(IDLE) {
            Ok(Incoming::Model(text)) => self.read(&text),
            Ok(Incoming::State(_)) | Err(_) => {
                self.diagnostics.tell(
                    "balance",
                    Health::Warning,
                    "no model yet: give -p model:= or publish /arm/model",
                    &[],
                );
                None
            }
        }
    }

    fn read(&self, text: &str) -> Option<Model> {
        match parse("/arm/model", text, &Catalogue::built_in()) {
            Ok(model) => Some(model),
            Err(error) => {
                self.logger.error(error.to_string());
                self.diagnostics.tell("balance", Health::Error, error.to_string(), &[]);
                None
            }
        }
    }

    /// Computes balances with one model until another arrives, or the end.
    fn follow(&self, model: &Model) -> Option<Model> {
        let tally = Mutex::new(Tally::default());
        // One window may be queued while another is analysed.
        let (sender, windows) = sync_channel(1);
        let ledger = Ledger::new(self.parameters.double("ledger_window"), sender, &tally);
        std::thread::scope(|scope| {
            let (tally, diagnostics) = (&tally, self.diagnostics);
            scope.spawn(move || judge_windows(model, &windows, tally, diagnostics));
            self.balance(model, ledger)
        })
    }

    fn balance(&self, model: &Model, mut ledger: Ledger<'_>) -> Option<Model> {
        let system = System::new(model);
        let settings =
            Settings { half_width: self.parameters.double("half_width"), gap: self.parameters.double("gap") };
        let mut monitor = Monitor::new(&system, settings);
        let mut watch = Watch::new(WatchSettings {
            window: self.parameters.double("watch_window"),
            significance: self.parameters.double("significance"),
        });
        let mut balances = Vec::new();
        let mut window = None;
        let (mut heard, mut reported) = (Instant::now(), Instant::now());
        let mut has_velocity = false;
        // Silences after which no state was queued: the monitor restarts and cannot count them as gaps.
        let (mut newest, mut silent, mut silences) = (None::<i64>, false, 0);
        while !self.stop.load(Ordering::Relaxed) {
            match self.incoming.recv_timeout(IDLE) {
                Ok(Incoming::State(state)) => {
                    let state = trimmed(state, model);
                    heard = Instant::now();
                    let stamp = state.header.stamp.nanoseconds();
                    let gap = newest.map_or(0.0, |newest| stamp.saturating_sub(newest) as f64 * 1e-9);
                    silences += u64::from(silent && gap > settings.gap);
                    (newest, silent) = (Some(stamp), false);
                    has_velocity = state.cylinders.iter().all(|cylinder| cylinder.velocity.is_finite());
                    monitor.push(sample(&state, model), &mut balances);
                    ledger.push(&state);
                }
                Ok(Incoming::Model(text)) => {
                    if let Some(next) = self.read(&text) {
                        return Some(next);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {
                    silent = true;
                    monitor.flush(&mut balances);
                }
                Err(RecvTimeoutError::Disconnected) => return None,
            }
            for balance in balances.drain(..) {
                window = watch.push(&balance).or(window);
                // The outlet counts refusals; they are reported below.
                let _ = self.outlet.publish(message(&balance, model));
            }
            if reported.elapsed() >= REPORT {
                reported = Instant::now();
                self.report(&monitor, silences, has_velocity, heard.elapsed());
                self.judge(window.as_ref());
            }
        }
        None
    }

    fn report(&self, monitor: &Monitor<'_, '_>, silences: u64, has_velocity: bool, silence: Duration) {
        let counts = monitor.counts();
        let (dropped, odd) = self.counts.get();
        let values = [
            ("states", counts.states.to_string()),
            ("balances", counts.balances.to_string()),
            ("incomplete balances", counts.incomplete.to_string()),
            ("duplicate stamps", counts.duplicates.to_string()),
            ("stamps out of order", counts.out_of_order.to_string()),
            ("gaps", (counts.gaps + silences).to_string()),
            ("jumps of the clock", counts.jumps.to_string()),
            ("dropped states", dropped.to_string()),
            ("states and models that are too large", odd.to_string()),
            ("refused balances", self.outlet.refused().to_string()),
            ("delay [s]", format!("{:.4}", monitor.delay(has_velocity))),
        ];
        let (health, message) = if silence > SILENT {
            (Health::Warning, "no states on /arm/state".to_string())
        } else if dropped > 0 {
            (Health::Warning, "states come faster than they can be followed".to_string())
        } else {
            (Health::Ok, "following".to_string())
        };
        self.diagnostics.tell("balance", health, message, &values);
    }

    fn judge(&self, window: Option<&Window>) {
        let Some(window) = window else { return };
        let values = [
            ("unexplained power [W]", format!("{:.3}", window.residual())),
            ("threshold [W]", format!("{:.3}", window.threshold())),
            ("resolution of the balance [W]", format!("{:.3}", window.resolution / window.length)),
            ("stored [J]", format!("{:.3}", window.stored)),
            ("supplied [J]", format!("{:.3}", window.supplied)),
            ("dissipated [J]", format!("{:.3}", -window.dissipated)),
            ("window [s]", format!("{:.3}", window.length)),
        ];
        let (health, word) = if window.violates_passivity() {
            (Health::Error, "more energy is stored than was supplied: an instrument or the supply side is wrong")
        } else if window.is_explained() {
            (Health::Ok, "the model explains the energy")
        } else {
            (Health::Warning, "the model does not explain all of the energy")
        };
        self.diagnostics.tell("passivity", health, word, &values);
    }
}
