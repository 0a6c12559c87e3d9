//! The UDP sockets of this process, which the middleware does not expose.

use std::collections::{BTreeMap, BTreeSet};
use std::io::IoSlice;
use std::os::fd::{AsRawFd, OwnedFd, RawFd};
use std::os::unix::net::UnixDatagram;

use nix::sys::socket::{ControlMessage, MsgFlags, UnixAddr, sendmsg};
use rustix::net::{RecvAncillaryBuffer, RecvAncillaryMessage, RecvFlags, recvmsg};
use socket2::Socket;

/// Number of a socket in the kernel.
pub(super) type Inode = u64;

/// The UDP table of the network namespace of this thread.
const TABLE: &str = "/proc/thread-self/net/udp";
/// Descriptors of this process.
const DESCRIPTORS: &str = "/proc/self/fd";

/// Data of the kernel about a UDP socket.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Row {
    pub port: u16,
    /// Packets that a filter refused or that found the buffer full.
    pub dropped: u64,
}

/// All UDP sockets in this network namespace.
pub(super) fn table() -> std::io::Result<BTreeMap<Inode, Row>> {
    Ok(parse(&std::fs::read_to_string(TABLE)?))
}

/// `sl local_address rem_address st tx_queue:rx_queue tr:tm->when retrnsmt uid timeout inode ref pointer drops`
fn parse(table: &str) -> BTreeMap<Inode, Row> {
    let row = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let port = u16::from_str_radix(words.get(1)?.rsplit(':').next()?, 16).ok()?;
        Some((words.get(9)?.parse().ok()?, Row { port, dropped: words.get(12)?.parse().ok()? }))
    };
    table.lines().skip(1).filter_map(row).collect()
}

/// All sockets of this process, of any kind, with their descriptors.
pub(super) fn own() -> std::io::Result<BTreeMap<Inode, RawFd>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(DESCRIPTORS)?.flatten() {
        // The descriptor may have been closed meanwhile.
        let Ok(target) = std::fs::read_link(entry.path()) else { continue };
        let inode = target.to_str().and_then(|name| name.strip_prefix("socket:[")?.strip_suffix(']')?.parse().ok());
        let descriptor = entry.file_name().to_str().and_then(|name| name.parse().ok());
        if let (Some(inode), Some(descriptor)) = (inode, descriptor) {
            found.insert(inode, descriptor);
        }
    }
    Ok(found)
}

/// Duplicates descriptors, as sockets: the process sends a descriptor to itself, and the kernel returns a new one for
/// the same socket. This works without privileges, also in containers.
pub(super) fn duplicates(descriptors: &BTreeSet<RawFd>) -> std::io::Result<Vec<Socket>> {
    let (sender, receiver) = UnixDatagram::pair()?;
    let mut sockets = Vec::new();
    for descriptor in descriptors {
        let content = [0_u8];
        let message = [ControlMessage::ScmRights(std::slice::from_ref(descriptor))];
        let none: Option<&UnixAddr> = None;
        sendmsg(sender.as_raw_fd(), &[IoSlice::new(&content)], &message, MsgFlags::empty(), none)?;
        let mut content = [0_u8];
        let mut space = [std::mem::MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(1))];
        let mut ancillary = RecvAncillaryBuffer::new(&mut space);
        let mut parts = [std::io::IoSliceMut::new(&mut content)];
        recvmsg(&receiver, &mut parts, &mut ancillary, RecvFlags::CMSG_CLOEXEC)?;
        for message in ancillary.drain() {
            if let RecvAncillaryMessage::ScmRights(received) = message {
                sockets.extend(received.map(|descriptor: OwnedFd| Socket::from(descriptor)));
            }
        }
    }
    Ok(sockets)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use std::net::UdpSocket;

    use super::*;

    #[test]
    fn the_kernel_s_table_is_read() {
        let table = "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode ref pointer drops\n\
            3: 00000000:1CE8 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 1234 2 0000000000000000 56\n\
            garbage\n";
        assert_eq!(parse(table), BTreeMap::from([(1234, Row { port: 7400, dropped: 56 })]));
    }

    #[test]
    fn a_socket_is_found_and_its_duplicate_is_the_same_socket() {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        let own = own().unwrap();
        let (inode, _) = own.iter().find(|(_, descriptor)| **descriptor == socket.as_raw_fd()).unwrap();
        assert_eq!(table().unwrap()[inode].port, socket.local_addr().unwrap().port());
        let twin = duplicates(&BTreeSet::from([socket.as_raw_fd()])).unwrap();
        let twin = UdpSocket::from(twin.into_iter().next().unwrap());
        socket.send_to(&[7], socket.local_addr().unwrap()).unwrap();
        twin.set_read_timeout(Some(std::time::Duration::from_secs(10))).unwrap();
        let mut bytes = [0; 4];
        assert_eq!((twin.recv(&mut bytes).unwrap(), bytes[0]), (1, 7));
    }
}
