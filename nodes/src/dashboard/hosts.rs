//! Restricts the host names that the page answers to.

use std::net::IpAddr;

use axum::http::{HeaderMap, Uri, header};

/// Host names that requests may use.
///
/// A foreign page can point its own host name at this machine after it was loaded (DNS rebinding). Its script could then read
/// the server's responses. Such a request carries the foreign name as its host, and unknown names are rejected.
#[derive(Debug, Clone, Default)]
pub struct Hosts {
    allowed: Vec<String>,
}

impl Hosts {
    /// The names in `allowed`, besides localhost, the loopback addresses and the address of the connection.
    pub fn new(allowed: impl IntoIterator<Item = String>) -> Self {
        Hosts { allowed: allowed.into_iter().map(|name| name.trim_end_matches('.').to_ascii_lowercase()).collect() }
    }

    /// Whether a request that arrived at the address `own` uses one of the names.
    pub(super) fn accept(&self, uri: &Uri, headers: &HeaderMap, own: IpAddr) -> bool {
        let mut given = headers.get_all(header::HOST).iter();
        let (Some(host), None) = (given.next(), given.next()) else { return false };
        let named = host.to_str().is_ok_and(|host| self.knows(without_port(host), own));
        named && uri.host().is_none_or(|host| self.knows(host, own))
    }

    fn knows(&self, host: &str, own: IpAddr) -> bool {
        let host = host.trim_end_matches('.').to_ascii_lowercase();
        let address = host.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
        match address {
            Ok(address) => address.to_canonical() == own.to_canonical() || address.is_loopback(),
            Err(_) => host == "localhost" || self.allowed.contains(&host),
        }
    }
}

fn without_port(host: &str) -> &str {
    match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|byte| byte.is_ascii_digit()) && !name.ends_with(':') => name,
        _ => host,
    }
}

#[cfg(test)]
mod tests {
    use std::net::Ipv4Addr;

    use axum::http::HeaderValue;

    use super::*;

    fn accepts(host: &str) -> bool {
        let mut headers = HeaderMap::new();
        headers.insert(header::HOST, HeaderValue::from_str(host).unwrap_or(HeaderValue::from_static("")));
        let hosts = Hosts::new(["Pit.example".to_string()]);
        hosts.accept(&Uri::from_static("/"), &headers, IpAddr::V4(Ipv4Addr::new(192, 168, 1, 5)))
    }

    #[test]
    fn own_names_are_answered_and_others_are_not() {
        for host in
            ["localhost", "LOCALHOST:8050", "127.0.0.1:1", "[::1]:8050", "[::1]", "192.168.1.5:8050", "pit.example"]
        {
            assert!(accepts(host), "{host}");
        }
        for host in
            ["evil.example", "localhost.evil.example", "192.168.1.6", "evil.example:8050", "", "[::2]:80", "a:b:c"]
        {
            assert!(!accepts(host), "{host}");
        }
    }

    #[test]
    fn no_host_two_hosts_and_another_host_in_the_line_are_refused() {
        let (hosts, own) = (Hosts::default(), IpAddr::V4(Ipv4Addr::LOCALHOST));
        let mut headers = HeaderMap::new();
        assert!(!hosts.accept(&Uri::from_static("/"), &headers, own));
        headers.append(header::HOST, HeaderValue::from_static("localhost"));
        assert!(!hosts.accept(&Uri::from_static("http://evil.example/"), &headers, own));
        headers.append(header::HOST, HeaderValue::from_static("localhost"));
        assert!(!hosts.accept(&Uri::from_static("/"), &headers, own));
    }
}
