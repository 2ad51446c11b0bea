"""Defines how commands end: exit codes, messages of failures, and signals."""

from __future__ import annotations

import errno
import logging
import signal
import time
import traceback
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from enum import IntEnum
from pathlib import Path
from types import FrameType
from typing import Any

import click

from drake_haptics.common.errors import HapticsError


class ExitCode(IntEnum):
    """Exit codes of all commands.

    Attributes:
        DONE: The command is done. Ctrl-C ends `run`, `device` and `decompose --show`
            this way, too.
        UNUSABLE: An input cannot be used, or the system refuses a file or a port.
        WRONG_CALL: There is no such command, option or value.
        NO: The command is done, and the answer is no: a run became unstable or ended
            with its device at fault, two logs differ, no setting holds the budget.
        DEFECT: The program has a defect.
        INTERRUPTED: Ctrl-C ended the command before it was done: 128 + SIGINT, as in
            shells.
    """

    DONE = 0
    UNUSABLE = 1
    WRONG_CALL = 2
    NO = 3
    DEFECT = 70
    INTERRUPTED = 130


_REMEDIES = {
    errno.ENOSPC: "free some space, or write to another disk",
    errno.EDQUOT: "free some space, or write to another disk",
    errno.EROFS: "name a file in a folder that can be written",
    errno.EACCES: "name a file or folder that is yours",
    errno.EMFILE: "allow more open files, with `ulimit -n 4096`",
}


# Drake logs this for each additional page; the pages show which one has the camera.
_TWO_CAMERAS = "More than one meshcat client is attempting to broadcast its camera pose"


class _Defect(click.ClickException):
    exit_code = ExitCode.DEFECT


class _Interrupted(click.ClickException):
    """A Ctrl-C, which is not an error."""

    exit_code = ExitCode.INTERRUPTED

    def show(self, file: Any = None) -> None:
        """Writes the message to stderr."""
        click.echo(self.format_message(), file=file, err=True)


@contextmanager
def failures_in_words(debug: bool) -> Iterator[None]:
    """Ends with one message if something fails, and with a traceback if requested.

    Python's warnings and log records of libraries become one line each on stderr.

    Raises:
        click.ClickException: Something failed; it has the message and the exit code.
    """
    with _warnings_in_lines(debug), _log_in_lines():
        try:
            yield
        except (click.exceptions.Exit, click.Abort, BrokenPipeError):
            raise  # not a failure, or the reader of our output has gone
        except click.UsageError as error:  # the call itself: there is nothing to trace
            if isinstance(error, click.NoSuchOption) and error.option_name == "--debug":
                words = "--debug goes before the command: drake-haptics --debug ..."
                raise click.UsageError(words, error.ctx) from error
            raise
        except (Exception, KeyboardInterrupt) as error:
            if debug:
                traceback.print_exc()
            if isinstance(error, click.ClickException):
                raise
            raise _describe(error) from error


def _describe(error: BaseException) -> click.ClickException:
    """Returns the failure that the user sees for an exception."""
    if isinstance(error, KeyboardInterrupt):
        # Work that was stored says how to continue.
        return _Interrupted(str(error) or "Stopped.")
    if isinstance(error, HapticsError):
        return click.ClickException(str(error))
    if isinstance(error, OSError) and error.errno is not None:
        return click.ClickException(_describe_refusal(error))
    if isinstance(error, MemoryError):
        return click.ClickException(
            "not enough memory; reduce the mesh first, with --max-triangles or a"
            " scene's max_triangles"
        )
    if isinstance(error, ModuleNotFoundError) and not _is_ours(error.name):
        return click.ClickException(
            f"the Python package '{error.name}' is missing: pip install {error.name}"
        )
    return _Defect(_describe_defect(error))


def _describe_refusal(error: OSError) -> str:
    """Returns what the system refused, and a remedy if there is one."""
    words = str(error.strerror)
    if error.filename is not None:
        words = f"{error.filename}: {words}"
    remedy = _REMEDIES.get(error.errno or 0)
    return words if remedy is None else f"{words}; {remedy}"


def _is_ours(module: str | None) -> bool:
    return module is None or module.partition(".")[0] == "drake_haptics"


def _describe_defect(error: BaseException) -> str:
    """Returns a message that asks the user to report a defect."""
    home = Path(__file__).parents[1]
    places = [
        f" ({Path(frame.filename).relative_to(home)}:{frame.lineno})"
        for frame in traceback.extract_tb(error.__traceback__)
        if Path(frame.filename).is_relative_to(home)
    ]
    what = " ".join(f"{type(error).__name__}: {error}".split())
    return (
        f"a defect of drake-haptics, not of your input: {what}"
        f"{places[-1] if places else ''}. Please report it, with the command and the"
        " output of the same command after `drake-haptics --debug`"
    )


@contextmanager
def naming(given: str, kind: type[HapticsError] = HapticsError) -> Iterator[None]:
    """Prefixes messages of the library with the option or its value.

    Raises:
        HapticsError: The library raised one of this kind.
    """
    try:
        yield
    except kind as error:
        raise kind(f"{given}: {error}") from error


@contextmanager
def _warnings_in_lines(debug: bool) -> Iterator[None]:
    """Shows Python's warnings as one line each, unless debugging."""

    def show(message: Warning | str, *_: Any, **__: Any) -> None:
        warn(str(message))

    with warnings.catch_warnings():
        if not debug:
            warnings.showwarning = show
        yield


class _LineHandler(logging.Handler):
    """Writes each log record as one line, once."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self._written: set[str] = set()

    def emit(self, record: logging.LogRecord) -> None:
        """Writes a record."""
        words = record.getMessage()
        if words not in self._written and not words.startswith(_TWO_CAMERAS):
            self._written.add(words)
            warn(words)


@contextmanager
def _log_in_lines() -> Iterator[None]:
    """Shows warnings and errors that libraries, including Drake, log."""
    handler = _LineHandler()
    logging.root.addHandler(handler)
    try:
        yield
    finally:
        logging.root.removeHandler(handler)


def warn(words: str) -> None:
    """Writes a warning to stderr, in one line."""
    click.secho(f"Warning: {' '.join(words.split())}", fg="yellow", err=True)


# Signals by which a keyboard, script, service or terminal ends a program.
_NUMBERS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
# Pressing Ctrl-C repeatedly is one request, whose report must not be lost.
_REPEATED_S = 2.0


@contextmanager
def lasting_interrupt(
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[Callable[[], None]]:
    """Keeps Ctrl-C, SIGTERM and SIGHUP pending until the loop has ended for them.

    A `KeyboardInterrupt` is raised wherever the interpreter happens to be. In Python
    code that C++ has called, or in a destructor, it may be lost, and a device would
    continue to show force. Further signals within two seconds count as the same one;
    later ones are raised again, in case the program hangs.

    Signals that are ignored, as under `nohup`, remain ignored. Only the main thread may
    use it.

    Yields:
        A function for a loop to call regularly, which raises `KeyboardInterrupt` if
        requested.
    """
    asked_s: float | None = None

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        nonlocal asked_s
        now_s = clock()
        if asked_s is not None and now_s < asked_s + _REPEATED_S:
            return
        asked_s = now_s
        raise KeyboardInterrupt

    def check() -> None:
        if asked_s is not None:
            raise KeyboardInterrupt

    before = {
        number: signal.signal(number, interrupt)
        for number in _NUMBERS
        if signal.getsignal(number) is not signal.SIG_IGN
    }
    try:
        yield check
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
