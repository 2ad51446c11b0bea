"""Objects that move get the opposite of friction's force, at the same points."""

from types import SimpleNamespace

import numpy as np
import pytest
from box_contacts import box_core
from pydrake.common.value import Value
from pydrake.math import RigidTransform

from drake_haptics._core import AutoDiffVector
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.contact.friction_reaction import FrictionReaction

# Of which the first and the last move.
NAMES = ("cart", "slab", "door")
OBJECTS = np.array([2, 0, 1, 2, 0])


class Columns(SimpleNamespace):
    """Stands for a core's set with the columns that are read here."""

    def __len__(self):
        return len(OBJECTS)

    def __deepcopy__(self, memo):
        return self


@pytest.fixture
def system():
    core = box_core(0.02, 0.02, 0.02)
    poses = [None, RigidTransform(), None]
    return FrictionReaction(
        [
            ContactObject(name, core, X_WO)
            for name, X_WO in zip(NAMES, poses, strict=True)
        ]
    )


def random_case(seed):
    """Returns p_WC (5, 3), f (5, 3) and poses (2, 7)."""
    rng = np.random.default_rng(seed)
    return rng.normal(size=(5, 3)), rng.normal(size=(5, 3)), rng.normal(size=(2, 7))


def evaluate(system, p_WC, f, q_WO):
    context = system.CreateDefaultContext()
    clusters = Columns(p_WC=p_WC, object_index=OBJECTS)
    system.GetInputPort("clusters").FixValue(context, Value[object](clusters))
    friction = Columns(f_cluster_W=f)
    system.GetInputPort("friction_force").FixValue(context, Value[object](friction))
    for name, q in zip(("cart", "door"), q_WO, strict=True):
        system.GetInputPort(f"X_WO_{name}").FixValue(context, q)
    return system.GetOutputPort("F_O_W").Eval(context)


def test_each_object_gets_the_opposite_of_its_own_clusters(system):
    p_WC, f, q_WO = random_case(0)
    expected = np.zeros((2, 6))
    for row, i in enumerate((0, 2)):
        for c in np.flatnonzero(OBJECTS == i):
            expected[row, :3] += np.cross(p_WC[c] - q_WO[row, 4:], -f[c])
            expected[row, 3:] -= f[c]
    found = evaluate(system, p_WC, f, q_WO)
    np.testing.assert_allclose(found, expected.ravel(), atol=1e-14)


def test_derivatives_agree_with_central_differences(system):
    case, direction = random_case(1), random_case(2)

    def differentiable(k, part=slice(None)):
        value, way = case[k][part].ravel(), direction[k][part].ravel()
        return AutoDiffVector(value, way.reshape(-1, 1))

    class At(dict):
        num_derivatives = 1

    at = At(
        clusters=Columns(p_WC=differentiable(0), value=Columns(object_index=OBJECTS)),
        friction_force=Columns(f_cluster_W=differentiable(1)),
        X_WO_cart=differentiable(2, 0),
        X_WO_door=differentiable(2, 1),
    )
    found = system.differentiate("F_O_W", at)
    np.testing.assert_allclose(found.value, evaluate(system, *case), atol=1e-14)
    h = 1e-3

    def moved(step):
        return evaluate(
            system, *(x + step * d for x, d in zip(case, direction, strict=True))
        )

    # Bilinear: central differences are exact.
    expected = (moved(h) - moved(-h)) / (2 * h)
    np.testing.assert_allclose(found.gradient.ravel(), expected, atol=1e-10)
