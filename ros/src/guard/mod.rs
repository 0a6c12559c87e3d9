//! A filter in the kernel in front of the middleware's sockets.
//!
//! RustDDS trusts the numbers in a packet. A HEARTBEAT of 52 bytes in the name of a known writer makes it list 2^60
//! missing samples, and the process is out of memory within seconds. GUIDs are visible to anybody on the network. The
//! guard drops such packets before the middleware reads them ([`program`] has the list). It needs no privileges.
//!
//! The guard keeps no state, so it does not know what a writer has sent so far. See `docs/security.md` for the
//! remaining risks.

mod assembler;
#[cfg(test)]
#[allow(clippy::panic)]
mod interpreter;
mod program;
mod sockets;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

use std::collections::BTreeSet;

use socket2::SockFilter;

use assembler::Instruction;
use program::{Limits, Shape, program};
use sockets::{Inode, duplicates, own, table};

use super::Environment;

/// Switches the guard off, for measurements.
const SWITCH: &str = "EXCAVATOR_PACKET_GUARD";

/// Error of the kernel if a program is larger than a socket's optional memory (20 kB before Linux 6.7, 128 kB since).
const NO_MEMORY: i32 = nix::errno::Errno::ENOMEM as i32;

/// Bytes of a fragment in RustDDS. Requests for missing fragments count in these.
const FRAGMENT: u32 = 256;

impl Limits {
    /// HEARTBEAT: twice the samples of a 1 kHz writer after a minute without an answer (60 000). RustDDS itself keeps
    /// at most 8192. The list takes 1 MB for a short time. GAP: 8192, since RustDDS discards entries beyond that.
    fn of_samples(sample_bytes: u32) -> Self {
        let sample_bytes = sample_bytes.clamp(1 << 16, 1 << 30).next_power_of_two();
        Limits { heartbeat_span: 1 << 17, gap_span: 8192, sample_bytes, fragments: sample_bytes / FRAGMENT }
    }
}

/// Fourteen submessages of any kind, as many as Cyclone DDS packs into a datagram of fragments, and 144 samples: enough
/// for the samples of 24 bytes that RustDDS packs into one repair round of 8192 bytes.
const SHAPE: Shape = Shape { first: 5, samples: 48, more: 3, blocks: 3 };

/// Why packets are not checked.
#[derive(Debug, Clone, thiserror::Error)]
pub(super) enum GuardError {
    #[error("{SWITCH}=off")]
    SwitchedOff,
    #[error("{SWITCH}={0} is neither on nor off")]
    Switch(String),
    #[error("the sockets of the middleware are not found: {0}")]
    Sockets(String),
    #[error("the kernel has no room for the filter; since Linux 6.7 it has, before: sysctl net.core.optmem_max=131072")]
    NoMemory,
    #[error("the kernel refuses the filter: {0}")]
    Refused(String),
}

/// The sockets that this process had before the middleware opened its own.
pub(super) struct Before(BTreeSet<Inode>);

impl Before {
    /// Lists the current sockets.
    pub fn look() -> Self {
        Before(own().map(|found| found.into_keys().collect()).unwrap_or_default())
    }
}

/// A filter on the sockets of one participant. It is removed when they close.
#[derive(Debug, Clone)]
pub(super) struct Guard {
    sockets: BTreeSet<Inode>,
    instructions: usize,
}

impl Guard {
    /// Attaches the filter to the sockets that the middleware has opened since `before`.
    pub fn attach(before: &Before, environment: &Environment) -> Result<Self, GuardError> {
        match std::env::var(SWITCH) {
            Ok(word) if word == "off" => return Err(GuardError::SwitchedOff),
            Ok(word) if !matches!(word.as_str(), "" | "on") => return Err(GuardError::Switch(word)),
            _ => {}
        }
        let limits = Limits::of_samples(environment.largest_sample);
        let failed = |error: std::io::Error| GuardError::Sockets(error.to_string());
        let table = table().map_err(failed)?;
        let own = own().map_err(failed)?;
        // Ports of a domain, RTPS 9.6.2.3: 250 from 7400 + 250 domain on.
        let first = 7400 + 250 * u32::from(environment.domain);
        let listens =
            |inode: &Inode| table.get(inode).is_some_and(|row| (first..first + 250).contains(&u32::from(row.port)));
        let ours: Vec<_> = own
            .into_iter()
            .filter(|(inode, _)| !before.0.contains(inode))
            .filter(|(inode, _)| listens(inode))
            .collect();
        if ours.is_empty() {
            return Err(GuardError::Sockets(format!("none on ports {first} to {}", first + 249)));
        }
        let sockets = ours.iter().map(|(inode, _)| *inode).collect();
        let descriptors = ours.iter().map(|(_, descriptor)| *descriptor).collect();
        let duplicates = duplicates(&descriptors).map_err(failed)?;
        let program = program(&limits, &SHAPE).ok_or_else(|| GuardError::Refused("it is too long".to_string()))?;
        let filter: Vec<SockFilter> = program.iter().map(filter).collect();
        match duplicates.iter().try_for_each(|socket| socket.attach_filter(&filter)) {
            Ok(()) => Ok(Guard { sockets, instructions: program.len() }),
            Err(error) if error.raw_os_error() == Some(NO_MEMORY) => Err(GuardError::NoMemory),
            Err(error) => Err(GuardError::Refused(error.to_string())),
        }
    }

    /// Packets on all sockets that were refused or found the buffer full.
    pub fn dropped(&self) -> u64 {
        let Ok(table) = table() else { return 0 };
        self.sockets.iter().filter_map(|inode| table.get(inode)).map(|row| row.dropped).sum()
    }
}

impl std::fmt::Display for Guard {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "on {} sockets, {} instructions", self.sockets.len(), self.instructions)
    }
}

fn filter(instruction: &Instruction) -> SockFilter {
    SockFilter::new(instruction.code, instruction.yes, instruction.no, instruction.operand)
}
