"""The reaction of friction on objects that move."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.common.value import Value
from pydrake.systems.framework import BasicVector, Context

from drake_haptics._core import AutoDiffVector
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)


class FrictionReaction(DifferentiableSystem):
    """The reaction of `StickSlipFriction` on objects that can move.

    At each cluster the object gets the opposite of the force on the tool, at the same
    point, so that total momentum is conserved.

    .. pydrake_system::

        name: FrictionReaction
        input_ports:
        - clusters
        - friction_force
        - X_WO_<name of each object that moves>
        output_ports:
        - F_O_W

    * `clusters` is the `drake_haptics._core.ClusterSet` that friction was found for.
    * `friction_force` is the `drake_haptics._core.FrictionStep`.
    * `X_WO_<name>` (7) is a pose [qw qx qy qz x y z] in the world, m.
    * `F_O_W` (6 for each object that moves) are wrenches [τ; f] on those objects, each
      at its origin in the world, N·m and N.
    """

    def __init__(self, objects: Sequence[ContactObject]):
        """Constructs the system.

        Args:
            objects: Objects of the `ContactQuery`, in the same order; at least one of
                them moves.
        """
        super().__init__()
        self._clusters = self.DeclareAbstractInputPort("clusters", Value[object]())
        self._friction = self.DeclareAbstractInputPort(
            "friction_force", Value[object]()
        )
        self._X_WO = {
            i: self.DeclareVectorInputPort(f"X_WO_{item.name}", 7)
            for i, item in enumerate(objects)
            if item.X_WO is None
        }
        self.DeclareVectorOutputPort(
            "F_O_W",
            6 * len(self._X_WO),
            self._calc_F_O_W,
            {self.all_input_ports_ticket()},
        )

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the wrenches with their derivatives."""
        clusters, D = at["clusters"], at.num_derivatives
        objects = clusters.value.object_index
        p_WC, f = clusters.p_WC, at["friction_force"].f_cluster_W
        F, by_F = np.zeros((len(self._X_WO), 6)), np.zeros((len(self._X_WO), 6, D))
        for row, (i, X_WO_port) in enumerate(self._X_WO.items()):
            X_WO, own = at[X_WO_port.get_name()], objects == i
            r = p_WC.value.reshape(-1, 3)[own] - X_WO.value[4:]
            by_r = p_WC.gradient.reshape(-1, 3, D)[own] - X_WO.gradient[4:]
            f_C, by_f = f.value.reshape(-1, 3)[own], f.gradient.reshape(-1, 3, D)[own]
            F[row] = _react(r, f_C)
            # The product rule.
            by_torque = np.cross(by_r, f_C[:, :, None], axis=1)
            by_torque += np.cross(r[:, :, None], by_f, axis=1)
            by_F[row] = -np.concatenate([by_torque.sum(axis=0), by_f.sum(axis=0)])
        return AutoDiffVector(F.ravel(), by_F.reshape(-1, D))

    def _calc_F_O_W(self, context: Context, output: BasicVector) -> None:
        clusters = self._clusters.Eval(context)
        f = self._friction.Eval(context).f_cluster_W
        F = np.zeros((len(self._X_WO), 6))
        if len(clusters) > 0:
            p_WC, objects = clusters.p_WC, clusters.object_index
            for row, (i, port) in enumerate(self._X_WO.items()):
                own = objects == i
                F[row] = _react(p_WC[own] - port.Eval(context)[4:], f[own])
        output.SetFromVector(F.ravel())


def _react(r: np.ndarray, f: np.ndarray) -> np.ndarray:
    """Returns the sum (6,) of the wrenches of -f (k, 3) at r (k, 3)."""
    return -np.concatenate([np.cross(r, f).sum(axis=0), f.sum(axis=0)])
