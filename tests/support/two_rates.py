"""A mass on a wall that is asked at one rate and shown at another."""

import numpy as np
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import LinearSystem
from wall_loop import PERIOD, make_mass


def make_two_rates(stiffness, damping=1.0, query_period=2e-3, offset=None):
    """A mass on a wall that is asked every 2 ms and shown every 1 ms."""
    builder = DiagramBuilder()
    mass = builder.AddNamedSystem("mass", make_mass())
    gains = [[-stiffness, -damping]]
    query = LinearSystem([[0]], gains, [[1]], np.zeros((1, 2)), query_period)
    builder.AddNamedSystem("query", query)
    servo = builder.AddNamedSystem(
        "servo", LinearSystem([[0]], [[1]], [[1]], [[0]], PERIOD)
    )
    builder.Connect(mass.get_output_port(), query.get_input_port())
    builder.Connect(query.get_output_port(), servo.get_input_port())
    builder.Connect(servo.get_output_port(), mass.get_input_port())
    return builder.Build()
