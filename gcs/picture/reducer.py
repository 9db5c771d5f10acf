"""The whole picture from one stream: fleet, alerts and commands, evaluated on a fixed grid of time.

Alerts are judged at every multiple of 0.1 s of the station's time (every 0.2 s with more than 250 vehicles,
every 0.3 s with more than 500, and so on: judging shall not take all the time there is), and a judgement
at T sees exactly the messages that came before T, no matter when anybody asks: so a replay of the recorded
stream (key, payload, now_ns) gives the live run's picture, alert for alert.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from gcs.picture import alert_rules as rules
from gcs.picture import station_journal
from gcs.picture.alerts import Alerts, Finding
from gcs.picture.assessment import assess
from gcs.picture.command_book import CommandBook
from gcs.picture.fleet import Fleet
from gcs.picture.station_journal import Acknowledged, Remark, Replied, Sent
from gcs.picture.thresholds import Thresholds
from gcs.picture.values import Alert, LogLine, Picture
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Severity
from onboard.wire.bus.topics import Heard, Topic

GRID_NS = NS_PER_S // 10
LONGEST_GAP_NS = 3600 * NS_PER_S  # judged step by step; a longer silence changes no alert any more


class PictureReducer:
    """Reduces the stream to a picture: `apply` in order of arrival, `tick` as time passes, then `picture`.

    `limits` decide about alerts, `version` (the station's own) is compared with the agents'.
    """

    def __init__(self, game: str, limits: Thresholds | None = None, version: str = "") -> None:
        self.fleet = Fleet(game)
        self.book = CommandBook()
        self.alerts = Alerts()
        self._limits = limits or Thresholds()
        self._version = version
        self.remarks: dict[str, Finding] = {}  # standing ones, by kind
        self._next_ns: int | None = None

    def apply(self, key: str, payload: bytes, now_ns: int) -> Heard | None:
        """Take in one message of the bus or of the journal; what was heard, None for a bad one."""
        if self._next_ns is None or self._next_ns <= now_ns:
            self.tick(now_ns)
        heard = self.fleet.apply(key, payload, now_ns)
        take = _TAKERS.get(heard.topic) if heard is not None else None
        if heard is not None and take is not None:
            take(self, heard.message, now_ns)
        return heard

    def tick(self, now_ns: int) -> None:
        """Let time pass to `now_ns`."""
        if self._next_ns is None or now_ns - self._next_ns > LONGEST_GAP_NS:
            start_ns = now_ns if self._next_ns is None else now_ns - LONGEST_GAP_NS
            self._next_ns = -(-start_ns // GRID_NS) * GRID_NS
        while self._next_ns <= now_ns:
            self._judge(self._next_ns)
            self._next_ns += GRID_NS * self.fleet.grid_steps

    def picture(self, now_ns: int) -> Picture:
        """The picture now."""
        self.tick(now_ns)
        return self._look(now_ns, whole=True)

    def _look(self, now_ns: int, whole: bool) -> Picture:
        game, vehicles = self.fleet.game(now_ns), self.fleet.vehicles(now_ns)
        tracks = self.fleet.tracks(now_ns)
        return Picture(
            now_ns=now_ns,
            game=game,
            vehicles=vehicles,
            tracks=tracks,
            assessments=assess(game, vehicles, tracks) if whole else (),
            commands=self.book.views(now_ns),
            dropped=tuple(sorted(self.fleet.drops.items())),
            bad_age_s=self.fleet.bad_age_s(now_ns),
            received=self.fleet.received,
            alerts=self.alerts.board() if whole else (),
            past_alerts=self.alerts.past() if whole else (),
            log=tuple(self.fleet.log) if whole else (),
        )

    def _judge(self, at_ns: int) -> None:
        picture = self._look(at_ns, whole=False)

        def find(in_force: Callable[[str], bool]) -> Iterator[Finding]:
            yield from rules.rules(picture, in_force, self._limits, self._version)
            yield from self.remarks.values()

        for alert in self.alerts.judge(find, at_ns):
            self._log(alert, at_ns)

    def _log(self, alert: Alert, at_ns: int) -> None:
        over = alert.cleared_ns > 0
        text = f"over: {alert.text}" if over else f"{alert.text}. {alert.advice}"
        line = LogLine(
            at_ns=at_ns,
            id=alert.id,
            severity=Severity.INFO if over else alert.severity,
            kind=f"{'cleared' if over else 'alert'}",
            text=text,
        )
        self.fleet.log.append(line)

    def _on_sent(self, sent: Sent, now_ns: int) -> None:
        quotes = {id: self.fleet.quote(id, now_ns) for id in sent.ids}
        self.book.issue(sent.command, sent.ids, now_ns, quotes, everybody=sent.everybody)
        whom = ["everybody"] if sent.everybody else [*map(str, sent.ids)]
        text = f"{sent.command.kind.value} to {', '.join(whom)}, by {sent.command.sender}"
        line = LogLine(at_ns=now_ns, id=0, severity=Severity.INFO, kind="command", text=text)
        self.fleet.log.append(line)

    def _on_replied(self, replied: Replied, now_ns: int) -> None:
        self.book.reply(replied.reply, now_ns)

    def _on_acknowledged(self, acknowledged: Acknowledged, now_ns: int) -> None:
        self.alerts.acknowledge(acknowledged.alert)

    def _on_remark(self, remark: Remark, now_ns: int) -> None:
        if remark.over:
            self.remarks.pop(remark.kind, None)
        elif remark.advice and remark.severity is not Severity.INFO:
            self.remarks[remark.kind] = Finding(remark.kind, 0, remark.severity, remark.text, remark.advice)


_TAKERS: dict[Topic[Any], Callable[[PictureReducer, Any, int], None]] = {
    station_journal.SENT: PictureReducer._on_sent,
    station_journal.REPLIED: PictureReducer._on_replied,
    station_journal.ACKNOWLEDGED: PictureReducer._on_acknowledged,
    station_journal.REMARK: PictureReducer._on_remark,
}
