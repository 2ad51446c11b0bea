"""The AutoDiffXd twin of a system, and what it takes from a context."""

import numpy as np
import pytest
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import LinearSystem
from remembering_system import Remembers_
from wall_loop import make_mass

from drake_haptics.analysis import calc_monodromy, find_equilibrium, linearize_sampled
from drake_haptics.analysis.diagram_systems import AutoDiffClone


def make_nested():
    inner = DiagramBuilder()
    inner.AddNamedSystem("remembers", Remembers_[float](0.25))
    builder = DiagramBuilder()
    builder.AddNamedSystem("inner", inner.Build())
    builder.AddNamedSystem("other", Remembers_[float](0.5))
    return builder.Build()


@pytest.mark.parametrize("analyze", [linearize_sampled, calc_monodromy])
def test_systems_are_told_before_they_are_converted(analyze):
    diagram = make_nested()
    found = analyze(diagram, diagram.CreateDefaultContext())
    np.testing.assert_array_equal(found.A, np.diag([0.25, 0.5]))


def test_systems_are_told_where_they_are_converted():
    system = Remembers_[float](0.25)
    builder = DiagramBuilder()
    builder.AddNamedSystem("remembers", system)
    # With a motion there is a state after the update, too.
    builder.AddNamedSystem("decay", LinearSystem([[-1.0]], *3 * [np.zeros((1, 1))]))
    builder.ExportInput(builder.GetSystems()[1].get_input_port(), "u")
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    diagram.get_input_port().FixValue(context, [0.0])
    context.SetDiscreteState(0, [8.0])
    found = find_equilibrium(diagram, context)
    linearize_sampled(diagram, found.context)
    assert system.told[0] == 8.0
    assert abs(system.told[-1]) < 1e-9


def test_the_users_context_is_never_told():
    diagram = make_nested()
    context = diagram.CreateDefaultContext()
    context.SetDiscreteState(0, [1.0])
    find_equilibrium(diagram, context)
    for analyze in (linearize_sampled, calc_monodromy):
        analyze(diagram, diagram.CreateDefaultContext())
    other = diagram.GetSubsystemByName("other").GetMyContextFromRoot(context)
    assert other.get_abstract_parameter(0).get_value() == 100.0
    assert context.get_discrete_state(0)[0] == 1.0


def test_a_twin_follows_time_state_and_inputs():
    mass = make_mass()
    context = mass.CreateDefaultContext()
    context.SetTime(3.0)
    context.SetContinuousState([1.0, 2.0])
    mass.get_input_port().FixValue(context, [4.0])
    twin = AutoDiffClone(mass)
    twin.follow(context)
    assert twin.context.get_time().value() == 3.0
    rates = twin.system.EvalTimeDerivatives(twin.context).CopyToVector()
    assert [rate.value() for rate in rates] == pytest.approx([2.0, 30.0])
    context.SetContinuousState([0.0, 5.0])
    twin.follow(context)
    assert twin.context.get_continuous_state_vector()[1].value() == 5.0
