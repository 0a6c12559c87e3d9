//! One runtime for all requests, and their retries.

use std::future::Future;
use std::sync::{OnceLock, PoisonError, RwLock};
use std::time::Duration;

use tokio::runtime::{Builder, Runtime};

use crate::StoreError;

/// Number of attempts before a failure is reported. The client of `object_store` retries most failures by itself. These
/// attempts are for those that it does not retry, such as a connection that ends in the middle of an answer.
pub(crate) const ATTEMPTS: u32 = 6;

/// Wait before the second attempt; it doubles each time, so that all waits together are 3 s.
const FIRST_WAIT: Duration = Duration::from_millis(100);

static RUNTIME: OnceLock<RwLock<Option<(u32, &'static Runtime)>>> = OnceLock::new();

/// Runs `work` on the runtime of the process. A separate thread serves connections between two calls: a runtime that
/// only works during calls would not notice that a server closed them.
///
/// # Errors
/// [`StoreError::Runtime`], and the errors of `work`.
pub(crate) fn block_on<T>(work: impl Future<Output = Result<T, StoreError>>) -> Result<T, StoreError> {
    runtime()?.block_on(work)
}

/// The runtime of this process. A forked process has no threads of its parent, so it gets its own runtime.
fn runtime() -> Result<&'static Runtime, StoreError> {
    let place = RUNTIME.get_or_init(RwLock::default);
    let process = std::process::id();
    if let Some((owner, runtime)) = *place.read().unwrap_or_else(PoisonError::into_inner)
        && owner == process
    {
        return Ok(runtime);
    }
    let mut own = place.write().unwrap_or_else(PoisonError::into_inner);
    if let Some((owner, runtime)) = *own
        && owner == process
    {
        return Ok(runtime);
    }
    let made = Builder::new_multi_thread().worker_threads(1).thread_name("store").enable_all().build();
    let runtime: &'static Runtime = Box::leak(Box::new(made.map_err(StoreError::Runtime)?));
    *own = Some((process, runtime));
    Ok(runtime)
}

/// Makes a request, and retries it if that may help.
///
/// # Errors
/// The error of the last attempt.
pub(crate) async fn persistently<T, F>(
    action: &'static str,
    url: &str,
    mut request: impl FnMut() -> F,
) -> Result<T, StoreError>
where
    F: Future<Output = object_store::Result<T>>,
{
    let mut wait = FIRST_WAIT;
    for attempt in 1.. {
        match request().await {
            Ok(found) => return Ok(found),
            Err(error) => {
                let told = StoreError::of(error, action, url, attempt);
                if attempt >= ATTEMPTS || !matches!(told, StoreError::Failed { .. }) {
                    return Err(told);
                }
            }
        }
        tokio::time::sleep(wait).await;
        wait *= 2;
    }
    Err(StoreError::Failed { action, url: url.to_string(), attempts: ATTEMPTS, reason: "no answer".to_string() })
}
