"""Models how the wrench on the handle changes as the handle moves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydrake.common.value import Value
from pydrake.systems.framework import BasicVector, Context, LeafSystem

from drake_haptics._core import handle_slopes
from drake_haptics.systems.framework.differentiable_system import (
    get_no_witness_functions,
)


class HandleModel(LeafSystem):
    """Stiffness and damping that a handle feels, for a servo between two ticks.

    The tool is taken to be light and at rest: coupling and contact are springs in
    series. In free space the handle feels no stiffness; at a wall it feels that of both
    springs, but only along the normal, however stiff the coupling is in other
    directions.

    .. pydrake_system::

        name: HandleModel
        input_ports:
        - X_WH
        - X_WT
        - coupling
        - <name of each other wrench>
        - contact_chain (with the chain)
        - motions_and_gains (with the chain)
        output_ports:
        - handle_slopes

    * `X_WH` and `X_WT` (7) are the poses [qw qx qy qz x y z] of the handle and the
      tool in the world, m.
    * `coupling` and each other wrench (78) are wrench models [F; K; B] on the tool,
      as `PenaltyForce` documents them.
    * `contact_chain` and `motions_and_gains` are those of `HapticTool`: the wrenches of
      the coupling and of the contacts, which are the first of the others, then come
      from them.
    * `handle_slopes` (72) is [K; B], each (6, 6) by rows, of the wrench [τ; f] on the
      handle at its origin in the world: it changes by -K δ - B ΔV where the handle
      moves by δ = [rotation vector; translation] and its velocity by ΔV.
    """

    DoGetWitnessFunctions = get_no_witness_functions

    def __init__(self, wrench_names: Sequence[str], *, enable_chain: bool = False):
        """Constructs the system.

        Args:
            wrench_names: A name for each wrench on the tool besides the coupling's.
            enable_chain: Whether coupling and contacts are computed by the chain; see
                `HapticTool`.
        """
        super().__init__()
        self._X_WH = self.DeclareVectorInputPort("X_WH", 7)
        self._X_WT = self.DeclareVectorInputPort("X_WT", 7)
        self._coupling = self.DeclareVectorInputPort("coupling", 78)
        self._wrenches = [
            self.DeclareVectorInputPort(name, 78) for name in wrench_names
        ]
        calc = self._calc
        if enable_chain:
            self._eval_chain = self.DeclareAbstractInputPort(
                "contact_chain", Value[object]()
            ).Eval
            self._eval_joined = self.DeclareVectorInputPort(
                "motions_and_gains", 39
            ).Eval
            calc = self._calc_chained
        self.DeclareVectorOutputPort(
            "handle_slopes", 72, calc, {self.all_input_ports_ticket()}
        )

    def _calc(self, context: Context, output: BasicVector) -> None:
        others = sum((port.Eval(context) for port in self._wrenches), np.zeros(78))
        output.SetFromVector(
            handle_slopes(
                self._X_WH.Eval(context),
                self._X_WT.Eval(context),
                self._coupling.Eval(context),
                others,
            )
        )

    def _calc_chained(self, context: Context, output: BasicVector) -> None:
        output.set_value(
            self._eval_chain(context).handle_slopes(
                self._eval_joined(context),
                [port.Eval(context) for port in self._wrenches[1:]],
            )
        )
