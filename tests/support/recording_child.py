"""A process that records a chase and tells each stamp on stdout: `recording_child.py FILE SECONDS`."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from gcs.recording.recorder import Recorder
from tests.support.chase_messages import chase


def main() -> None:
    recorder = Recorder(Path(sys.argv[1]), "field")
    for item in chase(float(sys.argv[2]), story=False):
        recorder.record(*item)
        sys.stdout.write(f"{item.stamp_ns}\n")
        sys.stdout.flush()
    recorder.close()
    print(recorder.status().trouble)


main()
