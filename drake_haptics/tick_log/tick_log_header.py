"""What stands at the head of a log: of what, with what, and on which meshes."""

from __future__ import annotations

import json
import math
import struct
import zlib
from dataclasses import asdict, dataclass, fields
from typing import BinaryIO

from drake_haptics.common.one_line import one_line
from drake_haptics.tick_log.tick_log_error import TickLogError

FILE_MAGIC = b"\x89DHLOG\r\n"
FORMAT_VERSION = 1

_FIXED = struct.Struct("<8sHHI")
_CRC = struct.Struct("<I")
_MAX_JSON_BYTES = 1 << 24


@dataclass(frozen=True)
class TickLogHeader:
    """What was recorded.

    Attributes:
        program_version: Of drake_haptics.
        period_s: The tick, s.
        scene: The scene file, YAML, with mesh paths that hold from any folder.
        mesh_sha256: SHA-256 (hex) of each mesh file of the scene by its path.
        X_WB: (7) where the device's base stood, [qw qx qy qz x y z], m.
    """

    program_version: str
    period_s: float
    scene: str
    mesh_sha256: dict[str, str]
    X_WB: list[float]

    __repr__ = one_line


def pack_header(header: TickLogHeader) -> bytes:
    """Returns the first bytes of a log."""
    text = json.dumps(asdict(header)).encode()
    head = _FIXED.pack(FILE_MAGIC, FORMAT_VERSION, 0, len(text)) + text
    return head + _CRC.pack(zlib.crc32(head))


def read_header(stream: BinaryIO, name: str) -> TickLogHeader:
    """Reads the head of a log; the stream is then at the first block.

    Args:
        stream: At its start.
        name: Of the file, for messages.

    Raises:
        TickLogError: It is no log, of another version, or damaged.
    """
    head = stream.read(_FIXED.size)
    if len(head) < _FIXED.size or not head.startswith(FILE_MAGIC):
        raise TickLogError(
            f"{name}: is not a tick log; record one with: drake-haptics run SCENE"
            " --log FILE"
        )
    _, version, _, length = _FIXED.unpack(head)
    if version != FORMAT_VERSION:
        raise TickLogError(
            f"{name}: has format version {version}, this program reads version"
            f" {FORMAT_VERSION}; read it with the drake_haptics that wrote it"
        )
    text = stream.read(min(length, _MAX_JSON_BYTES))
    crc = stream.read(_CRC.size)
    if _CRC.pack(zlib.crc32(head + text)) != crc:
        raise TickLogError(
            f"{name}: its head is damaged or was never finished, so that nothing says"
            " what was recorded; record again"
        )
    try:
        return _parse(json.loads(text))
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise TickLogError(
            f"{name}: its head does not say what version {FORMAT_VERSION} has to:"
            f" {error}; record again"
        ) from error


def _parse(facts: object) -> TickLogHeader:
    """Returns what JSON says.

    Raises:
        ValueError: It does not say it all, or in another way.
    """
    names = {field.name for field in fields(TickLogHeader)}
    if not isinstance(facts, dict) or not names <= facts.keys():
        raise ValueError(f"it needs {', '.join(sorted(names))}")
    header = TickLogHeader(**{name: facts[name] for name in names})
    texts = [header.program_version, header.scene]
    if not isinstance(header.mesh_sha256, dict) or not isinstance(header.X_WB, list):
        raise ValueError("mesh_sha256 is no object or X_WB no list")
    texts += [*header.mesh_sha256, *header.mesh_sha256.values()]
    numbers = [header.period_s, *header.X_WB]
    if not all(isinstance(text, str) for text in texts):
        raise ValueError("a text is none")
    if not all(isinstance(x, float) and math.isfinite(x) for x in numbers):
        raise ValueError("a number is not a finite one with a decimal point")
    if len(header.X_WB) != 7 or header.period_s <= 0.0:
        raise ValueError("X_WB has 7 numbers, and period_s is positive")
    return header
