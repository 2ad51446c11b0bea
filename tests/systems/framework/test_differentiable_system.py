"""Twins of scalar type AutoDiffXd: what they mirror, read, refuse and never lose."""

import gc
import importlib
import inspect
import pkgutil
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from pydrake.autodiffutils import AutoDiffXd, InitializeAutoDiff
from pydrake.common.value import Value
from pydrake.systems.analysis import Simulator_
from pydrake.systems.framework import (
    Diagram,
    DiagramBuilder,
    LeafSystem,
    LeafSystem_,
    PortDataType,
)
from pydrake.systems.primitives import ConstantVectorSource
from twin_check import check_twin

from drake_haptics import systems
from drake_haptics._core import AutoDiffVector, RigidToolDynamics
from drake_haptics.systems.framework.differentiable_system import DifferentiableSystem

PERIOD, OFFSET = 0.01, 0.002
A = np.array([[1.0, 2.0, -1.0], [0.5, -3.0, 4.0]])
SEED = InitializeAutoDiff(np.array([0.3, -0.2, 0.7])).ravel()
CONSTANT = np.array([AutoDiffXd(1.0), AutoDiffXd(2.0)])


class Gradients:
    """What an abstract port carries under AutoDiffXd."""

    def __init__(self, vector):
        self.vector = vector
        self.num_derivatives = vector.gradient.shape[1]

    def with_variables(self, num_derivatives):
        """Returns a constant with derivatives, which are zero."""
        assert self.num_derivatives == 0
        size = len(self.vector.value)
        return Gradients(
            AutoDiffVector(self.vector.value, np.zeros((size, num_derivatives)))
        )

    def __deepcopy__(self, memo):
        """Shares it: it never changes."""
        return self


class Sample(DifferentiableSystem):
    """y = A u + t; a (2) becomes sin(a) + v, b (1) becomes p · a[0] b, every period.

    Two inputs, of which y reads one, two groups of state, a parameter, an abstract
    port each way.
    """

    def __init__(self):
        super().__init__()
        self.num_published = 0
        self._u = self.DeclareVectorInputPort("u", 3)
        self._v = self.DeclareVectorInputPort("v", 2)
        self._w = self.DeclareAbstractInputPort("w", Value[object]())
        self._a = self.DeclareDiscreteState(np.array([0.1, 0.2]))
        self._b = self.DeclareDiscreteState(np.array([5.0]))
        self.DeclareAbstractParameter(Value[object](2.0))
        self.DeclareVectorOutputPort(
            "y", 2, self._calc_y, {self._u.ticket(), self.time_ticket()}
        )
        self.DeclareStateOutputPort("b", self._b)
        self.DeclareAbstractOutputPort(
            "double_w", Value[object], lambda context, value: None, {self._w.ticket()}
        )
        self.DeclarePeriodicDiscreteUpdateEvent(PERIOD, OFFSET, self._update)
        self.DeclarePerStepPublishEvent(self._publish)

    def _calc_y(self, context, y):
        y.SetFromVector(A @ self._u.Eval(context) + context.get_time())

    def _update(self, context, next_state):
        a, b = (context.get_discrete_state(i).value() for i in range(2))
        p = context.get_abstract_parameter(0).get_value()
        next_state.set_value(0, np.sin(a) + self._v.Eval(context))
        next_state.set_value(1, p * a[0] * b)

    def _publish(self, context):
        self.num_published += 1

    def differentiate(self, port, at):
        """Overrides the base's."""
        if port == "b":
            return AutoDiffVector(at.state.value[2:], at.state.gradient[2:])
        if port == "double_w":
            vector = at["w"].vector
            return Gradients(AutoDiffVector(2 * vector.value, 2 * vector.gradient))
        u, t = at["u"], at.time_s
        return AutoDiffVector(A @ u.value + t.value, A @ u.gradient + t.gradient)

    def differentiate_update(self, at):
        """Overrides the base's."""
        (p,) = at.parameters
        a, da = at.state.value[:2], at.state.gradient[:2]
        b, db = at.state.value[2], at.state.gradient[2]
        v = at["v"]
        return AutoDiffVector(
            np.append(np.sin(a) + v.value, p * a[0] * b),
            np.vstack(
                [np.cos(a)[:, None] * da + v.gradient, p * (da[0] * b + a[0] * db)]
            ),
        )


@pytest.fixture
def twin():
    return Sample().ToAutoDiffXd()


def derivatives(vector):
    return np.array([entry.derivatives() for entry in vector])


def test_a_twin_has_the_same_ports_state_parameters_and_events():
    system = Sample()
    system.set_name("sample")
    twin = system.ToAutoDiffXd()
    assert twin.get_name() == "sample"
    assert isinstance(twin, LeafSystem_[AutoDiffXd])
    for get, number in [
        ("get_input_port", "num_input_ports"),
        ("get_output_port", "num_output_ports"),
    ]:
        assert getattr(twin, number)() == getattr(system, number)()
        for i in range(getattr(system, number)()):
            port, original = getattr(twin, get)(i), getattr(system, get)(i)
            assert port.get_name() == original.get_name()
            assert port.get_data_type() == original.get_data_type()
            if port.get_data_type() == PortDataType.kVectorValued:
                assert port.size() == original.size()
    for i in range(3):
        for j in range(3):
            assert twin.HasDirectFeedthrough(i, j) == system.HasDirectFeedthrough(i, j)
    context = twin.CreateDefaultContext()
    state = [context.get_discrete_state(i).CopyToVector() for i in range(2)]
    assert [[x.value() for x in group] for group in state] == [[0.1, 0.2], [5.0]]
    assert context.get_abstract_parameter(0).get_value() == 2.0
    timing = twin.GetUniquePeriodicDiscreteUpdateAttribute()
    assert (timing.period_sec(), timing.offset_sec()) == (PERIOD, OFFSET)


def test_values_and_derivatives_are_those_of_the_system():
    check_twin(
        Sample(),
        {"u": [0.3, -0.2, 0.7], "v": [1.0, 2.0]},
        state=[0.4, -0.5, 0.6],
        time_s=1.5,
        step=1e-2,
    )


def test_the_default_state_depends_on_nothing(twin):
    """So that it mixes with inputs that depend on something."""
    context = twin.CreateDefaultContext()
    twin.GetInputPort("v").FixValue(context, SEED[:2])
    update = twin.EvalUniquePeriodicDiscreteUpdate(context)
    np.testing.assert_array_equal(
        derivatives(update.get_vector(0).CopyToVector()), np.eye(2, 3)
    )
    np.testing.assert_array_equal(
        derivatives(update.get_vector(1).CopyToVector()), np.zeros((1, 3))
    )


def test_an_output_reads_only_the_inputs_it_depends_on(twin):
    """Others may be open, or carry nothing that could be differentiated."""
    context = twin.CreateDefaultContext()
    twin.GetInputPort("u").FixValue(context, SEED)
    twin.GetInputPort("w").FixValue(context, Value[object]("no derivatives"))
    y = twin.GetOutputPort("y").Eval(context)
    np.testing.assert_array_equal(derivatives(y), A)


def test_a_loop_through_an_input_that_the_output_does_not_read_is_no_loop():
    builder = DiagramBuilder()
    sample = builder.AddNamedSystem("sample", Sample())
    source = builder.AddSystem(ConstantVectorSource([0.3, -0.2, 0.7]))
    builder.Connect(source.get_output_port(), sample.GetInputPort("u"))
    builder.Connect(sample.GetOutputPort("y"), sample.GetInputPort("v"))
    twin = builder.Build().ToAutoDiffXd().GetSubsystemByName("sample")
    context = twin.CreateDefaultContext()
    twin.GetInputPort("u").FixValue(context, SEED)
    assert twin.GetOutputPort("y").Eval(context)[0].value() == pytest.approx(-0.8)


def test_without_any_derivative_values_pass_through(twin):
    context = twin.CreateDefaultContext()
    twin.GetInputPort("v").FixValue(context, CONSTANT)
    update = twin.EvalUniquePeriodicDiscreteUpdate(context)
    a = update.get_vector(0).CopyToVector()
    assert [x.value() for x in a] == pytest.approx(
        np.sin([0.1, 0.2]) + np.array([1, 2])
    )
    assert all(x.derivatives().size == 0 for x in a)


def test_time_can_be_differentiated(twin):
    context = twin.CreateDefaultContext()
    context.SetTime(AutoDiffXd(1.5, np.array([0.0, 1.0])))
    twin.GetInputPort("u").FixValue(context, np.append(CONSTANT, CONSTANT[0]))
    y = twin.GetOutputPort("y").Eval(context)
    np.testing.assert_array_equal(derivatives(y), [[0, 1], [0, 1]])


def test_abstract_values_carry_their_derivatives_along(twin):
    context = twin.CreateDefaultContext()
    vector = AutoDiffVector(np.array([1.0]), np.array([[3.0, 4.0]]))
    twin.GetInputPort("w").FixValue(context, Value[object](Gradients(vector)))
    answer = twin.GetOutputPort("double_w").Eval(context)
    np.testing.assert_array_equal(answer.vector.gradient, [[6.0, 8.0]])


def test_an_abstract_value_that_is_constant_gets_the_variables_of_the_others(twin):
    context = twin.CreateDefaultContext()
    context.SetDiscreteState(1, SEED[:1])
    vector = AutoDiffVector(np.array([1.0]), np.zeros((1, 0)))
    twin.GetInputPort("w").FixValue(context, Value[object](Gradients(vector)))
    answer = twin.GetOutputPort("double_w").Eval(context)
    np.testing.assert_array_equal(answer.vector.gradient, np.zeros((1, 3)))


def test_outputs_follow_input_state_and_time(twin):
    """What was calculated before is not kept."""
    context = twin.CreateDefaultContext()

    def outputs():
        y, b = (twin.GetOutputPort(name).Eval(context) for name in ("y", "b"))
        return y[0].value(), b[0].value()

    twin.GetInputPort("u").FixValue(context, SEED)
    before = outputs()
    context.SetTime(2.0)
    assert outputs() == pytest.approx((before[0] + 2.0, before[1]))
    context.SetDiscreteState(1, [AutoDiffXd(6.0)])
    assert outputs() == pytest.approx((before[0] + 2.0, 6.0))
    twin.GetInputPort("u").FixValue(context, 2.0 * SEED)
    assert outputs() == pytest.approx((2.0 * before[0] + 2.0, 6.0))


def test_a_plain_value_in_an_abstract_port_is_an_error_and_no_zero(twin):
    context = twin.CreateDefaultContext()
    plain = SimpleNamespace(vector=None)
    twin.GetInputPort("w").FixValue(context, Value[object](plain))
    with pytest.raises(ValueError, match=r"input w of .* is a SimpleNamespace"):
        twin.GetOutputPort("double_w").Eval(context)


def test_derivatives_by_different_numbers_of_variables_are_an_error(twin):
    context = twin.CreateDefaultContext()
    context.SetTime(AutoDiffXd(0.0, np.ones(2)))
    twin.GetInputPort("u").FixValue(context, SEED)
    with pytest.raises(ValueError, match=r"different numbers of variables: \[2, 3\]"):
        twin.GetOutputPort("y").Eval(context)


def test_an_open_input_is_named(twin):
    with pytest.raises(ValueError, match=r"input u of .* has no value"):
        twin.GetOutputPort("y").Eval(twin.CreateDefaultContext())


def test_parameters_come_along_with_the_context():
    system = Sample()
    context = system.CreateDefaultContext()
    context.get_mutable_abstract_parameter(0).set_value(7.0)
    context.SetDiscreteState(1, [3.0])
    twin = system.ToAutoDiffXd()
    twin_context = twin.CreateDefaultContext()
    twin_context.SetTimeStateAndParametersFrom(context)
    twin.GetInputPort("v").FixValue(twin_context, CONSTANT)
    update = twin.EvalUniquePeriodicDiscreteUpdate(twin_context)
    assert update.get_vector(1)[0].value() == pytest.approx(7.0 * 0.1 * 3.0)


def test_a_twin_is_updated_as_a_simulator_runs_and_publishes_nothing():
    system = Sample()
    twin = system.ToAutoDiffXd()
    simulator = Simulator_[AutoDiffXd](twin)
    context = simulator.get_mutable_context()
    twin.GetInputPort("v").FixValue(context, SEED[:2])
    simulator.AdvanceTo(AutoDiffXd(OFFSET + 1.5 * PERIOD))
    a = np.array([0.1, 0.2])
    slope = np.zeros(2)
    for _ in range(2):
        slope = np.cos(a) * slope + 1.0
        a = np.sin(a) + np.array([0.3, -0.2])
    state = context.get_discrete_state(0).CopyToVector()
    assert [x.value() for x in state] == pytest.approx(a)
    np.testing.assert_allclose(derivatives(state)[:, :2], np.diag(slope), atol=1e-15)
    assert system.num_published == 0


def test_a_twin_outlives_the_diagram_it_was_made_from():
    builder = DiagramBuilder()
    sample = builder.AddNamedSystem("sample", Sample())
    builder.ExportInput(sample.GetInputPort("u"), "u")
    builder.ExportOutput(sample.GetOutputPort("y"), "y")
    diagram = builder.Build()
    twin = diagram.ToAutoDiffXd()
    del diagram, sample, builder
    gc.collect()
    context = twin.CreateDefaultContext()
    twin.GetInputPort("u").FixValue(context, SEED)
    y = twin.GetOutputPort("y").Eval(context)
    np.testing.assert_array_equal(derivatives(y), A)


class Bare(DifferentiableSystem):
    """Says nothing about its derivatives."""

    def __init__(self, declare):
        super().__init__()
        declare(self)


def nothing(context, values):
    """Calculates nothing."""


def declare_output(system):
    system.DeclareVectorOutputPort("y", 1, nothing, {system.nothing_ticket()})


def declare_state(system):
    system.DeclareDiscreteState(1)
    system.DeclarePeriodicDiscreteUpdateEvent(0.1, 0.0, nothing)


@pytest.mark.parametrize(
    ("declare", "method"),
    [(declare_output, "differentiate"), (declare_state, "differentiate_update")],
)
def test_a_system_without_derivatives_is_not_converted(declare, method):
    with pytest.raises(TypeError, match=f"Bare must define {method}$"):
        Bare(declare).ToAutoDiffXd()


def declare_two_rates(system):
    system.DeclareDiscreteState(1)
    system.DeclarePeriodicDiscreteUpdateEvent(0.1, 0.0, nothing)
    system.DeclarePeriodicDiscreteUpdateEvent(0.2, 0.0, nothing)


@pytest.mark.parametrize(
    ("declare", "reason"),
    [
        (lambda system: system.DeclareContinuousState(1), "continuous state"),
        (lambda system: system.DeclareAbstractState(Value[object]()), "abstract state"),
        (lambda system: system.DeclareDiscreteState(1), "without one periodic update"),
        (declare_two_rates, "without one periodic update"),
    ],
    ids=["continuous", "abstract", "never updated", "two rates"],
)
def test_what_a_twin_cannot_have_is_refused(declare, reason):
    with pytest.raises(ValueError, match=reason):
        Bare(declare).ToAutoDiffXd()


def test_a_twin_does_not_convert_back():
    with pytest.raises(TypeError, match="does not convert back to doubles"):
        Sample().ToAutoDiffXd().ToScalarType[float]()


@pytest.mark.parametrize("in_a_diagram", [False, True])
def test_a_system_that_cannot_be_cloned_says_so(in_a_diagram):
    system = Sample()
    if in_a_diagram:
        builder = DiagramBuilder()
        builder.AddNamedSystem("sample", system)
        system = builder.Build()
    with pytest.raises(TypeError, match=r"cannot be cloned.* build it once more"):
        system.Clone()


def test_the_core_refuses_arguments_by_different_variables():
    """It would read beyond the end of the shorter derivatives."""

    def vector(size, num_derivatives):
        return AutoDiffVector(np.ones(size), np.zeros((size, num_derivatives)))

    dynamics = RigidToolDynamics(0.1, np.zeros(3), 1e-4 * np.eye(3))
    with pytest.raises(ValueError, match="by the same variables"):
        dynamics.step(vector(13, 3), vector(78, 2), 1e-3)
    with pytest.raises(ValueError, match="wrench_model must have 78 entries, has 5"):
        dynamics.step(vector(13, 3), vector(5, 3), 1e-3)
    with pytest.raises(ValueError, match="a row for each of the 2 values"):
        AutoDiffVector(np.ones(2), np.ones((3, 1)))


def find_leaves_that_stay_doubles():
    """Returns the public names of the systems that have no AutoDiffXd twin."""
    names = set()
    for found in pkgutil.walk_packages(systems.__path__, f"{systems.__name__}."):
        module = importlib.import_module(found.name)
        here = [
            c
            for c in vars(module).values()
            if inspect.isclass(c) and c.__module__ == module.__name__
        ]
        for leaf in here:
            if issubclass(leaf, LeafSystem) and not (
                issubclass(leaf, DifferentiableSystem) or "𝓣" in leaf.__name__
            ):
                # A private leaf is part of the module's diagram.
                (owner,) = (
                    [leaf]
                    if not leaf.__name__.startswith("_")
                    else [c for c in here if issubclass(c, Diagram)]
                )
                names.add(owner.__name__)
    return names


def test_the_page_names_the_systems_that_do_not_convert():
    page = (Path(__file__).parents[3] / "docs" / "gradients.md").read_text("utf-8")
    told = page.split("do not convert:")[1].split("\n\n")[0]
    assert set(re.findall(r"`(\w+)`", told)) == find_leaves_that_stay_doubles()


def test_drake_finds_no_witness_functions_and_asks_no_python_for_them():
    """pybind11 takes a built-in function as its own: it overrides nothing."""
    assert inspect.isbuiltin(Sample.DoGetWitnessFunctions)
    assert Sample.DoGetWitnessFunctions(None) == []
    system = Sample()
    assert system.GetWitnessFunctions(system.CreateDefaultContext()) == []
