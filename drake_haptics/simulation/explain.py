"""Which parts a diagram has, why each is there, and what it takes of a tick."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass

from pydrake.systems.framework import Diagram, System

from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.simulation.callback_timer import CallbackTimer

_WHY = {
    "display_force_hold": "always: limits what the device shows",
    "device_io": "a device: reads the handle, writes the wrench",
    "handle_model": "a device: carries the wrench on between two ticks",
    "simulated_arm": "device.preset, hand: the arm that is held",
    "virtual_coupling": "always: couples the tool to the handle",
    "haptic_tool": "always: moves the tool",
    "contact_query": "always: finds the contacts",
    "pose_sample": "contact.query_rate_hz: says where contacts are looked for",
    "contact_advance": "contact.query_rate_hz: carries contacts on between queries",
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
# Of a system that this package does not know.
_NOT_OURS = "yours: it was added to the loop"
REST = "Drake and the rest"


@dataclass(frozen=True)
class Part:
    """A part of a tick.

    Attributes:
        name: Of the system in the diagram, or "Drake and the rest".
        system: Its class.
        why: The key of the scene that asks for it, or why it is always there.
        mean_us: Time of its own, mean of the middle half of the ticks, µs.
        share: Of the whole tick, 0 to 1.
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

    A part's time is that of its own Python and of the core it calls. What is left is
    Drake, which steps the arm's plant, calls the parts and hands values from port to
    port; and what the run itself notes down.

    Args:
        haptic: What ran.
        timer: What it was built and run under.

    Returns:
        The systems of the diagram in its order, then the rest. Times and shares add
        to the tick.
    """
    own_s, tick_s = timer.calc_means()

    def make_part(name: str, system: str, why: str, seconds: float) -> Part:
        share = seconds / tick_s if tick_s > 0.0 else 0.0
        return Part(name, system, why, 1e6 * seconds, share)

    parts = []
    for system in _list_systems(haptic):
        name = system.get_name()
        seconds = sum(own_s.get(leaf, 0.0) for leaf in _list_leaves(system))
        why = _WHY.get(name, _NOT_OURS)
        parts.append(make_part(name, type(system).__name__, why, seconds))
    rest_s = tick_s - sum(own_s.values())
    why = "always: steps the arm, calls the parts"
    parts.append(make_part(REST, "Simulator", why, rest_s))
    return parts


def _list_systems(haptic: HapticDiagram) -> list[System]:
    """Returns the systems of the diagram, those of the device in its place."""
    systems: list[System] = []
    for system in haptic.diagram.GetSystems():
        is_device = system is haptic.loop.device
        systems += haptic.loop.device.GetSystems() if is_device else [system]
    return systems


def _list_leaves(system: System) -> Iterator[System]:
    """Yields the systems that a system is made of, itself if it is one."""
    if not isinstance(system, Diagram):
        yield system
        return
    for part in system.GetSystems():
        yield from _list_leaves(part)
