"""The systems inside a Diagram, their names and timings."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from pydrake.autodiffutils import AutoDiffXd
from pydrake.systems.framework import Context, Diagram, Diagram_, System

_TIMING = re.compile(r"\(([\d.e+-]+),([\d.e+-]+)\)")
_DIAGRAMS = (Diagram, Diagram_[AutoDiffXd])


@dataclass(frozen=True, order=True)
class Timing:
    """A periodic discrete update, at offset, offset + period, ...

    Attributes:
        period_s: s.
        offset_s: s.
        system: Path of the system that it updates.
    """

    period_s: float
    offset_s: float
    system: str


def walk_systems(system: System) -> Iterator[System]:
    """Yields a system and, if it is a Diagram, all that it holds, depth first."""
    yield system
    if isinstance(system, _DIAGRAMS):
        for part in system.GetSystems():
            yield from walk_systems(part)


def walk_leaves(system: System) -> Iterator[System]:
    """Yields the systems that hold no others, in the order of Drake's states."""
    return (part for part in walk_systems(system) if not isinstance(part, _DIAGRAMS))


def calc_path(root: System, system: System) -> str:
    """Returns the name of a system inside a root, as "arm/controller"."""
    if system is root:
        return system.get_name() or type(system).__name__
    inner = system.GetSystemPathname().removeprefix(root.GetSystemPathname())
    return inner.removeprefix("::").replace("::", "/")


def find_timings(root: System, context: Context) -> list[Timing]:
    """Returns the timings of all periodic discrete updates, fastest first.

    Args:
        root: Any system.
        context: Its root context.
    """
    found = []
    for leaf in walk_leaves(root):
        if leaf.num_discrete_state_groups() == 0:
            continue
        name = calc_path(root, leaf)
        unique = leaf.GetUniquePeriodicDiscreteUpdateAttribute()
        if unique is not None:
            found.append(Timing(unique.period_sec(), unique.offset_sec(), name))
            continue
        # pydrake lists several timings of one system only in this error's text.
        try:
            leaf.EvalUniquePeriodicDiscreteUpdate(leaf.GetMyContextFromRoot(context))
        except RuntimeError as error:
            found += [
                Timing(float(period), float(offset), name)
                for offset, period in _TIMING.findall(str(error))
            ]
    return sorted(found)
