//! What docs/papers.md and docs/energy.md state of \[A\], each block made by simulation with seeds.

mod cross_validation;
mod energy_flow;
mod experiment;
mod identification_errors;
mod page;
mod servo_bench;

pub use page::{BLOCKS, Block, written};
