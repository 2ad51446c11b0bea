"""A block of a log: some hundreds of ticks, packed, that can be read alone.

The layout is documented in docs/record-replay.md.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass

import numpy as np

from drake_haptics.tick_log.tick_rows import COUNTS, NUM_REALS, TickRows

BLOCK_MAGIC = b"\x89DHBLK\r\n"
MAX_BLOCK_TICKS = 256
MAX_TICK = 1 << 48

_HEADER = struct.Struct("<8sQIII")
_CRC = struct.Struct("<I")
BLOCK_HEADER_BYTES = _HEADER.size + _CRC.size
_ROW_BYTES = 8 * NUM_REALS + 4 * len(COUNTS)
# What zlib makes of bytes that it cannot shorten is longer by less than this.
_MAX_PAYLOAD_BYTES = MAX_BLOCK_TICKS * _ROW_BYTES + 4096


@dataclass(frozen=True)
class BlockHeader:
    """What comes before a block's payload.

    Attributes:
        first_tick: Number of its first tick. Of the end mark: how many ticks there
            were.
        ticks: How many it has; none in the mark that ends a complete log.
        payload_bytes: How long the packed ticks are.
        payload_crc: Their CRC-32.
    """

    first_tick: int
    ticks: int
    payload_bytes: int
    payload_crc: int


def pack_block(first_tick: int, reals: np.ndarray, counts: np.ndarray) -> bytes:
    """Returns a block, or the end mark if there are no ticks.

    Args:
        first_tick: As in `BlockHeader`.
        reals: (n, 43) doubles.
        counts: (n, 7) uint32.
    """
    payload = b""
    if len(reals):
        raw = _shuffle(reals, "<u8") + _shuffle(counts, "<u4")
        payload = zlib.compress(raw, 1)
    head = _HEADER.pack(
        BLOCK_MAGIC, first_tick, len(reals), len(payload), zlib.crc32(payload)
    )
    return head + _CRC.pack(zlib.crc32(head)) + payload


def parse_block_header(data: bytes) -> BlockHeader | None:
    """Returns a block's header; None if these bytes are not a sound one.

    What it says of lengths is within bounds, so that it can be believed.
    """
    if len(data) < BLOCK_HEADER_BYTES:
        return None
    head = data[: _HEADER.size]
    (crc,) = _CRC.unpack_from(data, _HEADER.size)
    magic, *fields = _HEADER.unpack(head)
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
    """Returns the ticks of a block; None if the payload is not what was packed."""
    if zlib.crc32(payload) != header.payload_crc:
        return None
    n = header.ticks
    unpacker = zlib.decompressobj()
    try:
        # One byte more than there may be: a longer stream does not pass for whole.
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
    """Returns what is left of columns of smooth numbers, like bytes together.

    Neighbors in time share sign, exponent and leading bits: of the difference of
    their bit patterns these bytes are zero.
    """
    bits = np.ascontiguousarray(values).view(word)
    steps = np.diff(bits, axis=0, prepend=np.zeros((1, bits.shape[1]), word))
    planes = steps.view(np.uint8).reshape(*bits.shape, -1)
    return planes.transpose(1, 2, 0).tobytes()


def _unshuffle(raw: bytes, ticks: int, word: str) -> np.ndarray:
    """Returns the bit patterns (ticks, columns) that `_shuffle` made these bytes of."""
    size = np.dtype(word).itemsize
    planes = np.frombuffer(raw, np.uint8).reshape(-1, size, ticks)
    steps = np.ascontiguousarray(planes.transpose(2, 0, 1)).view(word)[..., 0]
    return np.cumsum(steps, axis=0, dtype=word)
