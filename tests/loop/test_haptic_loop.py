"""Every value of a loop is seen by the name of an output of the diagram."""

import numpy as np
import pytest
from box_scenes import PLATE_TOP, TOOL_HALF_HEIGHT, over_a_plate
from diagram_parts import EVERY, outputs
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import LogVectorOutput

from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import Effects
from drake_haptics.simulation.run import run

# The hand wants the cube's middle 5 mm above the plate, where half of it does not fit.
PRESSED = [(0.0, 0.0, 0.0, 0.02), (0.3, 0.0, 0.0, 0.005)]
ALWAYS = {
    "X_WT",
    "V_WT",
    "X_WH",
    "V_WH",
    "F_Ho_W_commanded",
    "F_Ho_W_rendered",
    "status",
    "contacts",
    "clusters",
    "contact_wrench",
    "F_To_W",
}


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    return over_a_plate(tmp_path_factory.mktemp("scene"), PRESSED)


def test_a_diagram_has_an_output_for_what_it_has(scene, tmp_path):
    assert outputs(BuildHapticDiagram(scene).diagram) == ALWAYS
    every = over_a_plate(tmp_path, PRESSED)
    every.effects = Effects(**EVERY)
    haptic = BuildHapticDiagram(every)
    assert outputs(haptic.diagram) == ALWAYS | {"friction_force", "energy_J"}
    # What is displayed comes last, and contacts are those that are felt.
    assert (
        haptic.loop.outputs["F_Ho_W_commanded"].get_system()
        is haptic.loop.effects.passivity
    )
    assert haptic.loop.outputs["contacts"].get_system() is haptic.loop.effects.shading


def test_a_tick_reads_what_balances_at_rest(scene):
    haptic = BuildHapticDiagram(scene)
    seen = {}

    def look(root):
        for name in ALWAYS:
            seen[name] = haptic.diagram.GetOutputPort(name).Eval(root)

    run(haptic, 1.0, on_tick=look)
    # Nothing moves, and nothing but coupling and contact acts on the tool: the
    # handle's wrench is the contact's, about another point.
    np.testing.assert_allclose(seen["V_WT"], 0.0, atol=1e-4)
    np.testing.assert_allclose(seen["V_WH"], 0.0, atol=1e-4)
    force = seen["F_To_W"][3:]
    assert force[2] > 0.5
    np.testing.assert_allclose(seen["F_Ho_W_rendered"][3:], force, atol=1e-3)
    np.testing.assert_allclose(
        seen["F_Ho_W_commanded"], seen["F_Ho_W_rendered"], atol=1e-3
    )
    # The coupling is the one spring between handle and tool: 800 N/m.
    X_WT, X_WH = vector_to_pose(seen["X_WT"]), vector_to_pose(seen["X_WH"])
    grasp = scene.tool.grasp.to_rigid_transform()
    stretch = X_WT.translation() - (X_WH @ grasp).translation()
    np.testing.assert_allclose(800.0 * stretch, force, atol=1e-2)
    gap = X_WT.translation()[2] - TOOL_HALF_HEIGHT - PLATE_TOP
    assert seen["contacts"].least_distance == pytest.approx(gap, abs=1e-6)
    assert len(seen["clusters"]) > 0


def test_an_output_is_logged_in_a_diagram_around_it(scene):
    haptic = BuildHapticDiagram(scene)
    builder = DiagramBuilder()
    builder.AddSystem(haptic.diagram)
    port = haptic.diagram.GetOutputPort("F_Ho_W_rendered")
    log = LogVectorOutput(port, builder, haptic.period_s)
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(0.3)
    found = log.FindLog(simulator.get_context())
    np.testing.assert_allclose(found.sample_times(), 1e-3 * np.arange(301), atol=1e-12)
    context = haptic.diagram.GetMyContextFromRoot(simulator.get_context())
    assert found.data()[5, -1] > 0.1
    np.testing.assert_array_equal(found.data()[:, -1], port.Eval(context))
