"""Drake's refusals become errors that a caller can catch."""

import sys

import pytest
from pydrake.autodiffutils import AutoDiffXd
from pydrake.common.value import Value
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.systems.framework import DiagramBuilder, LeafSystem_
from pydrake.systems.primitives import Linearize, LinearSystem
from pydrake.systems.scalar_conversion import TemplateSystem
from wall_loop import make_loop, make_mass

from drake_haptics.analysis import explain_drake_errors, linearize_sampled


def test_a_failed_assertion_is_an_error_that_can_be_caught():
    loop = make_loop(900.0)
    with pytest.raises(
        ValueError, match=r"looking: Drake linearizes only.*linearize_sampled.*Failure"
    ):
        with explain_drake_errors("looking"):
            Linearize(loop, loop.CreateDefaultContext())


def test_an_assertion_that_is_not_known_is_quoted():
    builder = DiagramBuilder()
    first, second = builder.AddSystem(make_mass()), builder.AddSystem(make_mass())
    gain = builder.AddSystem(LinearSystem([[0]], [[1]], [[1]], [[0]]))
    builder.Connect(gain.get_output_port(), first.get_input_port())
    builder.Connect(gain.get_output_port(), second.get_input_port())
    with pytest.raises(ValueError, match=r"wiring: .*Drake says: .*ThrowIfInputAlr"):
        with explain_drake_errors("wiring"):
            builder.Connect(gain.get_output_port(), first.get_input_port())


def test_it_decorates():
    @explain_drake_errors("adding")
    def add(a, b):
        return a + b

    assert add(1, b=2) == 3


@pytest.mark.parametrize("code", [3, None, "bye"])
def test_a_users_exit_passes(code):
    with pytest.raises(SystemExit):
        with explain_drake_errors("leaving"):
            sys.exit(code)


def test_a_users_own_error_passes():
    with pytest.raises(RuntimeError, match="my own"):
        with explain_drake_errors("running"):
            raise RuntimeError("my own")


def test_two_rates_point_to_monodromy():
    builder = DiagramBuilder()
    for period in (0.001, 0.002):
        builder.AddSystem(LinearSystem([[0.5]], [[1]], [[1]], [[0]], period))
    diagram = builder.Build()
    with pytest.raises(ValueError, match="several rates: use calc_monodromy"):
        with explain_drake_errors("evaluating"):
            diagram.EvalUniquePeriodicDiscreteUpdate(diagram.CreateDefaultContext())


def test_an_abstract_first_input_is_said():
    @TemplateSystem.define("FirstIn_", T_list=(float, AutoDiffXd))
    def FirstIn_(T):
        class Impl(LeafSystem_[T]):
            def _construct(self, converter=None):
                LeafSystem_[T].__init__(self, converter=converter)
                self.DeclareContinuousState(1)
                self.DeclareAbstractInputPort("any", Value(0))

            def _construct_copy(self, other, converter=None):
                Impl._construct(self, converter=converter)

            def DoCalcTimeDerivatives(self, context, derivatives):
                derivatives.SetFromVector([-context.get_continuous_state_vector()[0]])

        return Impl

    system = FirstIn_[float]()
    context = system.CreateDefaultContext()
    system.get_input_port().FixValue(context, 1)
    with pytest.raises(ValueError, match="name a vector port, or none"):
        with explain_drake_errors("linearizing"):
            Linearize(system, context)
    assert linearize_sampled(system, context, period_s=1.0).A[0, 0] < 0.37


def test_numbers_by_reference_are_said():
    @TemplateSystem.define("ByReference_", T_list=(float, AutoDiffXd))
    def ByReference_(T):
        class Impl(LeafSystem_[T]):
            def _construct(self, converter=None):
                LeafSystem_[T].__init__(self, converter=converter)
                self.DeclareDiscreteState(1)
                self.DeclarePeriodicDiscreteUpdateEvent(1e-3, 0.0, self._update)

            def _construct_copy(self, other, converter=None):
                Impl._construct(self, converter=converter)

            def _update(self, context, discrete_state):
                x = context.get_discrete_state(0).value()
                discrete_state.set_value(0, 0.5 * x)

        return Impl

    system = ByReference_[float]()
    try:
        found = linearize_sampled(system, system.CreateDefaultContext())
    except ValueError as error:
        assert "use CopyToVector()" in str(error)
    else:  # Drake 1.58 has learnt to give them.
        assert found.A.tolist() == [[0.5]]


def test_point_contact_of_a_continuous_plant_is_said():
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
    sphere = "<link name='{0}'><pose>0 0 {1} 0 0 0</pose>{2}<collision name='c'>"
    sphere += "<geometry><sphere><radius>0.1</radius></sphere></geometry>"
    sphere += "</collision></link>"
    inertial = "<inertial><mass>1</mass></inertial>"
    Parser(builder).AddModelsFromString(
        "<sdf version='1.7'><model name='m'>"
        + sphere.format("low", 0.0, inertial)
        + "<joint name='w' type='fixed'><parent>world</parent><child>low</child>"
        + "</joint>"
        + sphere.format("high", 0.19, inertial)
        + "</model></sdf>",
        "sdf",
    )
    plant.Finalize()
    diagram = builder.Build()
    with pytest.raises(ValueError, match="has no derivatives in Drake"):
        with explain_drake_errors("linearizing"):
            twin = diagram.ToAutoDiffXd()
            twin.EvalTimeDerivatives(_start_touching(twin))


def test_contact_of_drakes_without_derivatives_is_said():
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, 1e-3)
    Parser(builder).AddModelsFromString(
        "<mujoco model='m'><worldbody><geom type='box' size='1 1 0.1'/>"
        "<body name='b' pos='0 0 0.19'><freejoint/>"
        "<geom type='box' size='0.1 0.1 0.1' mass='1'/></body></worldbody></mujoco>",
        "xml",
    )
    plant.Finalize()
    twin = builder.Build().ToAutoDiffXd()
    with pytest.raises(ValueError, match=r"looking: .*AddHapticRendering render"):
        with explain_drake_errors("looking"):
            shapes = twin.GetSubsystemByName("scene_graph")
            found = shapes.get_query_output_port().Eval(
                shapes.GetMyContextFromRoot(_start_touching(twin))
            )
            found.ComputePointPairPenetration()


def _start_touching(diagram):
    context = diagram.CreateDefaultContext()
    plant = diagram.GetSubsystemByName("plant")
    q = plant.GetPositions(plant.GetMyContextFromRoot(context))
    q[6] = 0.19
    plant.SetPositions(plant.GetMyMutableContextFromRoot(context), q)
    return context
