"""Wrenches reach the bodies that they are of, summed, with their derivatives."""

import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff
from pydrake.multibody.tree import BodyIndex

from drake_haptics.systems.plant.applied_wrenches import AppliedWrenches

TOOL, CART, DOOR = BodyIndex(5), BodyIndex(2), BodyIndex(7)


def make_system():
    return AppliedWrenches(
        TOOL, ["contact", "coupling"], [CART, DOOR], ["contact", "friction"]
    )


def fix(system, context, seed=0):
    rng = np.random.default_rng(seed)
    values = {}
    for port in map(system.get_input_port, range(system.num_input_ports())):
        values[port.get_name()] = rng.normal(size=port.size())
        port.FixValue(context, values[port.get_name()])
    return values


def test_wrenches_on_a_body_are_summed_at_its_origin():
    system = make_system()
    context = system.CreateDefaultContext()
    values = fix(system, context)
    forces = system.get_output_port().Eval(context)
    assert [force.body_index for force in forces] == [TOOL, CART, DOOR]
    on_objects = values["F_O_W_contact"] + values["F_O_W_friction"]
    expected = [
        values["F_To_W_contact"] + values["F_To_W_coupling"],
        on_objects[:6],
        on_objects[6:],
    ]
    for force, F in zip(forces, expected, strict=True):
        np.testing.assert_array_equal(force.p_BoBq_B, np.zeros(3))
        np.testing.assert_array_equal(force.F_Bq_W.get_coeffs(), F)


def test_where_nothing_else_moves_only_the_tool_is_pushed():
    system = AppliedWrenches(TOOL, ["contact"])
    context = system.CreateDefaultContext()
    F = fix(system, context)["F_To_W_contact"]
    (force,) = system.get_output_port().Eval(context)
    np.testing.assert_array_equal(force.F_Bq_W.get_coeffs(), F)


def test_another_context_leaves_the_forces_of_the_first_as_they_are():
    system = make_system()
    first, second = (system.CreateDefaultContext() for _ in range(2))
    fix(system, first, seed=1)
    fix(system, second, seed=2)
    port = system.get_output_port()
    before, other, after = (
        [force.F_Bq_W.get_coeffs() for force in port.Eval(context)]
        for context in (first, second, first)
    )
    np.testing.assert_array_equal(before, after)
    assert not np.isin(before, other).any()


def count_foreign_forces(system, number):
    """Returns how often a context has forces that are not of its own inputs."""
    context = system.CreateDefaultContext()
    foreign = 0
    for k in range(1000):
        F = np.full(6, 1000.0 * number + k)
        for i in range(system.num_input_ports()):
            size = system.get_input_port(i).size()
            system.get_input_port(i).FixValue(context, np.resize(F, size))
        forces = system.get_output_port().Eval(context)
        foreign += any(np.any(force.F_Bq_W.get_coeffs() != 2.0 * F) for force in forces)
    return foreign


def test_threads_with_a_context_each_may_share_the_system():
    system = make_system()
    before_s = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(4) as threads:
            counts = threads.map(count_foreign_forces, [system] * 4, range(4))
            assert list(counts) == [0] * 4
    finally:
        sys.setswitchinterval(before_s)


@pytest.mark.parametrize("again", [False, True])
def test_derivatives_agree_with_central_differences(again):
    system = make_system()
    if again:
        system = system.Clone()
    context = system.CreateDefaultContext()
    values = fix(system, context)
    directions = {
        name: np.random.default_rng(1).normal(size=len(value))
        for name, value in values.items()
    }

    def forces(step):
        for name, value in values.items():
            system.GetInputPort(name).FixValue(context, value + step * directions[name])
        found = system.get_output_port().Eval(context)
        return np.concatenate([force.F_Bq_W.get_coeffs() for force in found])

    twin = system.ToAutoDiffXd()
    twin_context = twin.CreateDefaultContext()
    for name, value in values.items():
        twin.GetInputPort(name).FixValue(
            twin_context,
            InitializeAutoDiff(value, directions[name].reshape(-1, 1)).ravel(),
        )
    found = twin.get_output_port().Eval(twin_context)
    assert [force.body_index for force in found] == [TOOL, CART, DOOR]
    F = np.concatenate([force.F_Bq_W.get_coeffs() for force in found]).reshape(-1, 1)
    np.testing.assert_array_equal(ExtractValue(F).ravel(), forces(0.0))
    expected = (forces(0.5) - forces(-0.5)) / 1.0
    np.testing.assert_allclose(ExtractGradient(F).ravel(), expected, atol=1e-14)
    for force in found:
        np.testing.assert_array_equal(
            ExtractValue(np.reshape(force.p_BoBq_B, (3, 1))), np.zeros((3, 1))
        )
