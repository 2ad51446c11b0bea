"""The spring and damper between the device's handle and the tool."""

from __future__ import annotations

import numpy as np
from pydrake.math import RigidTransform
from pydrake.systems.framework import BasicVector, Context, Diagram, DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource

from drake_haptics._core import AutoDiffVector, CouplingGains, joined_coupling_wrench
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)
from drake_haptics.systems.framework.vector_ports import export_parts, import_parts


class VirtualCoupling(Diagram):
    """Six-axis spring and damper between handle and tool.

    It pulls the tool to X_WH X_HT, and the handle gets the reaction. The device thus
    feels at most this stiffness, however stiff the contact is (Adams and Hannaford
    1999). It has no state and adds no delay.

    It pulls with at most the gains' `max_force_N` and `max_torque_Nm`, which in a loop
    are those of the device: stretching it further presses the tool no harder.

    .. pydrake_system::

        name: VirtualCoupling
        input_ports:
        - X_WH
        - V_WH
        - X_WT
        - V_WT
        output_ports:
        - wrench_model
        - F_Ho_W_commanded
        - motions_and_gains

    `X_WH` and `X_WT` are poses [qw qx qy qz x y z] of the handle and the tool in
    the world, m; `V_WH` and `V_WT` their spatial velocities [ω; v] at the
    frame's origin, rad/s and m/s.

    * `wrench_model` (78) is [F; K; B] on the tool at its origin, as `PenaltyForce`
      documents it.
    * `F_Ho_W_commanded` (6) is the wrench [τ; f] on the handle at its origin in the
      world, N·m and N.
    * `motions_and_gains` (39) holds all that both depend on: the inputs, in this order,
      the gains, and the pose X_HT at which the spring rests.

    The gains (6), in the order of the constructor of `CouplingGains`, and X_HT (7) are
    a numeric parameter (13) of the Context; see `set_gains`. Outputs have no
    derivatives with respect to them.
    """

    def __init__(self, gains: CouplingGains, X_HT: RigidTransform):
        """Constructs the system.

        Args:
            gains: Default gains of the spring and the damper.
            X_HT: Pose of the tool in the handle at which the spring rests.

        Raises:
            ValueError: The pose is not finite.
        """
        super().__init__()
        if not np.isfinite(X_HT.GetAsMatrix34()).all():
            raise ValueError(
                "X_HT must be finite, has the translation"
                f" {X_HT.translation().tolist()} m and the rotation"
                f" {X_HT.rotation().matrix().tolist()}"
            )
        self._X_HT = X_HT
        builder = DiagramBuilder()
        spring = builder.AddNamedSystem("spring", _SpringAndDamper())
        # A system of Drake passes them on with the motions: reading a parameter in
        # Python takes longer than the law.
        self._gains = builder.AddNamedSystem(
            "gains",
            ConstantVectorSource(
                np.concatenate([gains_to_vector(gains), pose_to_vector(X_HT)])
            ),
        )
        import_parts(
            builder, spring.get_input_port(), _MOTIONS, self._gains.get_output_port()
        )
        export_parts(
            builder,
            spring.get_output_port(),
            {"wrench_model": 78, "F_Ho_W_commanded": 6},
        )
        joint = builder.GetSubsystemByName("joint")
        builder.ExportOutput(joint.get_output_port(), "motions_and_gains")
        builder.BuildInto(self)

    def get_gains(self, context: Context) -> CouplingGains:
        """Returns the gains of the spring and the damper.

        Args:
            context: Context of this system.
        """
        own = self.GetSubsystemContext(self._gains, context)
        return CouplingGains(*self._gains.get_source_value(own).value()[:6])

    def set_gains(self, context: Context, gains: CouplingGains) -> None:
        """Changes the gains, from now on.

        Args:
            context: Context of this system.
            gains: Gains of the spring and the damper.

        Raises:
            TypeError: The gains are not `CouplingGains`.
        """
        if not isinstance(gains, CouplingGains):
            raise TypeError(f"gains must be CouplingGains, is {type(gains).__name__}")
        own = self.GetMutableSubsystemContext(self._gains, context)
        self._gains.get_mutable_source_value(own).SetFromVector(
            np.concatenate([gains_to_vector(gains), pose_to_vector(self._X_HT)])
        )

    @property
    def X_HT(self) -> RigidTransform:
        """Pose of the tool in the handle at which the spring rests."""
        return self._X_HT


# Inputs of the spring and damper; the gains and X_HT follow them.
_MOTIONS = {"X_WH": 7, "V_WH": 6, "X_WT": 7, "V_WT": 6}


def gains_to_vector(gains: CouplingGains) -> np.ndarray:
    """Returns gains (6,) in the order of the constructor of `CouplingGains`."""
    return np.array(
        [
            gains.stiffness_N_per_m,
            gains.damping_Ns_per_m,
            gains.rotational_stiffness_Nm_per_rad,
            gains.rotational_damping_Nms_per_rad,
            gains.max_force_N,
            gains.max_torque_Nm,
        ]
    )


def coupling_wrench(
    q_WH: np.ndarray,
    V_WH: np.ndarray,
    q_HT: np.ndarray,
    q_WT: np.ndarray,
    V_WT: np.ndarray,
    gains: CouplingGains,
) -> np.ndarray:
    """Returns the wrenches of the coupling between a handle and a tool.

    Args:
        q_WH: (7,) pose [qw qx qy qz x y z] of the handle.
        V_WH: (6,) spatial velocity [rad/s; m/s] of the handle.
        q_HT: (7,) pose of the tool in the handle at which the spring rests.
        q_WT: (7,) pose of the tool.
        V_WT: (6,) spatial velocity of the tool.
        gains: Spring, damper, and their limits.

    Returns:
        (84,): the wrench model on the tool at To (78), then the reaction on the handle
        at Ho in W (6), [torque; force].
    """
    return joined_coupling_wrench(
        np.concatenate([q_WH, V_WH, q_WT, V_WT, gains_to_vector(gains), q_HT])
    )


class _SpringAndDamper(DifferentiableSystem):
    """Both wrenches of a `VirtualCoupling` from one call of the core."""

    def __init__(self) -> None:
        super().__init__()
        # Bound once, because looking up a method takes as long as adding vectors.
        self._eval_joined = self.DeclareVectorInputPort("motions_and_gains", 39).Eval
        self.DeclareVectorOutputPort(
            "wrenches", 84, self._calc_wrenches, {self.all_input_ports_ticket()}
        )

    def _calc_wrenches(self, context: Context, wrenches: BasicVector) -> None:
        wrenches.set_value(joined_coupling_wrench(self._eval_joined(context)))

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the wrenches with their derivatives."""
        return joined_coupling_wrench(at["motions_and_gains"])
