"""Represents the times and motions of loops, and makes their tables."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.report.page import Table

# Suffix of the name of a loop whose ticks wait for the clock.
PACED = ", paced"
BACKEND = "drake_haptics, your own backend"
PLANT = "drake_haptics, your own plant"
SCENE = "drake_haptics, simulated device"
OURS = "drake_haptics, whole tick"
NATIVE = "drake_haptics, native part"
# Bushing and point contact. Name -> contact solver of Drake.
STOCK = {"Drake, bushing, TAMSI": "tamsi", "Drake, bushing, SAP": "similar"}
MUJOCO = "MuJoCo, mj_step"
EMPTY = "Drake, one empty Python system"
# Description of the work of each loop in a tick.
_COMPUTES = (
    "drake_haptics: every pair within the tolerance with its exact depth, stiffness "
    "shared among contacts, an implicit step of tool, contact and coupling; its native "
    "part is the same in the core alone, without device, Drake and Python. Drake: "
    "penetrating pairs, an implicit contact, and a bushing taken at the beginning of "
    "the step, for which its rotational damping had to be less. MuJoCo: penetrating "
    "pairs, soft constraints with the same stiffness and damping where the whole mass "
    "of the tool moves; timed in C. In Drake's and MuJoCo's the handle is moved "
    "between two ticks, which is not timed."
)


@dataclass(frozen=True)
class LoopFigures:
    """The times of one loop, such as `OURS`, and its motion.

    Attributes:
        in_contact: Times of the ticks at which all loops have a contact.
        all_ticks: Times of all ticks but the first, which starts cold.
        median_contacts: Pairs of pieces that push, over the ticks in contact.
        max_contacts: Most pairs of pieces that push at a tick.
        deepest_m: Largest penetration of a pair of pieces, m.
        force_N: Median force of the spring between handle and tool, in contact, N.
        max_force_N: Largest force of this spring, N.
        apart_m: Median distance of the tool from this package's, m. It and the three
            before it are NaN if there is no tool.
    """

    scene: str
    loop: str
    in_contact: TickTimes
    all_ticks: TickTimes
    median_contacts: float
    max_contacts: int
    deepest_m: float
    force_N: float
    max_force_N: float
    apart_m: float


def loop_tables(figures: Sequence[LoopFigures]) -> list[Table]:
    """Returns tables of the loops' times and motions, scene by scene."""
    tables = []
    for scene in dict.fromkeys(f.scene for f in figures):
        by_name = {f.loop: f for f in figures if f.scene == scene}
        tables += [_make_times(scene, by_name), _make_deeds(scene, by_name)]
    return tables


def _make_times(scene: str, by_name: dict[str, LoopFigures]) -> Table:
    ours, native = by_name[OURS], by_name[NATIVE]
    return Table(
        title=f"Whole ticks of the 1 kHz loop, {scene}: µs",
        note=(
            "`paced`: each tick waits for the clock, as a device needs it, with caches "
            "and a processor that have rested. All other rows run as fast as they can, "
            "those of other libraries too, so that ratios are of rows that do not "
            "wait. "
            "Undisturbed: what a tick takes is the mean of the middle half of its "
            "repeats, so that interruptions by the machine fall out. "
            "Median, p99 and p99.9 over the ticks at which all loops have a contact; "
            "then median and p99 over all ticks. `ours / it` is the time of this "
            "package's whole tick, from the device's reading through Drake's Simulator "
            "to the device's wrench, divided by that of the row; `native / it` is that "
            "of its native part: medians in contact, and below 1 this package is "
            "faster."
        ),
        header=(
            *("loop", "median", "p99, undisturbed", "p99.9, undisturbed"),
            *("median, all", "p99, all, undisturbed"),
            *("ours / it", "native / it"),
        ),
        rows=[
            (
                name,
                *_list_times(f.in_contact),
                *_list_times(f.all_ticks)[:2],
                _ratio(ours.in_contact, f.in_contact),
                _ratio(native.in_contact, f.in_contact),
            )
            for name, f in by_name.items()
        ],
    )


def _make_deeds(scene: str, by_name: dict[str, LoopFigures]) -> Table:
    return Table.of(
        f"What the loops did, {scene}",
        f"{_COMPUTES} Contacts: pairs of pieces that push, median and most, in "
        "contact. Deepest: largest penetration of a pair. Force: of the spring "
        "between handle and tool, median in contact and largest. Apart: median "
        "distance of the tool's origin from this package's.",
        {
            "loop": lambda f: f.loop,
            "contacts": lambda f: f"{f.median_contacts:.0f}–{f.max_contacts}",
            "deepest": lambda f: f"{1e3 * f.deepest_m:.2f} mm",
            "force": lambda f: f"{f.force_N:.2f} / {f.max_force_N:.2f} N",
            "apart": lambda f: f"{1e3 * f.apart_m:.2f} mm",
        },
        [f for f in by_name.values() if not math.isnan(f.apart_m)],
    )


def _list_times(times: TickTimes) -> tuple[str, ...]:
    figures = (times.median_us, times.p99_us, times.p99_9_us)
    return tuple(f"{us:.1f}" if us < 100.0 else f"{us:.0f}" for us in figures)


def _ratio(ours: TickTimes, other: TickTimes) -> str:
    return f"{ours.median_us / other.median_us:.2f}"
