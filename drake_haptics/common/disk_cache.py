"""Keeps results on disk, so that what takes a while is done only once.

The key of an entry is a hash of everything on which its content depends, so that
entries never become stale. Faults of the cache never prevent a result: an entry that
cannot be read is made again and replaced, and one that cannot be written is left out.
"""

from __future__ import annotations

import logging
import os
import tempfile
import time
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

_log = logging.getLogger(__name__)

# Enough for thousands of meshes; the least recently used entries are deleted first.
MAX_CACHE_BYTES = 512 * 2**20
_ABANDONED_AFTER_S = 3600.0

_Content = TypeVar("_Content")


def cache_folder() -> Path:
    """Returns DRAKE_HAPTICS_CACHE, or drake_haptics in the user's cache folder."""
    own = os.environ.get("DRAKE_HAPTICS_CACHE")
    if own:
        return Path(own)
    user = os.environ.get("XDG_CACHE_HOME")
    try:
        return (Path(user) if user else Path.home() / ".cache") / "drake_haptics"
    except RuntimeError:  # a user of a container may have no home
        return Path(tempfile.gettempdir()) / "drake_haptics"


def load_entry(key: str, read: Callable[[Path], _Content]) -> _Content | None:
    """Returns what is stored under the key; None if there is no usable entry."""
    path = _path(key)
    try:
        content = read(path)
        os.utime(path)  # marks it as recently used
        return content
    except FileNotFoundError:
        return None
    except Exception as error:  # damaged entries raise various errors
        _log.info("cache entry is not used: %s", error)
        return None


def store_entry(key: str, write: Callable[[Path], None]) -> None:
    """Stores what `write` writes under the key, replacing an existing entry.

    Args:
        key: Key of the entry.
        write: Function that writes a file at a path, such as by `replace_file`.
    """
    path = _path(key)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write(path)
        _tidy(path.parent, keep=path)
    except OSError as error:
        _log.warning(
            "no mesh can be kept in %s (%s), so that each run reads and cuts its meshes"
            " again; DRAKE_HAPTICS_CACHE names another folder",
            path.parent,
            error.strerror,
        )


def replace_file(path: Path, data: bytes | memoryview) -> None:
    """Writes a file, atomically.

    The file is written to the same folder under another name, flushed to disk and
    renamed, so that a reader sees the old file or the new one, even if this process is
    killed or another one writes the same file.

    Raises:
        OSError: The file cannot be written.
    """
    if path.exists() and not path.is_file():
        path.write_bytes(data)  # must not replace a device or a pipe
        return
    temporary = path.with_name(f".{path.name}.{uuid.uuid4().hex}.tmp")
    try:
        with open(temporary, "xb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(temporary, path)
    except OSError as error:  # name the file that the caller knows
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        temporary.unlink(missing_ok=True)  # exists only after a failure


def _path(key: str) -> Path:
    return cache_folder() / f"{key}.npz"


def _tidy(folder: Path, keep: Path) -> None:
    """Deletes files of killed writers, and old entries beyond the size limit."""
    entries = []
    for path in folder.iterdir():
        try:
            status = path.stat()
            if path.name.endswith(".tmp"):
                if time.time() - status.st_mtime > _ABANDONED_AFTER_S:
                    path.unlink()
            elif path.suffix == ".npz" and path != keep:
                entries.append((status.st_mtime, status.st_size, path))
        except FileNotFoundError:
            continue  # another process is deleting, too
    room = MAX_CACHE_BYTES - keep.stat().st_size
    for _, size, path in sorted(entries, reverse=True):
        room -= size
        if room < 0:
            path.unlink(missing_ok=True)
