"""Test the derivatives of the penalty force against differences from the poses on."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from autodiff_check import constant
from contact_state import KV, METHODS, K, State, check_every_column, random_states

from drake_haptics import _core

STEP = 5e-7
COLUMNS = ("wrench_model", "F_To_W", "F_objects_W", "f_cluster_W")
# Rows of the wrench model that have one unit: force, and K, B by halves.
_MATRIX = np.arange(36).reshape(6, 6)
BLOCKS = {
    "torque": np.arange(3),
    "force": np.arange(3, 6),
    **{
        f"{name}, {rows} by {columns}": 6
        + offset
        + _MATRIX[slice(*r), slice(*c)].ravel()
        for name, offset in (("K", 0), ("B", 36))
        for rows, r in (("torque", (0, 3)), ("force", (3, 6)))
        for columns, c in (("turn", (0, 3)), ("shift", (3, 6)))
    },
}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", ["box on box", "spoon in cup", "peg in torus"])
def test_every_part_has_its_derivatives(pairs, name: str, method: str) -> None:
    """By poses and velocities of all bodies; the wrench model each unit by itself."""
    states = random_states(*pairs[name], method, 12, seed=1)
    check_every_column(
        states, State.wrench, State.differentiate_wrench, COLUMNS, STEP, BLOCKS
    )


@pytest.mark.parametrize("method", METHODS)
def test_values_are_those_of_doubles_to_the_last_bit(pairs, method: str) -> None:
    for pair in pairs.values():
        for state in random_states(*pair, method, 20):
            expected, found = state.wrench(), state.differentiate_wrench()
            for key in COLUMNS:
                np.testing.assert_array_equal(
                    getattr(found.value, key), getattr(expected, key)
                )
                np.testing.assert_array_equal(
                    getattr(found, key).value, np.ravel(getattr(expected, key))
                )


def test_every_variable_reaches_the_wrench(pairs) -> None:
    """Of bodies that touch: no column is lost on the way."""
    reached = np.zeros(39, dtype=bool)
    for state in random_states(*pairs["spoon in cup"], "shared", 20):
        found = state.differentiate_wrench()
        assert np.isfinite(found.wrench_model.gradient).all()
        of_state = found.F_To_W.gradient.any(axis=0)
        for body in (1, 2):
            by_object = of_state[13 * body : 13 * body + 13]
            assert by_object.any() == found.value.F_objects_W[body - 1].any()
        reached |= of_state
    # But the lengths of quaternions; of the objects, at the identity, real parts.
    assert np.flatnonzero(~reached).tolist() == [13, 26]


def test_arguments_of_other_sizes_are_refused(pairs) -> None:
    state = random_states(*pairs["box on box"], "shared", 1)[0]
    clusters = state.cluster(state.differentiate_contacts())
    D = clusters.num_derivatives
    good = {
        "p_WTo": constant(np.zeros(3), D),
        "V_WT": constant(np.zeros(6), D),
        "p_WO": constant(np.zeros(6), D),
        "V_WO": constant(np.zeros(12), D),
    }
    assert _core.penalty_force(clusters, **good, stiffness=K, damping=KV)
    for name, value in good.items():
        with pytest.raises(ValueError, match=f"{name} must have {len(value)} entries"):
            _core.penalty_force(
                clusters, **good | {name: constant([0], D)}, stiffness=K, damping=KV
            )
        with pytest.raises(ValueError, match=f"{name} must have derivatives by the 39"):
            _core.penalty_force(
                clusters,
                **good | {name: constant(value.value, 2)},
                stiffness=K,
                damping=KV,
            )
    with pytest.raises(ValueError, match="stiffness and damping"):
        _core.penalty_force(clusters, **good, stiffness=K, damping=KV[:1])
    with pytest.raises(ValueError, match="stiffness"):
        _core.penalty_force(clusters, **good, stiffness=-K, damping=KV)


def test_it_crosses_ports_as_itself(pairs) -> None:
    found = random_states(*pairs["box on box"], "shared", 1)[0].differentiate_wrench()
    assert copy.deepcopy(found) is found
    assert isinstance(found.value, _core.PenaltyWrench)
