"""Converts wrenches on tool and objects to forces on the bodies of a plant."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import reduce
from operator import add
from typing import Any

import numpy as np
from pydrake.autodiffutils import AutoDiffXd
from pydrake.common.value import AbstractValue, Value
from pydrake.multibody.math import SpatialForce_
from pydrake.multibody.plant import ExternallyAppliedSpatialForce_
from pydrake.multibody.tree import BodyIndex
from pydrake.systems.framework import LeafSystem_
from pydrake.systems.scalar_conversion import TemplateSystem

from drake_haptics.systems.framework.differentiable_system import (
    get_no_witness_functions,
)


@TemplateSystem.define(
    "AppliedWrenches_", T_list=(float, AutoDiffXd), scope=sys.modules[__name__]
)
def AppliedWrenches_(T: type) -> type:
    """Defines `AppliedWrenches` for one scalar type."""
    # Looked up once, because the lookup takes longer than all the rest.
    AppliedForce, SpatialForce = ExternallyAppliedSpatialForce_[T], SpatialForce_[T]
    # The default is NaN for AutoDiffXd.
    p_BoBo_B = np.array([T(0.0)] * 3)

    def make_copier(body: BodyIndex) -> Callable[[], Any]:
        """Returns a function that makes forces at a body's origin, not yet set.

        A copy takes a quarter of the time of setting body and point again.
        """
        force = AppliedForce()
        force.body_index = body
        force.p_BoBq_B = p_BoBo_B
        copier: Callable[[], Any] = force.__copy__
        return copier

    def make_force(copier: Callable[[], Any], F_Bo_W: Any) -> Any:
        """Returns a force on a body whose wrench (6,) is at its origin."""
        force = copier()
        force.F_Bq_W = SpatialForce(F_Bo_W)
        return force

    def add_up(evals: Sequence[Any], context: Any, first: Sequence[Any] = ()) -> Any:
        """Returns the sum of vectors; `sum` is slower, because it begins with 0."""
        return reduce(add, [*first, *(evaluate(context) for evaluate in evals)])

    class Impl(LeafSystem_[T]):
        """Sums wrenches on the tool and on objects, each at its body's origin.

        .. pydrake_system::

            name: AppliedWrenches
            input_ports:
            - F_To_W_<name of each wrench on the tool>
            - F_O_W_<name of each set of wrenches on the objects>
            - contact_chain (with the chain)
            - motions_and_gains (with the chain)
            output_ports:
            - applied_spatial_force

        * `F_To_W_<name>` (6) is a wrench [τ; f] on the tool at its origin in the
          world, N·m and N.
        * `F_O_W_<name>` (6 for each object) are such wrenches on the objects, in
          their order.
        * `contact_chain` is that of `ContactQuery`, `motions_and_gains` (39) that of
          `VirtualCoupling`. With them the core computes the first two wrenches on the
          tool, those of the contacts and of the coupling, bit for bit as the inputs
          have them; those inputs then serve for inspection and for derivatives.
        * `applied_spatial_force` is a list of `ExternallyAppliedSpatialForce`, for the
          port of this name of a `MultibodyPlant`: tool, then objects.

        It has no state, and converts to AutoDiffXd.
        """

        DoGetWitnessFunctions = get_no_witness_functions

        def _construct(
            self,
            tool: BodyIndex,
            tool_wrenches: Sequence[str],
            objects: Sequence[BodyIndex] = (),
            object_wrenches: Sequence[str] = (),
            enable_chain: bool = False,
            warn_of_depth: Callable[[Any, float, float], None] | None = None,
            converter: Any = None,
        ) -> None:
            """Constructs the system.

            Args:
                tool: Body that is the tool.
                tool_wrenches: A name for each wrench on the tool.
                objects: Bodies of the objects that move.
                object_wrenches: A name for each set of wrenches on the objects.
                enable_chain: Whether contacts and coupling are computed here; they are
                    the first two wrenches on the tool then.
                warn_of_depth: Function `warn_of_depth` of the `ContactClustering`,
                    which the chain bypasses. Defaults to no warning.
                converter: Scalar converter, which Drake passes.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self._bodies = [tool, *objects]
            self._copiers = [make_copier(body) for body in self._bodies]
            self._names = (tuple(tool_wrenches), tuple(object_wrenches))
            self._eval_on_tool = [
                self.DeclareVectorInputPort(f"F_To_W_{name}", 6).Eval
                for name in tool_wrenches
            ]
            self._eval_on_objects = [
                self.DeclareVectorInputPort(f"F_O_W_{name}", 6 * len(objects)).Eval
                for name in object_wrenches
            ]
            self._enable_chain = enable_chain
            self._warn_of_depth = warn_of_depth
            if enable_chain:
                self._eval_chain = self.DeclareAbstractInputPort(
                    "contact_chain", Value[object]()
                ).Eval
                self._eval_joined = self.DeclareVectorInputPort(
                    "motions_and_gains", 39
                ).Eval
            self.DeclareAbstractOutputPort(
                "applied_spatial_force",
                lambda: AbstractValue.Make([AppliedForce()]),
                self._calc_forces,
                {self.all_input_ports_ticket()},
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            tool, *objects = other._bodies
            on_tool, on_objects = other._names
            Impl._construct(
                self,
                tool,
                on_tool,
                objects,
                on_objects,
                other._enable_chain,
                other._warn_of_depth,
                converter,
            )

        def _add_up_on_tool(self, context: Any) -> Any:
            """Returns the sum of the wrenches (6,) on the tool."""
            # The chain has no derivatives.
            if not self._enable_chain or T is not float:
                return add_up(self._eval_on_tool, context)
            chain = self._eval_chain(context)
            first = chain.find_coupled_force(self._eval_joined(context))
            if self._warn_of_depth is not None:
                self._warn_of_depth(context, *chain.deepest)
            return add_up(self._eval_on_tool[2:], context, [first])

        def _calc_forces(self, context: Any, forces: AbstractValue) -> None:
            wrenches = [self._add_up_on_tool(context)]
            if self._eval_on_objects:
                on_objects = add_up(self._eval_on_objects, context)
                wrenches += [
                    on_objects[6 * i : 6 * i + 6] for i in range(len(self._bodies) - 1)
                ]
            # New objects each time, because threads may share the system.
            forces.set_value(list(map(make_force, self._copiers, wrenches)))

    return Impl


AppliedWrenches = AppliedWrenches_[None]
