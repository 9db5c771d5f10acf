"""What an agent's latency is compared with: `python -m tests.benchmarks.companions echo|mavsdk PORT SYSTEM`.

Both listen on the port, ask for positions at 20 Hz, enter GUIDED and answer every position with a velocity
that differs from the one before. `echo` is the least there can be in Python: asyncio and pymavlink's dialect.
"""

from __future__ import annotations

import asyncio
import sys
from typing import Any

RATE_HZ = 20.0


class Echo(asyncio.DatagramProtocol):
    """One datagram in, one out."""

    def __init__(self, system: int) -> None:
        from onboard.wire.mavlink.dialect import dialect

        self._dialect = dialect
        self._system = system
        self._parser: Any = dialect.MAVLink(None)
        self._parser.robust_parsing = True
        self._sender: Any = dialect.MAVLink(None, srcSystem=system, srcComponent=191)
        self._transport: Any = None
        self._peer: Any = None
        self._count = 0

    def connection_made(self, transport: Any) -> None:
        self._transport = transport

    def datagram_received(self, data: bytes, addr: Any) -> None:
        self._peer = addr
        for message in self._parser.parse_buffer(data) or ():
            if message.get_msgId() == self._dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT:
                self._count += 1
                north = 0.001 * (self._count % 1000)
                setpoint = self._dialect.MAVLink_set_position_target_local_ned_message
                numbers = (0, 0, 0, north, 0, 0, 0, 0, 0, 0, 0)  # position, velocity, acceleration, yaw
                self._send(setpoint(message.time_boot_ms, self._system, 1, 1, 0x0DC7, *numbers))

    def tick(self) -> None:
        """Once a second: a heartbeat, and what is wanted of the autopilot."""
        d = self._dialect
        if self._peer is None:
            return
        command = d.MAVLink_command_long_message
        self._send(d.MAVLink_heartbeat_message(18, 8, 0, 0, 4, 3))
        self._send(command(self._system, 1, 511, 0, 33, 1e6 / RATE_HZ, 0, 0, 0, 0, 0))
        self._send(command(self._system, 1, 176, 0, 1, 4, 0, 0, 0, 0, 0))  # GUIDED

    def _send(self, message: Any) -> None:
        self._transport.sendto(message.pack(self._sender), self._peer)
        self._sender.seq = (self._sender.seq + 1) & 0xFF


async def echo(port: int, system: int) -> None:
    """The bare one."""
    loop = asyncio.get_running_loop()
    _, protocol = await loop.create_datagram_endpoint(lambda: Echo(system), local_addr=("127.0.0.1", port))
    while True:
        protocol.tick()
        await asyncio.sleep(1.0)


async def mavsdk(port: int, system: int) -> None:
    """MAVSDK's asyncio path: its position stream, its offboard setpoints."""
    from mavsdk.asyncio import ComponentType, Configuration, Mavsdk
    from mavsdk.asyncio.plugins.offboard import OffboardAsync, VelocityNedYaw
    from mavsdk.asyncio.plugins.telemetry import TelemetryAsync

    configuration = Configuration.create_with_component_type(ComponentType.COMPANION_COMPUTER)
    configuration.system_id = system
    async with Mavsdk(configuration) as sdk:
        await sdk.add_any_connection(f"udpin://127.0.0.1:{port}")
        autopilot = await sdk.first_autopilot(timeout_s=20.0)
        if autopilot is None:
            raise SystemExit("no autopilot")
        telemetry, offboard = TelemetryAsync(autopilot), OffboardAsync(autopilot)
        await telemetry.set_rate_position(RATE_HZ)
        await offboard.set_velocity_ned(VelocityNedYaw(0.0, 0.0, 0.0, 0.0))
        await offboard.start()
        count = 0
        async for _ in telemetry.subscribe_position():
            count += 1
            await offboard.set_velocity_ned(VelocityNedYaw(0.001 * (count % 1000), 0.0, 0.0, 0.0))


if __name__ == "__main__":
    asyncio.run({"echo": echo, "mavsdk": mavsdk}[sys.argv[1]](int(sys.argv[2]), int(sys.argv[3])))
