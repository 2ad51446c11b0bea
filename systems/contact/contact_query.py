"""Finds the contacts between the tool and objects; reads the objects' motion."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.math import RigidTransform
from pydrake.systems.framework import (
    AbstractParameterIndex,
    Context,
    InputPort,
    LeafSystem,
)

from drake_haptics._core import (
    AutoDiffContactSet,
    AutoDiffVector,
    ContactChain,
    ConvexPieces,
    ObjectFrames,
    SceneTracker,
    differentiate_contacts,
)
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.common.value_checks import check_at_least
from drake_haptics.systems.framework.differentiable_system import (
    NOTHING,
    AutoDiffPoint,
    DifferentiableSystem,
    join,
    take,
)

DepthSearch = Literal["tracked", "global"]


@dataclass(frozen=True)
class ContactObject:
    """An object that the tool can touch.

    Attributes:
        name: Name, unique among the objects; part of port names.
        decomposition: Convex pieces of the object, in its frame O: the `core` of a
            `drake_haptics.Decomposition`.
        X_WO: Pose of the object in the world, if it never moves; None for an object
            whose pose comes from input ports.
    """

    name: str
    decomposition: ConvexPieces
    X_WO: RigidTransform | None = None


def check_objects(objects: Sequence[ContactObject]) -> None:
    """Raises ValueError unless there are objects, each with a name of its own."""
    if not objects:
        raise ValueError("objects must not be empty")
    counts = Counter(item.name for item in objects)
    if shared := [name for name, number in counts.items() if number > 1]:
        raise ValueError(
            f"objects must have different names; several are {', '.join(shared)}"
        )


class ContactQuery(DifferentiableSystem):
    """Contacts between the convex pieces of the tool and of the objects.

    For each pair of pieces nearer than the tolerance there is one contact: signed
    distance in m (negative: penetration depth), unit normal from the object into
    the tool, both witness points in the world in m, both features.

    .. pydrake_system::

        name: ContactQuery
        input_ports:
        - X_WT
        - X_WO_<name of each object that moves>
        - load_shedding (with load shedding)
        - rule (with the chain)
        - gains (with the chain)
        - shading (with the chain and shading)
        output_ports:
        - contacts
        - contact_chain (with the chain)

    `X_WT` and `X_WO_<name>` are poses [qw qx qy qz x y z] in the world, m. `contacts`
    is a `drake_haptics.ContactSet`, immutable. `load_shedding` is that of
    `LoadShedding`: contacts are searched for only up to its share of the tolerance.

    `contact_chain` is a `drake_haptics._core.ContactChain`, which goes on to forces by
    the `rule` of `ContactClustering` and the `gains` of `PenaltyForce`; if there is a
    `ForceShading`, its `shading` turns the normals first. A `HapticTool` that reads it
    evaluates none of the ports in between, and `contacts` then shows the contacts that
    the tool's step has found. It has no value under AutoDiffXd.

    The tolerance is an abstract parameter of the Context (index 1), a float; see
    `set_tolerance`.

    The search starts from its last result in the same Context (paper, 5.2), and the
    first time, and after parameters were copied or set to their defaults, from the
    abstract parameter `hint` (index 0), the result of a query in another Context.
    Without a hint it starts from scratch and may find another way out of a deep
    penetration, so call `prepare_conversion` before the parameters are copied.

    Under AutoDiffXd `contacts` is a `drake_haptics._core.AutoDiffContactSet`: the
    features stay the same. There every search starts from the hint, and its result is a
    function of the Context alone.
    """

    def __init__(
        self,
        tool: ConvexPieces,
        objects: Sequence[ContactObject],
        tolerance_m: float,
        depth: DepthSearch = "tracked",
        max_walk_steps: int = 1024,
        *,
        enable_load_shedding: bool = False,
        enable_chain: bool = False,
        enable_shading: bool = False,
    ):
        """Constructs the system.

        Args:
            tool: Convex pieces of the tool, in its frame, as those of an object.
            objects: Objects that the tool can meet, in the order of
                `ContactSet.object_index`.
            tolerance_m: Default distance up to which pairs are contacts, m.
            depth: Penetration depth of two pieces in overlap: "tracked", to which the
                search walks from its last result, or "global", the least of all; see
                `drake_haptics.SceneTracker`.
            max_walk_steps: Bound on the steps of such a walk, at least 1.
            enable_load_shedding: Whether the loop sheds load, which adds a port.
            enable_chain: Whether to add the port `contact_chain` with its inputs; then
                no object may move.
            enable_shading: Whether the chain has an input for shading.

        Raises:
            ValueError: The tolerance is negative or not finite, there is no object, a
                name is used twice, there is no such depth, no step is allowed, or there
                is a chain with an object that moves.
        """
        super().__init__()
        check_at_least(0, tolerance_m=tolerance_m)
        if depth not in get_args(DepthSearch):
            raise ValueError(f"depth must be 'tracked' or 'global', is {depth!r}")
        check_at_least(1, max_walk_steps=max_walk_steps)
        check_objects(objects)
        self._tool = tool
        self._objects = tuple(objects)
        self._depth: DepthSearch = depth
        self._max_walk_steps = max_walk_steps
        self._X_WT = self.DeclareVectorInputPort("X_WT", 7)
        self._eval_X_WT = self._X_WT.Eval
        self._X_WO = {
            i: self.DeclareVectorInputPort(f"X_WO_{item.name}", 7)
            for i, item in enumerate(objects)
            if item.X_WO is None
        }
        self._load_shedding = (
            self.DeclareVectorInputPort("load_shedding", 3)
            if enable_load_shedding
            else None
        )
        self._hint = self.DeclareAbstractParameter(Value[object](NOTHING))
        self._tolerance = self.DeclareAbstractParameter(Value[object](tolerance_m))
        from_hint, from_tolerance = (
            self.abstract_parameter_ticket(AbstractParameterIndex(parameter))
            for parameter in (self._hint, self._tolerance)
        )
        # A list of the hint, which is empty once a search has started from it.
        self._eval_unread = self.DeclareObjectCacheEntry(
            "unread hint", self._list_hint, {from_hint}
        ).Eval
        from_parameters = {from_hint, from_tolerance}
        self._contacts = self.DeclareAbstractOutputPort(
            "contacts",
            Value[object],
            self._calc_contacts,
            {self.all_input_ports_ticket(), *from_parameters},
        )
        self._law: list[InputPort] = []
        # A Context remembers its last search, which never changes a result by more than
        # round-off. As a cache entry it picks up another tolerance without cost per
        # tick.
        if enable_chain:
            self._law = self._declare_law(enable_shading)
            self._eval_tracker = self.DeclareAbstractOutputPort(
                "contact_chain",
                lambda: Value[object](NOTHING),
                self._prepare_tracker,
                {*from_parameters, *(port.ticket() for port in self._law)},
            ).Eval
        else:
            self._eval_tracker = self.DeclareObjectCacheEntry(
                "tracker", self._prepare_tracker, from_parameters
            ).Eval

    def _declare_law(self, enable_shading: bool) -> list[InputPort]:
        """Declares the inputs of the chain."""
        if self._X_WO:
            raise ValueError("enable_chain: the objects must rest")
        names = ["rule", "gains", *(["shading"] if enable_shading else [])]
        self.undifferentiated = frozenset({*names, "contact_chain"})
        self._at_rest = _place_at_rest(self._objects)
        return [self.DeclareAbstractInputPort(name, Value[object]()) for name in names]

    def get_tolerance(self, context: Context) -> float:
        """Returns the distance up to which pairs are contacts, m.

        Args:
            context: Context of this system.
        """
        self.ValidateContext(context)
        return context.get_abstract_parameter(self._tolerance).get_value()

    def set_tolerance(self, context: Context, tolerance_m: float) -> None:
        """Changes the distance up to which pairs are contacts, from now on.

        The features of the last search are kept: a deep penetration keeps its way out.

        Args:
            context: Context of this system.
            tolerance_m: New distance, m.

        Raises:
            ValueError: The distance is negative or not finite.
        """
        self.ValidateContext(context)
        check_at_least(0, tolerance_m=tolerance_m)
        # To Drake all abstract parameters change at once, but the hint stays as read.
        unread = [*self._eval_unread(context)]
        context.get_mutable_abstract_parameter(self._tolerance).set_value(tolerance_m)
        self._eval_unread(context)[:] = unread

    def prepare_conversion(self, context: Context) -> None:
        """Stores the last search in the parameter `hint`.

        Args:
            context: Context of this system, in which the query is evaluated if
                necessary.
        """
        self._contacts.Eval(context)
        hint = copy.deepcopy(self._eval_tracker(context))
        context.get_mutable_abstract_parameter(self._hint).set_value(hint)

    def take_hint(
        self, context: Context, other: ContactQuery, other_context: Context
    ) -> None:
        """Takes over the last search of another query that has the same pieces.

        Args:
            context: Context of this system.
            other: Other query, which is evaluated if necessary.
            other_context: Context of the other query.
        """
        if self._list_searched() == other._list_searched():
            other._contacts.Eval(other_context)
            context.get_mutable_abstract_parameter(self._hint).set_value(
                copy.deepcopy(other._eval_tracker(other_context))
            )

    def _list_searched(self) -> list[object]:
        """Returns the fixed properties of a tracker, for comparison."""
        pieces = [id(item.decomposition) for item in self._objects]
        return [id(self._tool), pieces, self._depth, self._max_walk_steps]

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffContactSet:
        """Returns the contacts with their derivatives."""
        reach_m: float = at.parameters[self._tolerance]
        tracker = self._make_tracker(at.parameters[self._hint], reach_m)
        X_WO = differentiate_poses(self._objects, at)
        for i in self._X_WO:
            tracker.set_object_pose(i, X_WO[i].value)
        if self._load_shedding is not None:
            reach_m *= at["load_shedding"].value[1]
        return differentiate_contacts(
            tracker.query(at["X_WT"].value, reach_m),
            reach_m,
            self._tool,
            at["X_WT"],
            [item.decomposition for item in self._objects],
            X_WO,
        )

    def _make_tracker(self, hint: object, tolerance_m: float) -> SceneTracker:
        if isinstance(hint, SceneTracker):
            tracker = copy.deepcopy(hint)
            tracker.tolerance = tolerance_m
        else:
            tracker = SceneTracker(
                self._tool,
                [item.decomposition for item in self._objects],
                tolerance_m,
                self._depth,
                self._max_walk_steps,
            )
        for i, item in enumerate(self._objects):
            if item.X_WO is not None:
                tracker.set_object_pose(i, item.X_WO)
        if self._law and not isinstance(tracker, ContactChain):
            tracker = ContactChain(tracker)
        return tracker

    def _list_hint(self, context: Context, unread: AbstractValue) -> None:
        unread.set_value([context.get_abstract_parameter(self._hint).get_value()])

    def _prepare_tracker(self, context: Context, value: AbstractValue) -> None:
        """Makes a tracker from a hint that is new, or sets the tracker's tolerance."""
        tolerance_m = self.get_tolerance(context)
        if unread := self._eval_unread(context):
            tracker = self._make_tracker(unread.pop(), tolerance_m)
            value.set_value(tracker)
        else:
            tracker = value.get_value()
            tracker.tolerance = tolerance_m
        if not self._law or not isinstance(tracker, ContactChain):
            return
        # A query that is used for its contacts alone needs no law.
        if all(port.HasValue(context) for port in self._law):
            rule, gains, *shading = (port.Eval(context) for port in self._law)
            tracker.set_law(
                rule.tolerance_m, rule.delta_m, self._at_rest, gains.materials, *shading
            )

    def _calc_contacts(self, context: Context, contacts: AbstractValue) -> None:
        tracker: SceneTracker = self._eval_tracker(context)
        for i, port in self._X_WO.items():
            tracker.set_object_pose(i, port.Eval(context))
        X_WT = self._eval_X_WT(context)
        if self._load_shedding is None:
            contacts.set_value(tracker.query(X_WT))
            return
        reach_m = self.get_tolerance(context) * self._load_shedding.Eval(context)[1]
        contacts.set_value(tracker.query(X_WT, reach_m))


def _place_at_rest(objects: Sequence[ContactObject]) -> ObjectFrames:
    """Returns all objects at rest, those that move at the world's origin."""
    p_WO = np.zeros((len(objects), 3))
    for i, item in enumerate(objects):
        if item.X_WO is not None:
            p_WO[i] = item.X_WO.translation()
    return ObjectFrames(p_WO, np.zeros((len(objects), 6)))


def differentiate_poses(
    objects: Sequence[ContactObject], at: AutoDiffPoint
) -> list[AutoDiffVector]:
    """Returns the pose (7,) of each object, m, from its port if it moves."""
    return [
        at[f"X_WO_{item.name}"]
        if item.X_WO is None
        else at.hold(pose_to_vector(item.X_WO))
        for item in objects
    ]


def differentiate_velocities(
    objects: Sequence[ContactObject], at: AutoDiffPoint
) -> list[AutoDiffVector]:
    """Returns the velocity (6,) of each object, rad/s and m/s, zero at rest."""
    rest = at.hold(np.zeros(6))
    return [at[f"V_WO_{x.name}"] if x.X_WO is None else rest for x in objects]


class ObjectMotions:
    """Reads the poses and velocities of all objects.

    It adds the input ports `X_WO_<name>` (7) and `V_WO_<name>` (6) to its system for
    each object that moves. All other objects are placed once, here.
    """

    def __init__(self, system: LeafSystem, objects: Sequence[ContactObject]):
        """Declares the ports.

        Args:
            system: System under construction, which gets the ports.
            objects: Objects in the order of the query.
        """
        self._objects = objects
        self._moving = [i for i, item in enumerate(objects) if item.X_WO is None]
        self._X_WO_ports: list[InputPort] = []
        self._V_WO_ports: list[InputPort] = []
        for i in self._moving:
            name = objects[i].name
            self._X_WO_ports.append(system.DeclareVectorInputPort(f"X_WO_{name}", 7))
            self._V_WO_ports.append(system.DeclareVectorInputPort(f"V_WO_{name}", 6))
        # There can be a thousand objects, so those at rest are passed to the core only
        # once.
        self._at_rest = _place_at_rest(objects)

    def read(self, context: Context) -> ObjectFrames:
        """Returns all objects as they are in a context."""
        if not self._moving:
            return self._at_rest
        return self._at_rest.moved(
            self._moving,
            [port.Eval(context) for port in self._X_WO_ports],
            [port.Eval(context) for port in self._V_WO_ports],
        )

    def differentiate(self, at: AutoDiffPoint) -> tuple[AutoDiffVector, AutoDiffVector]:
        """Returns p_WO (3 m,) and V_WO (6 m,) with their derivatives."""
        p_WO = [take(X, slice(4, 7)) for X in differentiate_poses(self._objects, at)]
        return join(p_WO), join(differentiate_velocities(self._objects, at))
