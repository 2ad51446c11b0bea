"""Objects that rest are placed once; those that move are read from ports."""

import numpy as np
import pytest
from box_contacts import box_core
from pydrake.math import RigidTransform
from pydrake.systems.framework import LeafSystem

from drake_haptics._core import AutoDiffVector, ObjectFrames
from drake_haptics.systems.contact.contact_query import ContactObject, ObjectMotions
from drake_haptics.systems.framework.differentiable_system import AutoDiffPoint


class Asking(LeafSystem):
    """Nothing but its objects' ports."""

    def __init__(self, objects):
        super().__init__()
        self.motions = ObjectMotions(self, objects)


@pytest.fixture(scope="module")
def core():
    return box_core(0.02, 0.02, 0.02)


def test_an_object_at_rest_has_no_port(core):
    system = Asking([ContactObject("table", core, RigidTransform([1.0, 2.0, 3.0]))])
    assert system.num_input_ports() == 0
    frames = system.motions.read(system.CreateDefaultContext())
    np.testing.assert_array_equal(frames.p_WO, [[1.0, 2.0, 3.0]])
    np.testing.assert_array_equal(frames.V_WO, np.zeros((1, 6)))


def test_an_object_that_moves_is_read_in_its_place(core):
    table = ContactObject("table", core, RigidTransform([1.0, 2.0, 3.0]))
    system = Asking([table, ContactObject("cart", core)])
    context = system.CreateDefaultContext()
    for x in (0.1, 0.2):
        system.GetInputPort("X_WO_cart").FixValue(context, [1, 0, 0, 0, x, 0, 0])
        system.GetInputPort("V_WO_cart").FixValue(context, [0, 0, 1, x, 0, 0])
        frames = system.motions.read(context)
        np.testing.assert_array_equal(frames.p_WO, [[1.0, 2.0, 3.0], [x, 0, 0]])
        np.testing.assert_array_equal(frames.V_WO, [np.zeros(6), [0, 0, 1, x, 0, 0]])


class Point(dict):
    """Inputs by name, with derivatives by four variables."""

    num_derivatives = 4
    hold = AutoDiffPoint.hold


def test_only_what_moves_has_derivatives(core):
    table = ContactObject("table", core, RigidTransform([1.0, 2.0, 3.0]))
    system = Asking([table, ContactObject("cart", core)])
    rng = np.random.default_rng(0)
    X_WO = AutoDiffVector(np.array([1.0, 0, 0, 0, 4, 5, 6]), rng.normal(size=(7, 4)))
    V_WO = AutoDiffVector(rng.normal(size=6), rng.normal(size=(6, 4)))
    p, V = system.motions.differentiate(Point(X_WO_cart=X_WO, V_WO_cart=V_WO))
    np.testing.assert_array_equal(p.value, [1, 2, 3, 4, 5, 6])
    np.testing.assert_array_equal(V.value, [*np.zeros(6), *V_WO.value])
    np.testing.assert_array_equal(p.gradient, [*np.zeros((3, 4)), *X_WO.gradient[4:]])
    np.testing.assert_array_equal(V.gradient, [*np.zeros((6, 4)), *V_WO.gradient])


def test_frames_that_are_moved_leave_the_others_and_themselves():
    frames = ObjectFrames(np.eye(3), np.zeros((3, 6)))
    moved = frames.moved([1], [np.array([1.0, 0, 0, 0, 4, 5, 6])], [np.arange(6.0)])
    np.testing.assert_array_equal(moved.p_WO, [[1, 0, 0], [4, 5, 6], [0, 0, 1]])
    np.testing.assert_array_equal(moved.V_WO[1], np.arange(6))
    np.testing.assert_array_equal(frames.p_WO, np.eye(3))


def test_frames_are_checked():
    frames = ObjectFrames(np.eye(3), np.zeros((3, 6)))
    pose, still = np.array([1.0, 0, 0, 0, 0, 0, 0]), np.zeros(6)
    with pytest.raises(ValueError, match="one row for each object"):
        ObjectFrames(np.eye(3), np.zeros((2, 6)))
    with pytest.raises(ValueError, match="one entry for each index"):
        frames.moved([0, 1], [pose], [still])
    for absent in (3, -1):
        with pytest.raises(IndexError):
            frames.moved([absent], [pose], [still])
