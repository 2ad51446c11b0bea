"""Friction of the constraint law against Coulomb's law and the balance of energy."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from constraint_rig import (
    COUPLING,
    PERIOD_S,
    REST,
    SKIN_M,
    ConstraintLoop,
    contact_wrench,
)
from press_tools import PressTool, hull_mesh, make_tool, make_tools
from scipy.spatial.transform import Rotation
from slide_scenes import TOP_M, fifty_pieces

from drake_haptics import _core
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench

# A coupling that does not pull: the tool is alone with its weight.
LOOSE = _core.CouplingGains(1e-9, 0.0, 1e-9, 0.0)
MASS_KG = 0.05


@pytest.fixture(scope="module")
def tools() -> dict[str, PressTool]:
    return make_tools()


@pytest.fixture(scope="module")
def plates() -> dict[str, _core.ConvexPieces]:
    """The same plate in one piece and cut."""
    corners = np.array(np.meshgrid([0, 0.1], [0, 0.05], [0, TOP_M])).reshape(3, -1).T
    whole = make_tool(hull_mesh(corners), [[0, 0, -1]]).core
    return {"whole": whole, "50 pieces": fifty_pieces()}


def lowest(tool: PressTool) -> float:
    return -tool.mesh.vertices[:, 2].min()


def at(x: float, y: float, z: float) -> np.ndarray:
    return np.array([1.0, 0, 0, 0, x, y, z])


def friction_wrench(result: _core.ConstraintStepResult) -> np.ndarray:
    """The wrench (6,) of friction on the tool in a tick."""
    model = result.friction.wrench_model
    return model[:6] - model[6:42].reshape(6, 6) @ (PERIOD_S * result.V_WT)


@pytest.mark.parametrize("coefficient", [0.2, 0.5])
@pytest.mark.parametrize("tool", ["box", "ball"])
@pytest.mark.parametrize("plate", ["whole", "50 pieces"])
def test_what_slides_is_held_by_coulombs_law(tools, plates, plate, tool, coefficient):
    tool = tools[tool]
    height = TOP_M + lowest(tool) - 3e-3
    loop = ConstraintLoop(
        tool, [plates[plate]], at(0.02, 0.02, height + 4e-3), coefficient=coefficient
    )
    for k in range(300):
        loop.tick(at(0.02, 0.02, height + max(0, 300 - k) * 1e-5))
    drawn = []
    for k in range(1200):
        result = loop.tick(at(0.02 + 3e-5 * k, 0.02 + 6e-6 * k, height))
        if k < 400:
            continue
        # What the spring draws with at the tick's end is the truth of both.
        stretch = loop.q_WH[4:] - loop.q_WT[4:]
        stretch += 2.0 / 800.0 * (np.array([0.03, 6e-3, 0]) - loop.V_WT[3:])
        drawn.append(np.linalg.norm(stretch[:2]) / -stretch[2])
        f = result.friction.f_cluster_W.sum(axis=0)
        assert np.linalg.norm(f) / result.lambda_N.sum() == pytest.approx(
            coefficient, rel=1e-4
        )
        assert result.friction.sliding.all()
    # But for what it takes to speed the tool up and down at seams.
    assert np.abs(np.array(drawn) / coefficient - 1).max() < 5e-3
    assert np.mean(drawn) == pytest.approx(coefficient, rel=2e-4)


@pytest.mark.parametrize("plate", ["whole", "50 pieces"])
def test_on_a_slope_the_angle_of_friction_decides(tools, plates, plate):
    coefficient, box = 0.3, tools["box"]
    angle = np.arctan(coefficient)

    def slide(slope_rad: float, ticks: int) -> tuple[np.ndarray, np.ndarray]:
        start = at(0.053, 0.026, TOP_M + lowest(box) + SKIN_M)
        loop = ConstraintLoop(
            box, [plates[plate]], start, gains=LOOSE, coefficient=coefficient
        )
        down = np.array([0.8, 0.6, 0.0]) * np.sin(slope_rad)
        weight = MASS_KG * 9.81 * (down - [0, 0, np.cos(slope_rad)])
        F = np.concatenate([np.cross(box.dynamics.p_TTcm, weight), weight])
        places, speeds = [], []
        for _ in range(ticks):
            loop.tick(loop.q_WT, np.zeros(6), F)
            places.append(loop.q_WT[4:])
            speeds.append(np.linalg.norm(loop.V_WT[3:]))
        return np.array(places), np.array(speeds)

    places, _ = slide(angle - 0.01, 11_000)
    assert np.linalg.norm(places[-1] - places[1000]) < 1e-7
    # It has given way before.
    assert np.linalg.norm(places[-1] - places[0]) > 5e-5
    _, speeds = slide(angle + 0.05, 100)
    gain = 9.81 * (np.sin(angle + 0.05) - coefficient * np.cos(angle + 0.05))
    assert np.diff(speeds[50:]) / PERIOD_S == pytest.approx(gain, rel=1e-2)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("tool", ["box", "ball", "spike"])
def test_no_stretch_of_a_stick_slip_way_makes_energy(tools, plates, tool, seed):
    """Handle and load go to and fro, and the tool turns, around a place."""
    tool, rng, n = tools[tool], np.random.default_rng(seed), 2000
    phase, times = rng.uniform(0, 2 * np.pi, 6), rng.integers(1, 9, 6)
    waves = np.sin(
        2 * np.pi * np.arange(n)[:, None] / n * times + [*phase[:3], 0, 0, 0]
    )
    amplitude = 10.0 ** rng.uniform(-4, -2.5)
    height = TOP_M + lowest(tool) - 2.2e-3
    places = [0.053, 0.026, height] + waves[:, :3] * [amplitude, amplitude, 2e-3]
    turns = np.roll(
        Rotation.from_rotvec(waves[:, 3:] * [0.1, 0.1, 0.5]).as_quat(), 1, axis=1
    )
    q_WH = np.hstack([turns, places])
    above = q_WH[0] + [0, 0, 0, 0, 0, 0, 4e-3]
    loop = ConstraintLoop(tool, [plates["50 pieces"]], above, coefficient=0.5)
    for share in np.linspace(1, 0, 500):
        loop.tick(q_WH[0] + share * (above - q_WH[0]))
    done_J, lost_J, was_sliding = 0.0, [], []
    for q in [*q_WH, *q_WH]:
        p_WTo = loop.q_WT[4:]
        result = loop.tick(q)
        assert result.num_substeps == 1
        wrench = contact_wrench(result, p_WTo) + friction_wrench(result)
        done_J += PERIOD_S * wrench @ result.V_WT
        lost_J.append(-done_J - result.friction.stored_J)
        was_sliding.append(bool(result.friction.sliding.any()))
    made_J = (np.maximum.accumulate(lost_J) - lost_J).max()
    assert made_J < 1e-5
    assert lost_J[-1] > 1e-4
    assert sum(a != b for a, b in pairwise(was_sliding)) > 4


def test_a_trembling_load_makes_no_creep(tools, plates):
    box = tools["box"]
    rng = np.random.default_rng(0)
    loop = ConstraintLoop(
        box,
        [plates["50 pieces"]],
        at(0.053, 0.026, TOP_M + lowest(box) + SKIN_M),
        gains=LOOSE,
        coefficient=0.3,
    )
    # Drawn by half of what the least load holds.
    x = []
    for _ in range(5000):
        F = np.array([0, 0, 0, 0.5 * 0.3 * 0.7, 0.0, -rng.uniform(0.7, 1.3)])
        loop.tick(loop.q_WT, np.zeros(6), F)
        x.append(loop.q_WT[4])
    assert np.ptp(x[2500:]) < 2e-6
    assert abs(np.mean(x[4000:]) - np.mean(x[2000:3000])) < 1e-6


def test_an_object_feels_the_opposite_and_takes_the_tool_along(tools, plates):
    box = tools["box"]
    height = TOP_M + lowest(box)
    loop = ConstraintLoop(
        box, [plates["whole"]], at(0.05, 0.025, height + SKIN_M), coefficient=0.3
    )
    X_WO, V_WO = np.eye(4), np.array([0, 0, 0, 0.01, 0, 0])
    for k in range(300):
        X_WO[0, 3] = 1e-5 * k
        loop.stepper.set_object_pose(0, X_WO, V_WO)
        p_WTo = loop.q_WT[4:]
        result = loop.tick(at(0.05, 0.025, height - 3e-3))
    f = result.friction.f_cluster_W.sum(axis=0)
    F_T = contact_wrench(result, p_WTo)
    F_T[3:] += f
    np.testing.assert_allclose(result.F_Oo_W[0, 3:], -F_T[3:], atol=1e-9)
    # Both about one point: nothing turns the two together.
    both = np.cross(X_WO[:3, 3], result.F_Oo_W[0, 3:]) + result.F_Oo_W[0, :3]
    contacts = result.contacts
    friction_torque = np.cross(contacts.p_WC - p_WTo, result.friction.f_cluster_W).sum(
        axis=0
    )
    both += F_T[:3] + friction_torque + np.cross(p_WTo, F_T[3:])
    np.testing.assert_allclose(both, 0, atol=1e-9)
    # It goes with the plate until the spring draws with μ N, then slides on it.
    assert f[0] == pytest.approx(0.3 * result.lambda_N.sum(), rel=1e-4)
    assert loop.q_WT[4] - 0.05 == pytest.approx(f[0] / 800.0, rel=0.02)


def test_friction_is_a_force_on_the_free_tools_step(tools, plates):
    box = tools["box"]
    height = TOP_M + lowest(box)
    loop = ConstraintLoop(
        box, [plates["50 pieces"]], at(0.05, 0.025, height + 1e-3), coefficient=0.4
    )
    for k in range(400):
        q_WH = at(0.05 + 2e-3 * np.sin(0.05 * k), 0.025, height - 2e-3)
        state = np.concatenate([loop.q_WT, loop.V_WT])
        result = loop.tick(q_WH, np.zeros(6))
        model = coupling_wrench(
            q_WH, np.zeros(6), REST, state[:7], state[7:], COUPLING
        )[:78].copy()
        model[:6] += contact_wrench(result, state[4:7])
        model += result.friction.wrench_model
        expected = box.dynamics.step(state, model, PERIOD_S)
        np.testing.assert_allclose(result.V_WT[:3], expected[7:10], atol=1e-5)
        np.testing.assert_allclose(result.V_WT[3:], expected[10:], atol=1e-7)


def test_what_it_cannot_use_is_refused(tools, plates):
    box, plate = tools["box"], plates["whole"]
    given = {
        "tool": box.core,
        "objects": [plate],
        "skin_m": [SKIN_M],
        "dynamics": box.dynamics,
        "gains": LOOSE,
        "q_HT": REST,
        "period_s": PERIOD_S,
        "coefficient": [0.3],
    }
    for name, value, message in [
        ("coefficient", [0.3, 0.3], "a coefficient for each object"),
        ("coefficient", [-0.1], "coefficient"),
        ("break_away_m", 0.0, "break_away_m"),
    ]:
        with pytest.raises(ValueError, match=message):
            _core.ConstraintStepper(**{**given, name: value})
    stepper = _core.ConstraintStepper(**given)
    still = REST, np.zeros(6), REST, np.zeros(6), np.zeros(6)
    for anchors in (np.zeros(5), np.full(8, np.nan)):
        with pytest.raises(ValueError, match="anchors must"):
            stepper.step(*still, anchors)
