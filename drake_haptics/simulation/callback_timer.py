"""Measures what each system's own Python takes of a tick."""

from __future__ import annotations

import inspect
import time
import warnings
from collections import deque
from collections.abc import Callable
from functools import wraps
from types import TracebackType
from typing import Any

import numpy as np
from pydrake.systems.framework import Context, LeafSystem, System

from drake_haptics.common.one_line import count

# The ways in which a system hands its callbacks to Drake.
_DECLARATIONS = (
    "DeclareVectorOutputPort",
    "DeclareAbstractOutputPort",
    "DeclarePeriodicDiscreteUpdateEvent",
    "DeclarePeriodicPublishEvent",
)
_MOST_TICKS = 1 << 16
# In the slowest ticks the computer did something else.
_MIDDLE_HALF = (0.25, 0.75)


class CallbackTimer:
    """Times the callbacks of the systems that are constructed while it is entered.

    Inside its block it stands between `LeafSystem` and Drake wherever a callback is
    declared; outside, systems are constructed as ever and nothing is measured. A
    callback's time is its own: what it waits for its inputs belongs to the systems
    that give them. Each call costs about 0.5 µs more::

        with CallbackTimer() as timer:
            haptic = BuildHapticDiagram(scene)
        run(haptic, 2.0, on_tick=timer.end_tick)
        own_s, tick_s = timer.calc_means()
    """

    def __init__(self) -> None:
        self._systems: list[System] = []
        self._own_s: list[float] = []
        # Time of callbacks that returned to the one that is running.
        self._nested_s = 0.0
        self._ticks: deque[tuple[float, ...]] = deque(maxlen=_MOST_TICKS)
        self._start_s = 0.0
        self._originals: dict[str, Any] = {}

    def __repr__(self) -> str:
        systems = count(len(self._systems), "system")
        return f"CallbackTimer({systems}, {count(len(self._ticks), 'tick')})"

    def __enter__(self) -> CallbackTimer:
        """Begins to time the systems that are constructed.

        Where bindings of Drake do not let it in, only whole ticks are timed, and a
        `RuntimeWarning` says so.
        """
        originals = {name: getattr(LeafSystem, name) for name in _DECLARATIONS}
        try:
            for name, original in originals.items():
                setattr(LeafSystem, name, self._timed_declaration(original))
                self._originals[name] = original
        except (AttributeError, TypeError) as error:
            self._restore()
            warnings.warn(
                "only whole ticks are timed: the systems of this version of Drake"
                f" cannot be timed one by one ({error})",
                RuntimeWarning,
                stacklevel=2,
            )
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Leaves later systems alone."""
        self._restore()

    def _restore(self) -> None:
        while self._originals:
            setattr(LeafSystem, *self._originals.popitem())

    def end_tick(self, context: Context) -> None:
        """Ends a tick; for `run(on_tick=...)`. The first call only begins one."""
        now_s = time.perf_counter()
        if self._start_s > 0.0:
            self._ticks.append((now_s - self._start_s, *self._own_s))
        self._own_s[:] = [0.0] * len(self._own_s)
        self._start_s = time.perf_counter()

    def calc_means(self) -> tuple[dict[System, float], float]:
        """Returns the mean time of each system and of the whole tick, s.

        Both are of the middle half of the ticks, by their length.
        """
        if not self._ticks:
            return dict.fromkeys(self._systems, 0.0), 0.0
        ticks = np.array(self._ticks)
        shortest, longest = np.quantile(ticks[:, 0], _MIDDLE_HALF)
        usual = (shortest <= ticks[:, 0]) & (ticks[:, 0] <= longest)
        tick_s, *own_s = ticks[usual].mean(axis=0).tolist()
        return dict(zip(self._systems, own_s, strict=True)), tick_s

    def calc_times(self) -> tuple[dict[System, np.ndarray], np.ndarray]:
        """Returns the time of each system and of the whole, tick by tick, s.

        Each is (n,), of the latest n ticks that ended.
        """
        ticks = np.array(self._ticks).reshape(-1, 1 + len(self._systems))
        tick_s, *own_s = ticks.T
        return dict(zip(self._systems, own_s, strict=True)), tick_s

    def _timed_declaration(self, declare: Callable[..., Any]) -> Callable[..., Any]:
        """Returns a declaration that takes the callback and declares a timed one."""

        @wraps(declare)
        def declare_timed(system: System, *args: Any, **kwargs: Any) -> Any:
            def timed(item: Any) -> Any:
                own = inspect.ismethod(item) and item.__self__ is system
                return self._timed(system, item) if own else item

            return declare(
                system,
                *map(timed, args),
                **{name: timed(item) for name, item in kwargs.items()},
            )

        return declare_timed

    def _timed(
        self, system: System, callback: Callable[..., Any]
    ) -> Callable[..., Any]:
        """Returns a callback that notes its own time."""
        if system not in self._systems:
            self._systems.append(system)
            self._own_s.append(0.0)
        index = self._systems.index(system)
        clock, own_s = time.perf_counter, self._own_s

        @wraps(callback)
        def timed_callback(*args: Any) -> Any:
            before_s, self._nested_s = self._nested_s, 0.0
            start_s = clock()
            try:
                return callback(*args)
            finally:
                taken_s = clock() - start_s
                own_s[index] += taken_s - self._nested_s
                self._nested_s = before_s + taken_s

        return timed_callback
