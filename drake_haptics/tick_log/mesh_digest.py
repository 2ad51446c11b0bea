"""Whether mesh files are still what a log was recorded on."""

from __future__ import annotations

import hashlib
from pathlib import Path

from drake_haptics.tick_log.tick_log_header import TickLogHeader


def hash_file(path: str) -> str:
    """Returns the SHA-256 of a file, in hexadecimal digits.

    Raises:
        OSError: It cannot be read.
    """
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def find_changed_meshes(header: TickLogHeader) -> list[str]:
    """Returns the mesh files that are gone or no longer what was recorded on."""

    def is_same(path: str, sha256: str) -> bool:
        try:
            return hash_file(path) == sha256
        except (OSError, ValueError):  # A forged path can be none at all.
            return False

    return [path for path, sha in header.mesh_sha256.items() if not is_same(path, sha)]
