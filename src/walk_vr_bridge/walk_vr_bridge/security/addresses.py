# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Under which names and addresses this machine can be reached."""

from __future__ import annotations

import fcntl
import re
import socket
import struct

_SIOCGIFADDR = 0x8915
LOOPBACK = ("localhost", "127.0.0.1", "::1")


def lan_addresses() -> tuple[str, ...]:
    """Returns the IPv4 addresses of this machine's network interfaces, without loopback."""
    found = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        for _, name in socket.if_nameindex():
            try:
                answer = fcntl.ioctl(probe.fileno(), _SIOCGIFADDR, struct.pack("256s", name.encode()[:15]))
            except OSError:
                continue  # an interface without an address
            found.append(socket.inet_ntoa(answer[20:24]))
    return tuple(address for address in found if not address.startswith("127."))


def host_names() -> tuple[str, ...]:
    """Returns this machine's name and its name in multicast DNS, where they are names that a certificate can have."""
    name = socket.gethostname().split(".")[0].lower()
    return (name, f"{name}.local") if re.fullmatch(r"[a-z0-9]([a-z0-9-]{0,61}[a-z0-9])?", name) else ()
