"""Services that every autopilot offers: parameters, missions, files, time, stream rates.

One function a message.
"""

from __future__ import annotations

from collections.abc import Callable

from onboard.wire.mavlink.dialect import DialectPacket, dialect
from sim_bridge.vehicle.autopilot import telemetry
from sim_bridge.vehicle.autopilot.files import refusal
from sim_bridge.vehicle.autopilot.state import AutopilotState


def param_list(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """PARAM_REQUEST_LIST: begin to send all parameters, and say the banner."""
    ap.parameters.list_all()
    for line in ap.banner:
        ap.say(dialect.MAV_SEVERITY_INFO, line)


def param_read(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """PARAM_REQUEST_READ: send one parameter, by name or by number."""
    ap.emit(ap.parameters.read(packet.message.param_id, packet.message.param_index))


def param_set(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """PARAM_SET: change a parameter and send the value that it has now."""
    ap.emit(ap.parameters.write(packet.message.param_id, packet.message.param_value))


def mission_list(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """MISSION_REQUEST_LIST: there are no items."""
    ap.emit(
        dialect.MAVLink_mission_count_message(packet.system, packet.component, 0, packet.message.mission_type)
    )


def mission_request(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """MISSION_REQUEST and MISSION_REQUEST_INT: there is no such item."""
    _mission_ack(ap, packet, dialect.MAV_MISSION_INVALID_SEQUENCE)


def mission_upload(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """MISSION_COUNT: no mission is taken, for there is no room for it."""
    _mission_ack(ap, packet, dialect.MAV_MISSION_NO_SPACE)


def mission_clear(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """MISSION_CLEAR_ALL: accepted, for there is nothing to clear."""
    _mission_ack(ap, packet, dialect.MAV_MISSION_ACCEPTED)


def _mission_ack(ap: AutopilotState, packet: DialectPacket, result: int) -> None:
    ap.emit(
        dialect.MAVLink_mission_ack_message(
            packet.system, packet.component, result, packet.message.mission_type
        )
    )


def file_transfer(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """FILE_TRANSFER_PROTOCOL: refused, so that clients fall back to the parameter protocol."""
    payload = refusal(bytes(packet.message.payload))
    ap.emit(dialect.MAVLink_file_transfer_protocol_message(0, packet.system, packet.component, payload))


def timesync(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """TIMESYNC: answer a request with the time since boot [ns]."""
    if packet.message.tc1 == 0:
        ap.emit(dialect.MAVLink_timesync_message(ap.boot_elapsed_ns(now_ns), packet.message.ts1))


def ping(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """PING: answer a ping to everybody."""
    m = packet.message
    if m.target_system == 0 and m.target_component == 0:
        ap.emit(dialect.MAVLink_ping_message(m.time_usec, m.seq, packet.system, packet.component))


def data_stream(ap: AutopilotState, now_ns: int, packet: DialectPacket) -> None:
    """REQUEST_DATA_STREAM: set the rate of a group of messages."""
    m = packet.message
    for number in telemetry.DATA_STREAMS.get(m.req_stream_id, ()):
        if telemetry.can_build(ap, number):
            hz = m.req_message_rate if m.start_stop else 0
            ap.streams.set(number, 1e6 / hz if hz else -1, now_ns)


Service = Callable[[AutopilotState, int, DialectPacket], None]

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
