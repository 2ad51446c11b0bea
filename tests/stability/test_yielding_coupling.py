"""A handle far beyond a wall: the tool stays on its side, at rest, and comes back.

The coupling yields at the device's largest force and torque, so that no hand presses
harder than the shipped contacts hold.
"""

from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np
import pytest

from drake_haptics import _core
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.geometry.mesh.mesh import make_tool_dynamics
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.simulated_device import make_hand_path
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

PERIOD_S = 1e-3
FAR_M, SPEED_M_PER_S, HOLD_S = 0.3, 0.5, 1.0
_OUT, _HOLD = round(FAR_M / SPEED_M_PER_S / PERIOD_S), round(HOLD_S / PERIOD_S)
_BACK = 500  # at rest at the end

# Where the objects are closed in front of the tool: into the cup, onto the plate
# between the box's walls, onto the block.
_AROUND = [np.array(u, float) for u in product((-1, 0, 1), repeat=3)]
DIRECTIONS = {
    "cup_spoon": [u for u in _AROUND if u[2] < 0],
    "can_box": [u for u in _AROUND if u[2] <= 0 and u.any()],
    "hammer_block": [np.array([0.0, 0.0, -1.0])],
}
CASES = [(scene, tuple(u)) for scene, us in DIRECTIONS.items() for u in us]


@dataclass(frozen=True)
class Course:
    """What the tool did: by tick, p_WT (m), V_WT, contacts, least distance (m)."""

    p: np.ndarray
    v: np.ndarray
    num_contacts: np.ndarray
    distance_m: np.ndarray
    pull_m: np.ndarray  # from the tool to where the handle would have it


@cache
def build(scene):
    return BuildHapticDiagram(load_scene(find_scene(scene)))


def drive(scene, direction, gains=None):
    """Leads the handle away from where the scene's hand starts, waits, and back."""
    haptic = build(scene)
    scene, coupling = haptic.scene, haptic.loop.virtual_coupling
    if gains is None:
        gains = coupling.get_gains(coupling.CreateDefaultContext())
    X_WT = make_hand_path(scene.hand.path).start
    way = np.linspace(0.0, FAR_M, _OUT + 1)
    way = np.concatenate([way, np.full(_HOLD, FAR_M), way[::-1], np.zeros(_BACK)])
    u = np.array(direction) / np.linalg.norm(direction)
    handle = np.zeros((len(way), 13))
    handle[:, :7] = pose_to_vector(X_WT @ coupling.X_HT.inverse())
    handle[:, 4:7] += np.outer(way, u)
    handle[1:, 10:] = np.outer(np.diff(way) / PERIOD_S, u)
    states, num_contacts, distance_m, _ = _core.run_tool_loop(
        haptic.tool.core,
        [part.core for part in haptic.environment],
        np.array(
            [
                pose_to_vector(item.pose.to_rigid_transform())
                for item in scene.environment
            ]
        ),
        scene.contact.tolerance_m,
        make_tool_dynamics(haptic.tool.mesh, scene.tool.mass_kg),
        gains,
        pose_to_vector(coupling.X_HT),
        scene.contact.stiffness_N_per_m,
        scene.contact.damping_Ns_per_m,
        PERIOD_S,
        handle,
        np.concatenate([pose_to_vector(X_WT), np.zeros(6)]),
    )
    held = X_WT.translation() + np.outer(way, u)
    p, v = states[:, 4:7], states[:, 10:]
    return Course(p, v, num_contacts, distance_m, held - p)


@pytest.mark.parametrize(("scene", "direction"), CASES)
def test_it_stays_in_contact_on_its_side_and_comes_back(scene, direction):
    course = drive(scene, direction)
    in_contact = np.flatnonzero(course.num_contacts)
    first, end = in_contact[0], _OUT + _HOLD
    assert first < _OUT
    # Some bounce once as they arrive; then none lets go while the handle is away.
    settled = slice(first + 150, end)
    assert course.num_contacts[settled].all()
    deepest = 8.5 / build(scene).scene.contact.stiffness_N_per_m
    assert course.distance_m.min() > -1.2 * deepest
    assert np.linalg.norm(course.p[end]) < 0.15
    np.testing.assert_allclose(course.p[-1], course.p[0], atol=5e-4)
    # Between facets of the cup the spoon may shake by a micrometer, unfelt.
    held = slice(_OUT + _HOLD // 2, _OUT + _HOLD)
    pull = course.pull_m[held]
    force_N = 8.5 * pull / np.linalg.norm(pull, axis=1, keepdims=True)
    assert np.ptp(force_N, axis=0).max() < 0.15
    assert np.linalg.norm(course.v[held], axis=1).max() < 0.2
    fastest = 2e-3 if scene == "cup_spoon" else 1e-3
    assert np.linalg.norm(course.v[held][-100:], axis=1).max() < fastest


def test_a_coupling_without_limits_is_pulled_through():
    """That is what the limits are for; it also shows that the above can fail."""
    gains = _core.CouplingGains(800.0, 2.0, 1.0, 0.004)
    course = drive("can_box", (0.0, 0.0, -1.0), gains)
    assert course.p[_OUT + _HOLD, 2] < -0.2
