"""Lists the systems in a Diagram, their timings and states; converts to AutoDiffXd."""

from __future__ import annotations

import re
from dataclasses import dataclass

from pydrake.autodiffutils import AutoDiffXd
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import QuaternionFloatingJoint
from pydrake.systems.framework import Context, Context_, System, System_

from drake_haptics.common.one_line import one_line
from drake_haptics.common.subsystems import walk_leaves, walk_systems

_TIMING = re.compile(r"\(([\d.e+-]+),([\d.e+-]+)\)")


@dataclass(frozen=True, order=True)
class Timing:
    """A periodic discrete update, at offset, offset + period, ...

    Attributes:
        period_s: Period, s.
        offset_s: Offset, s.
        system: Path of the system that it updates.
    """

    period_s: float
    offset_s: float
    system: str


def calc_path(root: System, system: System) -> str:
    """Returns the path of a system inside a root, such as "arm/controller"."""
    if system is root:
        return system.get_name() or type(system).__name__
    inner = system.GetSystemPathname().removeprefix(root.GetSystemPathname())
    return inner.removeprefix("::").replace("::", "/")


def find_timings(root: System, context: Context) -> list[Timing]:
    """Returns the timings of all periodic discrete updates, fastest first."""
    found = []
    for leaf in walk_leaves(root):
        if leaf.num_discrete_state_groups() == 0:
            continue
        name = calc_path(root, leaf)
        unique = leaf.GetUniquePeriodicDiscreteUpdateAttribute()
        if unique is not None:
            found.append(Timing(unique.period_sec(), unique.offset_sec(), name))
            continue
        # pydrake lists several timings of one system only in the text of this error.
        try:
            leaf.EvalUniquePeriodicDiscreteUpdate(leaf.GetMyContextFromRoot(context))
        except RuntimeError as error:
            found += [
                Timing(float(period), float(offset), name)
                for offset, period in _TIMING.findall(str(error))
            ]
    return sorted(found)


@dataclass(frozen=True)
class StateLayout:
    """Names and constraints of a state.

    Attributes:
        names: (n,) names of the states. A `MultibodyPlant` names its own coordinates,
            such as "plant/tool_x", and so does a system with a method
            `list_state_names()`; other states are "path/xc[0]" if continuous and
            "path/xd[0]" if discrete ("path/xd1[0]" for the first of the second group).
        quaternions: Positions in the state of the four numbers of each unit
            quaternion of a `MultibodyPlant`.
    """

    names: tuple[str, ...]
    quaternions: tuple[tuple[int, ...], ...]

    __repr__ = one_line


def find_state_layout(root: System) -> StateLayout:
    """Returns the layout of a system's state."""
    context = root.CreateDefaultContext()
    names: list[str] = []
    quaternions: list[tuple[int, ...]] = []
    # Diagrams put all continuous states first, each kind in the systems' order.
    for kind in ("xc", "xd"):
        for leaf in walk_leaves(root):
            sizes = _list_sizes(kind, leaf.GetMyContextFromRoot(context))
            prefix = "" if leaf is root else f"{calc_path(root, leaf)}/"
            own = _list_own_names(leaf)
            for i, size in enumerate(sizes):
                if own and size == len(own):
                    if isinstance(leaf, MultibodyPlant):
                        quaternions += _shift_quaternions(leaf, len(names))
                    names += [prefix + name for name in own]
                else:
                    names += [f"{prefix}{kind}{i or ''}[{j}]" for j in range(size)]
    return StateLayout(tuple(names), tuple(quaternions))


def _list_sizes(kind: str, context: Context) -> list[int]:
    """Returns the sizes of a leaf's groups of continuous or discrete states."""
    if kind == "xc":
        return [context.num_continuous_states()]
    groups = range(context.num_discrete_state_groups())
    return [context.get_discrete_state(i).size() for i in groups]


def _list_own_names(leaf: System) -> list[str]:
    """Returns the names of a system's states; those of a plant short if unique."""
    if hasattr(leaf, "list_state_names"):
        return leaf.list_state_names()
    if not isinstance(leaf, MultibodyPlant):
        return []
    names = list(leaf.GetStateNames(add_model_instance_prefix=False))
    if len(set(names)) == len(names):
        return names
    return list(leaf.GetStateNames(add_model_instance_prefix=True))


def _shift_quaternions(plant: MultibodyPlant, start: int) -> list[tuple[int, ...]]:
    """Returns the indices of a plant's quaternions, if its state begins at start."""
    joints = [plant.get_joint(index) for index in plant.GetJointIndices()]
    starts = [
        start + joint.position_start()
        for joint in joints
        if isinstance(joint, QuaternionFloatingJoint)
    ]
    return [tuple(range(first, first + 4)) for first in sorted(starts)]


class AutoDiffClone:
    """A system converted once to AutoDiffXd, which follows contexts of the original.

    Attributes:
        system: The AutoDiffXd twin.
        context: Its root context.
    """

    system: System_[AutoDiffXd]
    context: Context_[AutoDiffXd]

    def __init__(self, original: System):
        """Converts a system.

        Raises:
            RuntimeError: A system inside has no AutoDiffXd twin.
        """
        self._original = original
        self.system = original.ToScalarType[AutoDiffXd]()
        self.context = self.system.CreateDefaultContext()

    def follow(self, context: Context) -> None:
        """Copies time, state, parameters and fixed inputs from the original's context.

        Systems with a method `prepare_conversion(context)` first store in their
        parameters what a cache remembers.

        Args:
            context: Root context of the original, which this may change.
        """
        for part in walk_systems(self._original):
            if hasattr(part, "prepare_conversion"):
                part.prepare_conversion(part.GetMyMutableContextFromRoot(context))
        self.context.SetTimeStateAndParametersFrom(context)
        self.system.FixInputPortsFrom(self._original, context, self.context)
