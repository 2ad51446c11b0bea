"""Decides what each contact pushes with, given the others."""

from __future__ import annotations

import math
from typing import Literal, get_args, overload

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import Context, InputPort, OutputPort

from drake_haptics._core import (
    AutoDiffClusterSet,
    AutoDiffContactSet,
    ClusterSet,
    ContactSet,
    cluster_contacts,
    share_stiffness,
    thin_contacts,
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
        - relief (with load shedding)
        output_ports:
        - clusters

    `contacts` is a `drake_haptics.ContactSet`, `clusters` a
    `drake_haptics._core.ClusterSet`; both are immutable and in the world frame.
    `relief` is that of `LoadShedding`: contacts push only below its share of the
    tolerance, and those that are nearer than its cell to a deeper one along the same
    direction are left out.
    Under AutoDiffXd they are an `AutoDiffContactSet` and an `AutoDiffClusterSet` of
    `drake_haptics._core`: which contacts are together or push stays.
    """

    def __init__(
        self,
        method: ClusteringMethod,
        tolerance_m: float,
        delta_m: float | None = None,
        *,
        sheds_load: bool = False,
    ):
        """Constructs the system.

        Args:
            method: "shared" or "octree".
            tolerance_m: The distance t below which contacts push, m.
            delta_m: Cluster size δ of the octree, m.
            sheds_load: Whether the loop sheds load, and there is a port for that.

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
        self._relief = self.DeclareVectorInputPort("relief", 3) if sheds_load else None
        self._clusters = self.DeclareAbstractOutputPort(
            "clusters",
            Value[object],
            self._calc_clusters if self._relief is None else self._calc_fewer,
            {self.all_input_ports_ticket()},
        )

    @property
    def tolerance_m(self) -> float:
        """The distance t below which contacts push, m."""
        return self._tolerance_m

    def get_contacts_input_port(self) -> InputPort:
        """Returns the input `contacts`."""
        return self._contacts

    def get_relief_input_port(self) -> InputPort:
        """Returns the input `relief`, with load shedding."""
        return self.GetInputPort("relief")

    def get_clusters_output_port(self) -> OutputPort:
        """Returns the output `clusters`."""
        return self._clusters

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffClusterSet:
        """Returns the clusters with their derivatives."""
        if self._relief is None:
            return self._cluster(at["contacts"], self._tolerance_m)
        return self._cluster_fewer(at["contacts"], at["relief"].value)

    def _calc_clusters(self, context: Context, clusters: AbstractValue) -> None:
        clusters.set_value(
            self._cluster(self._contacts.Eval(context), self._tolerance_m)
        )

    def _calc_fewer(self, context: Context, clusters: AbstractValue) -> None:
        assert self._relief is not None
        clusters.set_value(
            self._cluster_fewer(
                self._contacts.Eval(context), self._relief.Eval(context)
            )
        )

    @overload
    def _cluster_fewer(
        self, contacts: ContactSet, relief: np.ndarray
    ) -> ClusterSet: ...

    @overload
    def _cluster_fewer(
        self, contacts: AutoDiffContactSet, relief: np.ndarray
    ) -> AutoDiffClusterSet: ...

    def _cluster_fewer(
        self, contacts: ContactSet | AutoDiffContactSet, relief: np.ndarray
    ) -> ClusterSet | AutoDiffClusterSet:
        _, reach_share, cell_m = relief
        if cell_m > 0.0:
            contacts = thin_contacts(contacts, cell_m)
        return self._cluster(contacts, reach_share * self._tolerance_m)

    @overload
    def _cluster(self, contacts: ContactSet, tolerance_m: float) -> ClusterSet: ...

    @overload
    def _cluster(
        self, contacts: AutoDiffContactSet, tolerance_m: float
    ) -> AutoDiffClusterSet: ...

    def _cluster(
        self, contacts: ContactSet | AutoDiffContactSet, tolerance_m: float
    ) -> ClusterSet | AutoDiffClusterSet:
        if self._delta_m is None:
            return share_stiffness(contacts, tolerance_m)
        return cluster_contacts(contacts, self._delta_m, tolerance_m)
