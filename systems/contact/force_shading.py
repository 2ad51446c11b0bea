"""Interpolates the normals of contacts, so that meshes feel smooth."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import Context

from drake_haptics._core import (
    AutoDiffContactSet,
    ContactShading,
    ConvexPieces,
    SurfaceShading,
)
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.contact.contact_query import (
    ContactObject,
    differentiate_poses,
)
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
    join,
)


class ForceShading(DifferentiableSystem):
    """Normals interpolated over the triangles under the witness points.

    The direction of the force follows the smooth surface that a mesh stands for instead
    of jumping from facet to facet (paper, 4.4.1; Morgenbesser and Srinivasan 1996).
    Edges that turn by the crease angle or more stay sharp. Only normals change, and by
    at most 45°, so that no contact pulls.

    .. pydrake_system::

        name: ForceShading
        input_ports:
        - contacts
        - X_WT
        - X_WO_<name of each object that moves>
        output_ports:
        - contacts
        - shading

    Poses are [qw qx qy qz x y z] in the world, m, those at which the contacts were
    found. Both `contacts` are a `drake_haptics.ContactSet`, immutable. `shading` is the
    `drake_haptics._core.ContactShading` itself, with which the `contact_chain` of
    `ContactQuery` does the same; it has no value under AutoDiffXd.

    Pieces of a decomposition that were not made from triangles (methods "hull" and
    "coacd") keep the normals of their facets. A shaded force is not the gradient of any
    energy: the documentation states how much a closed path can gain.

    Under AutoDiffXd both `contacts` are a `drake_haptics._core.AutoDiffContactSet`.
    Derivatives of the normals are complete: normals turn with the bodies and with the
    place on the triangle. At an edge between triangles they are those of the triangle
    that the witness point is taken to be on.
    """

    undifferentiated = frozenset({"shading"})

    def __init__(
        self,
        tool: ConvexPieces,
        objects: Sequence[ContactObject],
        *,
        crease_angle_deg: float,
        shaded: Sequence[bool],
    ):
        """Constructs the system.

        Args:
            tool: Tool of the `ContactQuery`.
            objects: Objects of the `ContactQuery`, in the same order.
            crease_angle_deg: Dihedral angle below which an edge is smooth, degrees.
            shaded: Whether each object is shaded. The tool is shaded if one of them is.

        Raises:
            ValueError: The angle is not in [0, 180], or `shaded` does not have one
                entry for each object.
        """
        super().__init__()
        if not 0.0 <= crease_angle_deg <= 180.0:
            raise ValueError(
                f"crease_angle_deg must be in [0, 180], is {crease_angle_deg}"
            )
        if len(shaded) != len(objects):
            raise ValueError(
                f"shaded must have one entry for each of the {len(objects)} objects, "
                f"has {len(shaded)}"
            )
        self._objects = tuple(objects)
        crease_angle = np.deg2rad(crease_angle_deg)
        self._shading = ContactShading(
            SurfaceShading(tool, crease_angle if any(shaded) else 0.0),
            [
                SurfaceShading(item.decomposition, crease_angle if smooth else 0.0)
                for item, smooth in zip(objects, shaded, strict=True)
            ],
        )
        self._contacts = self.DeclareAbstractInputPort("contacts", Value[object]())
        self._X_WT = self.DeclareVectorInputPort("X_WT", 7)
        self._X_WO = {
            i: self.DeclareVectorInputPort(f"X_WO_{item.name}", 7)
            for i, item in enumerate(objects)
            if item.X_WO is None
        }
        # Poses of objects at rest are read nowhere else.
        self._q_WO = np.zeros((len(objects), 7))
        for i, item in enumerate(objects):
            if item.X_WO is not None:
                self._q_WO[i] = pose_to_vector(item.X_WO)
        self.DeclareAbstractOutputPort(
            "contacts",
            Value[object],
            self._calc_contacts,
            {self.all_input_ports_ticket()},
        )
        self.DeclareAbstractOutputPort(
            "shading", Value[object], self._show_shading, {self.nothing_ticket()}
        )

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffContactSet:
        """Returns the shaded contacts with their derivatives."""
        q_WO = join(differentiate_poses(self._objects, at))
        return self._shading.shade(at["contacts"], at["X_WT"], q_WO)

    def _show_shading(self, context: Context, shading: AbstractValue) -> None:
        shading.set_value(self._shading)

    def _calc_contacts(self, context: Context, contacts: AbstractValue) -> None:
        q_WO = self._q_WO
        if self._X_WO:
            q_WO = q_WO.copy()
            for i, port in self._X_WO.items():
                q_WO[i] = port.Eval(context)
        contacts.set_value(
            self._shading.shade(
                self._contacts.Eval(context), self._X_WT.Eval(context), q_WO
            )
        )
