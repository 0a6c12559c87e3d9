//! Files of strangers: bombs, endless views, nests, devices.

mod bombs;
mod clock_step;
mod databases;
mod definitions;
mod devices;
mod killed;
mod mcap_text;
