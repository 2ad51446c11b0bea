"""What a loop leaves out where its ticks take too long, in which order, how fast."""

import numpy as np
import pytest
from fake_clock import FakeClock
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder, LeafSystem

from drake_haptics.systems.contact.load_shedding import LoadShedding, TickEnd, TickMeter

# Exact, so that each advance ends at a tick.
PERIOD_S = 2.0**-10
BUDGET_S = 5e-4
CELL_M = 8e-3


class Work(LeafSystem):
    """Takes as long in each tick as the test wants."""

    def __init__(self, clock):
        super().__init__()
        self.takes_s = 0.0
        self._clock = clock
        self.DeclarePeriodicPublishEvent(PERIOD_S, 0.0, self._work)

    def _work(self, context):
        self._clock.now_s += self.takes_s


class Loop:
    """A loop that does nothing but work, and waits between its ticks."""

    def __init__(self):
        clock = FakeClock()
        meter = TickMeter(clock)
        builder = DiagramBuilder()
        self._shedding = builder.AddSystem(
            LoadShedding(meter, PERIOD_S, BUDGET_S, CELL_M)
        )
        self._work = builder.AddSystem(Work(clock))
        builder.AddSystem(TickEnd(meter, PERIOD_S))
        self._simulator = Simulator(builder.Build())
        self._simulator.Initialize()
        self._clock = clock
        self._time_s = 0.0

    def run(self, ticks, takes_s):
        """Runs ticks that take so long; returns `load_shedding` of each, (ticks, 3)."""
        self._work.takes_s = takes_s
        load_shedding = []
        port = self._shedding.GetOutputPort("load_shedding")
        for _ in range(ticks):
            self._time_s += PERIOD_S
            self._simulator.AdvanceTo(self._time_s)
            # What lies between two ticks is no work of theirs.
            self._clock.now_s += 10 * PERIOD_S
            context = self._shedding.GetMyContextFromRoot(self._simulator.get_context())
            load_shedding.append(port.Eval(context))
        return np.array(load_shedding)


@pytest.fixture
def loop():
    return Loop()


def test_nothing_is_dropped_within_the_budget(loop):
    np.testing.assert_array_equal(
        loop.run(200, 0.9 * BUDGET_S), np.tile([0.0, 1.0, 0.0], (200, 1))
    )


def test_stages_follow_in_their_order(loop):
    shed, reach, cell = loop.run(200, 2 * BUDGET_S).T
    assert (np.diff(shed) >= 0.0).all() and shed[-1] == 3.0
    # Each stage begins where the one before has dropped all.
    assert (reach[shed <= 1.0] == 1.0).all()
    assert (reach[shed >= 2.0] == 0.25).all()
    assert (cell[shed <= 2.0] == 0.0).all()
    assert cell[-1] == CELL_M


def test_they_come_back_in_the_reverse_order_more_slowly(loop):
    dropped = loop.run(60, 2 * BUDGET_S)
    back = loop.run(2000, 0.5 * BUDGET_S)
    assert (np.diff(back[1:, 0]) <= 0.0).all() and back[-1, 0] == 0.0
    np.testing.assert_allclose(back[-1], [0.0, 1.0, 0.0])
    assert np.diff(dropped[:, 0]).max() > 10 * -np.diff(back[1:, 0]).min()


def test_between_budget_and_well_below_it_stays(loop):
    before = loop.run(70, 2 * BUDGET_S)[-1]
    # The tick that was measured last still was too long.
    loop.run(1, 0.9 * BUDGET_S)
    after = loop.run(300, 0.9 * BUDGET_S)
    assert after[0, 0] >= before[0]
    np.testing.assert_array_equal(after, np.tile(after[0], (300, 1)))


def test_one_late_tick_is_felt_by_no_one(loop):
    loop.run(10, 0.5 * BUDGET_S)
    load_shedding = np.vstack(
        [loop.run(1, 1000 * BUDGET_S), loop.run(3, 0.5 * BUDGET_S)]
    )
    assert 0.0 < load_shedding[:, 0].max() < 0.05
    assert (load_shedding[:, 1:] == [1.0, 0.0]).all()


@pytest.mark.parametrize("name", ["period_s", "budget_s", "largest_cell_m"])
@pytest.mark.parametrize("value", [0.0, -1.0, np.inf, np.nan])
def test_what_cannot_be_is_refused(name, value):
    arguments = {"period_s": PERIOD_S, "budget_s": 5e-4, "largest_cell_m": 1e-2}
    with pytest.raises(ValueError, match=f"{name} must be positive and finite"):
        LoadShedding(TickMeter(), **{**arguments, name: value})


def test_between_two_ticks_nothing_is_measured():
    clock = FakeClock()
    meter = TickMeter(clock)
    meter.end()
    assert meter.busy_s == 0.0
    meter.begin()
    clock.now_s += 0.25
    meter.end()
    clock.now_s += 5.0
    meter.end()
    assert meter.busy_s == 0.25


def test_a_loop_that_may_shed_load_can_be_differentiated():
    meter = TickMeter(FakeClock())
    builder = DiagramBuilder()
    builder.AddSystem(LoadShedding(meter, PERIOD_S, BUDGET_S, CELL_M))
    builder.AddSystem(TickEnd(meter, PERIOD_S))
    twin = builder.Build().ToAutoDiffXd()
    state = twin.CreateDefaultContext().get_discrete_state_vector().CopyToVector()
    assert [x.value() for x in state] == [0.0, 1.0, 0.0]


@pytest.mark.parametrize("period_s", [0.0, -1e-3])
def test_a_period_that_is_not_positive_is_refused(period_s):
    with pytest.raises(ValueError, match="period_s must be positive and finite"):
        TickEnd(TickMeter(), period_s)
