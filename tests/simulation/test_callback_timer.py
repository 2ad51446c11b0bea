"""What a callback takes is its own, by a clock that the callbacks turn themselves."""

import time

import pytest
from fake_clock import FakeClock
from pydrake.systems.framework import DiagramBuilder, LeafSystem

from drake_haptics.simulation import profiling
from drake_haptics.simulation.profiling import CallbackTimer


class Worker(LeafSystem):
    """Waits for its input, if it has one, then works for some time."""

    def __init__(self, clock, work_s, has_input, fails=False):
        super().__init__()
        self._clock, self._work_s, self._fails = clock, work_s, fails
        self._input = self.DeclareVectorInputPort("u", 1) if has_input else None
        self.DeclareVectorOutputPort("y", 1, self._calc, {self.time_ticket()})

    def _calc(self, context, output):
        if self._input is not None:
            self._input.Eval(context)
        self._clock.now_s += self._work_s
        if self._fails:
            raise RuntimeError("failed")


@pytest.fixture
def clock(monkeypatch):
    clock = FakeClock()
    monkeypatch.setattr(time, "perf_counter", clock)
    return clock


def build(source, sink):
    builder = DiagramBuilder()
    builder.AddSystem(source)
    builder.AddSystem(sink)
    builder.Connect(source.get_output_port(), sink.get_input_port())
    diagram = builder.Build()
    return diagram, diagram.CreateDefaultContext()


def tick(timer, clock, sink, root, time_s, outside_s):
    root.SetTime(time_s)
    sink.get_output_port().Eval(sink.GetMyContextFromRoot(root))
    clock.now_s += outside_s
    timer.end_tick(root)


def test_time_is_the_callbacks_own_and_the_rest_is_the_ticks(clock):
    with CallbackTimer() as timer:
        source, sink = Worker(clock, 5e-3, False), Worker(clock, 3e-3, True)
    _diagram, root = build(source, sink)
    # What comes before the first tick's end begins no tick.
    tick(timer, clock, sink, root, 1.0, 7.0)
    for i in range(10):
        tick(timer, clock, sink, root, 2.0 + i, 2e-3)
    own_s, tick_s = timer.calc_means()
    assert own_s[source] == pytest.approx(5e-3)
    assert own_s[sink] == pytest.approx(3e-3)
    assert tick_s == pytest.approx(10e-3)
    assert repr(timer) == "CallbackTimer(2 systems, 10 ticks)"


def test_only_the_middle_half_of_the_ticks_counts(clock):
    with CallbackTimer() as timer:
        source, sink = Worker(clock, 5e-3, False), Worker(clock, 3e-3, True)
    _diagram, root = build(source, sink)
    for i in range(301):
        outside_s = {0: 50.0, 1: 1e-3}.get(i % 5, 2e-3)
        tick(timer, clock, sink, root, 1.0 + i, outside_s)
    own_s, tick_s = timer.calc_means()
    assert tick_s == pytest.approx(10e-3)
    assert own_s[source] == pytest.approx(5e-3)


def test_a_callback_that_fails_leaves_the_books_in_order(clock):
    with CallbackTimer() as timer:
        source, sink = Worker(clock, 5e-3, False, fails=True), Worker(clock, 3e-3, True)
    _diagram, root = build(source, sink)
    timer.end_tick(root)
    with pytest.raises(RuntimeError, match="failed"):
        sink.get_output_port().Eval(sink.GetMyContextFromRoot(root))
    timer.end_tick(root)
    own_s, tick_s = timer.calc_means()
    assert own_s[source] == pytest.approx(5e-3)
    assert own_s[sink] == pytest.approx(0.0)
    assert tick_s == pytest.approx(5e-3)


def test_systems_from_outside_the_block_are_left_alone(clock):
    declare = LeafSystem.DeclareVectorOutputPort
    with CallbackTimer() as timer:
        assert LeafSystem.DeclareVectorOutputPort is not declare
    assert LeafSystem.DeclareVectorOutputPort is declare
    source, sink = Worker(clock, 5e-3, False), Worker(clock, 3e-3, True)
    _diagram, root = build(source, sink)
    for i in range(3):
        tick(timer, clock, sink, root, 1.0 + i, 2e-3)
    assert timer.calc_means() == ({}, pytest.approx(10e-3))


def test_without_a_tick_there_is_nothing(clock):
    with CallbackTimer() as timer:
        source = Worker(clock, 5e-3, False)
    assert timer.calc_means() == ({source: 0.0}, 0.0)


def test_pydrake_looks_declarations_up_on_the_class(clock):
    """What the timer rests on: a change of pydrake's bindings fails here first."""
    seen = []
    declare = LeafSystem.DeclareVectorOutputPort

    def spy(system, *arguments, **options):
        seen.append(system)
        return declare(system, *arguments, **options)

    LeafSystem.DeclareVectorOutputPort = spy
    try:
        source = Worker(clock, 5e-3, False)
    finally:
        LeafSystem.DeclareVectorOutputPort = declare
    assert seen == [source]


class _Sealed(type):
    """Lets one attribute of its classes be replaced, and no second one."""

    def __setattr__(cls, name, value):
        if name != profiling._DECLARATIONS[0]:
            raise TypeError(f"cannot set {name}")
        super().__setattr__(name, value)


def test_bindings_that_cannot_be_changed_leave_the_time_of_whole_ticks(
    clock, monkeypatch
):
    class Sealed(metaclass=_Sealed):
        """Has what the timer replaces."""

        DeclareVectorOutputPort = lambda *_: None  # noqa: E731
        DeclareAbstractOutputPort = lambda *_: None  # noqa: E731
        DeclarePeriodicDiscreteUpdateEvent = None
        DeclarePeriodicPublishEvent = None

    before = dict(vars(Sealed))
    monkeypatch.setattr(profiling, "LeafSystem", Sealed)
    with (
        pytest.warns(RuntimeWarning, match="only whole ticks are timed"),
        CallbackTimer() as timer,
    ):
        source, sink = Worker(clock, 5e-3, False), Worker(clock, 3e-3, True)
    assert dict(vars(Sealed)) == before
    _diagram, root = build(source, sink)
    for i in range(3):
        tick(timer, clock, sink, root, 1.0 + i, 2e-3)
    assert timer.calc_means() == ({}, pytest.approx(10e-3))
