"""DDS on the loopback interface, so that the tests neither need nor disturb a network.

DDS finds peers by multicast. Many machines have it switched off on loopback; root may switch it on. Without it RustDDS
and its peers still find each other by asking each other's well-known ports, but it takes seconds instead of 0.1 s.
"""

import fcntl
import os
import socket
import struct
import subprocess

_SIOCGIFFLAGS = 0x8913
_IFF_MULTICAST = 0x1000
# Ports that are asked without multicast: participants of one domain on this machine.
_MOST_PARTICIPANTS = 20

_multicast = None


def _flags():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        request = struct.pack("16sH14s", b"lo", 0, b"")
        return struct.unpack("16sH14s", fcntl.ioctl(probe, _SIOCGIFFLAGS, request))[1]


def _switch_multicast_on():
    if not _flags() & _IFF_MULTICAST and os.geteuid() == 0:
        try:
            subprocess.run(["ip", "link", "set", "lo", "multicast", "on"], check=False, capture_output=True)
        except FileNotFoundError:
            pass
    return bool(_flags() & _IFF_MULTICAST)


def prepare(for_standin):
    """Sets the environment of this process and its children; returns why the tests cannot run, or None."""
    global _multicast
    try:
        _multicast = _switch_multicast_on()
    except OSError as error:
        return f"no loopback interface 'lo': {error}"
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    if for_standin:
        os.environ["RMW_IMPLEMENTATION"] = "rmw_cyclonedds_cpp"
        os.environ.setdefault("CYCLONEDDS_URI", _configuration(_multicast))
    return None


def _configuration(multicast):
    peers = "" if multicast else "<Peers><Peer address='127.0.0.1'/></Peers>"
    # announced every second: RustDDS takes a peer that missed the first announcement with the next
    allowed = "true" if multicast else "false"
    return f"""
        <General>
          <Interfaces><NetworkInterface address='127.0.0.1' multicast='{allowed}'/></Interfaces>
          <AllowMulticast>{allowed}</AllowMulticast>
        </General>
        <Discovery>
          <ParticipantIndex>auto</ParticipantIndex>
          <MaxAutoParticipantIndex>{_MOST_PARTICIPANTS}</MaxAutoParticipantIndex>
          <SPDPInterval>1s</SPDPInterval>
          <LeaseDuration>10s</LeaseDuration>
          {peers}
        </Discovery>"""


def summary():
    reach = os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"]
    multicast = "with multicast" if _multicast else "without multicast, peers are found by unicast"
    return f"ROS_AUTOMATIC_DISCOVERY_RANGE={reach}, loopback {multicast}"


def free_domain():
    """A domain in which nobody on this machine takes part: one of EXCAVATOR_DOMAINS, 1-100 by default. Runs at the same time
    need domains of their own, since a domain is free until somebody has joined it."""
    import random

    first, last = map(int, os.environ.get("EXCAVATOR_DOMAINS", "1-100").split("-"))
    domains = list(range(first, last + 1))
    random.shuffle(domains)
    for domain in domains:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                # the port of participant 0 for discovery: DDSI-RTPS 9.6.1.1
                probe.bind(("127.0.0.1", 7400 + 250 * domain + 10))
                return domain
            except OSError:
                continue
    raise RuntimeError(f"all DDS domains from {first} to {last} are taken on this machine")
