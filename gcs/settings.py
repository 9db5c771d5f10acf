"""`gcs.toml`: strict, complete, every key with a default that works beside `sim-bridge serve`."""

from __future__ import annotations

import getpass
from pathlib import Path

from gcs.picture.thresholds import Thresholds
from onboard.config import strict as config
from onboard.config.bounds import HttpPort
from onboard.config.names import GameName
from onboard.config.strict import StrictConfig
from onboard.wire.bus.topics import DEFAULT_GAME


class BusSettings(StrictConfig, frozen=True):
    """How to reach the others."""

    endpoint: str = ""  # Zenoh endpoint; "" = tcp/127.0.0.1:7447
    listen: bool = True  # be the one the others connect to; where the port is taken, join
    zenoh: str = ""  # Zenoh configuration (JSON5): of `gcs keys init`, or one for TLS, a router elsewhere
    open: bool = False  # lead a game in the field on a bus without keys all the same


class RecordingSettings(StrictConfig, frozen=True):
    """The flight recorder."""

    enabled: bool = True
    folder: str = "runs"
    mavlink: tuple[str, ...] = ()  # links to log beside it, such as udpin://0.0.0.0:14550


class NeighbourSettings(StrictConfig, frozen=True):
    """Who else is told of the opponents' tracks; nobody by default."""

    adsb: tuple[str, ...] = ()  # MAVLink links that get ADSB_VEHICLE, such as udpout://127.0.0.1:14550
    cot: str = ""  # Cursor-on-Target to udp://HOST:PORT or tcp://HOST:PORT


class PageSettings(StrictConfig, frozen=True):
    """The page for browsers: `gcs page`, or `gcs --page` beside the console."""

    enabled: bool = False  # serve it beside the console too
    host: str = "127.0.0.1"  # address to listen at
    port: HttpPort = 8765  # 0 = any
    map: str = ""  # one's own map: MBTiles, PMTiles or a folder z/x/y.png; "" = none
    control: bool = False  # let who has the token command vehicles
    token_file: str = ""  # a token of one's own, mode 0600; "" = drawn at the start and printed
    tls_certificate: str = ""  # PEM; "" = no TLS
    tls_key: str = ""  # PEM; "" = in the certificate's file
    tls_keys: str = ""  # the listener's folder of `gcs keys`: TLS, and certificates of the roster's stations
    tls_clients: str = ""  # PEM of the authority whose client certificates are let in


class Settings(StrictConfig, frozen=True):
    """Everything a ground station can be told."""

    game: GameName = DEFAULT_GAME
    operator: str = ""  # signs the commands; "" = the user's name
    bus: BusSettings = BusSettings()
    recording: RecordingSettings = RecordingSettings()
    page: PageSettings = PageSettings()
    neighbours: NeighbourSettings = NeighbourSettings()
    alerts: Thresholds = Thresholds()

    @property
    def signature(self) -> str:
        """Who commands."""
        if self.operator:
            return self.operator
        try:
            return f"gcs/{getpass.getuser()}"
        except (KeyError, OSError):
            return "gcs"


def load(path: Path | None) -> Settings:
    """The settings of a file, or the defaults. Raises ConfigError."""
    return Settings() if path is None else config.read(path, Settings)


def check(settings: Settings, name: str) -> Settings:
    """`settings` where each lies in its range, after options were put over them. Raises ConfigError."""
    return config.checked(settings, name)
