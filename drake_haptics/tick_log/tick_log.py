"""Reads a log, whole or block by block, and finds what is missing."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from drake_haptics.common.one_line import count
from drake_haptics.tick_log.log_format import (
    BLOCK_HEADER_BYTES,
    FILE_MAGIC,
    MAGIC_START,
    QUATERNION_TOLERANCE,
    TickLogError,
    TickLogHeader,
    TickRows,
    join_rows,
    parse_block_header,
    read_header,
    unpack_block,
)

_SEARCHED_BYTES = 1 << 20


def _find_header(stream: BinaryIO, start: int, size: int) -> int:
    """Returns the offset of the next valid block's header, or log's; `size` if none."""
    stream.seek(start)
    window = b""
    while data := stream.read(_SEARCHED_BYTES):
        window += data
        found = window.find(MAGIC_START)
        while found >= 0:
            head = window[found : found + BLOCK_HEADER_BYTES]
            if head.startswith(FILE_MAGIC) or parse_block_header(head):
                return start + found
            found = window.find(MAGIC_START, found + 1)
        # A header may begin in one window and end in the next.
        kept = window[-(BLOCK_HEADER_BYTES - 1) :]
        start += len(window) - len(kept)
        window = kept
    return size


# Step of the reported progress, since a block takes less time than a report.
_REPORTED_SHARE = 0.01


@dataclass(frozen=True)
class Gap:
    """Ticks that are missing in a log.

    Attributes:
        first_tick: Number of the first missing tick.
        ticks: Number of missing ticks; None where it is unknown.
    """

    first_tick: int
    ticks: int | None

    def describe(self, period_s: float) -> str:
        """Returns a sentence."""
        where = f"from tick {self.first_tick} ({self.first_tick * period_s:.3f} s)"
        if self.ticks is None:
            return f"the log ends without its end mark: what came {where} on is missing"
        return f"{count(self.ticks, 'tick is', 'ticks are')} missing {where}"


@dataclass(frozen=True, eq=False)
class TickLog:
    """A recorded run.

    Attributes:
        header: Header of the log.
        rows: All valid ticks, in order.
        gaps: Gaps of the log, in order.
        damaged_blocks: Number of places in the file that could not be read.
    """

    header: TickLogHeader
    rows: TickRows
    gaps: tuple[Gap, ...]
    damaged_blocks: int

    def __repr__(self) -> str:
        ticks = count(len(self.rows), "tick")
        period_ms = 1e3 * self.header.period_s
        return f"TickLog({ticks} of {period_ms:g} ms, {count(len(self.gaps), 'gap')})"

    def describe_gaps(self) -> list[str]:
        """Returns a sentence for each gap."""
        return [gap.describe(self.header.period_s) for gap in self.gaps]

    def count_ticks_from_start(self) -> int:
        """Returns the number of ticks from the start to the first gap."""
        return self.gaps[0].first_tick if self.gaps else len(self.rows)

    def check_replayable(self) -> None:
        """Checks that a replay has poses to start from and to follow.

        A handle that is NaN passes: it was lost, and ends a replay at its tick.

        Raises:
            TickLogError: There is no first tick, or a pose has no unit quaternion.
        """
        ticks = self.count_ticks_from_start()
        if not ticks:
            raise TickLogError("the log has no first tick to start from; record again")
        for name, end in (("X_WT", 1), ("X_WH", ticks)):
            lengths = np.linalg.norm(self.rows[name][:end, :4], axis=1)
            wrong = np.flatnonzero(abs(lengths - 1.0) > QUATERNION_TOLERANCE)
            if len(wrong):
                raise TickLogError(
                    f"{name} of tick {wrong[0]} has no unit quaternion; record again"
                )


class TickLogReader:
    """Reads a log block by block, so that it need not fit into memory.

    Attributes:
        header: Header of the log.
        gaps: Gaps in the part that has been read so far.
        damaged_blocks: Number of places so far that could not be read.
    """

    def __init__(self, path: str | os.PathLike[str]):
        """Reads the header.

        Raises:
            TickLogError: It is no log, of another version, or its head is damaged.
            OSError: It cannot be opened.
        """
        self._path = Path(path)
        self.gaps: list[Gap] = []
        self.damaged_blocks = 0
        with open(self._path, "rb") as stream:
            self.header = read_header(stream, str(self._path))
            self._first_block = stream.tell()

    def iterate_blocks(
        self, progress: Callable[[str, float], None] | None = None
    ) -> Iterator[TickRows]:
        """Yields the ticks of every valid block, in order.

        A damaged block is left out; reading continues at the next valid one. Ticks
        increase from block to block; a repeated tick counts as damage. The head of
        another log ends this one. At most the largest block is read at once.

        After the last one, `gaps` and `damaged_blocks` are complete.
        """
        self.gaps, self.damaged_blocks = [], 0
        next_tick, next_share = 0, 0.0
        with open(self._path, "rb") as stream:
            size, position = os.fstat(stream.fileno()).st_size, self._first_block
            while position < size:
                stream.seek(position)
                head = stream.read(BLOCK_HEADER_BYTES)
                if head.startswith(FILE_MAGIC):
                    break
                header, rows = parse_block_header(head), None
                if header is not None and header.first_tick >= next_tick:
                    rows = unpack_block(header, stream.read(header.payload_bytes))
                if header is None or rows is None:
                    self.damaged_blocks += 1
                    position = _find_header(stream, position + 1, size)
                    continue
                if header.first_tick > next_tick:
                    missing = header.first_tick - next_tick
                    self.gaps.append(Gap(next_tick, missing))
                if header.ticks == 0:
                    return
                position += BLOCK_HEADER_BYTES + header.payload_bytes
                # A log that is still being written grows meanwhile.
                share = min(1.0, position / size)
                if progress is not None and share >= next_share:
                    progress("Reading", share)
                    next_share = share + _REPORTED_SHARE
                yield rows
                next_tick = header.first_tick + header.ticks
        self.gaps.append(Gap(next_tick, None))


def read_tick_log(
    path: str | os.PathLike[str], progress: Callable[[str, float], None] | None = None
) -> TickLog:
    """Reads a whole log.

    It takes 400 bytes of memory per tick, 1.4 GB for an hour at 1 kHz, and twice that
    while reading. `TickLogReader` reads block by block.

    Args:
        path: Path of the file. It may be truncated or damaged, or still be written.
        progress: Function that is called with the current work and the share done, from
            0 to 1.

    Raises:
        TickLogError: It is no log, of another version, or its head is damaged.
        OSError: It cannot be opened.
    """
    reader = TickLogReader(path)
    rows = join_rows(list(reader.iterate_blocks(progress)))
    return TickLog(reader.header, rows, tuple(reader.gaps), reader.damaged_blocks)
