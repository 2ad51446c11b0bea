"""The page is shown what the ticks were, no peak lost, in the picture's directions."""

import json
import math

import numpy as np
import pytest
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics.web.frame_maker import FrameMaker
from drake_haptics.web.messages import NOT_KNOWN, Telemetry, Tick

X_WC = RigidTransform(RollPitchYaw(-2.0, 0.2, 0.7), [0.3, -0.4, 0.5])


def tick(time_s, **changes):
    known = {
        "tick_s": 50e-6,
        "query_s": 30e-6,
        "contacts": 5.0,
        "clusters": 2.0,
        "distance_m": 1e-3,
        "tau_W": (0.0, 0.0, 0.1),
        "f_W": (3.0, 4.0, 0.0),
        "late_s": 1e-4,
    }
    return Tick(time_s=time_s, **(known | changes))


def packet(ticks, clock_s=0.0, **changes):
    known = {
        "gate": "active",
        "fault": "",
        "silent_s": 0.0,
        "shed": 0,
        "skipped": 3,
        "R_WC": tuple(X_WC.rotation().matrix().ravel().tolist()),
        "p_WC": tuple(X_WC.translation().tolist()),
        "p_WH": tuple(X_WC @ np.array([0.02, -0.03, 0.4])),
    }
    return Telemetry(clock_s=clock_s, ticks=ticks, **(known | changes))


def test_vectors_are_those_of_the_picture():
    f_W, tau_W = np.array([1.0, 2.0, 3.0]), np.array([-0.1, 0.0, 0.3])
    frame = FrameMaker().make(packet([tick(0.0, f_W=tuple(f_W), tau_W=tuple(tau_W))]))
    R_CW = X_WC.rotation().inverse()
    # Drake's camera has y down and z away; the page wants up and near.
    np.testing.assert_allclose(frame["f"], [1, -1, -1] * (R_CW @ f_W))
    np.testing.assert_allclose(frame["tau"], [1, -1, -1] * (R_CW @ tau_W))
    assert frame["f_W"] == [1.0, 2.0, 3.0]
    height_m = 2 * 0.4 * np.tan(np.deg2rad(37.5))
    np.testing.assert_allclose(frame["handle"], [0.02 / height_m, 0.03 / height_m])


def test_the_picture_is_as_high_at_the_handle_as_a_pinhole_makes_it():
    """75 degrees from its lower to its upper edge; z of the world is up."""
    p_WH = X_WC.translation() + X_WC.rotation().matrix() @ [0.1, -0.2, 0.5]
    frame = FrameMaker().make(packet([], p_WH=p_WH.tolist()))
    assert frame["height_m"] == pytest.approx(2 * 0.5 * math.tan(math.radians(37.5)))
    R_CW = X_WC.rotation().matrix().T
    for i, name in enumerate("xyz"):
        x, y, z = R_CW[:, i]
        np.testing.assert_allclose(frame["axes"][name], [x, -y, -z], atol=1e-12)


@pytest.mark.parametrize("depth_m", [-1.0, 0.0, math.inf, math.nan])
def test_what_is_not_before_the_camera_has_no_place(depth_m):
    p_WH = (X_WC.translation() + X_WC.rotation().matrix()[:, 2] * depth_m).tolist()
    assert FrameMaker().make(packet([], p_WH=p_WH))["handle"] is None


def test_of_a_camera_that_is_not_known_nothing_is_said():
    frame = FrameMaker().make(packet([], p_WC=(math.nan,) * 3))
    assert frame["axes"] is frame["height_m"] is frame["handle"] is None


def test_the_trace_has_the_largest_of_every_4_ms():
    frames, maker = [], FrameMaker()
    forces = 8.0 * np.random.default_rng(1).random(99)
    ticks = [tick(1e-3 * i, f_W=(f, 0.0, 0.0)) for i, f in enumerate(forces)]
    for i in range(0, 99, 33):
        frames.append(maker.make(packet(ticks[i : i + 33])))
    shown = [f for frame in frames for f in frame["trace"]["force_N"]]
    assert frames[0]["trace"]["dt_s"] == 4e-3
    # The last step is not over yet.
    np.testing.assert_array_equal(shown, forces[:96].reshape(-1, 4).max(axis=1))
    assert len(frames[0]["trace"]["torque_Nm"]) == len(frames[0]["trace"]["force_N"])


def test_a_scene_that_begins_again_has_a_trace_and_rates_again():
    maker = FrameMaker()
    maker.make(packet([tick(9.0 + 1e-3 * i) for i in range(100)], clock_s=1.0))
    frame = maker.make(packet([tick(1e-3 * i) for i in range(100)], clock_s=1.1))
    assert len(frame["trace"]["force_N"]) >= 24
    frame = maker.make(packet([tick(0.1 + 1e-3 * i) for i in range(100)], clock_s=1.2))
    assert frame["real_time"] == pytest.approx(1.0)


def test_rates_are_by_the_loops_clock():
    maker = FrameMaker()
    for i in range(60):
        ticks = [tick(1e-3 * (20 * i + k)) for k in range(20)]
        frame = maker.make(packet(ticks, clock_s=0.04 * i))
    assert frame["rate_hz"] == pytest.approx(500.0)
    assert frame["real_time"] == pytest.approx(0.5)


def test_times_are_those_of_the_latest_ticks():
    maker = FrameMaker()
    late_s = 1e-6 * np.arange(3000)
    for i in range(0, 3000, 100):
        ticks = [tick(1e-3 * k, late_s=late_s[k]) for k in range(i, i + 100)]
        frame = maker.make(packet(ticks))
    p50, p99, most = 1e6 * np.quantile(late_s[2000:], [0.5, 0.99, 1.0])
    expected = {"p50": p50, "p99": p99, "max": most}
    assert frame["late_us"] == pytest.approx(expected, abs=0.6)
    assert frame["tick_us"] == pytest.approx({"median": 50, "p99": 50, "max": 50})


def test_the_deepest_of_a_frame_is_told_and_the_last_counts():
    ticks = [tick(0.0, distance_m=-2e-3, contacts=7.0), tick(1e-3, distance_m=1e-3)]
    frame = FrameMaker().make(packet(ticks))
    assert frame["gap_m"] == -2e-3
    assert (frame["contacts"], frame["clusters"]) == (5, 2)
    frame = FrameMaker().make(packet([tick(0.0, distance_m=math.inf)]))
    assert frame["gap_m"] is None


def test_what_is_not_known_is_null_in_json():
    nothing = dict.fromkeys(
        ("tick_s", "query_s", "contacts", "clusters", "distance_m", "late_s"), NOT_KNOWN
    )
    frame = FrameMaker().make(packet([tick(0.0, **nothing)]))
    json.dumps(frame, allow_nan=False)
    for name in ("late_us", "tick_us", "contacts", "gap_m"):
        assert frame[name] is None


def test_a_frame_without_ticks_says_how_things_are():
    told = {"gate": "fault", "fault": "stale", "silent_s": 5.0}
    frame = FrameMaker(["drawing", "far"]).make(packet([], shed=1, **told))
    json.dumps(frame, allow_nan=False)
    assert frame["shed"] == ["drawing"]
    assert {name: frame[name] for name in told} == told
    assert frame["skipped"] == 3
    assert frame["trace"]["force_N"] == []
