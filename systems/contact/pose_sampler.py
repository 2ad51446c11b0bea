"""Samples poses less often than the loop ticks."""

from __future__ import annotations

from collections.abc import Sequence

from pydrake.systems.framework import Context, DiscreteValues, EventStatus

from drake_haptics._core import AutoDiffVector
from drake_haptics.common.value_checks import check_positive
from drake_haptics.systems.framework.differentiable_system import (
    AutoDiffPoint,
    DifferentiableSystem,
    join,
    take,
)

_IDENTITY = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]


class PoseSampler(DifferentiableSystem):
    """Holds poses as they were at the last sample.

    Its outputs change only when it samples, so that systems that read them calculate
    only then.

    .. pydrake_system::

        name: PoseSampler
        input_ports:
        - X_WT
        - X_WO_<name of each object that moves>
        output_ports:
        - X_WT
        - X_WO_<name of each object that moves>

    All ports are poses [qw qx qy qz x y z] in the world, m.

    The state is one discrete group (7) for each pose, in the order of the ports; it
    takes the inputs at initialization and then every period.
    """

    def __init__(self, names: Sequence[str], period_s: float):
        """Constructs the system.

        Args:
            names: Names of the objects that move.
            period_s: Time between two samples, s.

        Raises:
            ValueError: The period is not positive.
        """
        super().__init__()
        check_positive(period_s=period_s)
        ports = ["X_WT", *(f"X_WO_{name}" for name in names)]
        self._inputs = [self.DeclareVectorInputPort(port, 7) for port in ports]
        self._groups = [self.DeclareDiscreteState(_IDENTITY) for _ in ports]
        for port, group in zip(ports, self._groups, strict=True):
            self.DeclareStateOutputPort(port, group)
        self.DeclareInitializationDiscreteUpdateEvent(self._sample)
        self.DeclarePeriodicDiscreteUpdateEvent(period_s, 0.0, self._sample)

    def differentiate(self, port: str, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns a held pose with its derivatives."""
        start = 7 * int(self.GetOutputPort(port).get_index())
        return take(at.state, slice(start, start + 7))

    def differentiate_update(self, at: AutoDiffPoint) -> AutoDiffVector:
        """Returns the sampled poses with their derivatives."""
        return join([at[port.get_name()] for port in self._inputs])

    def list_state_names(self) -> list[str]:
        """Returns a name for each number of the state."""
        return [
            f"{port.get_name()}.{number}"
            for port in self._inputs
            for number in "qw qx qy qz x y z".split()
        ]

    def _sample(self, context: Context, next_state: DiscreteValues) -> EventStatus:
        for port, group in zip(self._inputs, self._groups, strict=True):
            next_state.set_value(group, port.Eval(context))
        return EventStatus.Succeeded()
