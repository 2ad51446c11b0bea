"""Tabulates a bolt that is turned in its nut, here, in MuJoCo and in Drake's own plant.

python docs/generate/thread_table.py --write
"""

from __future__ import annotations

import sys
import time
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from page_parts import make_parser, to_markdown
from page_stamp import show_parts

sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "support"))
from degenerate_scenes import record
from thread_peers import Turning, turn_in_drake, turn_in_mujoco
from threads import CONTACTS, PITCH_M, TURNER_WAIT_S, Turner, make_thread_scene

from drake_haptics.device.backend import DeviceReading
from drake_haptics.scene.schema import ContactParameters

PAGE = Path(__file__).parents[1] / "comparison.md"
HEAD = [
    "contact",
    "behind the lead at the end, mm",
    "torque per force, to the lead's",
    "a tick of 1 ms, µs",
]
TURNS, TURNS_PER_S, REST_S = 0.5, 1.0, 0.1


class _TimedTurner(Turner):
    """The handle, which notes when it is read: once a tick."""

    def __init__(self, turns: float, turns_per_s: float):
        super().__init__(turns, turns_per_s)
        self.read_at_s: list[float] = []

    def read(self) -> DeviceReading:
        self.read_at_s.append(time.perf_counter())
        return super().read()


def turn_here(
    contact: ContactParameters,
    turns: float,
    turns_per_s: float,
    duration_s: float,
    folder: Path,
) -> Turning:
    """Turns the bolt in the loop of this package."""
    handle = _TimedTurner(turns, turns_per_s)
    shown = record(make_thread_scene(contact, folder), handle, duration_s)
    angle = np.unwrap(2 * np.arctan2(shown.X_WT[:, 3], shown.X_WT[:, 0]))
    return Turning(
        angle / (2 * np.pi),
        shown.X_WT[:, 6],
        -shown.F_Ho_W,
        float(np.median(np.diff(handle.read_at_s))),
    )


def make_row(label: str, shown: Turning) -> list[str]:
    """Returns the cells of a simulation."""
    lag_m = PITCH_M * shown.turns[-1] - (shown.z_m[-1] - shown.z_m[0])
    late = (shown.turns > TURNS / 2) & (shown.turns < 0.99 * TURNS)
    wrench = shown.F_Bo_W[late].mean(axis=0)
    share = -wrench[2] / wrench[5] / (PITCH_M / (2 * np.pi))
    return [label, f"{1e3 * lag_m:.3f}", f"{share:.2f}", f"{1e6 * shown.step_s:,.0f}"]


def main() -> None:
    """Prints the table, and writes it into the page if asked to."""
    write = make_parser(__doc__, PAGE).parse_args().write
    duration_s = TURNER_WAIT_S + TURNS / TURNS_PER_S + REST_S
    turners = {
        **{
            f"`law: {law}`": partial(turn_here, contact)
            for law, contact in CONTACTS.items()
        },
        "MuJoCo, distance fields": turn_in_mujoco,
        "Drake, hydroelastic": turn_in_drake,
    }
    rows = []
    for label, turn in turners.items():
        print(f"{label} ...", file=sys.stderr, flush=True)
        with TemporaryDirectory() as folder:
            shown = turn(TURNS, TURNS_PER_S, duration_s, Path(folder))
        rows.append(make_row(label, shown))
    table = to_markdown([HEAD, *rows])
    show_parts(PAGE, {"thread": table}, __file__, write)


if __name__ == "__main__":
    main()
