"""Goes through a log block by block, whatever has become of the file."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO

from drake_haptics.tick_log.tick_block import (
    BLOCK_HEADER_BYTES,
    BLOCK_MAGIC,
    BlockHeader,
    parse_block_header,
    unpack_block,
)
from drake_haptics.tick_log.tick_rows import TickRows

_SEARCHED_BYTES = 1 << 20


@dataclass(frozen=True)
class Damage:
    """Bytes of a log that are no block, or not the one that follows.

    Attributes:
        offset_bytes: Where they start in the file.
    """

    offset_bytes: int


@dataclass(frozen=True)
class EndMark:
    """The end of a complete log.

    Attributes:
        ticks: How many there were.
    """

    ticks: int


def scan_blocks(stream: BinaryIO) -> Iterator[TickRows | Damage | EndMark]:
    """Yields what a log holds, from where its stream is to its end.

    Of a damaged block nothing is yielded but the damage; the search goes on at the next
    one that is sound. Ticks rise from block to block: one that comes again counts as
    damage. It never reads more at once than the largest block takes.

    Args:
        stream: Of the file, after its head; can seek.
    """
    size = os.fstat(stream.fileno()).st_size
    position, next_tick = stream.tell(), 0
    while position < size:
        stream.seek(position)
        header = parse_block_header(stream.read(BLOCK_HEADER_BYTES))
        if header is not None and header.first_tick >= next_tick:
            if header.ticks == 0:
                yield EndMark(header.first_tick)
                return
            rows = _read_rows(stream, header)
            if rows is not None:
                yield rows
                next_tick = header.first_tick + header.ticks
                position += BLOCK_HEADER_BYTES + header.payload_bytes
                continue
        yield Damage(position)
        position = _find_block_header(stream, position + 1, size)


def _read_rows(stream: BinaryIO, header: BlockHeader) -> TickRows | None:
    """Returns the ticks of a block whose payload comes next; None if damaged."""
    payload = stream.read(header.payload_bytes)
    if len(payload) < header.payload_bytes:
        return None
    return unpack_block(header, payload)


def _find_block_header(stream: BinaryIO, start: int, size: int) -> int:
    """Returns where the next sound header is, at `start` or later; `size` if none."""
    stream.seek(start)
    window = b""
    while data := stream.read(_SEARCHED_BYTES):
        window += data
        found = window.find(BLOCK_MAGIC)
        while found >= 0:
            if parse_block_header(window[found : found + BLOCK_HEADER_BYTES]):
                return start + found
            found = window.find(BLOCK_MAGIC, found + 1)
        # A header may begin in one window and end in the next.
        kept = window[-(BLOCK_HEADER_BYTES - 1) :]
        start += len(window) - len(kept)
        window = kept
    return size
