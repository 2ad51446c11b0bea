"""Makes few contacts of many."""

from __future__ import annotations

from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import Context, InputPort, LeafSystem, OutputPort

from drake_haptics._core import cluster_contacts


class ContactClustering(LeafSystem):
    """Groups contacts nearer than δ and replaces each group by one contact.

    Groups are found with an octree of cell size δ; the representative is the mean
    weighted by the depth below the tolerance (paper, 4.3, Eq. 1-5).

    .. pydrake_system::

        name: ContactClustering
        input_ports:
        - contacts
        output_ports:
        - clusters

    `contacts` is a `drake_haptics.ContactSet`, `clusters` a
    `drake_haptics._core.ClusterSet`; both are immutable and in the world frame.
    """

    def __init__(self, delta_m: float, tolerance_m: float):
        """Constructs the system.

        Args:
            delta_m: Cluster size δ, m.
            tolerance_m: The tolerance t of the query, m.

        Raises:
            ValueError: δ is not positive or the tolerance is negative.
        """
        super().__init__()
        if not delta_m > 0.0:
            raise ValueError(f"delta_m must be positive, is {delta_m}")
        if not tolerance_m >= 0.0:
            raise ValueError(f"tolerance_m must not be negative, is {tolerance_m}")
        self._delta_m = delta_m
        self._tolerance_m = tolerance_m
        self._contacts = self.DeclareAbstractInputPort("contacts", Value[object]())
        self._clusters = self.DeclareAbstractOutputPort(
            "clusters",
            Value[object],
            self._calc_clusters,
            {self._contacts.ticket()},
        )

    def get_contacts_input_port(self) -> InputPort:
        """Returns the input `contacts`."""
        return self._contacts

    def get_clusters_output_port(self) -> OutputPort:
        """Returns the output `clusters`."""
        return self._clusters

    def _calc_clusters(self, context: Context, clusters: AbstractValue) -> None:
        contacts = self._contacts.Eval(context)
        clusters.set_value(cluster_contacts(contacts, self._delta_m, self._tolerance_m))
