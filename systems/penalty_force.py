"""Answers contact clusters with forces."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import (
    BasicVector,
    Context,
    InputPort,
    OutputPort,
)

from drake_haptics._core import (
    AutoDiffPenaltyWrench,
    AutoDiffVector,
    PenaltyWrench,
    penalty_force,
)
from drake_haptics.systems.contact_query import ContactObject
from drake_haptics.systems.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)
from drake_haptics.systems.object_motions import ObjectMotions


class PenaltyForce(DifferentiableSystem):
    """Elastic force below the tolerance, with damping that never pulls.

    Each cluster pushes with k times its compression along n at its point, and with
    k_v times the speed of approach and its damping share more where the surfaces
    approach. With the octree's clusters that is (k (t - d) - k_v v) n of the paper
    (Eq. 6-10).

    .. pydrake_system::

        name: PenaltyForce
        input_ports:
        - clusters
        - X_WTool
        - V_WTool
        - X_WO_<name of each object that moves>
        - V_WO_<name of each object that moves>
        output_ports:
        - wrench_model
        - F_Tool_W
        - F_O_W (with objects that move)
        - contact_wrench

    Poses are [qw qx qy qz x y z], m. `V_WTool` and `V_WO_<name>` are spatial
    velocities [ω; v] of the frame's origin in the world, rad/s and m/s.

    * `clusters` is a `drake_haptics._core.ClusterSet`.
    * `wrench_model` (78) is [F; K; B]: the wrench on the tool at its origin in the
      world, N·m and N, and its 6 x 6 stiffness and damping, row-major, with
      F(δ, V + dV) ≈ F - K δ - B dV, δ = [rotation vector; translation] of the tool.
    * `F_Tool_W` (6) is its F, [τ; f].
    * `F_O_W` (6 for each object that moves) are the wrenches [τ; f] on those objects,
      each at its origin in the world, N·m and N.
    * `contact_wrench` is the `drake_haptics._core.PenaltyWrench` with the force of
      each cluster and the wrench on each object.

    Under AutoDiffXd `clusters` is an `AutoDiffClusterSet` and `contact_wrench` an
    `AutoDiffPenaltyWrench` of `drake_haptics._core`. K and B have derivatives of
    their own there, by which the tool's implicit step changes.
    """

    def __init__(
        self,
        objects: Sequence[ContactObject],
        stiffness_N_per_m: Sequence[float],
        damping_Ns_per_m: Sequence[float],
    ):
        """Constructs the system.

        Args:
            objects: Those of the `ContactQuery`, in the same order.
            stiffness_N_per_m: k of each object, N/m.
            damping_Ns_per_m: k_v of each object, N·s/m.

        Raises:
            ValueError: A gain is negative or not finite, or there is not one for
                each object.
        """
        super().__init__()
        self._stiffness = _check_gains("stiffness_N_per_m", stiffness_N_per_m, objects)
        self._damping = _check_gains("damping_Ns_per_m", damping_Ns_per_m, objects)
        self._clusters = self.DeclareAbstractInputPort("clusters", Value[object]())
        self._X_WTool = self.DeclareVectorInputPort("X_WTool", 7)
        self._V_WTool = self.DeclareVectorInputPort("V_WTool", 6)
        self._motions = ObjectMotions(self, objects)
        from_inputs = {self.all_input_ports_ticket()}
        self._wrench_model = self.DeclareVectorOutputPort(
            "wrench_model", 78, self._calc_wrench_model, from_inputs
        )
        self._F_Tool_W = self.DeclareVectorOutputPort(
            "F_Tool_W", 6, self._calc_F_Tool_W, from_inputs
        )
        self._moving = [i for i, item in enumerate(objects) if item.X_WO is None]
        if self._moving:
            self.DeclareVectorOutputPort(
                "F_O_W", 6 * len(self._moving), self._calc_F_O_W, from_inputs
            )
        self._contact_wrench = self.DeclareAbstractOutputPort(
            "contact_wrench",
            Value[object],
            self._calc_contact_wrench,
            from_inputs,
        )
        # A plant asks for the wrench on the tool and the reaction of objects that move:
        # these share the answer that `contact_wrench` keeps. A haptic loop asks for
        # `wrench_model` alone, and to call the core then takes less time.
        self._eval_wrench: Callable[[Context], PenaltyWrench] = (
            self._contact_wrench.Eval if self._moving else self._calc_wrench
        )

    @property
    def stiffness_N_per_m(self) -> list[float]:
        """Stiffness k of each object, N/m."""
        return self._stiffness.tolist()

    def get_clusters_input_port(self) -> InputPort:
        """Returns the input `clusters`."""
        return self._clusters

    def get_tool_pose_input_port(self) -> InputPort:
        """Returns the input `X_WTool`."""
        return self._X_WTool

    def get_tool_velocity_input_port(self) -> InputPort:
        """Returns the input `V_WTool`."""
        return self._V_WTool

    def get_object_pose_input_port(self, name: str) -> InputPort:
        """Returns the input `X_WO_<name>` of an object that moves."""
        return self.GetInputPort(f"X_WO_{name}")

    def get_object_velocity_input_port(self, name: str) -> InputPort:
        """Returns the input `V_WO_<name>` of an object that moves."""
        return self.GetInputPort(f"V_WO_{name}")

    def get_wrench_model_output_port(self) -> OutputPort:
        """Returns the output `wrench_model`."""
        return self._wrench_model

    def get_tool_wrench_output_port(self) -> OutputPort:
        """Returns the output `F_Tool_W`."""
        return self._F_Tool_W

    def get_object_wrenches_output_port(self) -> OutputPort:
        """Returns the output `F_O_W`; there is none if no object moves."""
        return self.GetOutputPort("F_O_W")

    def get_contact_wrench_output_port(self) -> OutputPort:
        """Returns the output `contact_wrench`."""
        return self._contact_wrench

    def differentiate(
        self, port: str, at: AutoDiffPoint
    ) -> AutoDiffVector | AutoDiffPenaltyWrench:
        """Returns a wrench, or all that is known of them, with derivatives."""
        X_WTool = at["X_WTool"]
        p_WO, V_WO = self._motions.differentiate(at)
        wrench = penalty_force(
            at["clusters"],
            AutoDiffVector(X_WTool.value[4:], X_WTool.gradient[4:]),
            at["V_WTool"],
            p_WO,
            V_WO,
            self._stiffness,
            self._damping,
        )
        if port == "contact_wrench":
            return wrench
        if port == "F_O_W":
            F = wrench.F_objects_W
            rows = [6 * i + k for i in self._moving for k in range(6)]
            return AutoDiffVector(F.value[rows], F.gradient[rows])
        return wrench.F_Tool_W if port == "F_Tool_W" else wrench.wrench_model

    def _calc_wrench(self, context: Context) -> PenaltyWrench:
        p_WO, V_WO = self._motions.read(context)
        return penalty_force(
            self._clusters.Eval(context),
            self._X_WTool.Eval(context)[4:],
            self._V_WTool.Eval(context),
            p_WO,
            V_WO,
            self._stiffness,
            self._damping,
        )

    def _calc_wrench_model(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._calc_wrench(context).wrench_model)

    def _calc_F_Tool_W(self, context: Context, output: BasicVector) -> None:
        output.SetFromVector(self._eval_wrench(context).F_Tool_W)

    def _calc_F_O_W(self, context: Context, output: BasicVector) -> None:
        wrench = self._eval_wrench(context)
        output.SetFromVector(wrench.F_objects_W[self._moving].ravel())

    def _calc_contact_wrench(self, context: Context, output: AbstractValue) -> None:
        output.set_value(self._calc_wrench(context))


def _check_gains(
    name: str, gains: Sequence[float], objects: Sequence[ContactObject]
) -> np.ndarray:
    """Returns one gain for each object as an array."""
    if len(gains) != len(objects):
        raise ValueError(
            f"{name} must have one value for each of the {len(objects)} objects, has"
            f" {len(gains)}"
        )
    for gain in gains:
        if not (gain >= 0.0 and math.isfinite(gain)):
            raise ValueError(f"{name} must be finite and not negative, has {gain}")
    return np.array(gains, dtype=float)
