"""Gives back the memory of a diagram that will not run again."""

from __future__ import annotations

from collections.abc import Iterator

from pydrake.systems.framework import Diagram, System

from drake_haptics.loop.builder import HapticDiagram


def retire(haptic: HapticDiagram) -> None:
    """Lets a diagram be freed when the last reference to it goes.

    pydrake never frees one that has a system in Python: such a system keeps its diagram
    by an attribute (`ref_cycle` of its bindings), and the diagram keeps the system in
    C++, where Python's garbage collector does not see it
    (https://github.com/RobotLocomotion/drake/issues/22515). So all attributes go. What
    pydrake still keeps is the bare system, some 40 kB, of those that calculate an
    output or a cache entry by a method of theirs.

    Args:
        haptic: What no simulator, port or onlooker uses any more.
    """
    for system in list(_list_systems(haptic.diagram)):
        # Other bindings may give a system no attributes to keep its diagram by.
        getattr(system, "__dict__", {}).clear()


def _list_systems(system: System) -> Iterator[System]:
    """Returns a system and all within it."""
    yield system
    if isinstance(system, Diagram):
        for part in system.GetSystems():
            yield from _list_systems(part)
