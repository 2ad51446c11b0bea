"""A system that remembers in doubles what its AutoDiffXd twin has as a parameter."""

import numpy as np
from pydrake.autodiffutils import AutoDiffXd
from pydrake.common.value import Value
from pydrake.systems.framework import LeafSystem_
from pydrake.systems.scalar_conversion import TemplateSystem
from wall_loop import PERIOD


@TemplateSystem.define("Remembers_", T_list=(float, AutoDiffXd))
def Remembers_(T):
    class Impl(LeafSystem_[T]):
        """x⁺ = factor · x: what is remembered in doubles, a parameter in the twin."""

        def _construct(self, factor, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.factor = factor
            self.told = []
            self.DeclareDiscreteState(1)
            self.parameter = self.DeclareAbstractParameter(Value(100.0))
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._update)

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, other.factor, converter=converter)

        def _get_factor(self, context):
            if T is float:
                return self.factor
            return context.get_abstract_parameter(self.parameter).get_value()

        def _update(self, context, discrete_state):
            x = context.get_discrete_state(0)[0]
            discrete_state.set_value(0, np.array([self._get_factor(context) * x]))

        def prepare_conversion(self, context):
            """Writes the factor into the parameter."""
            self.told.append(context.get_discrete_state(0)[0])
            context.get_mutable_abstract_parameter(self.parameter).set_value(
                self.factor
            )

    return Impl
