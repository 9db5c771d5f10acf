"""`gcs.toml`: strict, complete, every key with a default that works beside `sim-bridge serve`."""

from __future__ import annotations

import getpass
from pathlib import Path

import msgspec

from gcs.picture.alert_rules import Thresholds
from onboard.config import strict as config
from onboard.config.strict import ConfigError
from onboard.wire.bus.topics import DEFAULT_GAME


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Base of all parts: frozen and strict."""


class BusSettings(Part, frozen=True):
    """How to reach the others."""

    endpoint: str = ""  # Zenoh endpoint; "" = tcp/127.0.0.1:7447
    listen: bool = True  # be the one the others connect to; where the port is taken, join
    zenoh: str = ""  # Zenoh configuration file (JSON5): TLS, access control, a router elsewhere


class RecordingSettings(Part, frozen=True):
    """The flight recorder."""

    enabled: bool = True
    folder: str = "runs"
    mavlink: tuple[str, ...] = ()  # links to log beside it, such as udpin://0.0.0.0:14550


class Settings(Part, frozen=True):
    """Everything a ground station can be told."""

    game: str = DEFAULT_GAME
    operator: str = ""  # signs the commands; "" = the user's name
    bus: BusSettings = BusSettings()
    recording: RecordingSettings = RecordingSettings()
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
    return Settings() if path is None else check(config.read(path, Settings), str(path))


def check(settings: Settings, name: str) -> Settings:
    """Demand what types cannot say. Raises ConfigError with file, key, found and expected."""

    def demand(ok: bool, key: str, found: object, expected: str) -> None:
        if not ok:
            raise ConfigError(f"{name}: {key}: found {found}, expected {expected}")

    demand(
        bool(settings.game) and not set(settings.game) & set("/*$#? "), "game", f"'{settings.game}'",
        "a name without / * $ # ? or blanks",
    )  # fmt: skip
    a = settings.alerts
    for key in a.__struct_fields__:
        demand(getattr(a, key) >= 0, f"alerts.{key}", getattr(a, key), "zero or more")
    for key in ("battery_low", "battery_critical", "link_low"):
        demand(getattr(a, key) <= 1, f"alerts.{key}", getattr(a, key), "a share in [0, 1]")
    demand(
        a.battery_critical <= a.battery_low, "alerts.battery_critical", a.battery_critical,
        f"at most battery_low = {a.battery_low:g}",
    )  # fmt: skip
    demand(a.separation_clear >= 1, "alerts.separation_clear", a.separation_clear, "1 or more")
    return settings
