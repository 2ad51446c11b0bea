"""The systems inside a Diagram, their names, timings and states."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.framework import Context, Diagram, System

_TIMING = re.compile(r"\(([\d.e+-]+),([\d.e+-]+)\)")


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
    if isinstance(system, Diagram):
        for part in system.GetSystems():
            yield from walk_systems(part)


def walk_leaves(system: System) -> Iterator[System]:
    """Yields the systems that hold no others, in the order of Drake's states."""
    return (part for part in walk_systems(system) if not isinstance(part, Diagram))


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


def list_state_names(root: System) -> list[str]:
    """Returns a name for each number of the state [continuous; discrete groups].

    A `MultibodyPlant` names its own coordinates, as "plant/tool_x"; other states are
    "path/xc[0]" for continuous ones and "path/xd[0]" for discrete ones ("path/xd1[0]"
    for the first of the second group).
    """
    context = root.CreateDefaultContext()
    continuous, discrete = [], []
    for leaf in walk_leaves(root):
        own = leaf.GetMyContextFromRoot(context)
        path = calc_path(root, leaf)
        groups = [
            own.get_discrete_state(i).size()
            for i in range(own.num_discrete_state_groups())
        ]
        given = _list_plant_names(leaf, "" if leaf is root else f"{path}/")
        size = own.num_continuous_states()
        continuous += given[:size] if size == len(given) else _count(path, "xc", size)
        if groups[:1] == [len(given)] and given:
            discrete += given
            groups[0] = 0
        for i, size in enumerate(groups):
            discrete += _count(path, f"xd{i or ''}", size)
    return continuous + discrete


def _list_plant_names(leaf: System, prefix: str) -> list[str]:
    """Returns the names of a plant's positions and velocities, short if unique."""
    if not isinstance(leaf, MultibodyPlant):
        return []
    names = leaf.GetStateNames(add_model_instance_prefix=False)
    if len(set(names)) < len(names):
        names = leaf.GetStateNames(add_model_instance_prefix=True)
    return [prefix + name for name in names]


def _count(path: str, kind: str, size: int) -> list[str]:
    return [f"{path}/{kind}[{i}]" for i in range(size)]
