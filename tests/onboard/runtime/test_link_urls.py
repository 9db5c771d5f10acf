"""Links as people write them: in MAVSDK's, pymavlink's and MAVProxy's ways, and plain devices."""

from __future__ import annotations

import pytest

from onboard.config.strict import ConfigError
from onboard.runtime.link_urls import Form, LinkUrl, parse_link

UDP_IN, UDP_OUT, TCP_IN, TCP_OUT = Form.UDP_IN, Form.UDP_OUT, Form.TCP_IN, Form.TCP_OUT
HERE = "127.0.0.1"


@pytest.mark.parametrize(
    ("text", "link"),
    [
        ("udpin://127.0.0.1:14541", LinkUrl(UDP_IN, HERE, 14541)),
        ("udp://127.0.0.1:14541", LinkUrl(UDP_IN, HERE, 14541)),  # MAVSDK
        ("udp://:14540", LinkUrl(UDP_IN, "0.0.0.0", 14540)),
        ("udpin://0.0.0.0:14540/", LinkUrl(UDP_IN, "0.0.0.0", 14540)),
        ("udp:127.0.0.1:14550", LinkUrl(UDP_IN, HERE, 14550)),  # pymavlink, MAVProxy --master
        ("udp::14550", LinkUrl(UDP_IN, "0.0.0.0", 14550)),
        ("udpin:localhost:14550", LinkUrl(UDP_IN, "localhost", 14550)),
        ("UDPOUT:192.168.1.7:14550", LinkUrl(UDP_OUT, "192.168.1.7", 14550)),
        ("udpout://field.example:14550", LinkUrl(UDP_OUT, "field.example", 14550)),
        ("tcp:127.0.0.1:5760", LinkUrl(TCP_OUT, HERE, 5760)),
        ("tcp://127.0.0.1:5760", LinkUrl(TCP_OUT, HERE, 5760)),
        ("tcpout://127.0.0.1:5760", LinkUrl(TCP_OUT, HERE, 5760)),
        ("tcpin:0.0.0.0:5773", LinkUrl(TCP_IN, "0.0.0.0", 5773)),
        ("tcpin::5773", LinkUrl(TCP_IN, "0.0.0.0", 5773)),
        ("udpin:[::1]:14541", LinkUrl(UDP_IN, "::1", 14541)),
        ("tcp://[fe80::1%eth0]:5760", LinkUrl(TCP_OUT, "fe80::1%eth0", 5760)),
        ("serial:///dev/ttyAMA0:921600", LinkUrl(Form.SERIAL, device="/dev/ttyAMA0", baud=921600)),
        ("serial:/dev/ttyAMA0:921600", LinkUrl(Form.SERIAL, device="/dev/ttyAMA0", baud=921600)),
        ("serial:/dev/ttyAMA0", LinkUrl(Form.SERIAL, device="/dev/ttyAMA0", baud=57600)),
        ("/dev/ttyACM0,115200", LinkUrl(Form.SERIAL, device="/dev/ttyACM0", baud=115200)),  # MAVProxy
        ("/dev/ttyACM0:115200", LinkUrl(Form.SERIAL, device="/dev/ttyACM0", baud=115200)),
        ("/dev/ttyACM0", LinkUrl(Form.SERIAL, device="/dev/ttyACM0", baud=57600)),
        (
            "/dev/serial/by-id/usb-FTDI_FT232R:1.0-if00:57600",
            LinkUrl(Form.SERIAL, device="/dev/serial/by-id/usb-FTDI_FT232R:1.0-if00", baud=57600),
        ),
        ("  udpin:127.0.0.1:14541 ", LinkUrl(UDP_IN, HERE, 14541)),
    ],
)
def test_each_way_of_the_field_is_understood_and_written_in_one(text: str, link: LinkUrl) -> None:
    assert parse_link(text) == link
    assert parse_link(link.name) == link


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("127.0.0.1:14550", r"udpin:127\.0\.0\.1:14550 \(listen\), udpout:.* or tcp:127"),
        ("COM3", r"expected a device of Linux or macOS"),
        ("serial:COM3:57600", r"expected a device of Linux or macOS"),
        ("udp:::1:14550", r"IPv6 address in brackets"),
        ("udpbcast:192.168.1.255:14550", r"expected udpin:HOST:PORT"),
        ("http://127.0.0.1:80", r"expected udpin:HOST:PORT"),
        ("udpout::14550", r"found no host, expected udpout:HOST:14550"),
        ("tcp:127.0.0.1:0", r"found port 0, expected 1 to 65535"),
        ("tcp:127.0.0.1:70000", r"found port 70000"),
        ("serial:/dev/ttyACM0:0", r"found baud rate 0"),
        ("tcp:127.0.0.1", r"expected udpin:HOST:PORT"),
        ("", r"found '', expected"),
    ],
)
def test_what_is_none_says_what_may_have_been_meant(text: str, line: str) -> None:
    with pytest.raises(ConfigError, match=line) as caught:
        parse_link(text)
    assert "\n" not in str(caught.value)
