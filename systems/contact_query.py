"""Finds all contacts between the tool and its surroundings."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.math import RigidTransform
from pydrake.systems.framework import Context, InputPort, OutputPort

from drake_haptics._core import (
    AutoDiffContactSet,
    AutoDiffVector,
    Decomposition,
    SceneTracker,
    differentiate_contacts,
)
from drake_haptics.pose_vector import pose_to_vector
from drake_haptics.systems.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)
from drake_haptics.systems.scratch import declare_scratch, get_scratch

DepthSearch = Literal["tracked", "global"]


@dataclass(frozen=True)
class ContactObject:
    """Something the tool can meet.

    Attributes:
        name: Unique among the objects; part of port names.
        decomposition: Its convex pieces, in its frame O.
        X_WO: Its pose, if it never moves; None gives it input ports instead.
    """

    name: str
    decomposition: Decomposition
    X_WO: RigidTransform | None = None


class ContactQuery(DifferentiableSystem):
    """Contacts between the convex pieces of the tool and of the objects.

    For each pair of pieces nearer than the tolerance there is one contact: signed
    distance in m (negative: penetration depth), unit normal from the object into
    the tool, both witness points in the world in m, both features.

    .. pydrake_system::

        name: ContactQuery
        input_ports:
        - X_WTool
        - X_WO_<name of each object that moves>
        - relief (with load shedding)
        output_ports:
        - contacts

    `X_WTool` and `X_WO_<name>` are poses [qw qx qy qz x y z] in the world, m.
    `contacts` is a `drake_haptics.ContactSet`, immutable. `relief` is that of
    `LoadShedding`: contacts are looked for only up to its share of the tolerance.

    The search starts from its last answer in the same Context (paper, 5.2), and first
    from the abstract parameter `hint` (index 0): what a query of another Context knew.
    Without one it starts anew, and can find another way out of a deep penetration; so
    call `prepare_conversion` before the parameters are copied. Objects with a pose of
    their own are placed once for each Context.

    Under AutoDiffXd `contacts` is a `drake_haptics._core.AutoDiffContactSet`: the
    features stay. There every answer starts from the hint, and is a function of the
    Context alone.
    """

    def __init__(
        self,
        tool: Decomposition,
        objects: Sequence[ContactObject],
        tolerance_m: float,
        depth: DepthSearch = "tracked",
        max_walk_steps: int = 1024,
        *,
        sheds_load: bool = False,
    ):
        """Constructs the system.

        Args:
            tool: Convex pieces of the tool, in its frame.
            objects: What it can meet, in the order of `ContactSet.object_index`.
            tolerance_m: Pairs up to this distance are contacts, m.
            depth: Of two pieces in overlap: that walked to from the last answer, or
                the least one of all; see `drake_haptics.SceneTracker`.
            max_walk_steps: Bound on the steps of such a walk, at least 1.
            sheds_load: Whether the loop sheds load, and there is a port for that.

        Raises:
            ValueError: The tolerance is negative, there is no object, a name is used
                twice, there is no such depth, or no step is allowed.
        """
        super().__init__()
        if not tolerance_m >= 0.0:
            raise ValueError(f"tolerance_m must not be negative, is {tolerance_m}")
        if depth not in get_args(DepthSearch):
            raise ValueError(f"depth must be 'tracked' or 'global', is {depth!r}")
        if max_walk_steps < 1:
            raise ValueError(f"max_walk_steps must be at least 1, is {max_walk_steps}")
        if not objects:
            raise ValueError("objects must name something that the tool can meet")
        if len({item.name for item in objects}) < len(objects):
            raise ValueError("two objects have the same name")
        self._tool = tool
        self._objects = tuple(objects)
        self._tolerance_m = tolerance_m
        self._depth: DepthSearch = depth
        self._max_walk_steps = max_walk_steps
        self._X_WTool = self.DeclareVectorInputPort("X_WTool", 7)
        self._X_WO = {
            i: self.DeclareVectorInputPort(f"X_WO_{item.name}", 7)
            for i, item in enumerate(objects)
            if item.X_WO is None
        }
        self._relief = self.DeclareVectorInputPort("relief", 3) if sheds_load else None
        self._hint = self.DeclareAbstractParameter(Value[object](None))
        self._memory = declare_scratch(self, "memory", _Memory)
        self._contacts = self.DeclareAbstractOutputPort(
            "contacts",
            Value[object],
            self._calc_contacts,
            {self.all_input_ports_ticket()},
        )

    def get_tool_pose_input_port(self) -> InputPort:
        """Returns the input `X_WTool`."""
        return self._X_WTool

    def get_object_pose_input_port(self, name: str) -> InputPort:
        """Returns the input `X_WO_<name>` of an object that moves."""
        return self.GetInputPort(f"X_WO_{name}")

    def get_relief_input_port(self) -> InputPort:
        """Returns the input `relief`, with load shedding."""
        return self.GetInputPort("relief")

    def get_contacts_output_port(self) -> OutputPort:
        """Returns the output `contacts`."""
        return self._contacts

    def prepare_conversion(self, context: Context) -> None:
        """Writes what the query knows into the parameter `hint`.

        Args:
            context: Of this system; the query of it is asked if it has not been.
        """
        self._contacts.Eval(context)
        context.get_mutable_abstract_parameter(self._hint).set_value(
            copy.deepcopy(get_scratch(self._memory, context).tracker)
        )

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffContactSet:
        """Returns the contacts with their derivatives."""
        tracker = self._make_tracker(at.parameters[self._hint])
        X_WO = [
            at[f"X_WO_{item.name}"]
            if item.X_WO is None
            else AutoDiffVector(
                pose_to_vector(item.X_WO), np.zeros((7, at.num_derivatives))
            )
            for item in self._objects
        ]
        for i in self._X_WO:
            tracker.set_object_pose(i, X_WO[i].value)
        reach_m = self._tolerance_m
        if self._relief is not None:
            reach_m *= at["relief"].value[1]
        return differentiate_contacts(
            tracker.query(at["X_WTool"].value, reach_m),
            reach_m,
            self._tool,
            at["X_WTool"],
            [item.decomposition for item in self._objects],
            X_WO,
        )

    def _make_tracker(self, hint: SceneTracker | None) -> SceneTracker:
        if hint is not None:
            return copy.deepcopy(hint)
        decompositions = [item.decomposition for item in self._objects]
        tracker = SceneTracker(
            self._tool,
            decompositions,
            self._tolerance_m,
            self._depth,
            self._max_walk_steps,
        )
        for i, item in enumerate(self._objects):
            if item.X_WO is not None:
                tracker.set_object_pose(i, item.X_WO)
        return tracker

    def _calc_contacts(self, context: Context, contacts: AbstractValue) -> None:
        memory: _Memory = get_scratch(self._memory, context)
        tracker = memory.tracker
        if tracker is None:
            hint = context.get_abstract_parameter(self._hint).get_value()
            tracker = memory.tracker = self._make_tracker(hint)
        for i, port in self._X_WO.items():
            tracker.set_object_pose(i, port.Eval(context))
        X_WTool = self._X_WTool.Eval(context)
        if self._relief is None:
            contacts.set_value(tracker.query(X_WTool))
            return
        reach_m = self._tolerance_m * self._relief.Eval(context)[1]
        contacts.set_value(tracker.query(X_WTool, reach_m))


@dataclass
class _Memory:
    """What a query of a Context knows; nothing before it is first asked."""

    tracker: SceneTracker | None = None
