"""One period of a sampled system as functions of its state."""

import numpy as np
from pydrake.systems.framework import DiagramBuilder
from remembering_system import Remembers_
from wall_loop import make_loop

from drake_haptics.analysis.diagram_systems import find_timings
from drake_haptics.analysis.sampled_map import SampledMap, get_state, set_state


def make_map(system):
    context = system.CreateDefaultContext()
    return SampledMap(system, context, find_timings(system, context)), context


def test_the_update_comes_before_the_motion():
    one_period, _ = make_map(make_loop(900.0))
    x, u = np.array([0.01, 2.0, 0.5, 7.0]), np.zeros(0)
    held = one_period.hold(x, u)
    np.testing.assert_allclose(held, [0.01, 2.0, 0.01, -9.0])
    values = one_period.calc(x, held, u)
    np.testing.assert_allclose(values.update, held[2:])
    # a = (f - b v) / m with the force after the update.
    np.testing.assert_allclose(values.rates, [2.0, (-9.0 - 0.5 * 2.0) / 0.1])


def test_the_users_context_is_not_the_one_used():
    one_period, context = make_map(make_loop(900.0))
    one_period.calc(np.ones(4), np.ones(4), np.zeros(0))
    assert not get_state(context).any()
    set_state(context, np.arange(4.0))
    np.testing.assert_array_equal(get_state(context), np.arange(4.0))


def test_derivatives_are_prepared_at_the_state_not_where_it_was_last_used():
    builder = DiagramBuilder()
    system = builder.AddSystem(Remembers_[float](0.25))
    one_period, _ = make_map(builder.Build())
    one_period.calc(np.array([3.0]), np.array([4.0]), np.zeros(0))
    found = one_period.differentiate(np.array([5.0]), np.array([6.0]), np.zeros(0))
    assert system.told == [5.0]
    np.testing.assert_array_equal(found.update, [[0.25]])
