//! The dashboard's node.

use std::net::TcpListener;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use excavator_msgs::common::{DiagnosticArray, Text};
use excavator_msgs::{ArmState, EnergyState, OrificeCommand};

use super::{Board, Hosts, serve};
use crate::error::NodeError;
use excavator_ros::{Health, RosArguments, Supervisor, TopicQos};

/// Time between two frames: 25 per second.
const FRAME: Duration = Duration::from_millis(40);

/// Reliable, with room for two seconds at 1 kHz.
fn newest(depth: u32) -> TopicQos {
    TopicQos::reliable(depth).with_room(2_000)
}

/// Where the page is offered, and to whom.
#[derive(Debug, Clone)]
pub struct PageOptions {
    /// Port of the page; 0: any that is free.
    pub port: u16,
    /// Address that the page listens on.
    pub host: String,
    /// Names under which browsers may ask for the page, beside localhost and its address.
    pub allowed_hosts: Vec<String>,
}

/// Serves the page until a stop is requested. `on_open` receives the address of the page when it can be opened.
///
/// # Errors
/// [`NodeError`] if the graph cannot be joined or the address cannot be used.
pub fn run(options: &PageOptions, ros: &RosArguments, on_open: impl FnOnce(&str)) -> Result<(), NodeError> {
    let listener = TcpListener::bind((options.host.as_str(), options.port))
        .map_err(|source| NodeError::Listen { address: format!("{}:{}", options.host, options.port), source })?;
    let page = format!("http://{}/", listener.local_addr()?);
    let supervisor = Supervisor::start("dashboard", ros, Vec::new())?;
    let board = Arc::new(Board::in_namespace(supervisor.link.identity().namespace()));
    let of = || Arc::clone(&board);
    let (states, commands, energies, parts) = (of(), of(), of(), of());
    let (descriptions, models) = (of(), of());
    supervisor.link.subscribe("arm/state", newest(50), move |state: ArmState, _| states.take_state(state))?;
    supervisor.link.subscribe("arm/orifice_command", newest(10), move |command: OrificeCommand, _| {
        commands.take_command(command);
    })?;
    supervisor.link.subscribe("arm/energy", newest(50), move |energy: EnergyState, _| energies.take_energy(energy))?;
    supervisor.link.subscribe("/diagnostics", newest(10), move |array: DiagnosticArray, _| parts.take_health(array))?;
    // Both are published once and latched: late subscribers receive the last message.
    supervisor.link.subscribe("robot_description", TopicQos::latched(), move |text: Text, _| {
        descriptions.take_description(text.data);
    })?;
    supervisor.link.subscribe("arm/model", TopicQos::latched(), move |text: Text, _| models.take_model(&text.data))?;
    let stop = supervisor.stop_flag();
    let hosts = Hosts::new(options.allowed_hosts.iter().cloned());
    let server = std::thread::spawn(move || serve_frames(listener, board, hosts, &stop));
    supervisor.diagnostics.tell("page", Health::Ok, page.as_str(), &[]);
    on_open(&page);
    supervisor.run(|| {});
    supervisor.leave();
    match server.join() {
        Ok(served) => Ok(served?),
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

/// The server has a thread of its own, so that slow pages and a busy graph do not delay each other.
fn serve_frames(listener: TcpListener, board: Arc<Board>, hosts: Hosts, stop: &AtomicBool) -> std::io::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let (end, ended) = tokio::sync::oneshot::channel::<()>();
    runtime.block_on(async {
        let ticking = async {
            let mut tick = tokio::time::interval(FRAME);
            tick.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Skip);
            while !stop.load(Ordering::Relaxed) {
                tick.tick().await;
                board.frame();
            }
            let _ = end.send(());
        };
        let serving = serve(listener, Arc::clone(&board), hosts, async {
            let _ = ended.await;
        });
        futures::future::join(ticking, serving).await.1
    })
}
