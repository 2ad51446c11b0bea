"""Going on while another one holds the handle."""

from dataclasses import replace

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from diagram_parts import read_output, read_tool
from fake_device import ScriptedDevice, make_reading
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import Effects, FrictionParameters, Pose
from drake_haptics.simulation.run import run
from drake_haptics.simulation.transfer_state import find_handle, transfer_context

ABOVE = (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.02)
BESIDE = (0.2, 0.02, 0.01, TOOL_HALF_HEIGHT + 0.01)
X_TH = RigidTransform(RollPitchYaw(0.1, 0.2, 0.3), [0.0, 0.0, 0.04])


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    scene = over_a_plate(tmp_path_factory.mktemp("scene"), [ABOVE, BESIDE])
    X_HT = X_TH.inverse()
    rpy_deg = np.rad2deg(RollPitchYaw(X_HT.rotation()).vector()).tolist()
    scene.tool.grasp = Pose(X_HT.translation().tolist(), rpy_deg)
    return scene


@pytest.fixture(scope="module")
def by_hand(scene):
    return BuildHapticDiagram(scene)


@pytest.fixture(scope="module")
def under_way(by_hand):
    """A context in which the hand is under way."""
    return run_on(by_hand, by_hand.diagram.CreateDefaultContext(), 0.15)


def run_on(haptic, context, duration_s):
    """Returns the context so much later."""
    ends = []

    def end_tick(root):
        ends[:] = [root.Clone()]

    run(haptic, duration_s, context=context, on_tick=end_tick)
    return ends[0]


def move_by(step):
    """Returns a device whose handle moves by (3,), m, at each reading."""
    return ScriptedDevice(lambda k: make_reading(k, position=k * np.array(step)))


def test_a_device_that_can_stand_anywhere_takes_the_handle_where_it_is(
    scene, by_hand, under_way
):
    X_WH = find_handle(by_hand, under_way)
    device = ScriptedDevice(lambda k: make_reading(k, position=[0.3, 0.2, 0.1]))
    held = BuildHapticDiagram(scene, device=device, reuse=by_hand, X_WH=X_WH)
    context = transfer_context(by_hand, under_way, held)
    p_WH = find_handle(held, context).translation()
    np.testing.assert_allclose(p_WH, X_WH.translation(), atol=1e-12)
    tool = read_tool(by_hand, under_way)
    np.testing.assert_array_equal(read_tool(held, context), tool)
    assert context.get_time() == under_way.get_time()
    # Without a place to be it is put where the hand would start.
    elsewhere = BuildHapticDiagram(scene, device=device, reuse=by_hand)
    start = by_hand.diagram.CreateDefaultContext()
    np.testing.assert_allclose(
        find_handle(elsewhere, elsewhere.diagram.CreateDefaultContext()).translation(),
        find_handle(by_hand, start).translation(),
        atol=1e-12,
    )


def test_a_device_that_moves_on_while_an_effect_comes_is_where_it_is(scene, by_hand):
    """Its base does not move for that, or the handle would be somewhere else."""
    device = move_by([1e-4, 0.0, 0.0])
    first = BuildHapticDiagram(scene, device=device, reuse=by_hand)
    context = run_on(first, first.diagram.CreateDefaultContext(), 0.05)
    for _ in range(40):
        device.read()
    effects = Effects(friction=FrictionParameters())
    other = BuildHapticDiagram(
        replace(scene, effects=effects), device=device, reuse=first
    )
    assert other.X_WB.IsExactlyEqualTo(first.X_WB)
    there = transfer_context(first, context, other)
    np.testing.assert_array_equal(read_tool(other, there), read_tool(first, context))
    there = run_on(other, there, 0.001)
    moved = find_handle(other, there).translation()
    moved = moved - find_handle(first, context).translation()
    # 40 readings, and those of a build and a tick.
    assert 0.004 <= np.linalg.norm(moved) < 0.0055


def test_a_hand_takes_the_handle_where_a_device_left_it(scene, by_hand, under_way):
    X_WH = find_handle(by_hand, under_way)
    device = move_by([1e-4, 0.0, 5e-5])
    held = BuildHapticDiagram(scene, device=device, reuse=by_hand, X_WH=X_WH)
    context = run_on(held, transfer_context(by_hand, under_way, held), 0.1)
    there = transfer_context(held, context, by_hand)
    assert find_handle(by_hand, there).IsNearlyEqualTo(find_handle(held, context), 1e-9)
    np.testing.assert_array_equal(read_tool(by_hand, there), read_tool(held, context))
    # At rest, and nothing is shown yet.
    for name in ("V_WH", "F_Ho_W_rendered"):
        shown = read_output(by_hand.loop.device, name, there)
        np.testing.assert_array_equal(shown, np.zeros(6))


def test_out_of_the_arms_reach_the_hand_begins_at_its_path(scene, by_hand):
    device = move_by([0.0, 0.0, 0.02])
    held = BuildHapticDiagram(scene, device=device, reuse=by_hand)
    context = run_on(held, held.diagram.CreateDefaultContext(), 0.05)
    there = transfer_context(held, context, by_hand)
    start = by_hand.diagram.CreateDefaultContext()
    assert there.get_time() == context.get_time()
    assert find_handle(by_hand, there).IsNearlyEqualTo(find_handle(by_hand, start), 0.0)
    np.testing.assert_array_equal(read_tool(by_hand, there), read_tool(by_hand, start))


def test_an_arm_that_stands_elsewhere_is_another(scene, by_hand, under_way):
    base = Pose(position_m=[-0.2, 0.01, 0.2])
    moved = BuildHapticDiagram(
        replace(scene, device=replace(scene.device, base=base)), reuse=by_hand
    )
    there = transfer_context(by_hand, under_way, moved)
    assert find_handle(moved, there).IsNearlyEqualTo(
        find_handle(by_hand, under_way), 1e-9
    )
    tool = read_tool(by_hand, under_way)
    np.testing.assert_array_equal(read_tool(moved, there), tool)
