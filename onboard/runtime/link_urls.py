"""The ways in which people write a link, read in one place: MAVSDK's, pymavlink's, MAVProxy's; plain devices.

    udpin:HOST:PORT   udp:…    listen there; answer whom we last heard (HOST may be missing: all addresses)
    udpout:HOST:PORT           send there
    tcp:HOST:PORT     tcpout:… connect there, again when it ends
    tcpin:HOST:PORT            listen there for connections
    serial:/dev/NAME:BAUD      a serial port; also /dev/NAME, /dev/NAME:BAUD, /dev/NAME,BAUD (BAUD: 57600)

`//` may follow the first colon. IPv6 addresses stand in brackets.
"""

from __future__ import annotations

import re
from enum import Enum
from typing import NamedTuple

from onboard.config.strict import ConfigError

BAUD = 57600  # where a serial link does not say
ANY = "0.0.0.0"
FORMS = (
    "udpin:HOST:PORT (listen), udpout:HOST:PORT (send), tcp:HOST:PORT (connect), tcpin:HOST:PORT (listen) or "
    "serial:/dev/NAME:BAUD"
)


class Form(Enum):
    """What kind of link it is."""

    UDP_IN = "udpin"
    UDP_OUT = "udpout"
    TCP_OUT = "tcpout"
    TCP_IN = "tcpin"
    SERIAL = "serial"


WORDS = {
    "udp": Form.UDP_IN,
    "udpin": Form.UDP_IN,
    "udpout": Form.UDP_OUT,
    "tcp": Form.TCP_OUT,
    "tcpout": Form.TCP_OUT,
    "tcpin": Form.TCP_IN,
}
LISTENING = (Form.UDP_IN, Form.TCP_IN)


class LinkUrl(NamedTuple):
    """One link, as it is opened."""

    form: Form
    host: str = ""  # without brackets
    port: int = 0  # 0: any free one, of who listens
    device: str = ""  # of a serial link
    baud: int = 0

    @property
    def name(self) -> str:
        """The one way in which this program writes it."""
        if self.form is Form.SERIAL:
            return f"serial://{self.device}:{self.baud}"
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{self.form.value}://{host}:{self.port}"


def parse_link(text: str) -> LinkUrl:
    """Read a link as people write it. Raises ConfigError, one line that says what was expected."""
    url = text.strip()
    serial = re.fullmatch(r"(?:serial:(?://)?)?(/[^\s,]+?)(?:[:,](\d+))?", url)
    if serial:
        baud = int(serial.group(2) or BAUD)
        if baud == 0:
            raise ConfigError(f"link: {text}: found baud rate 0, expected one the device has")
        return LinkUrl(Form.SERIAL, device=serial.group(1), baud=baud)
    net = re.fullmatch(r"([A-Za-z]+):(?://)?(\[[0-9a-fA-F:.]+(?:%\w+)?\]|[^:/\[\]\s]*):(\d+)/?", url)
    form = WORDS.get(net.group(1).lower()) if net else None
    if net is None or form is None:
        raise ConfigError(f"link: found {text!r}, expected {_meant(url)}")
    host, port = net.group(2).strip("[]"), int(net.group(3))
    if not host and form not in LISTENING:
        raise ConfigError(f"link: {text}: found no host, expected {form.value}:HOST:{port}")
    if port > 65535 or (port == 0 and form not in LISTENING):
        raise ConfigError(f"link: {text}: found port {port}, expected 1 to 65535")
    return LinkUrl(form, host or ANY, port)


def _meant(url: str) -> str:
    """What somebody may have meant who wrote `url`, in words."""
    if re.fullmatch(r"[\w.-]+:\d+", url):
        return f"udpin:{url} (listen), udpout:{url} (send) or tcp:{url} (connect)"
    if re.fullmatch(r"(?i)(serial:)?COM\d+.*", url):
        return "a device of Linux or macOS, such as serial:/dev/ttyACM0:57600"
    if re.fullmatch(r"[A-Za-z]+:(//)?[0-9a-fA-F]*:[0-9a-fA-F:]+", url):
        return "an IPv6 address in brackets, such as udpin:[::1]:14541"
    return FORMS
