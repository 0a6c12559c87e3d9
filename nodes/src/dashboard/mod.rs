//! Shows the live topics on a page.
//!
//! Topics arrive at their own pace and go into a [`Board`]. The board makes a frame 25 times per second. Each page receives the
//! newest frame when it has taken the previous one. So a slow page misses frames, and no queue grows.

mod board;
mod bounded;
mod gates;
mod hosts;
mod machine;
mod node;
mod page;
mod server;

pub use board::Board;
pub use hosts::Hosts;
pub use node::{PageOptions, run};
pub use server::serve;
