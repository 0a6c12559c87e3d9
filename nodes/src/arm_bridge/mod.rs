//! Publishes foreign instruments as `/arm/state`.
//!
//! A description in TOML defines the source of each signal:
//!
//! ```toml
//! rate = 200.0                       # states per second, Hz
//!
//! [[udp]]                            # datagrams of fixed layout
//! port = 5600
//! address = "0.0.0.0"                # all networks; without: this machine alone
//! senders = ["192.168.1.20"]         # whose datagrams are taken; needed with an address
//! length = 20                        # bytes; others are refused
//! sequence = { at = 18, kind = "u16" } # repeated and old datagrams are refused, missing ones counted
//! byte_order = "little"              # or "big"
//! [[udp.fields]]
//! at = 0                             # first byte
//! kind = "f32"                       # u8 i8 u16 i16 u32 i32 f32 f64
//! signal = "arm.displacement"
//! scale = 0.001                      # raw value times scale plus offset is the value in SI
//! offset = -0.3
//! minimum = -0.31                    # outside: not measured, and told
//! maximum = 0.31
//! age = 0.05                         # older than this (s): not measured, and told
//! delay = 0.012                      # it was measured so long (s) before it comes
//!
//! [[can]]                            # a CAN bus
//! dbc = "excavator.dbc"              # which bits are which signal; seen from this file
//! device = "can0"                    # or: log = "arm.log", a log of `candump -L`
//! [[can.signals]]
//! message = "ArmPressures"           # names of the DBC file
//! name = "CapPressure"
//! signal = "arm.cap_pressure"
//! scale = 1e5                        # from the unit of the DBC file, here bar
//!
//! [[topics]]                         # topics of other nodes
//! topic = "/joint_states"
//! kind = "joint_state"               # or "fluid_pressure"; "fluid_pressure_array" and "labelled_numbers" with a name
//! joint = "arm_joint"                # which entry of a joint state
//! field = "position"                 # position, velocity or effort
//! signal = "arm.joint_angle"
//! ```
//!
//! Every signal may have `scale`, `offset`, `minimum`, `maximum`, `age` and `delay`. A state belongs to the latest moment for
//! which every signal has a value. That moment lies in the past by the longest `delay`, and the stamp of the state is that
//! moment.
//!
//! Signals are `CYLINDER.` with `joint_angle`, `displacement`, `velocity`, `cap_pressure`, `rod_pressure`,
//! `orifice_area` or `rod_force`, and `pump_pressure`, `tank_pressure`, `pump_flow`, `oil_temperature`.

#[cfg(feature = "can")]
pub mod can;
#[cfg(feature = "can")]
mod can_source;
mod datagram;
mod description;
mod frame_counts;
mod limits;
#[cfg(not(feature = "can"))]
mod no_can;
mod node;
mod publisher;
mod sequence;
mod signals;
mod udp_source;

pub use node::{parameters, run};
