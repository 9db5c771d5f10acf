"""`sim-bridge design`: what the loops of an aircraft give, in figures and in plots.

All figures belong to the loop as flown: the open loop is the kernel's own step, cut at the servo's
command (`loop_analysis`); the step responses are flown by `step_plane`, limits and all.
"""

from __future__ import annotations

from math import degrees, pi, radians
from pathlib import Path
from typing import NamedTuple

import numpy as np

from onboard.core.math.vectors import ZERO, Vec
from onboard.runtime.run_folder import made
from sim_bridge.studies.pictures import pyplot, save
from sim_bridge.vehicle.flight import control_toolbox as linear
from sim_bridge.vehicle.flight import loop_analysis
from sim_bridge.vehicle.flight.aircraft import Aircraft, load
from sim_bridge.vehicle.flight.axis import AxisLaw, AxisModel
from sim_bridge.vehicle.flight.control_toolbox import Array, Margins
from sim_bridge.vehicle.flight.plane import (
    Command,
    PlaneState,
    Steer,
    nose_yaw,
    start_state,
    step_plane,
    trimmed,
)

BAND = 0.02  # settled: within 2 % of the step
SIDE_GUST = 5.0  # [m/s] the constant disturbance through w_z


class Step(NamedTuple):
    """A flown step response; angles in degrees."""

    time: Array  # [s] (n,)
    angle: Array  # [deg] (n,)
    surface: Array  # [deg] (n,)
    size: float  # [deg] demanded
    settling_s: float
    overshoot: float  # share of the step
    final_error: float  # [deg] at the end


class AxisFigures(NamedTuple):
    """An axis of the design."""

    name: str
    margins: Margins
    bandwidth: float  # [rad/s] of the closed loop, −3 dB
    step: Step
    disturbed: Step  # under the side gust (yaw), or the same as `step` (pitch)


def fly_step(
    aircraft: Aircraft,
    axis: str,
    size_deg: float,
    seconds: float,
    gust: Vec = ZERO,
    settle_first: float = 0.0,
) -> Step:
    """Fly a step of `size_deg` in pitch or heading from trimmed level flight, in a constant gust."""
    model = aircraft.model
    speed = model.speed.trim
    state = trimmed(start_state(ZERO, 0.0, speed, ZERO), model)
    for _ in range(int(settle_first / model.dt)):
        state = step_plane(state, model, Command(Steer.HEADING, 0.0, 0.0, speed), ZERO, gust)
    size = radians(size_deg)
    command = Command(Steer.HEADING, size if axis == "yaw" else 0.0, size if axis == "pitch" else 0.0, speed)
    count = int(seconds / model.dt)
    angle = np.zeros(count)
    surface = np.zeros(count)
    for k in range(count):
        state = step_plane(state, model, command, ZERO, gust)
        angle[k] = degrees(_angle(state, aircraft, axis))
        surface[k] = degrees(state.yaw.surface if axis == "yaw" else state.pitch.surface)
    time: Array = np.asarray(model.dt * np.arange(1, count + 1), dtype=np.float64)
    outside = np.flatnonzero(np.abs(angle - size_deg) > BAND * abs(size_deg))
    settling = float(time[outside[-1]]) if len(outside) else 0.0
    over = float(np.max(angle / size_deg) - 1.0)
    return Step(time, angle, surface, size_deg, settling, max(0.0, over), float(angle[-1] - size_deg))


def _angle(state: PlaneState, aircraft: Aircraft, axis: str) -> float:
    return nose_yaw(state, aircraft.model) if axis == "yaw" else state.pitch.angle


def bandwidth(axis: AxisModel, law: AxisLaw, dt: float) -> float:
    """Where the closed loop has fallen by 3 dB [rad/s]."""
    omega = np.geomspace(1e-2, pi / dt * 0.999, 5000)
    size = np.abs(linear.response(loop_analysis.closed_response(axis, law, dt), omega))
    below = np.flatnonzero(size < 1.0 / np.sqrt(2.0))
    return float(omega[below[0]]) if len(below) else float("inf")


def figures(aircraft: Aircraft) -> tuple[AxisFigures, AxisFigures]:
    """Margins, bandwidth and step responses of the pitch and the yaw axis."""
    m = aircraft.model
    pitch = fly_step(aircraft, "pitch", 10.0, 12.0)
    return (
        AxisFigures(
            "pitch",
            linear.margins(loop_analysis.open_loop(m.pitch, m.pitch_law, m.dt), m.dt),
            bandwidth(m.pitch, m.pitch_law, m.dt),
            pitch,
            pitch,
        ),
        AxisFigures(
            "yaw",
            linear.margins(loop_analysis.open_loop(m.yaw, m.yaw_law, m.dt), m.dt),
            bandwidth(m.yaw, m.yaw_law, m.dt),
            fly_step(aircraft, "yaw", 30.0, 60.0),
            fly_step(aircraft, "yaw", 30.0, 90.0, Vec(0.0, SIDE_GUST, 0.0)),
        ),
    )


def report(aircraft: Aircraft) -> str:
    """Margins, bandwidth and step responses of an aircraft as lines for people."""
    spec = aircraft.spec
    lines = [
        f"{spec.name}: path model {spec.path.value}, stepped at {spec.rate_hz:g} Hz",
        *([spec.description] if spec.description else []),
        "",
        f"{'axis':6} {'poles':>24} {'w_n':>6} {'damping':>8} {'zero':>8} {'steady':>8}",
    ]
    for name, transfer in (("pitch", aircraft.pitch), ("yaw", aircraft.yaw)):
        poles = np.roots(transfer.denominator)
        zeros = np.roots(transfer.surface)
        natural = float(np.sqrt(abs(poles[0] * poles[1])))
        damping = float(-np.sum(poles).real / (2.0 * natural))
        pole = f"{poles[0].real:.3f} ± {abs(poles[0].imag):.3f}j"
        zero = f"{zeros[0].real:.3f}" if len(zeros) else "none"
        lines.append(f"{name:6} {pole:>24} {natural:6.3f} {damping:8.3f} {zero:>8} {transfer.steady:8.3f}")
    lines += [
        "",
        "loop as flown, cut at the servo's command",
        f"{'axis':6} {'gain margin':>12} {'phase margin':>13} {'crossover':>11}"
        f" {'delay margin':>13} {'bandwidth':>11}",
    ]
    both = figures(aircraft)
    for f in both:
        g = f.margins
        lines.append(
            f"{f.name:6} {g.gain_db:9.1f} dB {g.phase_deg:9.1f} deg {g.gain_crossover:5.2f} rad/s"
            f" {1000.0 * g.delay_s:10.0f} ms {f.bandwidth:5.2f} rad/s"
        )
    lines += [
        "",
        "steps as flown",
        f"{'step':34} {'settled 2 %':>12} {'overshoot':>10} {'at the end':>12} {'surface':>9}",
    ]
    rows = [
        ("pitch 10 deg", both[0].step),
        ("heading 30 deg", both[1].step),
        (f"heading 30 deg, {SIDE_GUST:g} m/s through w_z", both[1].disturbed),
    ]
    for title, step in rows:
        lines.append(
            f"{title:34} {step.settling_s:10.2f} s {100.0 * step.overshoot:8.1f} %"
            f" {step.final_error:z8.4f} deg {np.max(np.abs(step.surface)):5.1f} deg"
        )
    return "\n".join(lines)


def design(config_path: Path, figures_dir: Path | None) -> str:
    """The report of an aircraft file; draws Bode and step plots into `figures_dir` where given.

    Raises ConfigError where the file is at fault.
    """
    aircraft = load(config_path)
    if figures_dir is not None:
        made(figures_dir)
    text = report(aircraft)
    if figures_dir is not None:
        drawn = [draw_bode(aircraft, figures_dir), draw_steps(aircraft, figures_dir)]
        text += "\n\n" + "\n".join(f"drawn: {path}" for path in drawn)
    return text


def draw_bode(aircraft: Aircraft, folder: Path) -> Path:
    """Bode plot of both open loops as flown."""
    plt = pyplot()
    m = aircraft.model
    omega = np.geomspace(0.05, pi / m.dt * 0.999, 2000)
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(8, 6), layout="constrained")
    for name, axis, law in (("pitch", m.pitch, m.pitch_law), ("yaw", m.yaw, m.yaw_law)):
        loop = loop_analysis.open_loop(axis, law, m.dt)
        values = linear.response(loop, omega)
        phase = np.degrees(np.unwrap(np.angle(values)))
        phase -= 360.0 * np.round((phase[0] + 180.0) / 360.0)
        g = linear.margins(loop, m.dt)
        label = f"{name}: {g.gain_db:.0f} dB, {g.phase_deg:.0f}°"
        (line,) = above.semilogx(omega, 20.0 * np.log10(np.abs(values)), label=label)
        below.semilogx(omega, phase)
        above.axvline(g.gain_crossover, color=line.get_color(), linestyle=":", linewidth=1)
        below.axvline(g.gain_crossover, color=line.get_color(), linestyle=":", linewidth=1)
    above.axhline(0.0, color="0.5", linewidth=1)
    below.axhline(-180.0, color="0.5", linewidth=1)
    above.set(ylabel="gain [dB]", title=f"{aircraft.spec.name}: open loops as flown, with margins")
    below.set(ylabel="phase [deg]", xlabel="frequency [rad/s]")
    above.legend()
    for axes in (above, below):
        axes.grid(True, which="both", alpha=0.25)
    path = save(figure, folder / f"{aircraft.spec.name}-bode.png")
    plt.close(figure)
    return path


def draw_steps(aircraft: Aircraft, folder: Path) -> Path:
    """Step responses as flown: angle and surface."""
    plt = pyplot()
    pitch, yaw = figures(aircraft)
    figure, grid = plt.subplots(2, 2, figsize=(10, 6), layout="constrained")
    for column, axis in enumerate((pitch, yaw)):
        shown = [("", axis.step)]
        if axis.name == "yaw":
            shown.append((f", {SIDE_GUST:g} m/s through w_z", axis.disturbed))
        for note, step in shown:
            part = step.time <= (12.0 if axis.name == "pitch" else 40.0)
            grid[0][column].plot(step.time[part], step.angle[part], label=f"{axis.name} {step.size:g}°{note}")
            grid[1][column].plot(step.time[part], step.surface[part])
        grid[0][column].axhspan(
            axis.step.size * (1 - BAND), axis.step.size * (1 + BAND), color="0.85", label="±2 %"
        )
        grid[0][column].legend(loc="lower right")
        grid[0][column].set(ylabel="angle [deg]")
        grid[1][column].set(ylabel="surface [deg]", xlabel="time [s]")
    figure.suptitle(f"{aircraft.spec.name}: steps as flown")
    path = save(figure, folder / f"{aircraft.spec.name}-steps.png")
    plt.close(figure)
    return path
