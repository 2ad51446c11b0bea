"""The recorded handle as a system: tick k's bits at tick k."""

import numpy as np
import pytest
from pydrake.systems.analysis import Simulator

from drake_haptics.systems.device.replayed_handle import ReplayedHandle

# No binary fraction, and one whose multiples round down.
PERIODS = [1e-3, 1 / 3000, 0.1, 7e-4]


def make_motion(ticks):
    random = np.random.default_rng(4)
    return random.normal(size=(ticks, 7)), random.normal(size=(ticks, 6))


def read(handle, context):
    return [handle.GetOutputPort(name).Eval(context) for name in ("X_WH", "V_WH")]


@pytest.mark.parametrize("period_s", PERIODS)
def test_each_tick_has_its_own_row(period_s):
    X_WH, V_WH = make_motion(20_000)
    handle = ReplayedHandle(X_WH, V_WH, period_s)
    context = handle.CreateDefaultContext()
    handle.GetInputPort("F_Ho_W_rendered").FixValue(context, np.ones(6))
    for k in [0, 1, 2, *range(3, 20_000, 7)]:
        context.SetTime(k * period_s)
        pose, velocity = read(handle, context)
        assert (pose == X_WH[k]).all()
        assert (velocity == V_WH[k]).all()


def test_it_holds_between_ticks_and_after_the_last():
    X_WH, V_WH = make_motion(3)
    handle = ReplayedHandle(X_WH, V_WH, 1e-3)
    context = handle.CreateDefaultContext()
    for time_s, k in [(0.9e-3, 0), (1.1e-3, 1), (2.5e-3, 2), (3e-3, 2), (1e3, 2)]:
        context.SetTime(time_s)
        assert (read(handle, context)[0] == X_WH[k]).all()


def test_the_wrench_is_not_needed():
    handle = ReplayedHandle(*make_motion(2), 1e-3)
    assert not handle.HasAnyDirectFeedthrough()
    Simulator(handle).AdvanceTo(0.01)


def test_what_cannot_be_replayed_is_refused():
    X_WH, V_WH = make_motion(2)
    with pytest.raises(ValueError, match="have 2 and 1"):
        ReplayedHandle(X_WH, V_WH[:1], 1e-3)
    with pytest.raises(ValueError, match="have 0 and 0"):
        ReplayedHandle(X_WH[:0], V_WH[:0], 1e-3)
    with pytest.raises(ValueError, match="period_s must be positive and finite, is 0"):
        ReplayedHandle(X_WH, V_WH, 0.0)
    with pytest.raises(
        ValueError, match=r"X_WH must have shape \(n, 7\), has \(2, 6\)"
    ):
        ReplayedHandle(X_WH[:, :6], V_WH, 1e-3)
    with pytest.raises(
        ValueError, match=r"V_WH must have shape \(n, 6\), has \(2, 7\)"
    ):
        ReplayedHandle(X_WH, X_WH, 1e-3)
    X_WH[1, :4] = 0.0
    with pytest.raises(ValueError, match=r"X_WH\[1\] has a quaternion of zero"):
        ReplayedHandle(X_WH, V_WH, 1e-3)
