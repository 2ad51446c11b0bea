"""Discrete systems that carry derivatives, or drop some of them."""

import numpy as np
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, ExtractValue
from pydrake.systems.framework import BasicVector_, LeafSystem_
from pydrake.systems.scalar_conversion import TemplateSystem

PERIOD = 1e-3


def to_double(value):
    return value.value() if isinstance(value, AutoDiffXd) else value


@TemplateSystem.define("SpringMass_", T_list=(float, AutoDiffXd))
def SpringMass_(T):
    class Impl(LeafSystem_[T]):
        """Discrete mass on a spring: v⁺ = v - 400 q T, q⁺ = q + T v; "loses" says what.

        Output "y" is q, and input "u" pushes.
        """

        def _construct(self, loses, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.loses = loses
            self.DeclareVectorInputPort("u", 1)
            self.DeclareDiscreteState([0.0, 0.0])
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._update)
            self.DeclareVectorOutputPort(
                "y", 1, self._calc_y, prerequisites_of_calc={self.xd_ticket()}
            )

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, other.loses, converter=converter)

        def _update(self, context, discrete_state):
            q, v = context.get_discrete_state(0).CopyToVector()
            u = self.get_input_port().Eval(context)[0]
            if self.loses == "the spring":
                force = -400.0 * to_double(q)
            elif self.loses == "the input":
                force, u = -400.0 * q, to_double(u)
            else:
                force = -400.0 * q
            result = np.array([q + PERIOD * v, v + PERIOD * (force + u)])
            if self.loses == "everything":
                result = np.array([T(to_double(number)) for number in result])
            discrete_state.set_value(0, result)

        def _calc_y(self, context, output):
            q = context.get_discrete_state(0)[0]
            output.SetFromVector([T(to_double(q)) if self.loses == "the output" else q])

    return Impl


SpringMass = SpringMass_[None]


@TemplateSystem.define("Curve_", T_list=(float, AutoDiffXd))
def Curve_(T):
    class Impl(LeafSystem_[T]):
        """x⁺ = f(x), elementwise, with the derivative scaled by (1 + error)."""

        def _construct(self, f, start, error=0.0, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.f, self.start, self.error = f, start, error
            self.DeclareDiscreteState(BasicVector_[T](start))
            self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, 0.0, self._update)

        def _construct_copy(self, other, converter=None):
            Impl._construct(
                self, other.f, other.start, other.error, converter=converter
            )

        def _update(self, context, discrete_state):
            x = self.f(context.get_discrete_state(0).CopyToVector())
            if T is AutoDiffXd:
                gradient = ExtractGradient(x.reshape(-1, 1)) * (1.0 + self.error)
                values = ExtractValue(x.reshape(-1, 1)).ravel()
                x = np.array(
                    [AutoDiffXd(v, g) for v, g in zip(values, gradient, strict=True)]
                )
            discrete_state.set_value(0, x)

    return Impl


Curve = Curve_[None]
