"""Services that every autopilot offers: parameters, missions, files, time, stream rates.

One function a message.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from onboard.wire.mavlink.dialect import DialectPacket, dialect
from sim_bridge.vehicle.autopilot import telemetry
from sim_bridge.vehicle.autopilot.files import refusal

if TYPE_CHECKING:
    from sim_bridge.vehicle.autopilot.autopilot import Autopilot


def param_list(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    ap.parameters.list_all()
    for line in ap.banner:
        ap.say(dialect.MAV_SEVERITY_INFO, line)


def param_read(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    ap.emit(ap.parameters.read(packet.message.param_id, packet.message.param_index))


def param_set(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    ap.emit(ap.parameters.write(packet.message.param_id, packet.message.param_value))


def mission_list(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    ap.emit(
        dialect.MAVLink_mission_count_message(packet.system, packet.component, 0, packet.message.mission_type)
    )


def mission_request(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    _mission_ack(ap, packet, dialect.MAV_MISSION_INVALID_SEQUENCE)


def mission_upload(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    _mission_ack(ap, packet, dialect.MAV_MISSION_NO_SPACE)


def mission_clear(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    _mission_ack(ap, packet, dialect.MAV_MISSION_ACCEPTED)


def _mission_ack(ap: Autopilot, packet: DialectPacket, result: int) -> None:
    ap.emit(
        dialect.MAVLink_mission_ack_message(
            packet.system, packet.component, result, packet.message.mission_type
        )
    )


def file_transfer(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    payload = refusal(bytes(packet.message.payload))
    ap.emit(dialect.MAVLink_file_transfer_protocol_message(0, packet.system, packet.component, payload))


def timesync(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    if packet.message.tc1 == 0:
        ap.emit(dialect.MAVLink_timesync_message(ap.boot_elapsed_ns(now_ns), packet.message.ts1))


def ping(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    m = packet.message
    if m.target_system == 0 and m.target_component == 0:
        ap.emit(dialect.MAVLink_ping_message(m.time_usec, m.seq, packet.system, packet.component))


def data_stream(ap: Autopilot, now_ns: int, packet: DialectPacket) -> None:
    m = packet.message
    for number in telemetry.DATA_STREAMS.get(m.req_stream_id, ()):
        if telemetry.can_build(ap, number):
            hz = m.req_message_rate if m.start_stop else 0
            ap.streams.set(number, 1e6 / hz if hz else -1, now_ns)


Service = Callable[["Autopilot", int, DialectPacket], None]

SERVICES: dict[int, Service] = {
    dialect.MAVLINK_MSG_ID_PARAM_REQUEST_LIST: param_list,
    dialect.MAVLINK_MSG_ID_PARAM_REQUEST_READ: param_read,
    dialect.MAVLINK_MSG_ID_PARAM_SET: param_set,
    dialect.MAVLINK_MSG_ID_MISSION_REQUEST_LIST: mission_list,
    dialect.MAVLINK_MSG_ID_MISSION_REQUEST_INT: mission_request,
    dialect.MAVLINK_MSG_ID_MISSION_REQUEST: mission_request,
    dialect.MAVLINK_MSG_ID_MISSION_COUNT: mission_upload,
    dialect.MAVLINK_MSG_ID_MISSION_CLEAR_ALL: mission_clear,
    dialect.MAVLINK_MSG_ID_FILE_TRANSFER_PROTOCOL: file_transfer,
    dialect.MAVLINK_MSG_ID_TIMESYNC: timesync,
    dialect.MAVLINK_MSG_ID_PING: ping,
    dialect.MAVLINK_MSG_ID_REQUEST_DATA_STREAM: data_stream,
}
