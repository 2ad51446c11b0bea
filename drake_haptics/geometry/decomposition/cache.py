"""Caches decompositions on disk, so that each mesh is cut only once.

The name of an entry is a hash of everything on which its content depends, so that
entries never become stale. Faults of the cache never prevent a decomposition: an entry
that cannot be read is made again and replaced, and one that cannot be written is left
out.
"""

from __future__ import annotations

import hashlib
import json
import logging
import os
import time
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from drake_haptics import _core
from drake_haptics.common.errors import DecompositionFileError
from drake_haptics.geometry.decomposition.pieces import PieceData
from drake_haptics.geometry.decomposition.storage import (
    FORMAT_VERSION,
    read_pieces,
    write_pieces,
)
from drake_haptics.geometry.mesh.mesh import Mesh

_log = logging.getLogger(__name__)

# Enough for thousands of meshes; the least recently used entries are deleted first.
MAX_CACHE_BYTES = 512 * 2**20
_ABANDONED_AFTER_S = 3600.0


def cache_folder() -> Path:
    """Returns DRAKE_HAPTICS_CACHE, or drake_haptics in the user's cache folder."""
    own = os.environ.get("DRAKE_HAPTICS_CACHE")
    if own:
        return Path(own)
    user = os.environ.get("XDG_CACHE_HOME")
    return (Path(user) if user else Path.home() / ".cache") / "drake_haptics"


def cache_key(mesh: Mesh, method: str, parameters: dict[str, Any]) -> str:
    """Returns a hash of everything on which the pieces depend.

    It includes the compiled core, so that a changed core never finds pieces of another
    one.
    """
    settings = [FORMAT_VERSION, _core_digest(), method, parameters]
    sha = hashlib.sha256(json.dumps(settings, sort_keys=True).encode())
    for array in (mesh.vertices, mesh.triangles, mesh.solid):
        sha.update(f"{array.dtype} {array.shape}".encode())
        sha.update(np.ascontiguousarray(array).tobytes())
    return sha.hexdigest()


@cache
def _core_digest() -> str:
    return hashlib.sha256(Path(_core.__file__).read_bytes()).hexdigest()


def load_cached(key: str, mesh: Mesh) -> PieceData | None:
    """Returns the pieces stored under the key; None if there are no usable ones."""
    path = _path(key)
    try:
        pieces = read_pieces(path, key, mesh)
        os.utime(path)  # marks it as recently used
        return pieces
    except FileNotFoundError:
        return None
    except (OSError, DecompositionFileError) as error:
        _log.info("cache entry is not used: %s", error)
        return None


def store_cached(key: str, pieces: PieceData) -> None:
    """Stores pieces under the key, replacing an existing entry."""
    path = _path(key)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_pieces(path, key, pieces)
        _tidy(path.parent, keep=path)
    except OSError as error:
        _log.warning(
            "no decomposition can be kept in %s (%s), so that each run cuts its meshes"
            " again; DRAKE_HAPTICS_CACHE names another folder",
            path.parent,
            error.strerror,
        )


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
