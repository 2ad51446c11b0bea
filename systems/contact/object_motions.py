"""How the objects of a scene move, for systems that ask for it at every tick."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.systems.framework import Context, InputPort, LeafSystem

from drake_haptics._core import AutoDiffVector, ObjectFrames
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.framework.differentiable_system import AutoDiffPoint


class ObjectMotions:
    """Where all objects are and how they move; those that move are read from ports.

    Gives its system the input ports `X_WO_<name>` (7) and `V_WO_<name>` (6) for each
    object without a pose of its own. The others are placed here, once.
    """

    def __init__(self, system: LeafSystem, objects: Sequence[ContactObject]):
        """Declares the ports.

        Args:
            system: Under construction.
            objects: In the order of the query.
        """
        self._moving = [i for i, item in enumerate(objects) if item.X_WO is None]
        self._X_WO_ports: list[InputPort] = []
        self._V_WO_ports: list[InputPort] = []
        for i in self._moving:
            name = objects[i].name
            self._X_WO_ports.append(system.DeclareVectorInputPort(f"X_WO_{name}", 7))
            self._V_WO_ports.append(system.DeclareVectorInputPort(f"V_WO_{name}", 6))
        self._p_WO = np.zeros((len(objects), 3))
        self._V_WO = np.zeros((len(objects), 6))
        for i, item in enumerate(objects):
            if item.X_WO is not None:
                self._p_WO[i] = item.X_WO.translation()
        # There can be a thousand: what rests crosses to the core only here.
        self._at_rest = ObjectFrames(self._p_WO, self._V_WO)

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
        p_WO, V_WO = self._p_WO.copy(), self._V_WO.copy()
        by_p_WO = np.zeros((*p_WO.shape, at.num_derivatives))
        by_V_WO = np.zeros((*V_WO.shape, at.num_derivatives))
        ports = zip(self._moving, self._X_WO_ports, self._V_WO_ports, strict=True)
        for i, X_WO, V_WOi in ports:
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
