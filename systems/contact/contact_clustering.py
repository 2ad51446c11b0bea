"""Clusters contacts, so that many are not stiffer than one."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Literal, get_args, overload

import numpy as np
from pydrake.common.value import AbstractValue, Value
from pydrake.systems.framework import Context

from drake_haptics._core import (
    AutoDiffClusterSet,
    AutoDiffContactSet,
    ClusterSet,
    ContactSet,
    cluster_contacts,
    share_stiffness,
    thin_contacts,
)
from drake_haptics.common.value_checks import check_at_least, check_positive
from drake_haptics.scene.validation import SceneWarning, make_depth_warning
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
)

ClusteringMethod = Literal["shared", "octree"]


@dataclass(frozen=True)
class ClusteringRule:
    """The rule that decides which contacts push and which count as one; immutable.

    Attributes:
        method: Name of the method, "shared" or "octree".
        tolerance_m: Distance t below which contacts push, m.
        delta_m: Cluster size δ of the octree, m; None for "shared".

    Raises:
        ValueError: There is no such method, the tolerance is negative, or δ is not
            positive, missing, or given where there is no octree.
    """

    method: ClusteringMethod
    tolerance_m: float
    delta_m: float | None = None

    def __post_init__(self) -> None:
        """Checks the rule."""
        if self.method not in get_args(ClusteringMethod):
            raise ValueError(f"method must be 'shared' or 'octree', is {self.method!r}")
        check_at_least(0, tolerance_m=self.tolerance_m)
        if self.method == "octree":
            if self.delta_m is None:
                raise ValueError("delta_m must be given for octree")
            check_positive(delta_m=self.delta_m)
        elif self.delta_m is not None:
            raise ValueError(
                f"delta_m is for octree only; the method is {self.method!r}"
            )


class ContactClustering(DifferentiableSystem):
    """Clusters contacts, so that many are not stiffer than one.

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
        - load_shedding (with load shedding)
        output_ports:
        - clusters
        - rule

    `contacts` is a `drake_haptics.ContactSet`, `clusters` a
    `drake_haptics._core.ClusterSet`; both are immutable and in the world frame.
    `load_shedding` is that of `LoadShedding`: contacts push only below its share of the
    tolerance, and those that are nearer than its cell to a deeper one along the same
    direction are left out. Under AutoDiffXd `contacts` and `clusters` are an
    `AutoDiffContactSet` and an `AutoDiffClusterSet` of `drake_haptics._core`: the same
    contacts stay together, and the same push.

    Method, tolerance and δ are an abstract parameter of the Context, of type
    `ClusteringRule`; see `set_rule`. The output `rule` shows it, and has no value under
    AutoDiffXd.
    """

    undifferentiated = frozenset({"rule"})

    def __init__(
        self,
        method: ClusteringMethod,
        tolerance_m: float,
        delta_m: float | None = None,
        *,
        enable_load_shedding: bool = False,
        warns_deep: bool = False,
    ):
        """Constructs the system.

        Method, tolerance and δ are the default rule of a Context.

        Args:
            method: Name of the method, "shared" or "octree".
            tolerance_m: Distance t below which contacts push, m.
            delta_m: Cluster size δ of the octree, m.
            enable_load_shedding: Whether the loop sheds load, which adds a port.
            warns_deep: Whether to warn once of each contact that is deeper than ten
                tolerances. `run` warns at the end instead, because writing may delay a
                loop that a hand holds.

        Raises:
            ValueError: There is no such method, the tolerance is negative, or δ is
                not positive, missing, or given where there is no octree.
        """
        super().__init__()
        self._warns_deep, self._warned = warns_deep, False
        rule = ClusteringRule(method, tolerance_m, delta_m)
        self._rule = self.DeclareAbstractParameter(Value[object](rule))
        self._contacts = self.DeclareAbstractInputPort("contacts", Value[object]())
        self._eval_contacts = self._contacts.Eval
        self._load_shedding = (
            self.DeclareVectorInputPort("load_shedding", 3)
            if enable_load_shedding
            else None
        )
        self._clusters = self.DeclareAbstractOutputPort(
            "clusters",
            Value[object],
            self._calc_clusters,
            {self.all_input_ports_ticket(), self.pa_ticket()},
        )
        self.DeclareAbstractOutputPort(
            "rule", Value[object], self._show_rule, {self.pa_ticket()}
        )

    def get_rule(self, context: Context) -> ClusteringRule:
        """Returns the rule that decides which contacts push and which count as one.

        Args:
            context: Context of this system.
        """
        self.ValidateContext(context)
        return context.get_abstract_parameter(self._rule).get_value()

    def set_rule(self, context: Context, rule: ClusteringRule) -> None:
        """Changes the rule, from now on.

        Contacts are searched for up to the tolerance of the `ContactQuery`: a larger
        tolerance must be set there too.

        Args:
            context: Context of this system.
            rule: New rule.

        Raises:
            TypeError: The rule is not a `ClusteringRule`.
        """
        self.ValidateContext(context)
        if not isinstance(rule, ClusteringRule):
            raise TypeError(f"rule must be a ClusteringRule, is {type(rule).__name__}")
        context.get_mutable_abstract_parameter(self._rule).set_value(rule)

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffClusterSet:
        """Returns the clusters with their derivatives."""
        shed = None if self._load_shedding is None else at["load_shedding"].value
        return _cluster(at["contacts"], at.parameters[self._rule], shed)

    def _show_rule(self, context: Context, rule: AbstractValue) -> None:
        rule.set_value(self.get_rule(context))

    def _calc_clusters(self, context: Context, clusters: AbstractValue) -> None:
        rule = context.get_abstract_parameter(self._rule).get_value()
        contacts = self._eval_contacts(context)
        if self._warns_deep:
            self.warn_of_depth(context, contacts.least_distance, rule.tolerance_m)
        shedding = self._load_shedding
        shed = None if shedding is None else shedding.Eval(context)
        clusters.set_value(_cluster(contacts, rule, shed))

    def warn_of_depth(
        self, context: Context, least_distance_m: float, tolerance_m: float
    ) -> None:
        """Warns of a contact that is deeper than ten tolerances, once until it ends.

        Args:
            context: Context of any system of the same diagram, for the time.
            least_distance_m: Signed distance of the deepest contact, m.
            tolerance_m: Distance below which contacts push, m.
        """
        if least_distance_m > tolerance_m:
            self._warned = False
        if self._warned:
            return
        if warning := make_depth_warning(-least_distance_m, tolerance_m):
            self._warned = True
            rendering = self.GetSystemPathname().split("::")[-2]
            sentence = f"{rendering!r} at {context.get_time():.4g} s: {warning}"
            # Drake calls this, so the user's line is not known.
            warnings.warn(sentence, SceneWarning, stacklevel=1)


@overload
def _cluster(
    contacts: ContactSet, rule: ClusteringRule, load_shedding: np.ndarray | None
) -> ClusterSet: ...


@overload
def _cluster(
    contacts: AutoDiffContactSet, rule: ClusteringRule, load_shedding: np.ndarray | None
) -> AutoDiffClusterSet: ...


def _cluster(
    contacts: ContactSet | AutoDiffContactSet,
    rule: ClusteringRule,
    load_shedding: np.ndarray | None,
) -> ClusterSet | AutoDiffClusterSet:
    """Applies a rule, to fewer contacts while the loop sheds load."""
    tolerance_m = rule.tolerance_m
    if load_shedding is not None:
        _, reach_share, cell_m = load_shedding
        tolerance_m *= reach_share
        if cell_m > 0.0:
            contacts = thin_contacts(contacts, cell_m)
    if rule.delta_m is None:
        return share_stiffness(contacts, tolerance_m)
    return cluster_contacts(contacts, rule.delta_m, tolerance_m)
