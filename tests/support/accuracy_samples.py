"""Accuracy studies made by hand, with figures that are easy to reckon with."""

from __future__ import annotations

import math
from typing import Any

from drake_haptics.evaluation.accuracy.figures import (
    AccuracyStudy,
    Cost,
    Errors,
    PeerRow,
    Row,
)
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.evaluation.measuring.timing import TickTimes

MACHINE = {
    "processor": "a <processor>",
    "cores": 4,
    "system": "Linux x86_64",
    "python": "3.11.7",
    "drake_haptics": "0.1.0",
}


def make_times(median_us: float) -> TickTimes:
    """Times whose p99 is twice the median, and p99.9 three times."""
    return TickTimes(1000, median_us, 2.0 * median_us, 3.0 * median_us)


def make_errors(force_rms_N: float, stiffness: float | None = 3e4) -> Errors:
    """Returns errors that all grow with that of the force."""
    return Errors(
        force_rms_N=force_rms_N,
        force_max_N=4.0 * force_rms_N,
        torque_rms_Nm=0.01 * force_rms_N,
        torque_max_Nm=0.04 * force_rms_N,
        depth_max_m=1e-3 * force_rms_N,
        normal_jump_deg=10.0 * force_rms_N,
        energy_created_J=1e-3 * force_rms_N,
        stable_stiffness_N_per_m=stiffness,
    )


def make_row(
    knob: str,
    label: str,
    tick_us: float,
    native_us: float,
    force_rms_N: float,
    *,
    is_scene: bool = False,
    instructions: float | None = None,
    stiffness: float | None = 3e4,
    **changes: Any,
) -> Row:
    """A row that was measured; keys of `changes` have __ for dots."""
    plain = {key.replace("__", "."): value for key, value in changes.items()}
    return Row(
        setting=Setting(knob, label, plain),
        is_scene=is_scene,
        cost=Cost(make_times(tick_us), make_times(native_us), instructions),
        errors=make_errors(force_rms_N, stiffness),
        pieces=(97, 197),
    )


def make_study(*rows: Row, peers: tuple[PeerRow, ...] = ()) -> AccuracyStudy:
    """A study of these rows, or of a scene's usual ones if there are none."""
    return AccuracyStudy(
        scene="cup_spoon",
        description="A spoon goes around the inside of a cup & scrapes its wall.",
        machine=MACHINE,
        ticks=4800,
        contact_ticks=3900,
        reference=Setting(
            "reference",
            "every contact by itself, exact global depth",
            {"contact.depth": "global"},
        ),
        rows=rows or make_usual_rows(),
        peers=peers,
    )


def make_usual_rows() -> tuple[Row, ...]:
    """The scene as it is, and settings of several knobs."""
    scene = make_row("scene", "as it is", 150.0, 24.0, 0.004, is_scene=True)
    return (
        scene,
        make_row("contact.depth", "tracked", 150.0, 24.0, 0.004, is_scene=True,
                 contact__depth="tracked"),
        make_row("contact.depth", "global", 158.0, 31.0, 0.0,
                 contact__depth="global"),
        make_row("contact.tolerance_m", "1 mm", 150.0, 24.0, 0.004, is_scene=True,
                 contact__tolerance_m=1e-3),
        make_row("contact.tolerance_m", "0.5 mm", 138.0, 13.0, 0.02,
                 contact__tolerance_m=5e-4),
        make_row("contact.tolerance_m", "0.2 mm", 134.0, 9.5, 0.3,
                 contact__tolerance_m=2e-4),
        make_row("decomposition", "single hull", 124.0, 2.1, 2.4,
                 stiffness=math.inf, tool__decomposition="hull",
                 environment__decomposition="hull"),
        make_row("tool.max_triangles", "200", 145.0, 8.0, 0.05,
                 tool__max_triangles=200),
        make_row("effects.gravity", "off", 139.0, 24.0, 0.49,
                 stiffness=None, effects__gravity=None),
        Row(
            Setting("decomposition", "CoACD", {"tool.decomposition": "coacd"}),
            is_scene=False, cost=None, errors=None,
            failure_reason="coacd is not installed",
        ),
    )  # fmt: skip


def make_peers() -> tuple[PeerRow, ...]:
    """One library that was measured, and one that is not there."""
    errors = make_errors(0.6, stiffness=None)
    return (
        PeerRow("MuJoCo 3.3.0", "its own contacts", make_times(30.0), errors),
        PeerRow("coal 3.0.1", "every pair", None, None, "not installed"),
    )
