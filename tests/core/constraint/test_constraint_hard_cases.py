"""What must fit, must not pass, must not ripple and must come free, by constraints."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from constraint_rig import (
    COUPLING,
    PERIOD_S,
    REST,
    SKIN_M,
    ConstraintLoop,
    check_led_out,
    run_press,
    take_turns,
)
from peg_and_hole import peg_and_hole, solid_of
from press_rig import START_M, sample_presses
from press_tools import MODELS, PressTool, hull_mesh, make_tool, make_tools
from scipy.spatial.transform import Rotation
from slide_scenes import TOP_M, fifty_pieces

from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import load_mesh

SIGNS = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T


@pytest.fixture(scope="module")
def tools() -> dict[str, PressTool]:
    edge_on = make_tool(hull_mesh(SIGNS * [5e-4, 0.01, 0.01]), [[0, 0, -1]])
    return {**make_tools(), "edge-on plate": edge_on}


def lowest(tool: PressTool) -> float:
    return float(tool.mesh.vertices[:, 2].min())


def tilted_force_N(tool: PressTool, way_m: float) -> float:
    """Returns the force of a handle pushed by `way_m` beyond a rigid tool's contact.

    The tool turns about its lowest vertices, which lie at some distance r beside its
    origin: F = K (way − r φ), K_r φ = r F.
    """
    V = tool.mesh.vertices
    r_m = np.linalg.norm(V[V[:, 2] < lowest(tool) + 1e-9].mean(axis=0)[:2])
    K = COUPLING.stiffness_N_per_m
    return K * way_m / (1.0 + K * r_m**2 / COUPLING.rotational_stiffness_Nm_per_rad)


@pytest.mark.parametrize("speed_m_per_s", [0.03, 0.1, 0.3])
@pytest.mark.parametrize("name", ["box", "ball", "spike"])
def test_a_flat_face_in_fifty_pieces_does_not_ripple(tools, name, speed_m_per_s):
    """Nor do its seams drag: the tool lags by the tick that it learns of the handle."""
    tool = tools[name]
    start = np.array([0.02, 0.02, TOP_M - lowest(tool) + SKIN_M])
    along = np.array([0.06, 0.011, 0.0])
    q_WH = np.concatenate([REST[:4], start])
    loop = ConstraintLoop(tool, [fifty_pieces()], q_WH)
    for k in range(300):
        q_WH[6] = start[2] - min(k, 100) / 100 * 2.6 / 800
        loop.tick(q_WH)
    length_m = float(np.linalg.norm(along))
    forces_N = []
    for way_m in np.arange(0, length_m, speed_m_per_s * PERIOD_S):
        q_WH[4:6] = (start + along * way_m / length_m)[:2]
        forces_N.append(loop.tick(q_WH).F_Ho_W_commanded[3:])
    settled = np.array(forces_N)[len(forces_N) // 3 :]
    # Rows give way by a quarter of a micrometer, which is 0.2 mN.
    expected_N = tilted_force_N(tool, 2.6 / 800)
    assert settled[:, 2].mean() == pytest.approx(expected_N, abs=5e-4)
    assert np.ptp(settled[:, 2]) < 1e-3
    if speed_m_per_s < 0.2:
        lag_N = 800 * speed_m_per_s * PERIOD_S
        assert np.linalg.norm(settled[-1, :2]) == pytest.approx(lag_N, abs=1e-3)


@pytest.mark.parametrize("speed_m_per_s", [0.5, 3.0])
@pytest.mark.parametrize("name", ["spike", "box", "edge-on plate"])
def test_nothing_passes_a_wall_of_a_twentieth_of_a_millimeter(
    tools, name, speed_m_per_s
):
    tool = tools[name]
    wall = solid_of(trimesh.creation.box([0.06, 0.06, 5e-5]))
    q_WH = np.concatenate([REST[:4], [0, 0, 8e-3 - lowest(tool)]])
    loop = ConstraintLoop(tool, [wall], q_WH)
    end = q_WH[6] - 28e-3
    for _ in range(300):
        q_WH[6] = max(end, q_WH[6] - speed_m_per_s * PERIOD_S)
        result = loop.tick(q_WH)
        assert result.is_apart and not result.is_bounded
        assert result.least_distance_m > SKIN_M - 2e-6
    assert result.F_Ho_W_commanded[5] == pytest.approx(16.2, rel=0.01)


@pytest.mark.parametrize("play", [1.0, 1.1, 1.2, 2.0])
def test_a_peg_goes_into_a_hole_and_out_and_rests_there(play):
    """Askew by 2°, half a millimeter beside: play on each side, in skins."""
    tool, hole = peg_and_hole((play + 1e-3) * SKIN_M)
    turn = Rotation.from_rotvec([np.deg2rad(2), 0, 0]).as_quat()
    start = np.concatenate([np.roll(turn, 1), [5e-4, 3e-4, 0.0205]])
    loop = ConstraintLoop(tool, [hole], start)
    way_m = np.minimum(0.05 * PERIOD_S * np.arange(1400), 18.5e-3)
    forces = [loop.tick(start - [0, 0, 0, 0, 0, 0, z]).F_Ho_W_commanded for z in way_m]
    assert start[6] - loop.q_WT[6] > 18.3e-3
    rest = np.ptp(forces[-400:], axis=0)
    assert rest[3:].max() < 2e-3 and rest[:3].max() < 1e-4
    for z in way_m[way_m < 18.5e-3][::-1]:
        result = loop.tick(start - [0, 0, 0, 0, 0, 0, z])
        assert result.is_apart and result.least_distance_m > SKIN_M - 5e-6
    assert loop.q_WT[6] > start[6] - 1e-3
    # The most that contact gave beyond what it had been given.
    work_J = np.cumsum([0.0, *loop.work_J])
    assert (work_J - np.minimum.accumulate(work_J)).max() < 5e-5


def test_a_peg_stays_out_of_a_hole_with_less_play_than_its_skin():
    """Its lower edge rests a skin away from the hole's upper one."""
    tool, hole = peg_and_hole(0.8 * SKIN_M)
    start = np.concatenate([REST[:4], [0, 0, 0.0205]])
    loop = ConstraintLoop(tool, [hole], start)
    for z in np.minimum(0.05 * PERIOD_S * np.arange(600), 5e-3):
        result = loop.tick(start - [0, 0, 0, 0, 0, 0, z])
        assert result.is_apart
    assert loop.q_WT[6] == pytest.approx(0.02 + 0.6 * SKIN_M, abs=2e-6)


@pytest.mark.parametrize("name", ["cup", "torus"])
def test_a_tool_that_starts_a_millimeter_inside_is_led_out(name):
    """20 of 20, at 20 mm/s, with less than 3 N on the hand."""
    mesh = load_mesh(MODELS / f"{name}.obj", scale=1.0)
    solid, num_led = decompose(mesh).core, 0
    for tool, press in take_turns(mesh):
        outside, inside = press.q_WH(START_M - 1e-4, 0), press.q_WH(START_M + 1e-3, 0)
        if not ConstraintLoop(tool, [solid], outside).tick(outside).is_apart:
            continue
        loop = ConstraintLoop(tool, [solid], inside)
        assert not loop.tick(inside).is_apart
        check_led_out(loop, inside, 200)
        num_led += 1
        if num_led == 20:
            break


@pytest.mark.parametrize("motion", ["press", "jab"])
@pytest.mark.parametrize(
    ("solid_name", "name"),
    [
        *(("cup", tool) for tool in ("spike", "box", "spoon")),
        *(("spoon", tool) for tool in ("box", "spoon")),
        *(("hammer", "box"), ("torus", "spoon")),
    ],
)
def test_no_press_makes_energy_or_goes_through(tools, solid_name, name, motion):
    """At most 0.05 mJ over the whole way, and the skin is never gone."""
    mesh = load_mesh(MODELS / f"{solid_name}.obj", scale=1.0)
    solid, tool = decompose(mesh).core, tools[name]
    num_met = 0
    for press in sample_presses(mesh, tool, motion, range(6), 0):
        start = press.q_WH(0, 0)
        loop = ConstraintLoop(tool, [solid], start)
        if loop.tick(start).least_distance_m < SKIN_M:
            continue
        largest_N = 0.0
        for result in run_press(loop, press):
            assert result.is_apart and not result.is_bounded
            assert result.least_distance_m > SKIN_M - 1e-5
            force_N = np.linalg.norm(result.F_Ho_W_commanded[3:])
            largest_N = max(largest_N, force_N)
        num_met += largest_N > 1.0
        work_J = np.concatenate([[0], np.cumsum(loop.work_J)])
        assert (work_J - np.minimum.accumulate(work_J)).max() < 5e-5
    assert num_met >= 3
