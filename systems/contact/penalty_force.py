"""Calculates the forces of contact clusters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import BasicVector, Context

from drake_haptics._core import (
    AutoDiffPenaltyWrench,
    AutoDiffVector,
    ContactMaterials,
    PenaltyWrench,
    penalty_force,
    penalty_wrench_model,
)
from drake_haptics.common.value_checks import check_at_least
from drake_haptics.systems.contact.contact_query import ContactObject, ObjectMotions
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
    take,
)


@dataclass(frozen=True, eq=False)
class ContactGains:
    """Stiffness and damping of each object's contact; immutable.

    Attributes:
        stiffness_N_per_m: k of each object, (n,), N/m.
        damping_Ns_per_m: k_v of each object, (n,), N·s/m.
        materials: Both gains in the form that the core reads.

    Raises:
        ValueError: A gain is negative or not finite, or the gains are not two lists of
            the same length.
    """

    stiffness_N_per_m: np.ndarray
    damping_Ns_per_m: np.ndarray
    materials: ContactMaterials = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Checks the gains and takes read-only copies."""
        for name in ("stiffness_N_per_m", "damping_Ns_per_m"):
            gains = getattr(self, name)
            copied = np.array(gains, dtype=float)
            if copied.ndim != 1:
                raise ValueError(
                    f"{name} must have one value for each object, (n,), is {gains}"
                )
            check_at_least(0, **{name: copied})
            copied.flags.writeable = False
            object.__setattr__(self, name, copied)
        if len(self.stiffness_N_per_m) != len(self.damping_Ns_per_m):
            raise ValueError(
                "stiffness_N_per_m and damping_Ns_per_m must have one value for each"
                f" object, have {len(self.stiffness_N_per_m)} and"
                f" {len(self.damping_Ns_per_m)}"
            )
        materials = ContactMaterials(self.stiffness_N_per_m, self.damping_Ns_per_m)
        object.__setattr__(self, "materials", materials)

    def __deepcopy__(self, memo: object) -> ContactGains:
        """Returns itself, so that copies of a Context share it."""
        return self


class PenaltyForce(DifferentiableSystem):
    """Elastic force below the tolerance, with damping that never pulls.

    Each cluster pushes along n at its point with k times its compression, and where the
    surfaces approach also with k_v times the speed of approach times its damping share.
    With the octree's clusters that is (k (t - d) - k_v v) n of the paper (Eq. 6-10).

    .. pydrake_system::

        name: PenaltyForce
        input_ports:
        - clusters
        - X_WT
        - V_WT
        - X_WO_<name of each object that moves>
        - V_WO_<name of each object that moves>
        - contact_chain (with the chain)
        output_ports:
        - wrench_model
        - F_To_W
        - F_O_W (with objects that move)
        - contact_wrench
        - gains

    Poses are [qw qx qy qz x y z], m. `V_WT` and `V_WO_<name>` are spatial
    velocities [ω; v] of the frame's origin in the world, rad/s and m/s.

    * `clusters` is a `drake_haptics._core.ClusterSet`.
    * `contact_chain` is that of `ContactQuery`. With it the core finds the contacts of
      `F_To_W`, bit for bit those of `clusters`.
    * `wrench_model` (78) is [F; K; B]: the wrench on the tool at its origin in the
      world, N·m and N, and its 6 x 6 stiffness and damping, row-major, with
      F(δ, V + dV) ≈ F - K δ - B dV, δ = [rotation vector; translation] of the tool.
    * `F_To_W` (6) is its F, [τ; f].
    * `F_O_W` (6 for each object that moves) are the wrenches [τ; f] on those objects,
      each at its origin in the world, N·m and N.
    * `contact_wrench` is the `drake_haptics._core.PenaltyWrench` with the force of
      each cluster and the wrench on each object.

    Under AutoDiffXd `clusters` is an `AutoDiffClusterSet` and `contact_wrench` an
    `AutoDiffPenaltyWrench` of `drake_haptics._core`. K and B have derivatives there
    too, which the tool's implicit step needs.

    k and k_v are an abstract parameter of the Context, of type `ContactGains`; see
    `set_gains`. The output `gains` shows it, and has no value under AutoDiffXd.
    """

    undifferentiated = frozenset({"gains", "contact_chain"})

    def __init__(
        self,
        objects: Sequence[ContactObject],
        stiffness_N_per_m: Sequence[float],
        damping_Ns_per_m: Sequence[float],
        *,
        enable_chain: bool = False,
        warn_of_depth: Callable[[Context, float, float], None] | None = None,
    ):
        """Constructs the system.

        Args:
            objects: Objects of the `ContactQuery`, in the same order.
            stiffness_N_per_m: Default stiffness k of each object, N/m.
            damping_Ns_per_m: Default damping k_v of each object, N·s/m.
            enable_chain: Whether to add the port `contact_chain`.
            warn_of_depth: Function `warn_of_depth` of the `ContactClustering`, which
                the chain bypasses. Defaults to no warning.

        Raises:
            ValueError: A gain is negative or not finite, or there is not one for
                each object.
        """
        super().__init__()
        self._num_objects = len(objects)
        gains = ContactGains(np.array(stiffness_N_per_m), np.array(damping_Ns_per_m))
        self._check_number(gains)
        self._gains = self.DeclareAbstractParameter(Value[object](gains))
        self._clusters = self.DeclareAbstractInputPort("clusters", Value[object]())
        self._X_WT = self.DeclareVectorInputPort("X_WT", 7)
        self._V_WT = self.DeclareVectorInputPort("V_WT", 6)
        self._eval_clusters = self._clusters.Eval
        self._eval_X_WT = self._X_WT.Eval
        self._eval_V_WT = self._V_WT.Eval
        self._motions = ObjectMotions(self, objects)
        from_inputs = {self.all_input_ports_ticket(), self.pa_ticket()}
        self._wrench_model = self.DeclareVectorOutputPort(
            "wrench_model", 78, self._calc_wrench_model, from_inputs
        )
        calc_F_To_W = self._calc_F_To_W
        if enable_chain:
            self._eval_chain = self.DeclareAbstractInputPort(
                "contact_chain", Value[object]()
            ).Eval
            self._warn_of_depth = warn_of_depth
            calc_F_To_W = self._calc_chained_F_To_W
        self.DeclareVectorOutputPort("F_To_W", 6, calc_F_To_W, from_inputs)
        self._moving = [i for i, item in enumerate(objects) if item.X_WO is None]
        if self._moving:
            self.DeclareVectorOutputPort(
                "F_O_W", 6 * len(self._moving), self._calc_F_O_W, from_inputs
            )
        self._contact_wrench = self.DeclareAbstractOutputPort(
            "contact_wrench", Value[object], self._calc_contact_wrench, from_inputs
        )
        self.DeclareAbstractOutputPort(
            "gains", Value[object], self._show_gains, {self.pa_ticket()}
        )
        # A plant reads the wrench on the tool and the reaction on objects that move,
        # which share the cached `contact_wrench`. A haptic loop reads only
        # `wrench_model`, for which calling the core takes less time.
        self._eval_wrench: Callable[[Context], PenaltyWrench] = (
            self._contact_wrench.Eval if self._moving else self._calc_wrench
        )

    def get_gains(self, context: Context) -> ContactGains:
        """Returns the stiffness and damping of each object.

        Args:
            context: Context of this system.
        """
        self.ValidateContext(context)
        return context.get_abstract_parameter(self._gains).get_value()

    def set_gains(self, context: Context, gains: ContactGains) -> None:
        """Changes the stiffness and damping of each object, from now on.

        Args:
            context: Context of this system.
            gains: Stiffness and damping of each object, in their order.

        Raises:
            TypeError: The gains are not `ContactGains`.
            ValueError: There is not one gain of each kind for each object.
        """
        self.ValidateContext(context)
        if not isinstance(gains, ContactGains):
            raise TypeError(f"gains must be ContactGains, is {type(gains).__name__}")
        self._check_number(gains)
        context.get_mutable_abstract_parameter(self._gains).set_value(gains)

    def differentiate(
        self, port: str, at: AutoDiffPoint
    ) -> AutoDiffVector | AutoDiffPenaltyWrench:
        """Returns a wrench, or the whole `contact_wrench`, with derivatives."""
        gains: ContactGains = at.parameters[self._gains]
        wrench = penalty_force(
            at["clusters"],
            take(at["X_WT"], slice(4, 7)),
            at["V_WT"],
            *self._motions.differentiate(at),
            gains.stiffness_N_per_m,
            gains.damping_Ns_per_m,
        )
        if port == "contact_wrench":
            return wrench
        if port == "F_O_W":
            rows = [6 * i + k for i in self._moving for k in range(6)]
            return take(wrench.F_objects_W, rows)
        return wrench.F_To_W if port == "F_To_W" else wrench.wrench_model

    def _read(self, context: Context) -> tuple[Any, ...]:
        """Returns the arguments of the law."""
        return (
            self._eval_clusters(context),
            self._eval_X_WT(context),
            self._eval_V_WT(context),
            self._motions.read(context),
            context.get_abstract_parameter(self._gains).get_value().materials,
        )

    def _check_number(self, gains: ContactGains) -> None:
        """Raises ValueError unless there are gains of each object."""
        number = len(gains.stiffness_N_per_m)
        if number != self._num_objects:
            raise ValueError(
                "stiffness_N_per_m must have one value for each of the"
                f" {self._num_objects} objects, has {number}"
            )

    def _show_gains(self, context: Context, gains: AbstractValue) -> None:
        gains.set_value(self.get_gains(context))

    def _calc_wrench(self, context: Context) -> PenaltyWrench:
        return penalty_force(*self._read(context))

    def _calc_wrench_model(self, context: Context, output: BasicVector) -> None:
        output.set_value(penalty_wrench_model(*self._read(context)))

    def _calc_F_To_W(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._eval_wrench(context).F_To_W)

    def _calc_chained_F_To_W(self, context: Context, output: BasicVector) -> None:
        chain = self._eval_chain(context)
        output.set_value(
            chain.find_force(self._eval_X_WT(context), self._eval_V_WT(context))
        )
        if self._warn_of_depth is not None:
            self._warn_of_depth(context, *chain.deepest)

    def _calc_F_O_W(self, context: Context, output: BasicVector) -> None:
        wrench = self._eval_wrench(context)
        output.SetFromVector(wrench.F_objects_W[self._moving].ravel())

    def _calc_contact_wrench(self, context: Context, output: AbstractValue) -> None:
        output.set_value(self._calc_wrench(context))
