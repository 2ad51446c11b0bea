"""A log as a table that any program reads."""

from __future__ import annotations

import csv
from collections.abc import Callable
from typing import IO

from drake_haptics.tick_log.tick_log import TickLogReader
from drake_haptics.tick_log.tick_rows import iterate_column_names


def write_csv(
    reader: TickLogReader,
    stream: IO[str],
    progress: Callable[[str, float], None] | None = None,
) -> None:
    """Writes every sound tick as a line, with units in the names of the columns.

    Numbers are written with as many digits as it takes to get the same double back.
    Ticks that are missing in the log are missing here: the first column is the
    tick's number.

    Args:
        reader: Of the log; afterwards it knows what is missing.
        stream: To write to, of text.
        progress: Called with what is done and its share, in [0, 1].
    """
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["tick", *iterate_column_names()])
    for rows in reader.iterate_blocks(progress):
        writer.writerows(
            [tick, *reals, *counts]
            for tick, reals, counts in zip(
                rows.ticks.tolist(),
                rows.reals.tolist(),
                rows.counts.tolist(),
                strict=True,
            )
        )
