"""Applies gravity to the tool."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.systems.framework import BasicVector, Context

from drake_haptics._core import AutoDiffVector, tool_weight
from drake_haptics.common.value_checks import check_positive
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
    join,
)

STANDARD_GRAVITY_M_PER_S2 = (0.0, 0.0, -9.81)


class ToolGravity(DifferentiableSystem):
    """Gravity on the tool, a constant force at its center of mass.

    .. pydrake_system::

        name: ToolGravity
        input_ports:
        - X_WT
        output_ports:
        - wrench_model

    `X_WT` (7) is the tool's pose [qw qx qy qz x y z] in the world, m.

    `wrench_model` (78) is [F; K; B] on the tool at its origin, as `PenaltyForce`
    documents it. K and B are zero. The torque changes with the rotation, but its
    derivative is positive semidefinite only if the tool hangs below its origin, and an
    indefinite K would make the tool's implicit step unsafe.
    """

    def __init__(
        self,
        *,
        mass_kg: float,
        p_TTcm: Sequence[float],
        gravity_m_per_s2: Sequence[float] = STANDARD_GRAVITY_M_PER_S2,
    ):
        """Constructs the system.

        Args:
            mass_kg: Mass of the tool, kg.
            p_TTcm: (3,) center of mass of the tool in its frame, m.
            gravity_m_per_s2: (3,) acceleration of gravity in the world, m/s².

        Raises:
            ValueError: The mass is not positive, a vector does not have three entries,
                or a number is not finite.
        """
        super().__init__()
        check_positive(mass_kg=mass_kg)
        self._p_TTcm = _check_vector("p_TTcm", p_TTcm)
        self._weight_W = mass_kg * _check_vector("gravity_m_per_s2", gravity_m_per_s2)
        self._X_WT = self.DeclareVectorInputPort("X_WT", 7)
        self._wrench_model = self.DeclareVectorOutputPort(
            "wrench_model", 78, self._calc_wrench_model, {self._X_WT.ticket()}
        )

    @property
    def weight_W_N(self) -> np.ndarray:
        """(3,) the weight in the world, N."""
        return self._weight_W

    @property
    def p_TTcm(self) -> np.ndarray:
        """(3,) the center of mass in the tool's frame, m."""
        return self._p_TTcm

    def _calc_wrench_model(self, context: Context, output: BasicVector) -> None:
        wrench_model = np.zeros(78)
        wrench_model[:6] = tool_weight(
            self._X_WT.Eval(context), self._p_TTcm, self._weight_W
        )
        output.SetFromVector(wrench_model)

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the wrench model with its derivatives."""
        weight = tool_weight(at["X_WT"], self._p_TTcm, self._weight_W)
        return join([weight, at.hold(np.zeros(72))])


def _check_vector(name: str, vector: Sequence[float]) -> np.ndarray:
    """Returns a vector of three finite numbers as an array."""
    array = np.asarray(vector, dtype=float)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ValueError(f"{name} must be three finite numbers, is {vector}")
    return array
