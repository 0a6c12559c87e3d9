//! The machine's own process: plant and valves, driven by the node's orders, and the behaviour without orders.

use std::io::ErrorKind;
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

use excavator_model::Model;
use excavator_model::document;
use excavator_model::effects::Catalogue;
use excavator_model::equations::System;
use excavator_model::simulation::Plant;

use super::machine_process::{Answer, Order, Ready, Setup, TalkError, receive, send};
use super::valve_limits;
use crate::arm_state::arm_state;
use crate::command_gate::{Slew, Wanted};
use crate::error::NodeError;
use excavator_ros::system_nanoseconds;

/// Longest wall-clock time for which the machine continues after its node has gone: several times the closing time of a valve.
const LONGEST_ALONE: Duration = Duration::from_secs(60);

/// Runs the machine with the orders from standard input, which is one end of a socket pair.
///
/// # Errors
/// [`NodeError::Machine`] if it was started by hand.
pub fn run() -> Result<(), NodeError> {
    let input = std::io::stdin().as_fd().try_clone_to_owned()?;
    let mut stream = UnixStream::from(input);
    let setup: Setup = receive(&mut stream)
        .map_err(|_| NodeError::Machine("this verb is for excavator node arm-simulator only".to_string()))?;
    let failed = |reason: String| NodeError::Machine(reason);
    let model = match document::parse(&setup.name, &setup.model, &Catalogue::built_in()) {
        Ok(model) => model,
        Err(error) => {
            return send(&mut stream, &Ready { failure: error.to_string() }).map_err(|e| failed(e.to_string()));
        }
    };
    let system = System::new(&model);
    let supply_pressure = Some(setup.supply_pressure).filter(|pressure| *pressure > 0.0);
    let plant = match Plant::new(&system, &setup.start_displacement, setup.period, supply_pressure) {
        Ok(plant) => plant,
        Err(error) => {
            return send(&mut stream, &Ready { failure: error.to_string() }).map_err(|e| failed(e.to_string()));
        }
    };
    let slew = Slew::new(&valve_limits(&model), setup.opening_time, setup.closing_time);
    let mut machine = Machine { plant, model: &model, slew, period: setup.period, samples: 0, failures: Vec::new() };
    send(&mut stream, &Ready { failure: String::new() }).map_err(|error| failed(error.to_string()))?;
    let alone = follow(&mut stream, &mut machine, Duration::from_secs_f64(setup.wall_period.clamp(1e-6, 100.0)));
    if let Some(at) = alone {
        machine.close(setup.wall_period);
        eprintln!(
            "[WARN] [{}.machine]: the node has gone; every valve was closed {:.3} s later",
            setup.name,
            at.elapsed().as_secs_f64()
        );
    }
    Ok(())
}

struct Machine<'m, 's> {
    plant: Plant<'m, 's>,
    model: &'m Model,
    slew: Slew,
    period: f64,
    samples: u64,
    failures: Vec<String>,
}

/// Executes orders until the stream ends. Returns the time at which the node went with a valve open; `None` if all valves were
/// closed.
fn follow(stream: &mut UnixStream, machine: &mut Machine<'_, '_>, wall_period: Duration) -> Option<Instant> {
    // Samples that the machine simulated without an order and that no later order has accounted for yet.
    let mut unpaid: u32 = 0;
    let mut is_alone = false;
    let mut lease = LONGEST_ALONE;
    loop {
        // If the node hangs, the machine continues at its own pace.
        let patience = if is_alone { wall_period } else { lease.max(5 * wall_period) };
        if stream.set_read_timeout(Some(patience)).is_err() {
            return Some(Instant::now());
        }
        match receive::<Order>(stream) {
            Ok(order) => {
                lease = Duration::try_from_secs_f64(order.lease).unwrap_or_default();
                // The node may include the time that it lost only in the next order.
                let paid = unpaid.min(order.samples);
                (unpaid, is_alone) = (unpaid - paid, false);
                machine.obey(&order, order.samples - paid);
                if send(stream, &machine.answer(order.oil_temperature)).is_err() {
                    break;
                }
            }
            Err(TalkError::Broken(error)) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                (unpaid, is_alone) = (unpaid.saturating_add(1), true);
                machine.step_closing();
            }
            Err(_) => break,
        }
    }
    (!machine.slew.are_closed()).then(Instant::now)
}

impl Machine<'_, '_> {
    fn obey(&mut self, order: &Order, samples: u32) {
        for _ in 0..samples {
            let wanted = order.areas.iter().zip(&order.closing);
            self.step(&wanted.map(|(&area, &closing)| Wanted { area, closing }).collect::<Vec<_>>());
        }
    }

    fn step_closing(&mut self) {
        self.step(&vec![Wanted { area: 0.0, closing: true }; self.slew.areas().len()]);
    }

    fn step(&mut self, wanted: &[Wanted]) {
        self.samples += 1;
        self.slew.follow(wanted.iter().copied(), self.period);
        if let Err(error) = self.plant.step(self.slew.areas())
            && self.failures.len() < MOST_FAILURES
        {
            self.failures.push(error.to_string());
        }
    }

    fn answer(&mut self, oil_temperature: f64) -> Answer {
        let state = arm_state(&self.plant.sample(), self.model, oil_temperature);
        Answer {
            state,
            samples: self.samples,
            sampled_at: system_nanoseconds(),
            joint_rates: self.plant.joint_rates(),
            closed: self.slew.are_closed(),
            limited: self.slew.limited(),
            failures: std::mem::take(&mut self.failures),
        }
    }

    /// Closes the valves in real time.
    fn close(&mut self, wall_period: f64) {
        let start = Instant::now();
        while !self.slew.are_closed() && start.elapsed() < LONGEST_ALONE {
            self.step_closing();
            std::thread::sleep(Duration::try_from_secs_f64(wall_period).unwrap_or_default());
        }
    }
}

/// Most failures reported in one answer: a machine that fails at every sample reports the same failure each time.
const MOST_FAILURES: usize = 16;
