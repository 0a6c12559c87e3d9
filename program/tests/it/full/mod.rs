//! Tests that `tests/run --all` runs: live nodes in network namespaces, whole searches.

mod design;
#[cfg(all(feature = "dashboard", feature = "can"))]
mod live_bridge;
#[cfg(all(feature = "dashboard", feature = "can"))]
mod live_outages;
#[cfg(all(feature = "dashboard", feature = "can"))]
mod live_recording;
mod long_recordings;
mod proposals;
