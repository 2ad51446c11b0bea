"""Reads the motion of tool and objects from the ports of a plant."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import numpy as np
from pydrake.autodiffutils import AutoDiffXd
from pydrake.common.value import AbstractValue
from pydrake.math import RigidTransform_
from pydrake.multibody.math import SpatialVelocity_
from pydrake.multibody.tree import BodyIndex
from pydrake.systems.framework import Diagram, LeafSystem_
from pydrake.systems.scalar_conversion import TemplateSystem

from drake_haptics.systems.framework.differentiable_system import (
    get_no_witness_functions,
)
from drake_haptics.systems.framework.vector_ports import BuildAround


class BodyMotions(Diagram):
    """Selects the poses and velocities of tool and objects from those of all bodies.

    .. pydrake_system::

        name: BodyMotions
        input_ports:
        - body_poses
        - body_spatial_velocities
        output_ports:
        - X_WT
        - V_WT
        - X_WO_<name of each object>
        - V_WO_<name of each object>

    The inputs are the lists of a `MultibodyPlant`'s ports of these names.

    * `X_WT` and `X_WO_<name>` (7) are poses [qw qx qy qz x y z] of the bodies'
      frames in the world, m.
    * `V_WT` and `V_WO_<name>` (6) are their spatial velocities [ω; v] at the
      frame's origin in the world, rad/s and m/s.

    It has no state, and converts to AutoDiffXd. With a largest step it has a periodic
    publish event that does nothing, at which every step of an integrator ends.
    """

    def __init__(
        self,
        tool: BodyIndex,
        objects: Mapping[str, BodyIndex],
        largest_step_s: float | None = None,
    ):
        """Constructs the system.

        Args:
            tool: Body that is the tool.
            objects: Bodies of the objects that move, by the names of the objects.
            largest_step_s: Longest step that an integrator may take, s; None for a
                discrete plant.
        """
        super().__init__()
        sizes = {"X_WT": 7, "V_WT": 6}
        for name in objects:
            sizes |= {f"X_WO_{name}": 7, f"V_WO_{name}": 6}
        vector = _BodyMotionsVector([tool, *objects.values()], largest_step_s)
        BuildAround(self, "vector", vector, sizes)


@TemplateSystem.define(
    "_BodyMotionsVector_", T_list=(float, AutoDiffXd), scope=sys.modules[__name__]
)
def _BodyMotionsVector_(T: type) -> type:
    class Impl(LeafSystem_[T]):
        """All outputs of a `BodyMotions`, concatenated."""

        DoGetWitnessFunctions = get_no_witness_functions

        def _construct(
            self,
            bodies: list[BodyIndex],
            largest_step_s: float | None,
            converter: Any = None,
        ) -> None:
            LeafSystem_[T].__init__(self, converter=converter)
            self._bodies = [int(body) for body in bodies]
            self._largest_step_s = largest_step_s
            if largest_step_s is not None:
                self.DeclarePeriodicPublishEvent(
                    largest_step_s, 0.0, lambda context: None
                )
            self._poses = self.DeclareAbstractInputPort(
                "body_poses", AbstractValue.Make([RigidTransform_[T]()])
            )
            self._velocities = self.DeclareAbstractInputPort(
                "body_spatial_velocities", AbstractValue.Make([SpatialVelocity_[T]()])
            )
            self.DeclareVectorOutputPort(
                "motions",
                13 * len(bodies),
                self._calc_motions,
                {self.all_input_ports_ticket()},
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(
                self, other._bodies, other._largest_step_s, converter=converter
            )

        def _calc_motions(self, context: Any, motions: Any) -> None:
            poses = self._poses.Eval(context)
            velocities = self._velocities.Eval(context)
            parts = []
            for body in self._bodies:
                X_WB = poses[body]
                parts += [
                    X_WB.rotation().ToQuaternion().wxyz(),
                    X_WB.translation(),
                    velocities[body].get_coeffs(),
                ]
            motions.SetFromVector(np.concatenate(parts))

    return Impl


_BodyMotionsVector = _BodyMotionsVector_[None]
