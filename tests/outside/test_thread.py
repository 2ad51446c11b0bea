"""A bolt like M16 turned through its nut: motion and torque per turn.

Source: the thread's own geometry. A screw of lead P that is turned without friction
against an axial force F moves P a turn and needs the torque F P / 2π.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from degenerate_scenes import Run
from threads import AXIAL_PLAY_M, AXIAL_SHARE, CONTACTS, PITCH_M, make_bolt, turn_bolt

from drake_haptics.scene.schema import ContactParameters

TURNS, TURNS_PER_S = 0.5, 1.0
# Of the flanks, which are flat between 36 edges a turn.
FACETS_M = 2e-6


@dataclass(frozen=True)
class Law:
    """A law of contact that fits the play.

    Attributes:
        contact: Its parameters.
        get_kept: Returns how far it keeps surfaces apart at most, m.
        torque_share: Largest torque per force, as a share of the thread's.
        made_J: Energy that it is known to make, J: what was measured, and a tenth.
    """

    contact: ContactParameters
    get_kept: Callable[[ContactParameters], float]
    torque_share: float
    made_J: float


LAWS = {
    "penalty": Law(
        CONTACTS["penalty"], lambda contact: contact.tolerance_m, 1.1, 3.2e-5
    ),
    "constraint": Law(
        CONTACTS["constraint"], lambda contact: contact.skin_m, 1.25, 1e-9
    ),
}
laws = pytest.mark.parametrize("law", LAWS)


@cache
def run_once(law: str) -> tuple[Run, np.ndarray]:
    """The run, and the turns (n,) of the bolt."""
    with TemporaryDirectory() as folder:
        shown = turn_bolt(LAWS[law].contact, TURNS, TURNS_PER_S, Path(folder))
    angle = np.unwrap(2 * np.arctan2(shown.X_WT[:, 3], shown.X_WT[:, 0]))
    return shown, angle / (2 * np.pi)


def test_the_bolt_is_a_solid_of_the_thread_s_size() -> None:
    bolt = make_bolt(3)
    assert bolt.is_watertight and bolt.volume > 0
    radii = np.linalg.norm(bolt.vertices[:, :2], axis=1)
    assert radii.max() == pytest.approx(8e-3)
    assert bolt.extents[2] == pytest.approx(4 * PITCH_M, abs=0.3 * PITCH_M)


@laws
def test_the_bolt_moves_by_the_lead(law: str) -> None:
    """Less the play that the law leaves it on the side that it is pulled to."""
    shown, turns = run_once(law)
    moved_m = shown.X_WT[-1, 6] - shown.X_WT[0, 6]
    lag_m = PITCH_M * turns[-1] - moved_m
    assert turns[-1] == pytest.approx(TURNS, abs=1e-3)
    kept_m = LAWS[law].get_kept(LAWS[law].contact) / AXIAL_SHARE
    assert AXIAL_PLAY_M - kept_m - FACETS_M < lag_m < AXIAL_PLAY_M


@laws
def test_the_threads_never_cross(law: str) -> None:
    """By the helix: what turns by φ has φ P / 2π to go along, and the play."""
    shown, turns = run_once(law)
    lag_m = PITCH_M * turns - (shown.X_WT[:, 6] - shown.X_WT[0, 6])
    assert np.abs(lag_m).max() < AXIAL_PLAY_M


@laws
def test_the_torque_is_that_of_the_lead(law: str) -> None:
    shown, turns = run_once(law)
    (late,) = np.nonzero((turns > TURNS / 2) & (turns < 0.99 * TURNS))
    torque_Nm, force_N = shown.F_To_W[late, 2].mean(), shown.F_To_W[late, 5].mean()
    assert force_N > 0.3
    share = -torque_Nm / force_N / (PITCH_M / (2 * np.pi))
    assert 0.98 < share < LAWS[law].torque_share


@laws
def test_the_thread_makes_no_energy(law: str) -> None:
    shown, _ = run_once(law)
    assert shown.work_J.max() < LAWS[law].made_J
