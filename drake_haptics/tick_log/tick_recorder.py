"""Writes a log while a loop runs, without waiting for the disk."""

from __future__ import annotations

import io
import os
import threading
import time
from collections import deque
from pathlib import Path
from typing import BinaryIO

import numpy as np

from drake_haptics.common.one_line import count
from drake_haptics.tick_log.log_format import (
    COUNTS,
    FIRST_SIGNAL,
    MAX_BLOCK_TICKS,
    NUM_REALS,
    TickLogError,
    TickLogHeader,
    pack_block,
    pack_header,
)

# Time between writes, s.
_WRITE_PERIOD_S = 0.25
_CHUNK_TICKS = 1024
# Largest number of ticks that wait for a slow disk: 100 MB, four minutes at 1 kHz.
_MAX_CHUNKS = 256


class _Chunk:
    """A buffer for about a second of ticks, whose rows below `filled` are final."""

    def __init__(self, first_tick: int):
        self.first_tick = first_tick
        self.reals = np.zeros((_CHUNK_TICKS, NUM_REALS))
        self.counts = np.zeros((_CHUNK_TICKS, len(COUNTS)), np.uint32)
        self.filled = 0


def _create(path: Path, head: bytes) -> BinaryIO:
    """Returns a new file that begins with these bytes.

    Raises:
        OSError: The file cannot be created; the error names it.
    """
    stream = open(path, "wb", buffering=0)
    try:
        stream.write(head)
    except OSError as error:
        stream.close()
        raise OSError(error.errno, error.strerror, str(path)) from error
    return io.BufferedWriter(stream)


class TickRecorder:
    """A log that is being written.

    A thread packs and writes what `add` has recorded four times per second, so that a
    killed process loses less than the last second. (A loss of power may lose more.)

    If the disk fails, or falls behind by some minutes, ticks are left out and `close`
    says so, but the loop continues. Use it as a context manager; only a closed log has
    the end mark of a complete one.
    """

    def __init__(self, path: str | os.PathLike[str], header: TickLogHeader):
        """Creates the file, replacing an existing one, and writes the header.

        Args:
            path: The file.
            header: Header of the log.

        Raises:
            OSError: The file cannot be created.
        """
        self._path = Path(path)
        self._period_s = header.period_s
        self._stream = _create(self._path, pack_header(header))
        self._start_s = time.perf_counter()
        self._ticks = 0
        self._left_out = 0
        self._chunk = _Chunk(0)
        # The last one is being filled; the writer takes the first one.
        self._chunks = deque([self._chunk])
        self._written = 0
        self._error: OSError | None = None
        self._stop = threading.Event()
        self._thread = threading.Thread(
            target=self._write_all, name="tick_recorder", daemon=True
        )
        self._thread.start()

    @property
    def period_s(self) -> float:
        """The tick of the header, s."""
        return self._period_s

    @property
    def ticks(self) -> int:
        """Number of ticks so far."""
        return self._ticks

    def __repr__(self) -> str:
        return f"TickRecorder({str(self._path)!r}, {count(self._ticks, 'tick')} noted)"

    def add(
        self,
        time_s: float,
        signals: np.ndarray,
        counts: tuple[int, ...],
        *,
        query_s: float,
        distance_m: float,
        device_time_s: float,
    ) -> None:
        """Records a tick in some microseconds, without waiting.

        Args:
            time_s: Time of the simulation, s.
            signals: (38,) the quantities of `REALS` from `X_WH` to `V_WT`.
            counts: The quantities of `COUNTS`, in [0, 2³²).
            query_s: Duration of the contact query, s.
            distance_m: Distance of the nearest contact, m; infinite without one.
            device_time_s: Time of the device's clock, s; NaN if it is simulated.

        Raises:
            ValueError: The log is closed.
        """
        if self._stop.is_set():
            raise ValueError(
                f"the log {self._path} is closed: simulate before the recorder's `with`"
                " ends"
            )
        tick = self._ticks
        self._ticks = tick + 1
        chunk = self._chunk
        i = chunk.filled
        if i == _CHUNK_TICKS:
            if len(self._chunks) >= _MAX_CHUNKS:
                self._left_out += 1
                return
            chunk, i = _Chunk(tick), 0
            self._chunk = chunk
            self._chunks.append(chunk)
        clock_s = time.perf_counter() - self._start_s
        row = chunk.reals[i]
        row[:FIRST_SIGNAL] = (time_s, clock_s, query_s, device_time_s, distance_m)
        row[FIRST_SIGNAL:] = signals
        chunk.counts[i] = counts
        # Last, because the writer may take the row from here on.
        chunk.filled = i + 1

    def close(self) -> None:
        """Writes the rest and the end mark; may be called again.

        Raises:
            TickLogError: The log is not complete; the message says what is missing.
        """
        if self._stream.closed:
            return
        self._stop.set()
        self._thread.join()
        try:
            self._stream.close()
        except OSError as error:  # writing still fails
            self._error = self._error or error
        if self._error is not None:
            raise TickLogError(
                f"{self._path}: the log ends early, the system refused to write on:"
                f" {self._error.strerror}; make room and record again"
            ) from self._error
        if self._left_out:
            raise TickLogError(
                f"{self._path}: {count(self._left_out, 'tick is', 'ticks are')} missing"
                " in the log, the disk was too slow; record to a faster one"
            )

    def __enter__(self) -> TickRecorder:
        """Returns the recorder."""
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        """Closes the log; an error in the context hides one from closing."""
        try:
            self.close()
        except TickLogError:
            if kind is None:
                raise

    def _write_all(self) -> None:
        """Writes until told to stop; runs in the thread."""
        stopped = False
        try:
            while not stopped:
                stopped = self._stop.wait(_WRITE_PERIOD_S)
                self._write_noted()
            nothing = self._chunk.reals[:0], self._chunk.counts[:0]
            self._stream.write(pack_block(self._ticks, *nothing))
            self._stream.flush()
        except OSError as error:
            self._error = error

    def _write_noted(self) -> None:
        """Writes what has been recorded since the last time."""
        while True:
            chunk = self._chunks[0]
            filled = chunk.filled
            while self._written < filled:
                # In small blocks, because packing one holds the interpreter for some 30
                # µs; compressing does not.
                rows = slice(
                    self._written, min(filled, self._written + MAX_BLOCK_TICKS)
                )
                self._stream.write(
                    pack_block(
                        chunk.first_tick + self._written,
                        chunk.reals[rows],
                        chunk.counts[rows],
                    )
                )
                self._written = rows.stop
            if filled < _CHUNK_TICKS or len(self._chunks) == 1:
                self._stream.flush()
                return
            self._chunks.popleft()
            self._written = 0
