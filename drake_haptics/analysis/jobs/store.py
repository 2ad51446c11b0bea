"""Stores the results of a study in a file.

A digest of the function and of all values bound to it identifies the results.
"""

from __future__ import annotations

import fcntl
import functools
import hashlib
import json
import os
import pickle
import sys
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields, is_dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import joblib

PACKAGE_VERSION = version("drake_haptics")


@dataclass(frozen=True)
class StudyFunction:
    """The identity of a function and of the values bound to it.

    Attributes:
        name: Module and qualified name, for people.
        digest: Hash of the name, of all values bound to the function, and of this
            package's version, hex. It does not cover the function's source.
    """

    name: str
    digest: str

    @staticmethod
    def of(function: Callable[[Any], Any]) -> StudyFunction:
        """Identifies a top-level function, a partial of one, or a callable dataclass.

        Raises:
            ValueError: The function is of another kind, or a value bound to it cannot
                be pickled.
        """
        name = _name_whole(function)
        try:
            digest = joblib.hash([PACKAGE_VERSION, name, function])
        except (pickle.PicklingError, TypeError) as error:
            raise ValueError(
                f"a store cannot tell {name} from others: {error}. Bind data, paths,"
                " dataclasses and functions of the top level of a module, and build the"
                " rest inside the function"
            ) from error
        return StudyFunction(name, digest)

    def make_key(self, task: str) -> str:
        """Returns the hash of this function with a task (exact JSON), hex."""
        return hashlib.sha256(f"{self.digest} {task}".encode()).hexdigest()[:32]


def _name_whole(function: Any) -> str:
    """Returns the name, with the names of functions bound to it in brackets.

    Raises:
        ValueError: The function has no name.
    """
    if isinstance(function, functools.partial):
        name = _name_whole(function.func)
        bound = [*function.args, *function.keywords.values()]
    elif is_dataclass(function) and not isinstance(function, type):
        name = _name(type(function))
        bound = [getattr(function, field.name) for field in fields(function)]
    else:
        return _name(function)
    inner = [_name_whole(value) for value in bound if callable(value)]
    return f"{name}({', '.join(inner)})" if inner else name


def _name(function: Any) -> str:
    """Returns module and qualified name; the module of a program is its file.

    Raises:
        ValueError: The function is not at the top level of a module.
    """
    module = getattr(function, "__module__", None)
    name = getattr(function, "__qualname__", "<object>")
    if module is None or "<" in name:  # <lambda>, <locals>
        raise ValueError(
            f"a store needs functions of the top level of a module, whose name says"
            f" what they are: {function!r} is not one"
        )
    if module == "__main__":
        program = getattr(sys.modules["__main__"], "__file__", None)
        module = Path(program).name if program else module
    return f"{module}.{name}"


# Every line begins like this; a file without it is something else.
_MARK = b'{"format":"drake_haptics study 1",'
_DIGEST = b',"sha256":"'
# Largest number of damaged lines that a warning names.
_NAMED_LINES = 10


class StudyWarning(UserWarning):
    """Warns of lines in a store that are skipped."""


class StudyStore:
    """A file of JSON lines, one for each task that is done.

    Each line is complete: the function's name and digest, the version of this package,
    key, task, result, and a hash over all of them. A line is written as soon as its
    result is available, so that killing the program loses nothing that was reported as
    done, and flushed to disk when the store is closed. Only one program at a time may
    open it.

    Args:
        path: Path of the file, which is created if it does not exist.
        function: The function whose results it keeps.

    Attributes:
        path: Path of the file.

    Raises:
        ValueError: The file does not belong to a study, or another program uses it.
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

    def __exit__(self, *_: object) -> None:
        """Writes everything to the disk and closes the file."""
        with self._stream:
            self._stream.flush()
            os.fsync(self._stream.fileno())
            # A process that was forked meanwhile shares the lock until released.
            fcntl.flock(self._stream, fcntl.LOCK_UN)

    def load(self, tasks: Iterable[str]) -> dict[str, str]:
        """Reads the results of tasks.

        Incomplete or damaged lines are skipped with a `StudyWarning`.

        Returns:
            Exact JSON of the available results, by task.

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
        if not line.endswith(b"\n"):  # the next result must not join an incomplete line
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
        """Raises ValueError if a line belongs to another study."""
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
    """Returns the content of a line; None if a single bit of it has changed."""
    body, _, end = line.rpartition(_DIGEST)
    if end != _hash(body) + b'"}\n':
        return None
    return json.loads(body + b"}")


def _hash(body: bytes) -> bytes:
    return hashlib.sha256(body).hexdigest()[:16].encode()


def _dump(plain: Any) -> str:
    return json.dumps(plain, separators=(",", ":"), allow_nan=False)
