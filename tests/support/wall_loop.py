"""One mass against a sampled virtual wall: the loop with the known stability table."""

import numpy as np
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import LinearSystem

MASS_KG = 0.1
PERIOD = 1e-3


def make_mass(damping=0.5, hand=(0.0, 0.0, 0.0)):
    """A handle of 0.1 kg with its damper, in a hand (m, b, k); state [x; v]."""
    m, b, k = hand
    m, b = m + MASS_KG, b + damping
    return LinearSystem(
        [[0, 1], [-k / m, -b / m]], [[0], [1 / m]], np.eye(2), np.zeros((2, 1))
    )


def make_wall(stiffness, damping=0.0, period=PERIOD):
    """F = -(K x + B (x - x_before) / T), calculated once per period and held.

    State [x_before; f].
    """
    K, B = stiffness, damping
    return LinearSystem(
        [[0, 0], [B / period, 0]],
        [[1, 0], [-K - B / period, 0]],
        [[0, 1]],
        np.zeros((1, 2)),
        period,
    )


def make_loop(stiffness, wall_damping=0.0, delay=0, **mass):
    """The mass and the wall, `delay` samples apart; output "x", [x; v]."""
    builder = DiagramBuilder()
    handle = builder.AddNamedSystem("mass", make_mass(**mass))
    last = builder.AddNamedSystem("wall", make_wall(stiffness, wall_damping))
    builder.Connect(handle.get_output_port(), last.get_input_port())
    for i in range(delay):
        hop = LinearSystem([[0]], [[1]], [[1]], [[0]], PERIOD)
        builder.AddNamedSystem(f"hop{i}", hop)
        builder.Connect(last.get_output_port(), hop.get_input_port())
        last = hop
    builder.Connect(last.get_output_port(), handle.get_input_port())
    builder.ExportOutput(handle.get_output_port(), "x")
    return builder.Build()
