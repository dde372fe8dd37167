//! The addresses under which a server is opened, from this machine and from others.

use std::fmt;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};

/// Whole addresses of a page, token included.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Addresses {
    /// For a browser on this machine.
    pub here: String,
    /// For browsers on other machines, where the server listens on all interfaces.
    pub elsewhere: Vec<String>,
}

impl Addresses {
    /// The addresses of a bound socket; `url` makes the address of a host with its port.
    pub(super) fn of(bound: SocketAddr, url: impl Fn(&str) -> String) -> Self {
        let port = bound.port();
        if !bound.ip().is_unspecified() {
            return Self { here: url(&bound.to_string()), elsewhere: Vec::new() };
        }
        let others = interfaces(bound.is_ipv6()).into_iter().map(|ip| url(&SocketAddr::new(ip, port).to_string()));
        Self { here: url(&format!("localhost:{port}")), elsewhere: others.collect() }
    }
}

impl fmt::Display for Addresses {
    /// One line for each, as the program prints them.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Some((first, rest)) = self.elsewhere.split_first() else { return write!(f, "page     {}", self.here) };
        write!(f, "page     {first}")?;
        rest.iter().try_for_each(|address| write!(f, "\nor       {address}"))?;
        write!(f, "\nhere     {}", self.here)
    }
}

/// The addresses of this machine by which others reach it. The system is asked which it would use towards the internet and towards each
/// kind of private network; nothing is sent.
fn interfaces(six: bool) -> Vec<IpAddr> {
    let v4 = [[192, 0, 2, 1], [10, 255, 255, 254], [172, 31, 255, 254], [192, 168, 255, 254]].map(|ip| IpAddr::from(Ipv4Addr::from(ip)));
    let v6 = [Ipv6Addr::new(0x2001, 0xdb8, 0, 0, 0, 0, 0, 1), Ipv6Addr::new(0xfd00, 0, 0, 0, 0, 0, 0, 1)].map(IpAddr::from);
    let towards = v4.into_iter().chain(v6.into_iter().filter(|_| six));
    let mut found: Vec<IpAddr> = Vec::new();
    for ip in towards.filter_map(own_address) {
        if !ip.is_loopback() && !ip.is_unspecified() && !found.contains(&ip) {
            found.push(ip);
        }
    }
    found
}

/// The address that this machine would have towards another; `None` where no way leads there.
fn own_address(other: IpAddr) -> Option<IpAddr> {
    let any: IpAddr = if other.is_ipv6() { Ipv6Addr::UNSPECIFIED.into() } else { Ipv4Addr::UNSPECIFIED.into() };
    let socket = UdpSocket::bind((any, 0)).ok()?;
    socket.connect((other, 9)).ok()?;
    Some(socket.local_addr().ok()?.ip())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_interfaces_are_told_by_addresses_that_can_be_opened() {
        let told = Addresses::of((Ipv4Addr::UNSPECIFIED, 7000).into(), |host| format!("http://{host}/view/?token=t"));
        assert_eq!(told.here, "http://localhost:7000/view/?token=t");
        assert!(
            told.elsewhere.iter().all(|url| !url.contains("0.0.0.0") && !url.contains("127.0.0.1") && url.ends_with(":7000/view/?token=t"))
        );
        let printed = told.to_string();
        assert!(!printed.contains("0.0.0.0") && printed.lines().count() == told.elsewhere.len() + 1, "{printed}");
    }

    #[test]
    fn one_interface_is_told_as_it_was_asked_for() {
        let told = Addresses::of((Ipv4Addr::LOCALHOST, 7000).into(), |host| format!("http://{host}/"));
        assert_eq!((told.to_string(), told.elsewhere.len()), ("page     http://127.0.0.1:7000/".into(), 0));
    }
}
