"""Motions on a sampled wall, simulated by their closed form, without its matrix."""

import cmath
import math
from dataclasses import replace

import numpy as np

from drake_haptics.analysis.sampled_wall import SampledWall

T = 1e-3
NO_HAND = {}
HAND = {"hand_mass": 0.2, "hand_damping": 5.0, "hand_stiffness": 300.0}
# b, B, periods of delay, hand, K by eigenvalues and K by simulation, N/m: figures of
# an earlier study, of a mass of 0.1 kg at 1 kHz.
TABLE = [
    (0.5, 0.0, 0, NO_HAND, 1000.83, 1000.89),
    (0.5, 0.0, 1, NO_HAND, 333.80, 333.81),
    (0.5, 2.0, 0, NO_HAND, 4905.3, 4905.6),
    (0.5, 2.0, 1, NO_HAND, 1632.0, 1632.1),
    (0.5, 20.0, 0, NO_HAND, 33591.0, 33593.0),
    (0.5, 0.0, 1, HAND, 3686.8, 3687.0),
    (0.5, 2.0, 1, HAND, 4988.0, 4988.3),
]


def make_wall(b, B, delay, hand, **more):
    return SampledWall(0.1, b, T, wall_damping=B, delay_s=delay * T, **hand, **more)


def measure_growth(wall, ticks):
    """Simulates by the roots of m r² + c r + k, and returns the late over the early."""
    m = wall.mass + wall.hand_mass
    c, k = wall.damping + wall.hand_damping, wall.hand_stiffness
    root = cmath.sqrt(c * c - 4 * m * k)
    r1, r2 = (-c + root) / (2 * m), (-c - root) / (2 * m)
    e1, e2 = cmath.exp(r1 * T), cmath.exp(r2 * T)
    x, v, last = 1e-3, 0.0, 1e-3
    waiting = [0.0] * round(wall.delay_s / T)
    speeds = np.empty(ticks)
    for i in range(ticks):
        force = -(wall.stiffness * x + wall.wall_damping * (x - last) / T)
        waiting.append(force)
        force = waiting.pop(0)
        last = x
        if k > 0.0:
            # About the rest position under this force.
            rest = force / k
            a2 = (v - r1 * (x - rest)) / (r2 - r1)
            a1 = x - rest - a2
            x, v = (rest + a1 * e1 + a2 * e2).real, (a1 * r1 * e1 + a2 * r2 * e2).real
        else:
            # About the final speed under this force.
            speed, decay = force / c, math.exp(-c * T / m)
            x += speed * T + (v - speed) * (1 - decay) * m / c
            v = speed + (v - speed) * decay
        speeds[i] = abs(v)
    return speeds[-ticks // 10 :].max() / speeds[ticks // 5 : 3 * ticks // 10].max()


def find_simulated_limit(wall, near):
    """Simulates close to both sides, and returns the stiffness that neither grows.

    It is found from the logarithms of the growth, linear in K to second order.
    """
    K = near * np.array([0.998, 1.002])
    growth = [math.log(measure_growth(replace(wall, stiffness=k), 20000)) for k in K]
    return float(K[0] - growth[0] * (K[1] - K[0]) / (growth[1] - growth[0]))
