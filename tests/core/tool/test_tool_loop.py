"""The tool's loop in the core does what its parts do one after the other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from shapes import SHAPES

from drake_haptics import _core
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import Mesh, calc_mass_properties
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench

_TICKS = 400
_PERIOD_S = 1e-3
_TOLERANCE_M = 1e-3
_STIFFNESS, _DAMPING = 2e3, 4.0
_X_HT = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.01])


def _shape(name: str) -> Any:
    surface = SHAPES[name]()
    return decompose(Mesh.from_arrays(surface.vertices, surface.triangles, name=name))


def _press() -> dict[str, Any]:
    """A ball that a handle presses into a block, from 2 mm above it, and drags."""
    ball, block = _shape("sphere"), _shape("block")
    top = block.mesh.vertices[:, 2].max() - ball.mesh.vertices[:, 2].min()
    share = np.linspace(0.0, 1.0, _TICKS)
    handle = np.zeros((_TICKS, 13))
    handle[:, 0] = 1.0
    handle[:, 4] = 5e-3 * share
    handle[:, 6] = top + 2e-3 - 8e-3 * np.minimum(2.0 * share, 1.0) + 0.01
    handle[:, 7:] = np.gradient(handle[:, [1, 2, 3, 4, 5, 6]], _PERIOD_S, axis=0)
    p_TTcm, I_TTcm_T = calc_mass_properties(ball.mesh, 0.1)
    start = np.concatenate([handle[0, :7] + [0, 0, 0, 0, 0, 0, -0.01], np.zeros(6)])
    return {
        "tool": ball.core,
        "objects": [block.core],
        "q_WO": np.array([[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]]),
        "tolerance": _TOLERANCE_M,
        "dynamics": _core.RigidToolDynamics(0.1, p_TTcm, I_TTcm_T),
        "gains": _core.CouplingGains(800.0, 2.0, 1.0, 4e-3),
        "q_HT": _X_HT,
        "stiffness": _STIFFNESS,
        "damping": _DAMPING,
        "h": _PERIOD_S,
        "handle": handle,
        "start": start,
    }


def test_it_is_its_parts_one_after_the_other() -> None:
    given = _press()
    states, num_contacts, nearest, seconds = _core.run_tool_loop(**given)
    tracker = _core.SceneTracker(given["tool"], given["objects"], _TOLERANCE_M)
    state, rest = given["start"], np.zeros((1, 6))
    for tick, handle in enumerate(given["handle"]):
        contacts = tracker.query(state[:7])
        force = _core.penalty_force(
            _core.share_stiffness(contacts, _TOLERANCE_M),
            state[4:7],
            state[7:],
            np.zeros((1, 3)),
            rest,
            np.array([_STIFFNESS]),
            np.array([_DAMPING]),
        )
        coupling = coupling_wrench(
            handle[:7], handle[7:], _X_HT, state[:7], state[7:], given["gains"]
        )
        model = force.wrench_model + coupling[:78]
        state = given["dynamics"].step(state, model, _PERIOD_S)
        assert num_contacts[tick] == len(contacts)
        assert nearest[tick] == min(contacts.distance, default=_TOLERANCE_M)
        np.testing.assert_allclose(states[tick], state, rtol=0, atol=1e-12)
    assert nearest.min() < 0.0 and num_contacts[0] == 0
    assert seconds.shape == (_TICKS,) and (seconds > 0.0).all()


def test_it_ends_where_two_springs_balance() -> None:
    given = _press()
    given["handle"][:, 4] = 0.0
    given["handle"][:, 7:] = 0.0
    given["handle"] = np.vstack(
        [given["handle"], np.tile(given["handle"][-1], (3000, 1))]
    )
    states, _, nearest, _ = _core.run_tool_loop(**given)
    stretch_m = states[-1, 6] - (given["handle"][-1, 6] - 0.01)
    pressed_m = _TOLERANCE_M - nearest[-1]
    assert stretch_m * 800.0 == pytest.approx(pressed_m * _STIFFNESS, rel=1e-3)


def test_every_object_needs_a_pose() -> None:
    given = _press()
    with pytest.raises(ValueError, match="one row for each object"):
        _core.run_tool_loop(**{**given, "q_WO": np.zeros((0, 7))})
    with pytest.raises(ValueError, match="q_WO"):
        _core.run_tool_loop(**{**given, "q_WO": np.zeros((1, 7))})
