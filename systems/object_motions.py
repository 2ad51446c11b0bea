"""How the objects of a scene move, for systems that ask for it at every tick."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.systems.framework import Context, LeafSystem

from drake_haptics._core import AutoDiffVector
from drake_haptics.systems.contact_query import ContactObject
from drake_haptics.systems.differentiable_system import AutoDiffPoint


class ObjectMotions:
    """Origins and velocities of all objects, those that move read from ports.

    Gives its system the input ports `X_WO_<name>` (7) and `V_WO_<name>` (6) for each
    object without a pose of its own. The others are placed here, once.
    """

    def __init__(self, system: LeafSystem, objects: Sequence[ContactObject]):
        """Declares the ports.

        Args:
            system: Under construction.
            objects: In the order of the query.
        """
        self._moving = [
            (
                i,
                system.DeclareVectorInputPort(f"X_WO_{item.name}", 7),
                system.DeclareVectorInputPort(f"V_WO_{item.name}", 6),
            )
            for i, item in enumerate(objects)
            if item.X_WO is None
        ]
        self._p_WO = np.zeros((len(objects), 3))
        self._V_WO = np.zeros((len(objects), 6))
        for i, item in enumerate(objects):
            if item.X_WO is not None:
                self._p_WO[i] = item.X_WO.translation()

    def read(self, context: Context) -> tuple[np.ndarray, np.ndarray]:
        """Returns p_WO (m, 3), m, and V_WO (m, 6), rad/s and m/s; not to be changed."""
        if not self._moving:
            return self._p_WO, self._V_WO
        p_WO, V_WO = self._p_WO.copy(), self._V_WO.copy()
        for i, X_WO, V_WOi in self._moving:
            p_WO[i] = X_WO.Eval(context)[4:]
            V_WO[i] = V_WOi.Eval(context)
        return p_WO, V_WO

    def differentiate(self, at: AutoDiffPoint) -> tuple[AutoDiffVector, AutoDiffVector]:
        """Returns p_WO (3 m,) and V_WO (6 m,) with their derivatives."""
        p_WO, V_WO = self._p_WO.copy(), self._V_WO.copy()
        by_p_WO = np.zeros((*p_WO.shape, at.num_derivatives))
        by_V_WO = np.zeros((*V_WO.shape, at.num_derivatives))
        for i, X_WO, V_WOi in self._moving:
            X, V = at[X_WO.get_name()], at[V_WOi.get_name()]
            p_WO[i], by_p_WO[i] = X.value[4:], X.gradient[4:]
            V_WO[i], by_V_WO[i] = V.value, V.gradient
        return (
            AutoDiffVector(
                p_WO.ravel(), by_p_WO.reshape(p_WO.size, at.num_derivatives)
            ),
            AutoDiffVector(
                V_WO.ravel(), by_V_WO.reshape(V_WO.size, at.num_derivatives)
            ),
        )
