//! A publisher whose last message is sent to late joiners, also after the link was rebuilt.

use std::sync::{Arc, Mutex, PoisonError};

use excavator_msgs::Message;

use super::connection::{Closed, Connection, Endpoint, Install};
use super::{Outlet, PublishError, RosError};

/// A transient-local publisher of one topic; clones share it.
pub struct Latched<M: Message> {
    outlet: Outlet<M>,
    last: Arc<Mutex<Option<M>>>,
}

impl<M: Message> Clone for Latched<M> {
    fn clone(&self) -> Self {
        Latched { outlet: self.outlet.clone(), last: Arc::clone(&self.last) }
    }
}

impl<M: Message + Clone + Send + Sync + 'static> Latched<M> {
    pub(super) fn new(outlet: Outlet<M>) -> Self {
        Latched { outlet, last: Arc::new(Mutex::new(None)) }
    }

    /// Publishes. The message is kept for late joiners.
    ///
    /// # Errors
    /// [`PublishError`]. A message that is published while the link is down is sent as soon as it is up.
    pub fn publish(&self, message: M) -> Result<(), PublishError> {
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some(message.clone());
        self.outlet.publish(message)
    }
}

impl<M: Message + Clone + Send + Sync + 'static> Endpoint for Latched<M> {
    fn open(self: Arc<Self>, connection: &mut Connection) -> Result<Install, RosError> {
        let install = Arc::new(self.outlet.clone()).open(connection)?;
        Ok(Box::new(move |runtime| {
            install(runtime);
            if let Some(last) = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone() {
                // A new writer has an empty history, so it cannot be full.
                let _ = self.outlet.publish(last);
            }
        }))
    }

    fn close(&self) -> Closed {
        self.outlet.close()
    }

    fn interface(&self) -> Option<(String, String)> {
        self.outlet.interface()
    }
}
