//! `excavator dashboard`: the live topics on a page.
//!
//! Topics come in at their own pace and go into a [`Board`]; 25 times per second the board makes one frame of it, and
//! each page is sent the newest frame when it has taken the one before. So a slow page misses frames, and nothing grows.

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
pub use node::run;
pub use server::serve;
