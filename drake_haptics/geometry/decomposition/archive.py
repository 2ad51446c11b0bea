"""A checked archive of arrays in one file, written so that it is whole or absent."""

from __future__ import annotations

import hashlib
import io
import json
import os
import uuid
from pathlib import Path
from typing import Any

import numpy as np

from drake_haptics.common.errors import DecompositionFileError

FORMAT_NAME = "drake_haptics decomposition"
FORMAT_VERSION = 1


def write_archive(
    path: Path, facts: dict[str, Any], arrays: dict[str, np.ndarray]
) -> None:
    """Writes facts (JSON data) and arrays to an .npz file, atomically.

    The file is written beside its place under a name of its own, flushed to the
    disk and renamed: a reader sees the old file or the new one, also when this
    process is killed or another one writes the same file.

    Raises:
        OSError: if the system refuses.
    """
    header = {"format": FORMAT_NAME, "version": FORMAT_VERSION, **facts}
    text = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    entries = {"facts": text, **arrays}
    digest = np.frombuffer(_digest(entries), dtype=np.uint8)
    buffer = io.BytesIO()
    np.savez(buffer, digest=digest, **entries)  # type: ignore[arg-type]
    if path.exists() and not path.is_file():
        path.write_bytes(buffer.getbuffer())  # a device or a pipe, not to be replaced
        return
    temporary = path.with_name(f".{path.name}.{uuid.uuid4().hex}.tmp")
    try:
        with open(temporary, "xb") as stream:
            stream.write(buffer.getbuffer())
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(temporary, path)
    except OSError as error:  # name the file that the caller knows
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        temporary.unlink(missing_ok=True)  # gone already unless something failed


def read_archive(path: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Reads what `write_archive` wrote; the arrays are read-only.

    Raises:
        DecompositionFileError: if the file is damaged, foreign or of another
            version of the format.
        OSError: if the file cannot be opened.
    """
    with open(path, "rb") as stream:
        data = stream.read()
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            entries = {name: archive[name] for name in archive.files}
        digest = entries.pop("digest").tobytes()
        facts = json.loads(entries["facts"].tobytes())
        name, version = facts["format"], facts["version"]
    except Exception as error:  # damaged archives raise whatever they run into
        raise DecompositionFileError(
            f"{path}: is not a decomposition file, or is damaged "
            f"({type(error).__name__}); make it again with: drake-haptics decompose"
        ) from error
    if name != FORMAT_NAME or version != FORMAT_VERSION:
        raise DecompositionFileError(
            f"{path}: has format {name!r} version {version!r}, this program reads "
            f"version {FORMAT_VERSION}; make it again with: drake-haptics decompose"
        )
    if digest != _digest(entries):
        raise DecompositionFileError(
            f"{path}: is damaged (its content does not match its checksum); make it "
            f"again with: drake-haptics decompose"
        )
    del entries["facts"]
    for array in entries.values():
        array.flags.writeable = False
    return facts, entries


def _digest(entries: dict[str, np.ndarray]) -> bytes:
    sha = hashlib.sha256()
    for name in sorted(entries):
        sha.update(f"{name} {entries[name].dtype} {entries[name].shape}".encode())
        sha.update(np.ascontiguousarray(entries[name]).tobytes())
    return sha.digest()
