"""Runs: what they measure, how they end."""

import gc
import json
import time

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from fake_clock import FakeClock
from fake_device import ScriptedDevice, make_reading
from pydrake.systems.framework import DiagramBuilder

from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.settings import change_scene
from drake_haptics.simulation.run import RunError, make_simulator, run
from drake_haptics.simulation.statistics import RunStatistics

ABOVE = (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.02)
# 1 cm into the plate, through a hand of 300 N/m.
PRESSING = (0.2, 0.0, 0.0, TOOL_HALF_HEIGHT - 0.01)


@pytest.fixture(scope="module")
def haptic(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scene")
    return BuildHapticDiagram(over_a_plate(folder, [ABOVE, PRESSING]))


def test_a_run_measures_every_tick(haptic):
    times = []
    figures = run(
        haptic, 0.5, on_tick=lambda context: times.append(context.get_time())
    ).to_dict()
    assert figures["ticks"] == 500
    np.testing.assert_allclose(times, np.arange(1, 501) * 1e-3, atol=1e-12)
    assert figures["duration_s"] == pytest.approx(0.5)
    assert 0.0 < figures["contact_query_us"]["median"] < figures["tick_us"]["median"]
    assert figures["contacts"]["max"] >= 1
    assert figures["clusters"]["max"] >= 1
    assert 1.0 < figures["max_force_N"] < 8.5
    assert (figures["limit_hits"], figures["non_finite_events"]) == (0, 0)


def test_runs_of_parts_of_a_tick_count_no_tick_twice(haptic):
    times, statistics = [], RunStatistics(haptic.period_s)
    context = haptic.diagram.CreateDefaultContext()
    for duration_s in (0.4e-3, 1.6e-3, 3e-3):
        run(
            haptic,
            duration_s,
            context=context,
            statistics=statistics,
            on_tick=lambda context: times.append(context.get_time()),
        )
    assert times == pytest.approx(np.arange(1, 7) * 1e-3)
    assert statistics.duration_s == pytest.approx(context.get_time())


def test_an_infinite_run_ends_when_it_is_told(haptic):
    figures = run(haptic, np.inf, on_tick=lambda context: context.get_time() > 4.5e-3)
    assert figures.ticks == 5


def test_statistics_made_before_a_run_report_its_lateness(haptic):
    statistics = RunStatistics(haptic.period_s)
    run(haptic, 0.01, pace=RealTimePacer(haptic.period_s), statistics=statistics)
    assert statistics.lateness_us["skipped"] >= 0


def test_a_run_starts_again_each_time(haptic):
    first, second = (run(haptic, 0.3, energy=True).to_dict() for _ in range(2))
    for key in (
        "max_force_N",
        "max_torque_Nm",
        "max_penetration_m",
        "contacts",
        "energy_J",
    ):
        assert first[key] == second[key]


def test_a_context_that_never_ran_starts_like_the_scene(tmp_path):
    slow = change_scene(over_a_plate(tmp_path, [ABOVE]), ["contact.query_rate_hz=100"])
    haptic = BuildHapticDiagram(slow)
    expected = run(haptic, 0.02)
    found = run(haptic, 0.02, context=haptic.diagram.CreateDefaultContext())
    assert found.max_force_N == expected.max_force_N


def test_the_energy_of_every_tick_is_booked(haptic):
    # The books begin with the first tick: what the tool has at the end came in.
    books = run(haptic, 0.3, energy=True).to_dict()["energy_J"]
    tool = books["tool"]
    assert tool["stored"] > 0.0
    assert tool["net"] == pytest.approx(tool["stored"] + tool["lost"], rel=1e-12)
    assert books["device"]["in"] > books["contact"]["in"] > 0.0


def test_steps_between_ticks_are_no_ticks(tmp_path):
    """A run whose tool is stepped four times a tick has the motion of a fast one."""
    path = [(0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 2e-3), (0.05, 0.0, 0.0, 0.0)]
    scene = over_a_plate(tmp_path, path)
    scene = change_scene(scene, ["contact.law=constraint", "device.servo_rate_hz=4000"])
    ends = []
    between = run(
        BuildHapticDiagram(scene),
        0.1,
        energy=True,
        on_tick=lambda context: ends.append(context.get_time()),
    )
    assert (between.ticks, between.duration_s) == (100, pytest.approx(0.1))
    np.testing.assert_allclose(ends, np.arange(1, 101) * 1e-3, atol=1e-12)
    pace = RealTimePacer(1e-3)
    run(BuildHapticDiagram(scene), 0.02, pace=pace)
    assert pace.ticks == 19  # the first only begins
    fast = change_scene(scene, ["device.servo_rate_hz=", "device.rate_hz=4000"])
    fine = run(BuildHapticDiagram(fast), 0.1, energy=True)
    assert (fine.ticks, fine.duration_s) == (400, pytest.approx(0.1))
    assert fine.max_force_N > 0.1
    assert between.energy_J == fine.energy_J


def test_a_run_in_parts_measures_what_one_does(haptic):
    """Each part goes on where the last one was ended from its `on_tick`."""
    whole = run(haptic, 0.4).to_dict()
    context, statistics = None, None
    for ticks in (150, 1, 249):
        ends = []

        def end_tick(root, ends=ends, ticks=ticks):
            ends.append(root.Clone())
            return len(ends) == ticks

        statistics = run(
            haptic, None, on_tick=end_tick, context=context, statistics=statistics
        )
        context = ends[-1]
    parts = statistics.to_dict()
    assert context.get_time() == pytest.approx(0.4)
    exact = ["ticks", "duration_s", "contacts", "clusters", "limit_hits"]
    assert [parts[key] for key in exact] == [whole[key] for key in exact]
    for key in ("max_force_N", "max_torque_Nm", "max_penetration_m"):
        assert parts[key] == pytest.approx(whole[key], rel=1e-9)


def test_a_part_of_a_run_takes_its_own_time(haptic):
    context = haptic.diagram.CreateDefaultContext()
    context.SetTime(0.1)
    times = []
    run(haptic, 0.02, context=context, on_tick=lambda c: times.append(c.get_time()))
    np.testing.assert_allclose(times, np.arange(101, 121) * 1e-3, atol=1e-12)


def test_energy_is_not_booked_of_a_part(haptic):
    with pytest.raises(ValueError, match="energy"):
        run(haptic, 0.01, energy=True, statistics=run(haptic, 0.01))


def test_a_simulator_is_made_of_what_the_builder_gave(haptic):
    with pytest.raises(TypeError, match=r"^haptic must be .*HapticDiagram, is of"):
        make_simulator(haptic.diagram)


@pytest.mark.parametrize("duration_s", [-1.0, float("nan")])
def test_a_time_before_now_is_refused_and_does_not_end_python(haptic, duration_s):
    with pytest.raises(ValueError, match=r"^duration_s must not be negative, is"):
        run(haptic, duration_s)


def test_statistics_of_another_tick_are_refused(haptic):
    with pytest.raises(ValueError, match=r"^statistics: have ticks of 0\.5 s, and"):
        run(haptic, 0.01, statistics=RunStatistics(0.5))


def test_a_diagram_inside_another_is_not_run_alone(tmp_path):
    part, builder = (
        BuildHapticDiagram(over_a_plate(tmp_path, [ABOVE])),
        DiagramBuilder(),
    )
    builder.AddSystem(part.diagram)
    run(part, 0.001)
    builder.Build()
    with pytest.raises(ValueError, match=r"^haptic: its diagram is part"):
        run(part, 0.001)


def test_garbage_is_thawed_after_a_run(haptic):
    before = gc.get_freeze_count()
    run(haptic, 0.01)
    assert gc.get_freeze_count() == before


def test_ctrl_c_comes_out_of_a_run_and_leaves_what_ran(haptic):
    def interrupt(context):
        if context.get_time() > 0.0495:
            raise KeyboardInterrupt

    statistics = RunStatistics(haptic.period_s)
    frozen = gc.get_freeze_count()
    with pytest.raises(KeyboardInterrupt):
        run(haptic, None, on_tick=interrupt, statistics=statistics)
    assert statistics.ticks == 50
    assert statistics.to_dict()["tick_us"]["median"] > 0.0
    assert gc.get_freeze_count() == frozen


def test_other_errors_come_out(haptic):
    def fail(context):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        run(haptic, 0.01, on_tick=fail)


def test_in_real_time_a_run_is_not_faster_than_the_clock(haptic):
    start = time.perf_counter()
    figures = run(haptic, 0.2, pace=RealTimePacer(haptic.period_s)).to_dict()
    assert time.perf_counter() - start >= 0.199
    assert figures["ticks"] == 200


def test_waiting_is_not_part_of_a_tick(haptic, monkeypatch):
    clock = FakeClock(reading_s=1e-6)
    monkeypatch.setattr(time, "perf_counter", clock)
    pace = RealTimePacer(haptic.period_s, clock, clock.sleep)
    figures = run(haptic, 0.2, pace=pace).to_dict()
    assert pace.ticks == 199 and pace.skipped == 0
    # Two readings: the one that ends the tick and the one that waiting begins with.
    assert figures["tick_us"]["max"] == pytest.approx(2.0)


def test_a_value_that_is_not_finite_stops_the_run(haptic):
    root = haptic.diagram.CreateDefaultContext()
    tool = haptic.loop.haptic_tool.GetMyMutableContextFromRoot(root)
    tool.get_mutable_discrete_state_vector().SetAtIndex(9, np.nan)
    with pytest.raises(
        RunError, match=r"stopped at 0.0010 s: the tool's state is not finite"
    ) as caught:
        run(haptic, 1.0, energy=True, context=root)
    figures = caught.value.statistics.to_dict()
    assert figures["non_finite_events"] == 1
    # The device was shown nothing, and nothing was booked.
    assert figures["max_force_N"] == 0.0
    assert all(part["in"] == 0.0 for part in figures["energy_J"].values())
    json.dumps(figures, allow_nan=False)


def test_an_arm_that_is_lost_stops_the_run(haptic):
    root = haptic.diagram.CreateDefaultContext()
    state = root.get_mutable_continuous_state_vector()
    state.SetAtIndex(state.size() - 1, np.inf)
    with pytest.raises(RunError, match="the arm's state is not finite"):
        run(haptic, 1.0, energy=True, context=root)


def test_a_tool_that_is_lost_to_an_absurd_handle_stops_the_run(tmp_path):
    """The slopes for the device are computed before the tick ends."""
    scene = over_a_plate(tmp_path, [ABOVE, PRESSING])
    backend = ScriptedDevice(lambda k: make_reading(k, velocity=(0.0, 0.0, 1e308)))
    with pytest.raises(RunError, match="the tool's state is not finite"):
        run(BuildHapticDiagram(scene, device=backend), 1.0)


def test_no_coupling_is_too_stiff_for_the_limits_of_the_device(tmp_path):
    scene = over_a_plate(tmp_path, [ABOVE, PRESSING])
    scene.coupling.stiffness_N_per_m = 1e308
    figures = run(BuildHapticDiagram(scene), 0.5).to_dict()
    assert figures["limit_hits"] > 0
    assert figures["max_force_N"] <= 8.5 * (1 + 1e-12)
    json.dumps(figures, allow_nan=False)


def test_the_step_is_fine_enough_for_the_arm(haptic):
    # A four times smaller step changes the handle's motion, at 0.15 m/s, by less
    # than the resolution of such devices, 30 µm.
    ends = []
    for share in (1.0, 0.25):
        simulator = make_simulator(haptic)
        simulator.get_mutable_integrator().set_maximum_step_size(
            share * haptic.period_s
        )
        simulator.AdvanceTo(0.15)
        X_WH = haptic.diagram.GetOutputPort("X_WH").Eval(simulator.get_context())
        ends.append(X_WH[4:])
    assert np.linalg.norm(ends[0] - ends[1]) < 1e-5
