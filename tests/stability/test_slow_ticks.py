"""A loop whose ticks are too slow drops work in its order, and nothing that counts."""

import json
from functools import partial

import numpy as np
import pytest
from fake_clock import FakeClock

from drake_haptics import SceneTracker
from drake_haptics.loop import builder
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import BrakingParameters, Effects, FrictionParameters
from drake_haptics.simulation.run import run
from drake_haptics.systems.contact.load_shedding import TickMeter

BUDGET_S = 5e-4
# Slow while the spoon scrapes along the cup's wall.
SLOW_S = (1.0, 1.6)
END_S = 4.8
# So soft that the spoon penetrates: m, N/m, N·s/m.
SOFT = {"tolerance_m": 1e-3, "stiffness_N_per_m": 2e3, "damping_Ns_per_m": 4.0}


def build(scene_name, monkeypatch, *, budget_us=1e6 * BUDGET_S, **contact):
    """Returns a scene with a budget, and the clock that its ticks are timed by."""
    scene = load_scene(find_scene(scene_name))
    scene.device.tick_budget_us = budget_us
    scene.effects = Effects(friction=FrictionParameters(), braking=BrakingParameters())
    for name, value in {**SOFT, **contact}.items():
        setattr(scene.contact, name, value)
    # Each look at it is half a tick's work later.
    clock = FakeClock(reading_s=0.4 * BUDGET_S)
    monkeypatch.setattr(builder, "TickMeter", partial(TickMeter, clock))
    return BuildHapticDiagram(scene), clock


def watch_run(haptic, clock):
    """Runs it, slow for a while.

    Returns:
        For each tick the time, `load_shedding` (3), the force on the tool (3), N, the
        distance of the deepest cluster and that of the deepest contact by another
        query, m.
    """
    loop = haptic.loop
    truth = SceneTracker(
        haptic.tool, haptic.environment, haptic.scene.contact.tolerance_m
    )
    rows = []

    def watch(context):
        time_s = context.get_time()
        slow = SLOW_S[0] <= time_s < SLOW_S[1]
        # What a tick takes passes while it is worked at.
        clock.reading_s = BUDGET_S * (1.6 if slow else 0.4)
        own = {
            system: system.GetMyContextFromRoot(context)
            for system in (
                loop.load_shedding,
                loop.penalty_force,
                loop.contact_clustering,
                loop.haptic_tool,
            )
        }
        load_shedding = loop.load_shedding.GetOutputPort("load_shedding").Eval(
            own[loop.load_shedding]
        )
        F = loop.penalty_force.GetOutputPort("F_To_W").Eval(own[loop.penalty_force])
        clusters = loop.contact_clustering.GetOutputPort("clusters").Eval(
            own[loop.contact_clustering]
        )
        X_WT = loop.haptic_tool.GetOutputPort("X_WT").Eval(own[loop.haptic_tool])
        contacts = truth.query(X_WT)
        rows.append(
            (
                time_s,
                *load_shedding,
                *F[3:],
                clusters.distance.min(initial=0.0),
                contacts.distance.min(initial=0.0),
            )
        )

    figures = run(haptic, END_S, on_tick=watch).to_dict()
    return np.array(rows), figures


METHODS = {"shared": {}, "octree": {"cluster_size_m": 4e-3}}


@pytest.fixture(scope="module", params=METHODS)
def method(request):
    return {"clustering": request.param, **METHODS[request.param]}


@pytest.fixture(scope="module")
def slow(method):
    with pytest.MonkeyPatch.context() as patch:
        return watch_run(*build("cup_spoon", patch, **method))


def test_all_is_dropped_in_its_order_and_comes_back(slow):
    (time_s, shed, reach, cell, *_), figures = slow[0].T, slow[1]
    assert shed[time_s < SLOW_S[0]].max() == 0.0
    assert shed.max() == 3.0
    assert shed[-1] == 0.0
    assert (reach[shed <= 1.0] == 1.0).all()
    assert (cell[shed <= 2.0] == 0.0).all()
    stages = list(json.loads(json.dumps(figures["shed_ticks"])).values())
    assert stages == sorted(stages, reverse=True) and stages[-1] > 0


def test_nothing_that_penetrates_is_lost(slow):
    *_, kept, deepest = slow[0].T
    pressing = deepest < -1e-6
    assert pressing[slow[0][:, 1] > 2.0].any()
    np.testing.assert_allclose(kept[pressing], deepest[pressing], atol=1e-9)


def test_no_limit_is_met_and_no_force_jumps_that_did_not(slow, method, monkeypatch):
    rows, figures = slow
    assert (figures["limit_hits"], figures["non_finite_events"]) == (0, 0)
    # A budget that no tick of that clock exceeds.
    plain, _ = watch_run(*build("cup_spoon", monkeypatch, budget_us=1e3, **method))
    assert plain[:, 1].max() == 0.0
    largest_N = [find_steps(f_W).max() for f_W in (rows[:, 4:7], plain[:, 4:7])]
    # Among forces of some newtons, no step below half of one is a jump.
    assert largest_N[0] < 2.0 * max(largest_N[1], 0.5)


def test_the_skin_thins_and_thickens_unnoticed(slow):
    # Thinning by 3/4 mm within 50 ticks, with 2000 N/m: 0.03 N in a tick, shared by
    # contacts at most 4/3 as stiff together; the rest is the motion's own.
    rows, _ = slow
    thinning = np.diff(rows[:, 2]) != 0.0
    assert thinning.sum() > 500
    own = np.median(find_steps(rows[:, 4:7])[~thinning])
    assert np.median(find_steps(rows[:, 4:7])[thinning]) < own + 0.04


def find_steps(f_W):
    """Returns how far the force (n, 3) changes from tick to tick (n - 1,), N."""
    return np.linalg.norm(np.diff(f_W, axis=0), axis=1)
