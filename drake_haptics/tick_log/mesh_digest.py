"""Whether mesh files are still what a log was recorded on."""

from __future__ import annotations

import hashlib
from pathlib import Path

from drake_haptics.tick_log.tick_log_header import TickLogHeader

_READ_BYTES = 1 << 20


def hash_file(path: str) -> str:
    """Returns the SHA-256 of a file, in hexadecimal digits.

    Raises:
        OSError: It cannot be read.
    """
    sha = hashlib.sha256()
    with open(path, "rb") as stream:
        while data := stream.read(_READ_BYTES):
            sha.update(data)
    return sha.hexdigest()


def find_changed_meshes(header: TickLogHeader) -> list[str]:
    """Returns the mesh files that are gone or no longer what was recorded on."""

    def is_same(path: str, sha256: str) -> bool:
        try:
            # A forged path can be that of a device, which never ends, or none at all.
            return Path(path).is_file() and hash_file(path) == sha256
        except (OSError, ValueError):
            return False

    return [path for path, sha in header.mesh_sha256.items() if not is_same(path, sha)]
