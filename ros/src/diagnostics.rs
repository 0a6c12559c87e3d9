//! `/diagnostics`: state of each part of the node, once per second and on change.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use excavator_msgs::Header;
use excavator_msgs::common::{DiagnosticArray, DiagnosticStatus, KeyValue};
use tokio::sync::Notify;

use super::{Link, Outlet, RosClock, RosError, TopicQos};

/// Time between two messages when nothing changes, as `diagnostic_aggregator` expects.
const PERIOD: Duration = Duration::from_secs(1);
/// Minimum time between two messages when many values change.
const LEAST: Duration = Duration::from_millis(50);

/// State of a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Health {
    Ok,
    Warning,
    Error,
    Stale,
}

#[derive(Debug, Clone, PartialEq)]
struct Part {
    health: Health,
    message: String,
    values: Vec<(String, String)>,
}

/// States of the parts of a node; clones share them.
#[derive(Clone)]
pub struct Diagnostics {
    shared: Arc<Shared>,
}

struct Shared {
    node: String,
    /// Hardware that the parts belong to: the machine, or empty.
    hardware: Mutex<String>,
    parts: Mutex<BTreeMap<String, Part>>,
    changed: Notify,
}

impl Diagnostics {
    /// Publishes the diagnostics of the link's node from now on.
    ///
    /// # Errors
    /// [`RosError::Endpoint`].
    pub fn new(link: &Link, clock: &RosClock) -> Result<Self, RosError> {
        let outlet: Outlet<DiagnosticArray> = link.publish("/diagnostics", TopicQos::reliable(10))?;
        let node = link.identity().full_name().trim_start_matches('/').to_string();
        let shared =
            Arc::new(Shared { node, hardware: Mutex::default(), parts: Mutex::default(), changed: Notify::new() });
        let diagnostics = Diagnostics { shared };
        let publishing = diagnostics.clone();
        let clock = clock.clone();
        link.runtime().spawn(async move {
            loop {
                let _ = tokio::time::timeout(PERIOD, publishing.shared.changed.notified()).await;
                let header = Header { stamp: clock.now(), frame_id: String::new() };
                // A lost message is replaced one second later.
                let _ = outlet.publish(DiagnosticArray { header, status: publishing.statuses() });
                tokio::time::sleep(LEAST).await;
            }
        });
        Ok(diagnostics)
    }

    /// Sets the machine that the parts belong to, as REP 107 requires.
    pub fn set_hardware(&self, name: &str) {
        name.clone_into(&mut self.shared.hardware.lock().unwrap_or_else(PoisonError::into_inner));
    }

    /// Sets the state of a part. A new level or message is published at once, new values with the next message.
    ///
    /// ```no_run
    /// use excavator_ros::{Health, RosArguments, Supervisor};
    ///
    /// let supervisor = Supervisor::start("pump_watch", &RosArguments::default(), Vec::new())?;
    /// let values = [("pressure [Pa]", "31.4e6".to_string())];
    /// supervisor.diagnostics.tell("pump", Health::Warning, "the relief valve is open", &values);
    /// # Ok::<(), excavator_ros::RosError>(())
    /// ```
    pub fn tell(&self, part: &str, health: Health, message: impl Into<String>, values: &[(&str, String)]) {
        let message = message.into();
        let values = values.iter().map(|(key, value)| (key.to_string(), value.clone())).collect();
        let mut parts = self.shared.parts.lock().unwrap_or_else(PoisonError::into_inner);
        let told = parts.get(part).is_some_and(|known| known.health == health && known.message == message);
        parts.insert(part.to_string(), Part { health, message, values });
        drop(parts);
        if !told {
            self.shared.changed.notify_one();
        }
    }

    fn statuses(&self) -> Vec<DiagnosticStatus> {
        let hardware = self.shared.hardware.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let parts = self.shared.parts.lock().unwrap_or_else(PoisonError::into_inner);
        parts
            .iter()
            .map(|(name, part)| DiagnosticStatus {
                level: part.health as u8,
                name: format!("{}: {name}", self.shared.node),
                message: part.message.clone(),
                hardware_id: hardware.clone(),
                values: part
                    .values
                    .iter()
                    .map(|(key, value)| KeyValue { key: key.clone(), value: value.clone() })
                    .collect(),
            })
            .collect()
    }
}
