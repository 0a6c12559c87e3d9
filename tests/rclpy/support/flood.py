"""Datagrams that make no sense, on loopback only, a bounded number in a bounded time."""

import random
import socket
import struct
import time

# Participants of one domain on this machine whose ports are hit.
_PARTICIPANTS = 8
_LONGEST = 15.0

_RTPS = b"RTPS\x02\x03\x01\x12"


def dds_ports(domain):
    """Discovery and user ports of a domain (DDSI-RTPS 9.6.1.1), without the multicast ones."""
    base = 7400 + 250 * domain
    return [base + offset + 2 * participant for participant in range(_PARTICIPANTS) for offset in (10, 11)]


def _prefix(numbers):
    return numbers.randbytes(12)


def malformed_packet(numbers):
    """One of the kinds that a broken or hostile sender makes."""
    kind = numbers.randrange(6)
    if kind == 0:  # noise
        return numbers.randbytes(numbers.randrange(1, 200))
    if kind == 1:  # a header that is cut
        return (_RTPS + _prefix(numbers))[: numbers.randrange(1, 20)]
    head = _RTPS + _prefix(numbers)
    if kind == 2:  # noise after a good header
        return head + numbers.randbytes(numbers.randrange(1, 400))
    if kind == 3:  # a submessage that claims more bytes than there are
        return head + struct.pack("<BBH", numbers.choice([0x06, 0x07, 0x08, 0x09, 0x15]), 1, 0xFFF0) + b"\0" * 20
    if kind == 4:  # submessages of random kinds with random content
        body = b""
        for _ in range(numbers.randrange(1, 6)):
            content = numbers.randbytes(4 * numbers.randrange(0, 12))
            body += struct.pack("<BBH", numbers.randrange(256), numbers.randrange(256), len(content)) + content
        return head + body
    # samples and heartbeats with absurd numbers, for readers and writers that may exist
    entity = struct.pack(">II", 0, numbers.choice([0x000100C2, 0x000003C2, 0x000004C2, 0x00000103]))
    content = entity + numbers.randbytes(numbers.choice([20, 24, 60]))
    return head + struct.pack("<BBH", numbers.choice([0x07, 0x15, 0x06, 0x08]), 1, len(content)) + content


def flood(ports, count, make, pause_every=50, pause=0.002):
    """Sends `count` datagrams to ports of this machine in turn; returns how many were sent."""
    numbers = random.Random(count)
    end = time.monotonic() + _LONGEST
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for number in range(count):
            if time.monotonic() > end:
                return number
            try:
                sender.sendto(make(numbers), ("127.0.0.1", ports[number % len(ports)]))
            except ConnectionRefusedError:
                pass  # nobody at the port that was hit before
            if number % pause_every == 0:
                time.sleep(pause)
    return count
