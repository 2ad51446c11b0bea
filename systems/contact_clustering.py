"""Decides what each contact pushes with, given the others."""

from __future__ import annotations

import math
from typing import Literal, get_args, overload

from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import Context, InputPort, OutputPort

from drake_haptics._core import (
    AutoDiffClusterSet,
    AutoDiffContactSet,
    ClusterSet,
    ContactSet,
    cluster_contacts,
    share_stiffness,
)
from drake_haptics.systems.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)

ClusteringMethod = Literal["shared", "octree"]


class ContactClustering(DifferentiableSystem):
    """Keeps many contacts from being stiffer than one.

    There are two methods, by name:

    * `shared`: each contact stays, and contacts along one direction share stiffness
      as if they pressed into a common elastic skin. The force is a continuous
      function of the contacts, and does not depend on how finely a face is cut
      into pieces.
    * `octree`: contacts nearer than δ are grouped with an octree of cell size δ, and
      each group is replaced by one contact, the mean weighted by the depth below
      the tolerance (paper, 4.2, Eq. 1-5). The force jumps where a contact crosses a
      cell.

    .. pydrake_system::

        name: ContactClustering
        input_ports:
        - contacts
        output_ports:
        - clusters

    `contacts` is a `drake_haptics.ContactSet`, `clusters` a
    `drake_haptics._core.ClusterSet`; both are immutable and in the world frame.
    Under AutoDiffXd they are an `AutoDiffContactSet` and an `AutoDiffClusterSet` of
    `drake_haptics._core`: which contacts are together or push stays.
    """

    def __init__(
        self,
        method: ClusteringMethod,
        tolerance_m: float,
        delta_m: float | None = None,
    ):
        """Constructs the system.

        Args:
            method: "shared" or "octree".
            tolerance_m: The distance t below which contacts push, m.
            delta_m: Cluster size δ of the octree, m.

        Raises:
            ValueError: There is no such method, the tolerance is negative, or δ is
                not positive, missing, or given where there is no octree.
        """
        super().__init__()
        if method not in get_args(ClusteringMethod):
            raise ValueError(f"method must be 'shared' or 'octree', is {method!r}")
        if not (tolerance_m >= 0.0 and math.isfinite(tolerance_m)):
            raise ValueError(
                f"tolerance_m must be finite and not negative, is {tolerance_m}"
            )
        if method == "octree":
            if delta_m is None or not (delta_m > 0.0 and math.isfinite(delta_m)):
                raise ValueError(f"delta_m must be finite and positive, is {delta_m}")
        elif delta_m is not None:
            raise ValueError(f"delta_m is of the octree; the method is {method!r}")
        self._delta_m = delta_m
        self._tolerance_m = tolerance_m
        self._contacts = self.DeclareAbstractInputPort("contacts", Value[object]())
        self._clusters = self.DeclareAbstractOutputPort(
            "clusters",
            Value[object],
            self._calc_clusters,
            {self._contacts.ticket()},
        )

    @property
    def tolerance_m(self) -> float:
        """The distance t below which contacts push, m."""
        return self._tolerance_m

    def get_contacts_input_port(self) -> InputPort:
        """Returns the input `contacts`."""
        return self._contacts

    def get_clusters_output_port(self) -> OutputPort:
        """Returns the output `clusters`."""
        return self._clusters

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffClusterSet:
        """Returns the clusters with their derivatives."""
        return self._cluster(at["contacts"])

    def _calc_clusters(self, context: Context, clusters: AbstractValue) -> None:
        clusters.set_value(self._cluster(self._contacts.Eval(context)))

    @overload
    def _cluster(self, contacts: ContactSet) -> ClusterSet: ...

    @overload
    def _cluster(self, contacts: AutoDiffContactSet) -> AutoDiffClusterSet: ...

    def _cluster(
        self, contacts: ContactSet | AutoDiffContactSet
    ) -> ClusterSet | AutoDiffClusterSet:
        if self._delta_m is None:
            return share_stiffness(contacts, self._tolerance_m)
        return cluster_contacts(contacts, self._delta_m, self._tolerance_m)
