"""Connects a body of a plant with the proxy that contact stops in its place."""

from __future__ import annotations

import numpy as np
from pydrake.common.eigen_geometry import AngleAxis
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.common.value_checks import check_positive


class BodyOfProxy(LeafSystem):
    """Predicts the body's pose for its proxy, and applies the proxy's wrenches to it.

    .. pydrake_system::

        name: BodyOfProxy
        input_ports:
        - X_WT
        - V_WT
        - X_WP
        - F_Po_W
        - handle
        output_ports:
        - X_WT_next
        - F_To_W

    * `X_WT` (7) is the body's pose [qw qx qy qz x y z] in the world, m, `V_WT` (6) its
      spatial velocity [ω; v] at its origin in the world, rad/s and m/s.
    * `X_WP` (7) is the proxy's pose.
    * `F_Po_W` (6) is the wrench [τ; f] of contact on the proxy at its origin in the
      world, N·m and N; `handle` (78) is a wrench model that begins with another wrench
      on the proxy; it counts as zero if it is not connected.
    * `X_WT_next` (7) is the body's pose after a step without forces. A proxy that is
      pulled there does not lag behind a body that coasts.
    * `F_To_W` (6) is the sum of both wrenches at the body's origin: wrenches on a proxy
      without mass act on its body at the same point, so that momentum and angular
      momentum are conserved, and a body that touches nothing feels nothing.

    It has no state.
    """

    no_derivatives = "puts a proxy in its body's place: take contact.law: penalty"

    def __init__(self, period_s: float):
        """Constructs the system.

        Args:
            period_s: Duration of a step, s.

        Raises:
            ValueError: The period is not positive.
        """
        super().__init__()
        check_positive(period_s=period_s)
        self._period_s = period_s
        self._X_WT = self.DeclareVectorInputPort("X_WT", 7)
        self._V_WT = self.DeclareVectorInputPort("V_WT", 6)
        self._X_WP = self.DeclareVectorInputPort("X_WP", 7)
        self._F_Po_W = self.DeclareVectorInputPort("F_Po_W", 6)
        self._handle = self.DeclareVectorInputPort("handle", 78)
        self.DeclareVectorOutputPort(
            "X_WT_next",
            7,
            self._calc_X_WT_next,
            {self._X_WT.ticket(), self._V_WT.ticket()},
        )
        self.DeclareVectorOutputPort(
            "F_To_W",
            6,
            self._calc_F_To_W,
            {
                self._X_WT.ticket(),
                self._X_WP.ticket(),
                self._F_Po_W.ticket(),
                self._handle.ticket(),
            },
        )

    def _calc_X_WT_next(self, context: Context, output: BasicVector) -> None:
        X_WT = vector_to_pose(self._X_WT.Eval(context))
        motion = self._period_s * self._V_WT.Eval(context)
        angle = float(np.linalg.norm(motion[:3]))
        turn = RotationMatrix()
        if angle > 0.0:
            turn = RotationMatrix(AngleAxis(angle, motion[:3] / angle))
        X_WT_next = RigidTransform(
            turn @ X_WT.rotation(), X_WT.translation() + motion[3:]
        )
        output.SetFromVector(pose_to_vector(X_WT_next))

    def _calc_F_To_W(self, context: Context, output: BasicVector) -> None:
        F_Po_W = self._F_Po_W.Eval(context).copy()
        if self._handle.HasValue(context):
            F_Po_W += self._handle.Eval(context)[:6]
        p_ToPo_W = self._X_WP.Eval(context)[4:] - self._X_WT.Eval(context)[4:]
        shift = np.cross(p_ToPo_W, F_Po_W[3:])
        output.SetFromVector(F_Po_W + np.concatenate([shift, np.zeros(3)]))
