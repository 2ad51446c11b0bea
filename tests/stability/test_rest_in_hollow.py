"""A tool held still in a hollow of facets comes to rest, wherever it is pressed."""

from __future__ import annotations

import numpy as np
import pytest
from contact_samples import decomposed
from hollow_block import height, hollow_block, spike

from drake_haptics import _core
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench

PRESS_M = 0.006  # the handle below the surface
COMING, HELD, WATCHED = 800, 1800, 400  # ticks of 1 ms
COUPLING = _core.CouplingGains(800.0, 2.0, 1.0, 5e-3)
AT_ORIGIN = np.array([1.0, 0, 0, 0, 0, 0, 0])
GAINS = {"default": (2e4, 2e-3), "sinking": (5e3, 5e-4), "soft": (2e3, 1e-3)}


def press(x, stiffness, tolerance):
    """Positions of a tool of 50 g, m, and numbers of its contacts, tick by tick."""
    tool = _core.RigidToolDynamics(0.05, np.zeros(3), 1e-5 * np.eye(3))
    tracker = _core.SceneTracker(
        decomposed(*spike()), [decomposed(*hollow_block())], tolerance
    )
    rest = _core.ObjectFrames(np.zeros((1, 3)), np.zeros((1, 6)))
    materials = _core.ContactMaterials(np.array([stiffness]), np.array([0.0]))
    handle = np.array([1.0, 0, 0, 0, x, 3e-4, 4e-3])
    state = np.concatenate([handle, np.zeros(6)])
    bottom = height(x) - PRESS_M
    down = np.concatenate([np.linspace(4e-3, bottom, COMING), np.full(HELD, bottom)])
    seen, counts = [], []
    for handle[6] in down:
        contacts = tracker.query(state[:7])
        clusters = _core.share_stiffness(contacts, tolerance)
        push = _core.penalty_wrench_model(
            clusters, state[:7].copy(), state[7:].copy(), rest, materials
        )
        pull = coupling_wrench(
            handle, np.zeros(6), AT_ORIGIN, state[:7].copy(), state[7:].copy(), COUPLING
        )
        state = tool.step(state, [push, pull[:78]], 1e-3)
        seen.append(state[4:7].copy())
        counts.append(len(contacts))
    return np.array(seen), np.array(counts)


@pytest.mark.parametrize("gains", GAINS)
def test_a_spike_rests_in_every_place_of_a_hollow(gains):
    """Of these 37 places there were 8, 2 and 4 at which it never did."""
    restless = []
    for x in np.linspace(-9e-3, 9e-3, 37):
        positions, counts = press(x, *GAINS[gains])
        assert counts[-1] > 0
        if np.ptp(positions[-WATCHED:], axis=0).max() > 1e-9:
            restless.append(round(x, 4))
    assert restless == []
