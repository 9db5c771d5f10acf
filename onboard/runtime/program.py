"""The host of every command: how a program begins and in what ways it can end.

A user's mistake costs one line on standard error and exit code 2, ctrl-C one line and 130. A reader of the
output who leaves (`| head`) ends the program quietly; output that cannot be written ends it with one line.
"""

from __future__ import annotations

import atexit
import contextlib
import errno
import os
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, NoReturn, TextIO

from onboard.config.printable import printable
from onboard.config.strict import ConfigError
from onboard.runtime import early
from onboard.runtime.early import INTERRUPTED
from onboard.runtime.extras import lacking

MISTAKE = 2
NOT_WRITTEN = 74  # EX_IOERR of sysexits.h
READER_LEFT = 141  # as a shell reports SIGPIPE
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)  # no mistake of whoever named the file
NO_ROOM = (*FULL, errno.EIO)
FORBIDDEN = (
    errno.EACCES, errno.EPERM, errno.EROFS, errno.EISDIR, errno.ENOTDIR, errno.ENAMETOOLONG, errno.ELOOP
)  # fmt: skip


def run(app: Callable[..., Any], name: str) -> NoReturn:
    """Run a program to its end and leave with its exit code.

    `app` is a Typer application, or a function without arguments that gives the exit code (None: 0); `name`
    stands before every line on standard error. Never returns: raises SystemExit.
    """
    try:
        _run(app, name)
    except SystemExit as end:
        _leave(end.code, None)
        raise
    except BaseException as fault:
        _leave(1, fault)
        raise


def _run(app: Callable[..., Any], name: str) -> NoReturn:
    try:
        early.take_over()
        tolerate_characters(sys.stdout, sys.stderr)
        code = _called(app, name)
        if sys.stdout is not None:
            sys.stdout.flush()  # here, where what goes wrong can be told
    except BaseException as error:
        end = _end_of(error)
        if end is None:
            raise  # a fault of the program keeps its traceback
        if end.code in (NOT_WRITTEN, READER_LEFT):
            _discard(sys.stdout)
        if end.code == INTERRUPTED:  # of a coroutine that had not begun nobody need be warned
            warnings.simplefilter("ignore", RuntimeWarning)
        _end(name, end.words, end.code)
    finally:
        early.leave()
    _settle(sys.stderr)
    sys.exit(code if isinstance(code, int) else 0)


def fail(name: str, text: str) -> NoReturn:
    """Tell a user's mistake in one line on standard error and exit with code 2."""
    _end(name, " ".join(text.split()), MISTAKE)


def tolerate_characters(*streams: TextIO | None) -> None:
    """Let streams write any text: a character that their encoding lacks comes out as `\\u03c8` does."""
    for stream in streams:
        reconfigure = getattr(stream, "reconfigure", None)  # a test's own stream may have none
        if reconfigure is not None:
            reconfigure(errors="backslashreplace")


def _called(app: Callable[..., Any], name: str) -> Any:
    """What the program gives, or the code of a `sys.exit` in it."""
    typer = sys.modules.get("typer")  # the agent does without: it costs 12 MB of memory
    try:
        return app() if typer is None else _called_by_typer(app, name, typer)
    except SystemExit as error:
        return error.code


def _called_by_typer(app: Callable[..., Any], name: str, typer: Any) -> Any:
    if not isinstance(app, typer.Typer):
        return app()
    command = typer.main.get_command(app)
    if f"_{name}_COMPLETE".replace("-", "_").upper() in os.environ:
        return command.main(prog_name=name, standalone_mode=False)  # the shell asks for words
    try:  # not `app()`: it would turn ctrl-C and a reader who left into exit codes of its own
        with command.make_context(name, sys.argv[1:]) as context:
            return command.invoke(context)
    except typer.Exit as error:
        return error.exit_code
    except typer.TyperException as error:
        text = error.format_message()
        if text.startswith("Usage:"):  # no arguments at all: the help
            print(text, file=sys.stderr)
            sys.exit(MISTAKE)
        context = getattr(error, "ctx", None)  # of the subcommand that was meant
        fail(name, f"{text} (see {context.command_path if context else name} --help)")
    except typer.Abort:
        raise KeyboardInterrupt from None


def _leave(code: object, fault: BaseException | None) -> None:
    """Leave a program whose libraries' threads still run, without taking the interpreter down under them;
    a fault of the program leaves its traceback.

    A thread that comes back from foreign code (Zenoh's, in Rust) into an interpreter that is going down
    aborts the process: "exception not rethrown", exit 134.
    """
    main = threading.main_thread()
    if not early.program() or not any(one.daemon for one in threading.enumerate() if one is not main):
        return
    if fault is not None:
        sys.excepthook(type(fault), fault, fault.__traceback__)
    threading._shutdown()  # type: ignore[attr-defined]  # as the interpreter does first: the others end
    atexit._run_exitfuncs()
    _settle(sys.stderr)
    _settle(sys.stdout)
    os._exit(code if isinstance(code, int) else int(code is not None))


class _End(NamedTuple):
    code: int
    words: str  # "" = without a word


def _end_of(error: BaseException) -> _End | None:
    """How a program ends of what is no fault of its own; None where it is one.

    Of a group, as tasks raise it, every part must be no fault: the most telling one counts.
    """
    if isinstance(error, BaseExceptionGroup):
        ends = [_end_of(leaf) for leaf in _leaves(error)]
        found = [end for end in ends if end is not None]
        order = (INTERRUPTED, MISTAKE, NOT_WRITTEN, READER_LEFT)
        return min(found, key=lambda end: order.index(end.code)) if len(found) == len(ends) else None
    if isinstance(error, ConfigError):
        cause = error.__context__  # `from None` hides it from tracebacks alone
        full = isinstance(cause, OSError) and cause.errno in FULL
        return _End(NOT_WRITTEN if full else MISTAKE, str(error))
    if isinstance(error, ModuleNotFoundError):
        words = lacking(error.name or "")
        return _End(MISTAKE, words) if words else None
    if isinstance(error, KeyboardInterrupt):  # its words say what was left behind
        return _End(INTERRUPTED, ": ".join(("interrupted", *map(str, error.args[:1]))))
    if isinstance(error, BrokenPipeError):
        return _End(READER_LEFT, "")
    if not isinstance(error, OSError) or error.errno not in NO_ROOM + (FORBIDDEN if error.filename else ()):
        return None
    where = f"{error.filename}: " if error.filename else "cannot write: "
    return _End(NOT_WRITTEN, f"{where}{(error.strerror or str(error)).lower()}")


def _end(name: str, text: str, code: int) -> NoReturn:
    with contextlib.suppress(OSError):  # standard error may be full, or its reader gone
        if text:
            print(printable(f"{name}: {text}"), file=sys.stderr, flush=True)
    _settle(sys.stderr)
    _settle(sys.stdout)
    sys.exit(code)


def _settle(stream: TextIO | None) -> None:
    """Write what a stream still holds, or nothing of it: the interpreter would try at the exit, and exit with
    a code of its own (120) where it cannot."""
    try:
        if stream is not None:
            stream.flush()
    except (OSError, ValueError):
        _discard(stream)


def _discard(stream: TextIO | None) -> None:
    """Lead a stream into nothing, so that what is left in its buffer does no harm at the exit."""
    if stream is not None:
        with contextlib.suppress(OSError, ValueError):  # a test's own stream has no descriptor
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _leaves(group: BaseExceptionGroup[BaseException]) -> Iterator[BaseException]:
    for error in group.exceptions:
        if isinstance(error, BaseExceptionGroup):
            yield from _leaves(error)
        else:
            yield error
