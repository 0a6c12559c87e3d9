//! The networks of this machine.

use std::net::Ipv4Addr;

use nix::ifaddrs::getifaddrs;
use nix::net::if_::InterfaceFlags;

/// Names and addresses of the networks that are up, and whether they support multicast.
pub(super) fn networks() -> Vec<(String, Ipv4Addr, bool)> {
    let Ok(interfaces) = getifaddrs() else { return Vec::new() };
    interfaces
        .filter(|interface| interface.flags.contains(InterfaceFlags::IFF_UP))
        .filter_map(|interface| {
            let address = interface.address?.as_sockaddr_in()?.ip();
            Some((interface.interface_name, address, interface.flags.contains(InterfaceFlags::IFF_MULTICAST)))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_loopback_network_is_seen() {
        assert!(networks().iter().any(|(_, address, _)| *address == Ipv4Addr::LOCALHOST));
    }
}
