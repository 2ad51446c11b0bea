"""What each number of a diagram's state [x_c; all discrete groups] is."""

from __future__ import annotations

from dataclasses import dataclass

from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import QuaternionFloatingJoint
from pydrake.systems.framework import Context, System

from drake_haptics.analysis.diagram_systems import calc_path, walk_leaves
from drake_haptics.common.one_line import one_line


@dataclass(frozen=True)
class StateLayout:
    """Names and constraints of a state.

    Attributes:
        names: (n,). A `MultibodyPlant` names its own coordinates, as "plant/tool_x",
            and so does a system with a method `list_state_names()`; others are
            "path/xc[0]" for continuous ones and "path/xd[0]" for discrete ones
            ("path/xd1[0]" for the first of the second group).
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
    # Drake's diagrams put all continuous states first, each in the systems' order.
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
    """Returns the names that a system has for its state, a plant's short if unique."""
    if hasattr(leaf, "list_state_names"):
        return leaf.list_state_names()
    if not isinstance(leaf, MultibodyPlant):
        return []
    names = list(leaf.GetStateNames(add_model_instance_prefix=False))
    if len(set(names)) == len(names):
        return names
    return list(leaf.GetStateNames(add_model_instance_prefix=True))


def _shift_quaternions(plant: MultibodyPlant, start: int) -> list[tuple[int, ...]]:
    """Returns where a plant's quaternions are, if its state begins at start."""
    joints = [plant.get_joint(index) for index in plant.GetJointIndices()]
    starts = [
        start + joint.position_start()
        for joint in joints
        if isinstance(joint, QuaternionFloatingJoint)
    ]
    return [tuple(range(first, first + 4)) for first in sorted(starts)]
