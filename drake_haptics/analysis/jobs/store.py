"""The file in which a study keeps what is done."""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import warnings
from collections.abc import Iterable
from types import TracebackType
from typing import Any

from drake_haptics.analysis.jobs.function import PACKAGE_VERSION, StudyFunction

# Every line begins so; a file without it belongs to somebody else.
_MARK = b'{"format":"drake_haptics study 1",'
_DIGEST = b',"sha256":"'
# Damaged lines that a warning names; more are only counted.
_NAMED_LINES = 10


class StudyWarning(UserWarning):
    """Something in a store that is skipped."""


class StudyStore:
    """A file of JSON lines, one for each task that is done.

    Each line stands on its own: the function's name and the hash of what is bound to
    it, version of this package, key, task, result, and a hash over all that. It is
    handed to the operating system as soon as the result is there, so that killing the
    program loses nothing that was reported done, and goes to the disk when the store
    is closed. One program at a time may have it open.

    Args:
        path: Of the file; made if it is not there.
        function: What its results are of.

    Attributes:
        path: Of the file.

    Raises:
        ValueError: The file is none of a study, or is in use by another program.
        OSError: The file cannot be opened.
    """

    def __init__(self, path: str | os.PathLike[str], function: StudyFunction):
        self.path = os.fspath(path)
        self._function = function
        self._stream = open(self.path, "a+b")
        try:
            self._lock()
        except BaseException:
            self._stream.close()
            raise

    def __enter__(self) -> StudyStore:
        """Returns itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Brings all to the disk and closes the file."""
        with self._stream:
            self._stream.flush()
            os.fsync(self._stream.fileno())
            # A process that was forked meanwhile shares the lock until released.
            fcntl.flock(self._stream, fcntl.LOCK_UN)

    def load(self, tasks: Iterable[str]) -> dict[str, str]:
        """Reads the results that are asked for.

        Lines that are torn or damaged are skipped with a `StudyWarning`.

        Args:
            tasks: Exact JSON of each.

        Returns:
            Exact JSON of the results that are there, by task.

        Raises:
            ValueError: The file holds another study, or something else.
        """
        task_of = {self._function.make_key(task): task for task in tasks}
        results: dict[str, str] = {}
        damaged: list[int] = []
        ours, line = False, b"\n"
        self._stream.seek(0)
        for number, line in enumerate(self._stream, start=1):
            ours |= line.startswith(_MARK) or _MARK.startswith(line.rstrip(b"\n"))
            record = _read(line)
            if record is None:
                damaged.append(number)
                continue
            self._check(record, number)
            if record["key"] in task_of:
                results[task_of[record["key"]]] = _dump(record["result"])
        if damaged and not ours:
            raise ValueError(
                f"store {self.path} is not a file of a study, and is left as it is:"
                " give another one"
            )
        if not line.endswith(b"\n"):  # the next result must not join a torn line
            self._write(b"\n")
        self._warn(damaged)
        return results

    def add(self, task: str, result: str) -> None:
        """Appends a result; both are exact JSON."""
        name, key = _dump(self._function.name), self._function.make_key(task)
        line = _MARK + (
            f'"function":{name},"bound":"{self._function.digest}",'
            f'"version":"{PACKAGE_VERSION}","key":"{key}","task":{task},'
            f'"result":{result}'
        ).encode("ascii")
        self._write(line + _DIGEST + _hash(line) + b'"}\n')

    def _write(self, data: bytes) -> None:
        self._stream.write(data)
        self._stream.flush()

    def _lock(self) -> None:
        try:
            fcntl.flock(self._stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise ValueError(
                f"store {self.path} is in use by another program: wait for it, or"
                " give another file"
            ) from None
        except OSError:
            pass  # some network file systems have no locks

    def _check(self, record: dict[str, Any], number: int) -> None:
        """Raises ValueError if a line is of another study."""
        if record["bound"] == self._function.digest:
            return
        name, by = record["function"], record["version"]
        if name != self._function.name:
            why = f"results of {name}, not of {self._function.name}"
        elif by != PACKAGE_VERSION:
            why = f"results by version {by}, and this is {PACKAGE_VERSION}"
        else:
            why = f"results of {name} with other values bound to it"
        raise ValueError(
            f"store {self.path} holds {why} (line {number}): give another file, or"
            " delete this one"
        )

    def _warn(self, damaged: list[int]) -> None:
        if not damaged:
            return
        named = ", ".join(map(str, damaged[:_NAMED_LINES]))
        more = len(damaged) - _NAMED_LINES
        warnings.warn(
            f"store {self.path}: line {named}{f' and {more} more' if more > 0 else ''}"
            " is damaged and skipped; what it held is computed again",
            StudyWarning,
            stacklevel=2,
        )


def _read(line: bytes) -> dict[str, Any] | None:
    """Returns what a line holds; None if a single bit of it is not as written."""
    body, _, end = line.rpartition(_DIGEST)
    if end != _hash(body) + b'"}\n':
        return None
    record: dict[str, Any] = json.loads(body + b"}")
    return record


def _hash(body: bytes) -> bytes:
    return hashlib.sha256(body).hexdigest()[:16].encode()


def _dump(plain: Any) -> str:
    return json.dumps(plain, separators=(",", ":"), allow_nan=False)
