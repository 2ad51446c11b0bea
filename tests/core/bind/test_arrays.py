"""How arrays of NumPy's come into the core and out of it."""

import ctypes
from pathlib import Path

import numpy as np
import pytest

from drake_haptics import _core

BINDINGS = Path(__file__).parents[3] / "drake_haptics" / "core" / "bind"
WRENCH = np.array([0.1, -0.2, 0.3, 1.5, -2.5, 3.5])


def pass_through(vector):
    """Returns what came in, out of limits that it does not meet."""
    return _core.limit_wrench(vector, 1e9, 1e9)[:6]


def spread(vector):
    """Every third number of a longer array."""
    wide = np.zeros(3 * len(vector))
    wide[::3] = vector
    return wide[::3]


def frozen(vector):
    """A copy that must not be written."""
    copy = vector.copy()
    copy.setflags(write=False)
    return copy


@pytest.mark.parametrize(
    "change", [np.copy, spread, frozen, lambda x: x[::-1][::-1], memoryview]
)
def test_doubles_are_read_where_they_are(change):
    assert pass_through(change(WRENCH)).tolist() == WRENCH.tolist()


@pytest.mark.parametrize("dtype", ["float32", "int64"])
def test_other_numbers_are_converted(dtype):
    vector = np.arange(6.0).astype(dtype)
    assert pass_through(vector).tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]


@pytest.mark.parametrize("item", [ctypes.c_double, ctypes.c_float, ctypes.c_int])
def test_arrays_of_ctypes_are_converted(item):
    """Their buffers say nothing of strides."""
    vector = (item * 6)(*range(6))
    assert pass_through(vector).tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    with pytest.raises(TypeError):
        pass_through((item * 5)())


@pytest.mark.parametrize("dtype", ["float64", "float32"])
@pytest.mark.parametrize("shape", [(10**13,), (10**13, 3)])
def test_an_array_larger_than_memory_is_refused(dtype, shape):
    """One number that NumPy shows ten million million times."""
    many = np.broadcast_to(np.zeros(1, dtype), shape)
    column, table = (many, np.zeros((2, 2))) if len(shape) == 1 else (np.zeros(2), many)
    with pytest.raises(TypeError):
        _core.AutoDiffVector(column, table)


@pytest.mark.parametrize(
    "wrong", [np.zeros(5), np.zeros((6, 1)), np.zeros((1, 6)), np.zeros(()), None, b"6"]
)
def test_another_shape_is_refused(wrong):
    with pytest.raises(TypeError):
        pass_through(wrong)


def test_what_comes_out_is_an_array_of_its_own():
    first, second = (_core.limit_wrench(WRENCH, 1e9, 1e9) for _ in range(2))
    assert (first.dtype, first.shape) == (np.float64, (7,))
    assert first.flags.owndata and first.flags.writeable
    first[:] = 0.0
    assert second[:6].tolist() == WRENCH.tolist()


@pytest.mark.parametrize("order", ["C", "F"])
def test_matrices_keep_rows_and_columns(order):
    rng = np.random.default_rng(2)
    mass, p_TTcm, I_TTcm_T = 0.3, np.zeros(3), np.diag([1e-3, 2e-3, 2.5e-3])
    I_TTcm_T[0, 1] = I_TTcm_T[1, 0] = 1e-4
    tool = _core.RigidToolDynamics(mass, p_TTcm, np.array(I_TTcm_T, order=order))
    state = np.concatenate([[1.0, 0, 0, 0, 0, 0, 0], np.zeros(6)])
    model = np.zeros(78)
    model[:3] = rng.normal(size=3)
    omega = tool.step(state, model, 1e-3)[7:10]
    np.testing.assert_allclose(I_TTcm_T @ omega, 1e-3 * model[:3], rtol=1e-12)
    value, gradient = rng.normal(size=5), np.array(rng.normal(size=(5, 3)), order=order)
    pair = _core.AutoDiffVector(value, gradient)
    np.testing.assert_array_equal(pair.gradient, gradient)
    np.testing.assert_array_equal(pair.value, value)
    assert _core.AutoDiffVector(np.zeros(0), np.zeros((0, 3))).gradient.shape == (0, 3)


def test_all_bindings_hand_arrays_over_in_one_way():
    # Two files that disagree on it would not be one program.
    texts = [file.read_text("utf-8") for file in BINDINGS.glob("*.cc")]
    bindings = [text for text in texts if "nb::arg(" in text]
    assert len(bindings) > 20
    for text in bindings:
        assert '#include "bind/bind.h"' in text, text
