"""Delays the wrench on its way to the motors by whole ticks."""

from __future__ import annotations

from itertools import pairwise

from pydrake.systems.framework import Diagram, DiagramBuilder
from pydrake.systems.primitives import ZeroOrderHold

from drake_haptics.common.value_checks import check_at_least, check_positive


class ForceDelay(Diagram):
    """Delays a wrench by whole periods, on top of the hold before it.

    Each hold samples the value that the one before it held until then, so that the
    output is exactly the wrench of `samples` ticks ago.

    .. pydrake_system::

        name: ForceDelay
        input_ports:
        - F_Ho_W_rendered
        output_ports:
        - F_delayed

    Both are wrenches (6) [τ; f], N·m and N.

    The state is one discrete group (6) per sample, newest first, the last of which is
    `F_delayed`; initially zero. The holds are Drake's, which run no Python and have
    derivatives, so that a stability analysis sees the delay.
    """

    def __init__(self, period_s: float, samples: int):
        """Constructs the system.

        Args:
            period_s: The tick, s.
            samples: Delay in ticks, at least 1.

        Raises:
            ValueError: The period is not positive, or `samples` is less than 1.
        """
        super().__init__()
        check_positive(period_s=period_s)
        check_at_least(1, samples=samples)
        builder = DiagramBuilder()
        holds = [
            builder.AddNamedSystem(f"hold_{i}", ZeroOrderHold(period_s, 6))
            for i in range(samples)
        ]
        builder.ExportInput(holds[0].get_input_port(), "F_Ho_W_rendered")
        for before, hold in pairwise(holds):
            builder.Connect(before.get_output_port(), hold.get_input_port())
        builder.ExportOutput(holds[-1].get_output_port(), "F_delayed")
        builder.BuildInto(self)
