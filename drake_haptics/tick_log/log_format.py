"""Defines the format of a log: its header, the columns of a tick, and its blocks.

A block contains some hundred packed ticks and can be read separately.
docs/record-replay.md documents the layout.
"""

from __future__ import annotations

import hashlib
import json
import math
import struct
import zlib
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from itertools import accumulate
from pathlib import Path
from typing import BinaryIO

import numpy as np

from drake_haptics.common.errors import HapticsError
from drake_haptics.common.one_line import one_line


class TickLogError(HapticsError):
    """A log cannot be written, read or replayed; the message says what to do."""


FILE_MAGIC = b"\x89DHLOG\r\n"
FORMAT_VERSION = 1

_FILE_HEAD = struct.Struct("<8sHHI")
_CRC = struct.Struct("<I")
_MAX_JSON_BYTES = 1 << 24
# That of a device's readings.
QUATERNION_TOLERANCE = 1e-3


@dataclass(frozen=True)
class TickLogHeader:
    """The header of a log, which says what was recorded.

    Attributes:
        program_version: Version of drake_haptics.
        period_s: The tick, s.
        scene: The scene file, YAML, with absolute mesh paths.
        mesh_sha256: SHA-256 (hex) of each mesh file of the scene by its path.
        X_WB: (7,) pose of the device's base, [qw qx qy qz x y z], m.
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
    head = _FILE_HEAD.pack(FILE_MAGIC, FORMAT_VERSION, 0, len(text)) + text
    return head + _CRC.pack(zlib.crc32(head))


def read_header(stream: BinaryIO, name: str) -> TickLogHeader:
    """Reads the header of a log; the stream is then at the first block.

    Raises:
        TickLogError: The file is not a log, of another version, or damaged.
    """
    head = stream.read(_FILE_HEAD.size)
    if len(head) < _FILE_HEAD.size or not head.startswith(FILE_MAGIC):
        raise TickLogError(
            f"{name}: is not a tick log; record one with: drake-haptics run SCENE"
            " --log FILE"
        )
    _, version, _, length = _FILE_HEAD.unpack(head)
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
        return _parse_header(json.loads(text))
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise TickLogError(
            f"{name}: its head does not say what version {FORMAT_VERSION} has to:"
            f" {error}; record again"
        ) from error


def _parse_header(facts: object) -> TickLogHeader:
    """Returns the header from JSON data.

    Raises:
        ValueError: A part is missing or invalid.
    """
    names = {field.name for field in fields(TickLogHeader)}
    if not isinstance(facts, dict) or not names <= facts.keys():
        raise ValueError(f"it needs {', '.join(sorted(names))}")
    header = TickLogHeader(**{name: facts[name] for name in names})
    texts = [header.program_version, header.scene]
    if not isinstance(header.mesh_sha256, dict) or not isinstance(header.X_WB, list):
        raise ValueError("mesh_sha256 is not an object, or X_WB is not a list")
    texts += [*header.mesh_sha256, *header.mesh_sha256.values()]
    numbers = [header.period_s, *header.X_WB]
    if not all(isinstance(text, str) for text in texts):
        raise ValueError("a version, a scene or a mesh is not text")
    if not all(isinstance(x, float) and math.isfinite(x) for x in numbers):
        raise ValueError("a number is not a finite one with a decimal point")
    length = math.hypot(*header.X_WB[:4])
    is_pose = len(header.X_WB) == 7 and abs(length - 1.0) <= QUATERNION_TOLERANCE
    if not is_pose or header.period_s <= 0.0:
        raise ValueError("X_WB is a pose of 7 numbers, and period_s is positive")
    return header


_READ_BYTES = 1 << 20


def hash_file(path: str) -> str:
    """Returns the SHA-256 of a file, in hexadecimal digits.

    Raises:
        OSError: The file cannot be read.
    """
    sha = hashlib.sha256()
    with open(path, "rb") as stream:
        while data := stream.read(_READ_BYTES):
            sha.update(data)
    return sha.hexdigest()


def find_changed_meshes(header: TickLogHeader) -> list[str]:
    """Returns the mesh files that are gone or have changed since the recording."""

    def is_same(path: str, sha256: str) -> bool:
        try:
            # A forged path may name a device, which never ends, or not be a path at
            # all.
            return Path(path).is_file() and hash_file(path) == sha256
        except (OSError, ValueError):
            return False

    return [path for path, sha in header.mesh_sha256.items() if not is_same(path, sha)]


POSE = ("qw", "qx", "qy", "qz", "x_m", "y_m", "z_m")
VELOCITY = (
    *("wx_rad_per_s", "wy_rad_per_s", "wz_rad_per_s"),
    *("vx_m_per_s", "vy_m_per_s", "vz_m_per_s"),
)
WRENCH = ("taux_Nm", "tauy_Nm", "tauz_Nm", "fx_N", "fy_N", "fz_N")

# The quantities of a tick that are doubles, with the names of their numbers, in the
# order of format version 1.
REALS: dict[str, tuple[str, ...]] = {
    "time_s": ("",),
    "clock_s": ("",),
    "query_s": ("",),
    "device_time_s": ("",),
    "distance_m": ("",),
    "X_WH": POSE,
    "V_WH": VELOCITY,
    "F_Ho_W_commanded": WRENCH,
    "F_Ho_W_rendered": WRENCH,
    "X_WT": POSE,
    "V_WT": VELOCITY,
}
# The quantities that are unsigned 32-bit integers.
COUNTS = ("contacts", "clusters", "status", "sequence", "buttons", "gate", "fault")

NUM_REALS = sum(map(len, REALS.values()))
# Index of the first vector that is a signal of the loop.
FIRST_SIGNAL = 5
SIGNALS = tuple(REALS)[FIRST_SIGNAL:]
# Quantities that depend on the computer and its load, so that every run differs.
CLOCK_QUANTITIES = ("clock_s", "query_s", "device_time_s")
# Quantities of a device besides its handle, which a replay does not have.
DEVICE_QUANTITIES = ("sequence", "buttons", "gate", "fault")


_ENDS = accumulate(map(len, REALS.values()))
SLICES = {
    name: slice(end - len(numbers), end)
    for (name, numbers), end in zip(REALS.items(), _ENDS, strict=True)
}


@dataclass(frozen=True, eq=False)
class TickRows:
    """Ticks of a log, one row each.

    A row has the values that the updates of its tick saw, all at the same instant
    before the tick changes anything.

    Attributes:
        ticks: (n,) int64, increasing numbers of the ticks, from 0.
        reals: (n, 43) doubles, the concatenated quantities of `REALS`.
        counts: (n, 7) uint32, the quantities of `COUNTS`.
    """

    ticks: np.ndarray
    reals: np.ndarray
    counts: np.ndarray

    __repr__ = one_line

    def __len__(self) -> int:
        """Returns the number of ticks."""
        return len(self.ticks)

    def __getitem__(self, quantity: str) -> np.ndarray:
        """Returns a quantity: (n,) if it is one number, else (n, numbers).

        Raises:
            KeyError: No quantity has that name.
        """
        if quantity in COUNTS:
            return self.counts[:, COUNTS.index(quantity)]
        values = self.reals[:, SLICES[quantity]]
        return values[:, 0] if len(REALS[quantity]) == 1 else values


def iterate_column_names() -> Iterator[str]:
    """Yields the name, with a unit, of each number of a row, in order."""
    for quantity, numbers in REALS.items():
        for number in numbers:
            yield f"{quantity}_{number}" if number else quantity
    yield from COUNTS


def join_rows(parts: list[TickRows]) -> TickRows:
    """Returns consecutive rows as one."""
    if not parts:
        return TickRows(
            np.zeros(0, np.int64),
            np.zeros((0, NUM_REALS)),
            np.zeros((0, len(COUNTS)), np.uint32),
        )
    return TickRows(
        *(
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("ticks", "reals", "counts")
        )
    )


BLOCK_MAGIC = b"\x89DHBLK\r\n"
# Common to `FILE_MAGIC` and `BLOCK_MAGIC`.
MAGIC_START = b"\x89DH"
MAX_BLOCK_TICKS = 256
MAX_TICK = 1 << 48

_BLOCK_HEAD = struct.Struct("<8sQIII")
BLOCK_HEADER_BYTES = _BLOCK_HEAD.size + _CRC.size
_ROW_BYTES = 8 * NUM_REALS + 4 * len(COUNTS)
# Largest number of bytes that zlib adds to incompressible data.
_MAX_PAYLOAD_BYTES = MAX_BLOCK_TICKS * _ROW_BYTES + 4096


@dataclass(frozen=True)
class BlockHeader:
    """The header before a block's payload.

    Attributes:
        first_tick: Number of the first tick; in the end mark, the total number of
            ticks.
        ticks: Number of ticks in the block; 0 in the end mark of a complete log.
        payload_bytes: Length of the packed ticks.
        payload_crc: CRC-32 of the packed ticks.
    """

    first_tick: int
    ticks: int
    payload_bytes: int
    payload_crc: int


def pack_block(first_tick: int, reals: np.ndarray, counts: np.ndarray) -> bytes:
    """Returns a block, or the end mark if there are no ticks.

    Args:
        first_tick: Number of the first tick, as in `BlockHeader`.
        reals: (n, 43) doubles, as in `TickRows`.
        counts: (n, 7) uint32, as in `TickRows`.
    """
    payload = b""
    if len(reals):
        raw = _shuffle(reals, "<u8") + _shuffle(counts, "<u4")
        payload = zlib.compress(raw, 1)
    head = _BLOCK_HEAD.pack(
        BLOCK_MAGIC, first_tick, len(reals), len(payload), zlib.crc32(payload)
    )
    return head + _CRC.pack(zlib.crc32(head)) + payload


def parse_block_header(data: bytes) -> BlockHeader | None:
    """Returns a block's header; None if the bytes are not a valid one.

    Its lengths are within bounds, so that they can be trusted.
    """
    if len(data) < BLOCK_HEADER_BYTES:
        return None
    head = data[: _BLOCK_HEAD.size]
    (crc,) = _CRC.unpack_from(data, _BLOCK_HEAD.size)
    magic, *fields = _BLOCK_HEAD.unpack(head)
    header = BlockHeader(*fields)
    if (
        magic != BLOCK_MAGIC
        or crc != zlib.crc32(head)
        or header.first_tick + header.ticks > MAX_TICK
        or header.ticks > MAX_BLOCK_TICKS
        or header.payload_bytes > _MAX_PAYLOAD_BYTES
        or (header.ticks == 0) != (header.payload_bytes == 0)
    ):
        return None
    return header


def unpack_block(header: BlockHeader, payload: bytes) -> TickRows | None:
    """Returns the ticks of a block; None if the payload is damaged."""
    if header.ticks == 0:
        return join_rows([])
    if zlib.crc32(payload) != header.payload_crc:
        return None
    n = header.ticks
    unpacker = zlib.decompressobj()
    try:
        # One byte more than allowed, so that a longer stream is detected.
        raw = unpacker.decompress(payload, n * _ROW_BYTES + 1)
    except zlib.error:
        return None
    if len(raw) != n * _ROW_BYTES or not unpacker.eof or unpacker.unused_data:
        return None
    end = 8 * n * NUM_REALS
    return TickRows(
        np.arange(header.first_tick, header.first_tick + n, dtype=np.int64),
        _unshuffle(raw[:end], n, "<u8").view("<f8"),
        _unshuffle(raw[end:], n, "<u4"),
    )


def _shuffle(values: np.ndarray, word: str) -> bytes:
    """Returns differences of columns of smooth numbers, with like bytes together.

    Neighbors in time share sign, exponent and leading bits, so that these bytes of the
    difference of their bit patterns are zero.
    """
    bits = np.ascontiguousarray(values).view(word)
    steps = np.diff(bits, axis=0, prepend=np.zeros((1, bits.shape[1]), word))
    planes = steps.view(np.uint8).reshape(*bits.shape, -1)
    return planes.transpose(1, 2, 0).tobytes()


def _unshuffle(raw: bytes, ticks: int, word: str) -> np.ndarray:
    """Returns the bit patterns (ticks, columns) from the bytes of `_shuffle`."""
    size = np.dtype(word).itemsize
    planes = np.frombuffer(raw, np.uint8).reshape(-1, size, ticks)
    steps = np.ascontiguousarray(planes.transpose(2, 0, 1)).view(word)[..., 0]
    return np.cumsum(steps, axis=0, dtype=word)
