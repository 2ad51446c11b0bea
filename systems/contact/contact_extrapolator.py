"""Extrapolates contacts between two queries."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import Context, InputPort

from drake_haptics._core import AutoDiffContactSet, ContactExtrapolation, ConvexPieces
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
    join,
)


class ContactExtrapolator(DifferentiableSystem):
    """Moves the contacts of an earlier query to where the bodies are now.

    The features of each contact stay the same. The normal turns with the body whose
    facet it belongs to; of two edges it is their cross product; of a vertex and an edge
    or another vertex it is the direction between their closest points. Distance and
    witness points are those of the features, but the center of pressure of flush faces
    stays on both bodies. That is exact for a vertex over a facet and for two edges
    while these are the features, and otherwise wrong to second order in the motion
    since the query. No contact appears or vanishes: pieces that come within the
    tolerance between two queries are contacts from the next query on.

    .. pydrake_system::

        name: ContactExtrapolator
        input_ports:
        - contacts
        - found_X_WT
        - X_WT
        - found_X_WO_<name of each object that moves>
        - X_WO_<name of each object that moves>
        output_ports:
        - contacts

    `contacts` are a `drake_haptics.ContactSet`, immutable. `found_...` are the poses
    [qw qx qy qz x y z] in the world, m, at which they were found, `X_...` those now.
    Under AutoDiffXd `contacts` are a `drake_haptics._core.AutoDiffContactSet`.
    """

    def __init__(self, tool: ConvexPieces, objects: Sequence[ContactObject]):
        """Constructs the system.

        Args:
            tool: Tool of the `ContactQuery`.
            objects: Objects of the `ContactQuery`, in the same order.
        """
        super().__init__()
        self._carrier = ContactExtrapolation(
            tool,
            [item.decomposition for item in objects],
            [
                None if item.X_WO is None else pose_to_vector(item.X_WO)
                for item in objects
            ],
        )
        bodies = ["T", *(f"O_{item.name}" for item in objects if item.X_WO is None)]
        self._contacts = self.DeclareAbstractInputPort("contacts", Value[object]())
        self._found, self._now = [], []
        for body in bodies:
            self._found.append(self.DeclareVectorInputPort(f"found_X_W{body}", 7))
            self._now.append(self.DeclareVectorInputPort(f"X_W{body}", 7))
        self.DeclareAbstractOutputPort(
            "contacts",
            Value[object],
            self._calc_contacts,
            {self.all_input_ports_ticket()},
        )

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffContactSet:
        """Returns the contacts with their derivatives."""
        return self._carrier.advance(
            at["contacts"],
            join([at[port.get_name()] for port in self._found]),
            join([at[port.get_name()] for port in self._now]),
        )

    def _calc_contacts(self, context: Context, contacts: AbstractValue) -> None:
        contacts.set_value(
            self._carrier.advance(
                self._contacts.Eval(context),
                _read_poses(self._found, context),
                _read_poses(self._now, context),
            )
        )


def _read_poses(ports: Sequence[InputPort], context: Context) -> np.ndarray:
    """Returns concatenated poses, (7 m,)."""
    if len(ports) == 1:
        return ports[0].Eval(context)
    return np.concatenate([port.Eval(context) for port in ports])
