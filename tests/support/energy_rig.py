"""Readings of small haptic loops, made up for the ledger; and what books must show."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from drake_haptics import _core
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench

H = 1e-3
MASS = 0.1
INERTIA = np.diag([2e-5, 4e-5, 5e-5])
IDENTITY = np.array([1.0, 0, 0, 0, 0, 0, 0])
NO_GAINS = _core.CouplingGains(0, 0, 0, 0)
NO_WRENCH = np.zeros(78)
X = np.array([0, 0, 0, 1.0, 0, 0])


# Far below what can be felt, far above rounding.
ROUNDING_J = 1e-9


def assert_nothing_is_created(books):
    """Fails if a part of a run's books made more than sampling explains."""
    for name, part in books.items():
        assert part["beyond"] < ROUNDING_J, name
        assert part["created"] <= part["bound"] + ROUNDING_J, name


def make_ledger(sources=(), *, gains=NO_GAINS, c=(0, 0, 0), q_HT=IDENTITY):
    tool = _core.RigidToolDynamics(MASS, np.array(c, float), INERTIA)
    return tool, _core.EnergyLedger(tool, gains, q_HT, H, list(sources))


def add(ledger, tool_state, sources=(), stored=None, **changes):
    """Adds a reading that holds only the given values."""
    reading = {
        "q_WH": IDENTITY,
        "F_Ho_W_rendered": np.zeros(6),
        "coupling": NO_WRENCH,
        "wrench_models": list(sources),
        "stored_J": [0.0] * len(sources) if stored is None else stored,
    }
    ledger.add(tool_state=tool_state, **(reading | changes))


def model(F, K=None, B=None):
    K = np.zeros((6, 6)) if K is None else K
    B = np.zeros((6, 6)) if B is None else B
    return np.concatenate([F, np.ravel(K), np.ravel(B)])


def tool_at(x, v=0.0):
    """Returns the state of a tool at x on the first axis, that came at speed v."""
    return np.concatenate([[1, 0, 0, 0, x, 0, 0], v * X])


def random_model(rng, scale=1.0):
    def spread():
        root = rng.normal(size=(6, 6))
        return root @ root.T

    return model(scale * rng.normal(size=6), spread(), 1e-4 * spread())


def rotation_of(q):
    return Rotation.from_quat(np.roll(q[:4], -1))


def pose(rotation, p):
    return np.concatenate([np.roll(rotation.as_quat(), 1), p])


def coupling_model(q_WH, V_WH, q_HT, state, gains):
    wrench = coupling_wrench(q_WH, V_WH, q_HT, state[:7], state[7:], gains)
    return wrench[:78], wrench[78:]
