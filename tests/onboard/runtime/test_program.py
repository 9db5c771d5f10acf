"""How commands end, seen from outside: real processes, their exit codes and what they print."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.paths import ROOT

BODY = """
import sys
from onboard.runtime.program import run
{imports}

def main():
{body}

{app}
"""
PLAIN = "run(main, 'prog')"
TYPER = "app = typer.Typer(pretty_exceptions_enable=False)\napp.command()(main)\nrun(app, 'prog')"
KINDS = [("", PLAIN), ("import typer", TYPER)]
BOTH = pytest.mark.parametrize(("imports", "app"), KINDS, ids=["plain", "typer"])


def script(body: str, imports: str = "", app: str = PLAIN) -> list[str]:
    indented = "\n".join(f"    {line}" for line in body.splitlines())
    return [sys.executable, "-c", BODY.format(imports=imports, body=indented, app=app)]


def ended(command: list[str], **environment: str) -> tuple[int, str, str]:
    env = os.environ | environment
    done = subprocess.run(command, capture_output=True, env=env, timeout=60, check=False)
    return done.returncode, done.stdout.decode("latin-1"), done.stderr.decode("latin-1")


@BOTH
@pytest.mark.parametrize(
    ("body", "code", "out", "err"),
    [
        ("print('done')", 0, "done\n", ""),
        ("return 3", 3, "", ""),
        ("sys.exit(5)", 5, "", ""),
        ("from onboard.config.strict import ConfigError\nraise ConfigError('a.toml: no\\n  good')", 2, "",
         "prog: a.toml: no good\n"),
        ("raise KeyboardInterrupt", 130, "", "prog: interrupted\n"),
        ("import errno\nraise OSError(errno.ENOSPC, 'No space left on device', 'runs/1.tlog')", 74, "",
         "prog: runs/1.tlog: no space left on device\n"),
        ("import os\nraise PermissionError(13, os.strerror(13), 'runs/1.tlog')", 74, "",
         "prog: runs/1.tlog: permission denied\n"),
        ("open('/')", 74, "", "prog: /: is a directory\n"),
        ("raise ModuleNotFoundError('No', name='mcap.writer')", 2, "",
         "prog: found no mcap, expected: pip install 'apollonius[gcs]'\n"),
        ("raise ModuleNotFoundError('No', name='PIL')", 2, "",
         "prog: found no PIL, expected: pip install 'apollonius[page]' or 'apollonius[sim]'\n"),
    ],
)  # fmt: skip
def test_every_end_has_its_code_and_at_most_one_line(
    imports: str, app: str, body: str, code: int, out: str, err: str
) -> None:
    assert ended(script(body, imports, app)) == (code, out, err)


@pytest.mark.parametrize(
    ("end", "code", "last"),
    [("return 3", 3, ""), ("raise KeyboardInterrupt", 130, "prog: interrupted"),
     ("raise ValueError('a fault')", 1, "ValueError: a fault")],
)  # fmt: skip
def test_a_session_that_is_being_opened_does_not_abort_the_end(
    tmp_path: Path, end: str, code: int, last: str
) -> None:
    """Threads that come back from Zenoh while the interpreter goes down: "exception not rethrown", 134."""
    program = tmp_path / "prog.py"
    program.write_text(
        """
import atexit, concurrent.futures, threading, time
from onboard.runtime import early
early.one_line_interrupts("prog", __name__)
import zenoh
from onboard.runtime.program import run

def opens():
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", '["tcp/127.0.0.1:9"]')
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5("connect/timeout_ms", "0")
    while True:
        try:
            zenoh.open(config)
        except zenoh.ZError:
            pass

def app():
    print("begun")
    atexit.register(print, "swept up")
    concurrent.futures.ThreadPoolExecutor().submit(print, "pooled").result()  # its thread waits for more
    for _ in range(8):
        threading.Thread(target=opens, daemon=True).start()
    time.sleep(0.3)
    END

run(app, "prog")
""".replace("END", end),
        encoding="utf-8",
    )
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, program], env=env, capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stdout) == (code, "begun\npooled\nswept up\n")
    assert done.stderr.strip().rpartition("\n")[2] == last


def test_a_mistake_found_within_tasks_is_told_like_any_other() -> None:
    body = """
import asyncio
from onboard.config.strict import ConfigError
async def fails():
    raise ConfigError("link: found nobody")
async def both():
    async with asyncio.TaskGroup() as group:
        group.create_task(fails())
        group.create_task(asyncio.sleep(60))
asyncio.run(both())"""
    assert ended(script(body)) == (2, "", "prog: link: found nobody\n")


@pytest.mark.parametrize(
    ("raised", "code", "err"),
    [
        ("BrokenPipeError(32, 'Broken pipe')", 141, ""),
        ("OSError(28, 'No space left on device')", 74, "prog: cannot write: no space left on device\n"),
        ("ConfigError('a: b'), BrokenPipeError(32, 'Broken pipe')", 2, "prog: a: b\n"),
    ],
)
def test_output_that_fails_within_tasks_ends_as_elsewhere(raised: str, code: int, err: str) -> None:
    body = f"from onboard.config.strict import ConfigError\nraise ExceptionGroup('tasks', [{raised}])"
    assert ended(script(body)) == (code, "", err)


def test_a_group_with_a_fault_in_it_keeps_its_traceback() -> None:
    body = "raise ExceptionGroup('tasks', [BrokenPipeError(32, 'Broken pipe'), ZeroDivisionError('oops')])"
    code, _, err = ended(script(body))
    assert code == 1
    assert "ZeroDivisionError" in err


def test_a_module_that_no_extra_brings_is_a_fault_of_the_program() -> None:
    code, _, err = ended(script("import onboard.nowhere"))
    assert code == 1
    assert "Traceback" in err


def test_a_fault_of_the_program_keeps_its_traceback() -> None:
    code, _, err = ended(script("raise ZeroDivisionError('oops')"))
    assert code == 1
    assert "Traceback" in err
    code, _, err = ended(script("raise OSError(2, 'No such file or directory', 'gone')"))
    assert code == 1
    assert "Traceback" in err


def test_wrong_options_and_help_of_typer() -> None:
    command = script("print('ran')", "import typer", TYPER)
    code, out, err = ended([*command, "--wrong"])
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert err.startswith("prog: No such option: --wrong")
    assert err.endswith("(see prog --help)\n")
    assert ended([*command, "--help"])[0] == 0


@BOTH
def test_a_reader_who_leaves_ends_the_program_quietly(imports: str, app: str) -> None:
    body = "for n in range(100_000): print('line', n)"
    reading, writing = os.pipe()
    child = subprocess.Popen(script(body, imports, app), stdout=writing, stderr=subprocess.PIPE)
    os.close(writing)
    os.read(reading, 10)
    os.close(reading)
    _, err = child.communicate(timeout=60)
    assert (child.returncode, err) == (141, b"")


@BOTH
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
@pytest.mark.parametrize("body", ["print('short')", "for n in range(100_000): print('line', n)"])
def test_output_that_cannot_be_written_costs_one_line(imports: str, app: str, body: str) -> None:
    with open("/dev/full", "wb") as full:
        command = script(body, imports, app)
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (74, b"prog: cannot write: no space left on device\n")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_a_full_standard_error_does_not_change_the_exit_code() -> None:
    body = "from onboard.config.strict import ConfigError\nraise ConfigError('x')"
    with open("/dev/full", "wb") as full:
        assert subprocess.run(script(body), stderr=full, timeout=60, check=False).returncode == 2


@pytest.mark.parametrize(("encoding", "shown"), [("ascii", "\\u03c8 \\xb2\n"), ("latin-1", "\\u03c8 \xb2\n")])
def test_a_character_that_the_terminal_lacks_is_escaped(encoding: str, shown: str) -> None:
    body = "print('\\u03c8 \\xb2')"
    assert ended(script(body), PYTHONIOENCODING=encoding, PYTHONUTF8="0") == (0, shown, "")


def test_ctrl_c_ends_with_one_line() -> None:
    body = "import time\nprint('up', flush=True)\ntime.sleep(60)"
    child = subprocess.Popen(script(body), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert child.stdout is not None
    assert child.stdout.readline() == b"up\n"
    child.send_signal(signal.SIGINT)
    _, err = child.communicate(timeout=60)
    assert (child.returncode, err) == (130, b"prog: interrupted\n")


@BOTH
def test_ctrl_c_before_the_loop_stands_says_nothing_of_what_had_not_begun(imports: str, app: str) -> None:
    body = """
import asyncio

async def work(): ...

def no_loop():
    raise KeyboardInterrupt

asyncio.new_event_loop = no_loop
asyncio.events.new_event_loop = no_loop
asyncio.run(work())
"""
    assert ended(script(body, imports, app)) == (130, "", "prog: interrupted\n")



@pytest.mark.parametrize("program", ["onboard.cli", "gcs.cli", "sim_bridge.cli"])
def test_the_three_programs_have_this_host(program: str) -> None:
    command = [sys.executable, "-m", program]
    with open("/dev/full", "wb") as full:
        done = subprocess.run(
            [*command, "--help"], stdout=full, stderr=subprocess.PIPE, timeout=60, check=False
        )
    assert done.returncode == 74
    assert done.stderr.endswith(b": cannot write: no space left on device\n")
    assert done.stderr.count(b"\n") == 1
    code, out, err = ended([*command, "--no-such-option"], PYTHONIOENCODING="ascii", PYTHONUTF8="0")
    assert (code, out, err.count("\n")) == (2, "", 1)
