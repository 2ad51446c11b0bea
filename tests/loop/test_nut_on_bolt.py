"""The shipped nut goes where its thread leads it, and not where the hand presses it."""

from __future__ import annotations

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw
from shapes.threads import THREAD_PITCH_M

from drake_haptics import BuildHapticDiagram, find_scene, load_scene
from drake_haptics.loop.clearance import find_clearance
from drake_haptics.simulation.run import run

# Where the first turn of the nut's thread is in line with the bolt's.
START_M = 0.034


@pytest.fixture(scope="module")
def haptic():
    return BuildHapticDiagram(load_scene(find_scene("nut_on_bolt")))


@pytest.mark.parametrize("turns", [-1.0, -1.25, -2.0])
def test_the_nut_has_a_tenth_of_a_millimeter_of_play(haptic, turns):
    bolt = [(haptic.environment[0].core, RigidTransform())]
    X_WT = RigidTransform(
        RollPitchYaw(0, 0, 2 * np.pi * turns), [0, 0, START_M + turns * THREAD_PITCH_M]
    )
    found = find_clearance(haptic.tool.core, bolt, [X_WT], [2e-4])
    assert found is not None
    assert 1e-4 < found.share * 2e-4 < 1.1e-4


def test_the_thread_leads_the_nut_down_and_up(haptic):
    ways = []
    statistics = run(
        haptic,
        6.5,
        energy=True,
        on_tick=lambda context: ways.append(
            [
                haptic.diagram.GetOutputPort(name).Eval(context)
                for name in ("X_WT", "X_WH")
            ]
        ),
    )
    X_WT, X_WH = np.swapaxes(ways, 0, 1)
    turns = np.unwrap(2 * np.arctan2(X_WT[:, 3], X_WT[:, 0])) / (2 * np.pi)
    beside_m = X_WT[:, 6] - START_M - THREAD_PITCH_M * turns
    pressed_m = X_WH[:, 6] - START_M - THREAD_PITCH_M * turns
    # Engaged, down and then up; a flank leaves it more along the axis than across.
    for ticks, side in [(slice(2500, 4300), -1), (slice(5100, 6000), 1)]:
        assert np.abs(beside_m[ticks]).max() < 2.5e-4
        assert (side * pressed_m[ticks]).min() > 4e-4
    assert turns.min() == pytest.approx(-2.0, abs=0.02)
    assert statistics.least_distance_m > 0.9 * haptic.scene.contact.skin_m
    assert statistics.energy_J["contact"]["beyond"] < 5e-5
