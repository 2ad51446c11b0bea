"""Brakes the tool before it touches."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import BasicVector, Context

from drake_haptics._core import AutoDiffVector, BrakingGains, pre_contact_braking
from drake_haptics.systems.contact.contact_query import ContactObject, ObjectMotions
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
    take,
)


class PreContactBraking(DifferentiableSystem):
    """Viscous force against the approach of surfaces that do not yet touch.

    At each contact with 0 < d < D, where D is the braking distance, the tool is pushed
    with b s w v along the normal, where v is the speed of approach at the contact; it
    is never pulled, nor slowed when it moves away (McNeely, Puterbaugh and Troy 1999).
    The profile w = 4 (d/D) (1 - d/D) fades at both ends, so that the wrench is
    continuous in pose and velocity. On a straight path to a surface a mass m loses 2 b
    D / (3 m) of its speed, at any speed.

    The share s keeps contacts with like normals from adding up, however finely a
    surface is cut, and leaves all other contacts alone (core/law/braking.h). The
    damping is at most 1.1 b where all normals are alike, and 4.4 b along any direction.

    .. pydrake_system::

        name: PreContactBraking
        input_ports:
        - contacts
        - X_WT
        - V_WT
        - X_WO_<name of each object that moves>
        - V_WO_<name of each object that moves>
        - load_shedding (with load shedding)
        - contact_chain (with the chain)
        output_ports:
        - wrench_model
        - F_O_W (with objects that move)

    `contacts` is a `drake_haptics.ContactSet`; the query must find contacts up to at
    least D. Poses are [qw qx qy qz x y z], m. `V_WT` and `V_WO_<name>` are spatial
    velocities [ω; v] of the frame's origin in the world, rad/s and m/s. `load_shedding`
    is that of `LoadShedding`: D shrinks to its share. `contact_chain` is that of
    `ContactQuery`, with which the core finds contacts and braking in one call, without
    the port `contacts`.

    `wrench_model` (78) is [F; K; B] on the tool at its origin, as `PenaltyForce`
    documents it. K is zero: the braking changes with the pose only as the speed does.
    `F_O_W` (6 for each object that moves) is the reaction: wrenches [τ; f] on those
    objects, each at its origin in the world, N·m and N.

    Under AutoDiffXd `contacts` is a `drake_haptics._core.AutoDiffContactSet`.
    Derivatives are complete: profile, shares and normals change with the pose. Where a
    contact begins or ends to brake (d = 0, d = D) they are those of a contact that does
    not; at rest they are the mean of approach and parting.
    """

    undifferentiated = frozenset({"contact_chain"})

    def __init__(
        self,
        objects: Sequence[ContactObject],
        *,
        damping_Ns_per_m: float,
        distance_m: float,
        enable_load_shedding: bool = False,
        enable_chain: bool = False,
    ):
        """Constructs the system.

        Args:
            objects: Objects of the `ContactQuery`, in the same order.
            damping_Ns_per_m: Damping b half-way to the surface, N·s/m.
            distance_m: Distance D at which braking begins, m.
            enable_load_shedding: Whether the loop sheds load, which adds a port.
            enable_chain: Whether there is the port `contact_chain`; the objects must
                rest then, and no load be shed.

        Raises:
            ValueError: The damping is negative, the distance not positive, one of them
                not finite, or an object of a chain moves.
        """
        super().__init__()
        self._gains = BrakingGains(damping_Ns_per_m, distance_m)
        self._damping_Ns_per_m = damping_Ns_per_m
        self._distance_m = distance_m
        self._contacts = self.DeclareAbstractInputPort("contacts", Value[object]())
        self._X_WT = self.DeclareVectorInputPort("X_WT", 7)
        self._V_WT = self.DeclareVectorInputPort("V_WT", 6)
        self._motions = ObjectMotions(self, objects)
        self._load_shedding = (
            self.DeclareVectorInputPort("load_shedding", 3)
            if enable_load_shedding
            else None
        )
        calc_wrench_model = self._calc_wrench_model
        if enable_chain:
            if any(item.X_WO is None for item in objects):
                raise ValueError("enable_chain: the objects must rest")
            self._chain = self.DeclareAbstractInputPort(
                "contact_chain", Value[object]()
            )
            calc_wrench_model = self._calc_chained_wrench_model
        from_inputs = {self.all_input_ports_ticket()}
        self._wrench_model = self.DeclareVectorOutputPort(
            "wrench_model", 78, calc_wrench_model, from_inputs
        )
        # Rows of the objects that move, in what the core returns.
        self._moving = [
            78 + 6 * i + k
            for i, item in enumerate(objects)
            if item.X_WO is None
            for k in range(6)
        ]
        self._eval_wrenches: Callable[[Context], np.ndarray] = self._calc_wrenches
        if self._moving:
            self.DeclareVectorOutputPort(
                "F_O_W", len(self._moving), self._calc_F_O_W, from_inputs
            )
            # The wrench on the tool and the reaction share one result.
            self._eval_wrenches = self.DeclareObjectCacheEntry(
                "wrenches", self._keep_wrenches, from_inputs
            ).Eval

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the wrench model, or the reaction, with its derivatives."""
        wrenches = pre_contact_braking(
            at["contacts"],
            take(at["X_WT"], slice(4, 7)),
            at["V_WT"],
            *self._motions.differentiate(at),
            self._gains
            if self._load_shedding is None
            else self._relieve(float(at["load_shedding"].value[1])),
        )
        return take(wrenches, self._moving if port == "F_O_W" else slice(78))

    def _calc_wrenches(self, context: Context) -> np.ndarray:
        """Returns the wrench model (78,) and the wrench (6) on each object."""
        return pre_contact_braking(
            self._contacts.Eval(context),
            self._X_WT.Eval(context)[4:],
            self._V_WT.Eval(context),
            self._motions.read(context),
            self._gains
            if self._load_shedding is None
            else self._relieve(self._load_shedding.Eval(context)[1]),
        )

    def _relieve(self, reach_share: float) -> BrakingGains:
        """Returns the gains with a share of the distance D."""
        return BrakingGains(self._damping_Ns_per_m, reach_share * self._distance_m)

    def _keep_wrenches(self, context: Context, value: AbstractValue) -> None:
        value.set_value(self._calc_wrenches(context))

    def _calc_wrench_model(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._eval_wrenches(context)[:78])

    def _calc_chained_wrench_model(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(
            self._chain.Eval(context).find_braking(
                self._gains, self._X_WT.Eval(context), self._V_WT.Eval(context)
            )
        )

    def _calc_F_O_W(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._eval_wrenches(context)[self._moving])
