"""A spoon pressed against a cup for 10 seconds: it rests, and makes nothing."""

import numpy as np
import pytest

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import (
    Effects,
    FrictionParameters,
    GravityParameters,
    ShadingParameters,
)
from drake_haptics.simulation.run import run
from drake_haptics.simulation.statistics import RunStatistics

SETTLED_S, END_S = 3.0, 13.0
# From then on no energy flows, if nothing but springs and dampers acts.
STILL_S = 8.0
LAST_WAYPOINT_S = 1.2
LARGEST_DRIFT_M = 1.5e-6
LARGEST_FORCE_CYCLE_N = 0.01


@pytest.mark.parametrize(
    ("clustering", "effects"),
    [
        ("shared", Effects()),
        ("octree", Effects()),
        (
            "shared",
            Effects(
                shading=ShadingParameters(),
                friction=FrictionParameters(),
                gravity=GravityParameters(),
            ),
        ),
    ],
    ids=["shared", "octree", "effects"],
)
def test_the_spoon_rests(clustering, effects):
    scene = load_scene(find_scene("cup_spoon"))
    scene.contact.clustering = clustering
    if clustering == "octree":
        scene.contact.cluster_size_m = 6e-3
    scene.effects = effects
    path = scene.hand.path
    path.periodic = False
    path.waypoints = [x for x in path.waypoints if x.time_s <= LAST_WAYPOINT_S]
    haptic = BuildHapticDiagram(scene)
    tool, device = haptic.loop.haptic_tool, haptic.loop.device
    p_WT, f_shown, still = [], [], {}
    statistics = RunStatistics(haptic.period_s)

    def watch(context):
        if context.get_time() < SETTLED_S:
            return
        if not still and context.get_time() > STILL_S:
            still.update(statistics.energy_J)
        pose = tool.GetOutputPort("X_WT").Eval(tool.GetMyContextFromRoot(context))
        shown = device.GetOutputPort("F_Ho_W_rendered").Eval(
            device.GetMyContextFromRoot(context)
        )
        p_WT.append(pose[4:])
        f_shown.append(shown[3:])

    figures = run(
        haptic, END_S, energy=True, statistics=statistics, on_tick=watch
    ).to_dict()
    assert (figures["limit_hits"], figures["non_finite_events"]) == (0, 0)
    assert np.linalg.norm(f_shown[-1]) > 0.5
    assert np.ptp(p_WT, axis=0).max() < LARGEST_DRIFT_M
    assert np.ptp(f_shown, axis=0).max() < LARGEST_FORCE_CYCLE_N
    for name, part in figures["energy_J"].items():
        if name in ("coupling", "tool", "display"):
            assert part["created"] <= part["bound"] + 1e-9, name
    if (clustering, effects) == ("shared", Effects()):
        assert still["contact"]["stored"] > 1e-4
        for name, part in figures["energy_J"].items():
            for what in ("in", "out", "stored", "lost"):
                assert part[what] == pytest.approx(still[name][what], abs=1e-12)
