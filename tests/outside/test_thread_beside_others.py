"""The same bolt in the same nut, in MuJoCo and in Drake's own plant.

`docs/generate/thread_table.py` tabulates what they do. Here both are shown to be asked
fairly: they get solids of the right size, and turn the bolt along the thread.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from thread_peers import (
    Turning,
    find_boundary,
    make_nut_volume,
    turn_in_drake,
    turn_in_mujoco,
)
from threads import AXIAL_PLAY_M, MAJOR_M, PITCH_M, PLAY_M, make_nut

TURNS, TURNS_PER_S, DURATION_S = 0.03, 1.0, 0.1


def test_the_nut_is_a_solid_with_the_thread_inside() -> None:
    vertices, cells = make_nut_volume(2)
    edges = vertices[cells[:, 1:]] - vertices[cells[:, :1]]
    volumes = np.linalg.det(edges) / 6
    surface = find_boundary(vertices, cells)
    assert volumes.min() > 0
    assert surface.is_watertight
    assert surface.volume == pytest.approx(volumes.sum())
    thread = make_nut(2)
    assert set(map(tuple, thread.vertices.round(9))) < set(
        map(tuple, surface.vertices.round(9))
    )
    radii = np.linalg.norm(vertices[:, :2], axis=1)
    assert radii.min() == pytest.approx(MAJOR_M - 1e-3 + PLAY_M)
    assert radii.max() == pytest.approx(12e-3)


@pytest.mark.parametrize("turn", [turn_in_mujoco, turn_in_drake])
def test_it_turns_the_bolt_in_the_thread(
    turn: Callable[..., Turning], tmp_path: Path
) -> None:
    shown = turn(TURNS, TURNS_PER_S, DURATION_S, tmp_path)
    assert shown.turns[-1] == pytest.approx(TURNS, abs=2e-3)
    # So far the bolt has only taken up the play, and a compliant nut a little more.
    lag_m = PITCH_M * shown.turns[-1] - (shown.z_m[-1] - shown.z_m[0])
    assert 0 < lag_m < 1.5 * AXIAL_PLAY_M
