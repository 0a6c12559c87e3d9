//! The bridge's node.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use excavator_msgs::Time;
use excavator_msgs::common::{Float64MultiArray, FluidPressure, FluidPressureArray, JointState};

#[cfg(feature = "can")]
use super::can_source::CanSource;
use super::description::{Description, JointField, TopicKind, TopicSource};
#[cfg(not(feature = "can"))]
use super::no_can::CanSource;
use super::publisher::{Publisher, Refused, lock};
use super::signals::Signals;
use super::udp_source::UdpSource;
use crate::arm_state::{FRAME, frame_parameter};
use crate::error::NodeError;
use excavator_ros::{Health, Lifecycle, Parameter, RosArguments, RosError, Supervisor, TopicQos, Value};

/// Longest time until a listening thread notices that the node ends.
const GLANCE: Duration = Duration::from_millis(100);
/// Time for readers to discover the bridge, and to receive the last messages, if the bridge ends by itself.
const ACQUAINTANCE: Duration = Duration::from_secs(1);
/// Largest age of a message by its stamp, ns. A stamp that is older, or in the future, is of another clock.
const OLDEST: i64 = 1_000_000_000;

/// All parameters, with defaults.
pub fn parameters() -> Vec<Parameter> {
    let file =
        Parameter::new("description", Value::String(String::new()), "file (.toml) that says where signals come from");
    vec![file.read_only(), frame_parameter(), Lifecycle::parameter()]
}

/// Runs the bridge until a stop is requested.
///
/// # Errors
/// [`NodeError`] when it cannot start.
pub fn run(ros: &RosArguments) -> Result<(), NodeError> {
    let supervisor = Supervisor::start("arm_bridge", ros, parameters())?;
    let path = supervisor.parameters.text("description");
    if path.is_empty() {
        let reason = "no signals: give the file that describes them with -p description:=FILE.toml".to_string();
        return Err(RosError::Parameter(reason).into());
    }
    let description = Description::read(Path::new(&path)).map_err(RosError::Parameter)?;
    supervisor.diagnostics.set_hardware(&description.hardware);
    let mut treatments = description.treatments();
    let refused = Refused::default();
    let mut first = 0;
    let mut sockets = Vec::new();
    for udp in &description.udp {
        sockets.push(UdpSource::open(udp, first)?);
        first += udp.fields.len();
    }
    let mut buses = Vec::new();
    for can in &description.can {
        let mine = &mut treatments[first..first + can.signals.len()];
        buses.push(CanSource::open(can, first, mine).map_err(RosError::Parameter)?);
        first += can.signals.len();
    }
    let signals = Arc::new(Mutex::new(Signals::new(treatments)));
    for (index, source) in description.topics.iter().enumerate() {
        subscribe(&supervisor, source, first + index, &signals)?;
    }
    let identity = supervisor.link.identity();
    let own_joints = identity.resolve("joint_states")?;
    let echoes =
        description.topics.iter().any(|source| identity.resolve(&source.topic).is_ok_and(|topic| topic == own_joints));
    let lifecycle = supervisor.lifecycle()?;
    let publisher = Publisher {
        rate: description.rate,
        frame: supervisor.parameters.text(FRAME),
        signals: &signals,
        states: supervisor.link.publish("arm/state", TopicQos::reliable(50))?,
        joints: (!echoes).then(|| supervisor.link.publish("joint_states", TopicQos::reliable(10))).transpose()?,
        lifecycle: &lifecycle,
        clock: &supervisor.clock,
        diagnostics: &supervisor.diagnostics,
        refused: &refused,
        has_frames: !buses.is_empty(),
        has_datagrams: !description.udp.is_empty(),
    };
    let has_own_clock = buses.iter().any(CanSource::is_the_clock);
    let stop = supervisor.stop_flag();
    std::thread::scope(|scope| {
        let (publisher, refused, stop) = (&publisher, &refused, &stop);
        for socket in sockets {
            let signals = &signals;
            scope.spawn(move || socket.listen(signals, refused, stop));
        }
        for bus in buses {
            let supervisor = &supervisor;
            scope.spawn(move || {
                if bus.is_the_clock() {
                    wait_for_a_reader(supervisor, stop);
                }
                bus.run(publisher, refused, &supervisor.logger, stop);
            });
        }
        if !has_own_clock {
            scope.spawn(move || publisher.run(stop));
        }
        supervisor.run(|| {});
    });
    if has_own_clock {
        std::thread::sleep(ACQUAINTANCE);
    }
    supervisor.leave();
    Ok(())
}

/// Waits for a reader: states that are published once, as fast as possible, must not start before one is there.
fn wait_for_a_reader(supervisor: &Supervisor, stop: &AtomicBool) {
    supervisor.diagnostics.tell("signals", Health::Ok, "waiting for a reader of /arm/state", &[]);
    while !stop.load(Ordering::Relaxed) && !supervisor.link.has_readers("arm/state") {
        std::thread::sleep(GLANCE);
    }
    std::thread::sleep(ACQUAINTANCE);
}

fn subscribe(
    supervisor: &Supervisor,
    source: &TopicSource,
    index: usize,
    signals: &Arc<Mutex<Signals>>,
) -> Result<(), RosError> {
    let signals = Arc::clone(signals);
    let clock = supervisor.clock.clone();
    let measured = move |stamp: Time, at: Instant| measured(stamp.nanoseconds(), clock.nanoseconds(), at);
    // A best-effort reader matches every publisher, and an old value is of no use.
    let qos = TopicQos::best_effort(10);
    match source.kind {
        TopicKind::JointState => {
            let (joint, field) = (source.joint.clone(), source.field);
            supervisor.link.subscribe(&source.topic, qos, move |state: JointState, received| {
                let values = match field {
                    JointField::Position => &state.position,
                    JointField::Velocity => &state.velocity,
                    JointField::Effort => &state.effort,
                };
                let position = state.name.iter().position(|name| *name == joint);
                if let Some(value) = position.and_then(|position| values.get(position)) {
                    lock(&signals).take(index, *value, measured(state.header.stamp, received.at));
                }
            })?;
        }
        TopicKind::FluidPressure => {
            supervisor.link.subscribe(&source.topic, qos, move |state: FluidPressure, received| {
                lock(&signals).take(index, state.fluid_pressure, measured(state.header.stamp, received.at));
            })?;
        }
        TopicKind::FluidPressureArray => {
            let name = source.name.clone();
            supervisor.link.subscribe(&source.topic, qos, move |state: FluidPressureArray, received| {
                if let Some(own) = state.array.iter().find(|own| own.header.frame_id == name) {
                    lock(&signals).take(index, own.fluid_pressure, measured(own.header.stamp, received.at));
                }
            })?;
        }
        TopicKind::LabelledNumbers => {
            let name = source.name.clone();
            supervisor.link.subscribe(&source.topic, qos, move |state: Float64MultiArray, received| {
                let place = state.layout.dim.iter().position(|dimension| dimension.label == name);
                if let Some(value) = place.and_then(|place| state.data.get(place)) {
                    lock(&signals).take(index, *value, received.at);
                }
            })?;
        }
    }
    Ok(())
}

/// When a message that came `at` was measured: at its stamp, where that is on the clock of this node (`now`, ns), else when it came.
fn measured(stamp: i64, now: i64, at: Instant) -> Instant {
    match u64::try_from(now.saturating_sub(stamp)) {
        Ok(age) if stamp > 0 && age <= OLDEST as u64 => at.checked_sub(Duration::from_nanos(age)).unwrap_or(at),
        _ => at,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_of_the_same_clock_are_kept() {
        let at = Instant::now();
        let now = 1_790_000_000_000_000_000;
        assert_eq!(measured(now - 30_000_000, now, at), at - Duration::from_millis(30));
        for stamp in [0, now + 1, now - 2 * OLDEST, 5_000_000_000] {
            assert_eq!(measured(stamp, now, at), at, "{stamp}");
        }
    }
}
