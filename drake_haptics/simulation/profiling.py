"""Measures how much of a tick each system takes, and explains why it is there."""

from __future__ import annotations

import inspect
import time
import warnings
from collections import deque
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import wraps
from typing import Any

import numpy as np
from pydrake.systems.framework import Context, LeafSystem, System

from drake_haptics.common.one_line import count
from drake_haptics.common.subsystems import walk_leaves
from drake_haptics.loop.builder import HapticDiagram

# Methods by which a system passes its callbacks to Drake.
_DECLARATIONS = (
    "DeclareVectorOutputPort",
    "DeclareAbstractOutputPort",
    "DeclarePeriodicDiscreteUpdateEvent",
    "DeclarePeriodicPublishEvent",
)
_MOST_TICKS = 1 << 16
# In the slowest ticks the computer was busy with something else.
_MIDDLE_HALF = (0.25, 0.75)
_WHY = {
    "rendered_force_hold": "always: limits what the device shows",
    "device_io": "a device: reads the handle, writes the wrench",
    "handle_model": "a device: carries the wrench on between two ticks",
    "simulated_arm": "device.preset, hand: the arm that is held",
    "virtual_coupling": "always: couples the tool to the handle",
    "haptic_tool": "always: moves the tool",
    "constraint_tool_step": "contact.law: constraint: finds, couples, moves, answers",
    "contact_query": "always: finds the contacts",
    "pose_sampler": "contact.query_rate_hz: says where contacts are looked for",
    "contact_extrapolator": "contact.query_rate_hz: moves contacts on in between",
    "contact_clustering": "always: contact.clustering",
    "penalty_force": "always: answers the contacts",
    "force_shading": "effects.shading",
    "stick_slip_friction": "effects.friction",
    "pre_contact_braking": "effects.braking",
    "tool_gravity": "effects.gravity",
    "passivity_control": "effects.passivity",
    "load_shedding": "device.tick_budget_us: says what slow ticks leave out",
    "tick_end": "device.tick_budget_us: times the tick",
    "tick_log_sink": "a log: notes every tick",
    "haptic_visualizer": "draws the page or the recording",
}
# Systems whose work is one call of the core where no object moves.
_CHAINED = (
    "haptic_tool",
    "contact_query",
    "force_shading",
    "contact_clustering",
    "penalty_force",
)
CHAIN = "contact_chain"
_CHAIN_WHY = "always: contacts, force and the tool's step, in one call"
# With them the hold computes the coupling's wrench for the device.
_COUPLED = ("rendered_force_hold", "virtual_coupling")
_COUPLED_WHY = "always: couples tool and handle, limits what the device shows"
# For a system that this package does not know.
_NOT_OURS = "yours: it was added to the loop"
REST = "Drake and the rest"


class CallbackTimer:
    """Times the callbacks of the systems that are constructed while it is entered.

    Inside its block it wraps every callback that a `LeafSystem` declares; systems that
    are constructed outside are not measured. The time of a callback excludes the
    evaluation of its inputs, which counts for the systems that provide them. Each call
    takes about 0.5 µs more::

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

        If the bindings of Drake do not allow it, only whole ticks are timed, and a
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

    def __exit__(self, *_: object) -> None:
        """Stops timing systems that are constructed later."""
        self._restore()

    def _restore(self) -> None:
        while self._originals:
            setattr(LeafSystem, *self._originals.popitem())

    def end_tick(self, context: Context) -> None:
        """Ends a tick, for `run(on_tick=...)`; the first call only begins one."""
        now_s = time.perf_counter()
        if self._start_s > 0.0:
            self._ticks.append((now_s - self._start_s, *self._own_s))
        self._own_s[:] = [0.0] * len(self._own_s)
        self._start_s = time.perf_counter()

    def calc_means(self) -> tuple[dict[System, float], float]:
        """Returns the mean time of each system and of the whole tick, s.

        Both are means over the middle half of the ticks by duration.
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

        Each is (n,), for the latest n ticks.
        """
        ticks = np.array(self._ticks).reshape(-1, 1 + len(self._systems))
        tick_s, *own_s = ticks.T
        return dict(zip(self._systems, own_s, strict=True)), tick_s

    def _timed_declaration(self, declare: Callable[..., Any]) -> Callable[..., Any]:
        """Returns a declaration that replaces callbacks by timed ones."""

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
        """Returns a callback that measures its time without that of others."""
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


@dataclass(frozen=True)
class Part:
    """A part of a tick.

    Attributes:
        name: Name of the system in the diagram; "contact_chain" for those from the
            contact query to the tool where the core does their work in one call; or
            "Drake and the rest".
        system: Class of the system.
        why: Key of the scene that adds it, or the reason why it is always there.
        mean_us: Time of its callbacks, mean of the middle half of the ticks, µs.
        share: Share of the whole tick, 0 to 1.
    """

    name: str
    system: str
    why: str
    mean_us: float
    share: float

    def to_dict(self) -> dict[str, object]:
        """Returns the part for a report, ready for JSON."""
        return asdict(self)


def explain_tick(haptic: HapticDiagram, timer: CallbackTimer) -> list[Part]:
    """Explains a tick of a run.

    The time of a part is that of its Python code and of the core that this calls. The
    rest is Drake, which steps the arm's plant, calls the parts and passes values from
    port to port, and the measurements of the run. If friction or braking reads the
    contact chain, the first of them also finds the contacts for the others.

    Args:
        haptic: Diagram that was run.
        timer: Timer under which it was built and run.

    Returns:
        The systems of the diagram in its order, then the rest. Times and shares add
        to the tick.
    """
    own_s, tick_s = timer.calc_means()

    def make_part(name: str, system: str, why: str, seconds: float) -> Part:
        share = seconds / tick_s if tick_s > 0.0 else 0.0
        return Part(name, system, why, 1e6 * seconds, share)

    parts = []
    systems = _list_systems(haptic)
    chained, coupled = _find_chained(haptic)
    for system in systems:
        name, kind = system.get_name(), type(system).__name__
        if name in [*chained[1:], *coupled[1:]]:
            continue
        why = _WHY.get(name, _NOT_OURS)
        together: tuple[str, ...] = (name,)
        if name in chained:
            together = chained
            name, kind, why = CHAIN, "ContactChain", _CHAIN_WHY
            if haptic.loop.effects.shading is not None:
                why += ", with effects.shading"
        elif name in coupled:
            together, why = coupled, _COUPLED_WHY
        taken = [one for one in systems if one is system or one.get_name() in together]
        leaves = [leaf for one in taken for leaf in walk_leaves(one)]
        parts.append(
            make_part(name, kind, why, sum(own_s.get(leaf, 0.0) for leaf in leaves))
        )
    rest_s = tick_s - sum(own_s.values())
    why = "always: steps the arm, calls the parts"
    parts.append(make_part(REST, "Simulator", why, rest_s))
    return parts


def _find_chained(haptic: HapticDiagram) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Returns the names of the systems whose work is one call of the core.

    Returns:
        The systems of the tool's step, and those of the wrench on the device.
    """
    loop = haptic.loop
    if loop.penalty is None or not loop.contact_query.HasOutputPort(CHAIN):
        return (), ()
    return _CHAINED, _COUPLED if loop.effects.passivity is None else ()


def _list_systems(haptic: HapticDiagram) -> list[System]:
    """Returns the systems of the diagram, with the device replaced by its parts."""
    systems: list[System] = []
    for system in haptic.diagram.GetSystems():
        is_device = system is haptic.loop.device
        systems += haptic.loop.device.GetSystems() if is_device else [system]
    return systems
