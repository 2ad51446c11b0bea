"""Exports a log as CSV."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from typing import IO

from drake_haptics.device.backend import Fault, GateState
from drake_haptics.tick_log.log_format import TickRows, iterate_column_names
from drake_haptics.tick_log.tick_log import TickLogReader

_GATES = {int(gate): gate.name.lower() for gate in GateState}
_FAULTS = {int(fault): fault.name.lower() for fault in Fault}
_SIMULATED = "simulated"


def write_csv(
    reader: TickLogReader,
    stream: IO[str],
    progress: Callable[[str, float], None] | None = None,
) -> None:
    """Writes every valid tick as a line, with units in the names of the columns.

    Numbers have as many digits as it takes to read the same doubles back. Gate and
    fault are words, those of `GateState` and `Fault`; the gate of a simulated device,
    which has none, is `simulated`. Ticks that are missing in the log are missing in the
    table, whose first column is the tick's number.

    Args:
        reader: Reader of the log, which afterwards knows what is missing.
        stream: Text stream to write to.
        progress: Function that is called with the current work and the share done, from
            0 to 1.
    """
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["tick", *iterate_column_names()])
    for rows in reader.iterate_blocks(progress):
        writer.writerows(
            [tick, *reals, *counts[:-2], gate, fault]
            for tick, reals, counts, (gate, fault) in zip(
                rows.ticks.tolist(),
                rows.reals.tolist(),
                rows.counts.tolist(),
                _tell_gates(rows),
                strict=True,
            )
        )


def _tell_gates(rows: TickRows) -> list[tuple[str | int, str | int]]:
    """Returns the names of gate and fault at each tick, or unknown numbers."""
    return [
        (
            _SIMULATED if math.isnan(time_s) and gate == 0 else _GATES.get(gate, gate),
            _FAULTS.get(fault, fault),
        )
        for time_s, gate, fault in zip(
            rows["device_time_s"].tolist(),
            rows["gate"].tolist(),
            rows["fault"].tolist(),
            strict=True,
        )
    ]
