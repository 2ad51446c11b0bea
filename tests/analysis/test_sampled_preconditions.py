"""What a linear map over one period cannot describe is refused, with the reason."""

import numpy as np
import pytest
from eventful_system import Eventful
from pydrake.autodiffutils import AutoDiffXd
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder, LeafSystem, LeafSystem_
from pydrake.systems.primitives import Linearize, LinearSystem
from pydrake.systems.scalar_conversion import TemplateSystem
from wall_loop import PERIOD, make_loop, make_mass

from drake_haptics.analysis import (
    calc_monodromy,
    find_equilibrium,
    find_modes,
    linearize_sampled,
)


def make(*systems, names=("wall", "servo", "plant")):
    builder = DiagramBuilder()
    for name, system in zip(names, systems, strict=False):
        builder.AddNamedSystem(name, system)
    return builder.Build()


def linearize(diagram, **options):
    return linearize_sampled(diagram, diagram.CreateDefaultContext(), **options)


@pytest.mark.parametrize(
    ("events", "reason"),
    [
        (["offset"], r"updates with an offset, 0.001 s from 0.0005 s on \(wall\)"),
        (["second period"], r"several periods, 0.001 s \(wall\), 0.002 s \(wall\)"),
        (["step"], "discrete update runs at every step"),
        (["unrestricted"], "unrestricted update.*Look among wall"),
        (["unrestricted step"], "unrestricted update"),
        (["unrestricted offset"], "unrestricted update"),
        (["abstract state"], "wall has abstract state"),
    ],
)
def test_what_has_no_place_in_one_map_is_refused(events, reason):
    with pytest.raises(ValueError, match=reason):
        linearize(make(Eventful(*events)))


def test_publish_and_initialization_events_parameters_and_caches_are_fine():
    system = Eventful("publish", "publish step", "initialize")
    found = linearize(make(system))
    np.testing.assert_array_equal(found.A, [[0.5, 0.0], [0.0, 1.0]])
    assert system.published


def test_a_memory_that_nothing_updates_stays():
    @TemplateSystem.define("Kept_", T_list=(float, AutoDiffXd))
    def Kept_(T):
        class Impl(LeafSystem_[T]):
            def _construct(self, converter=None):
                LeafSystem_[T].__init__(self, converter=converter)
                self.DeclareDiscreteState(2)

            def _construct_copy(self, other, converter=None):
                Impl._construct(self, converter=converter)

        return Impl

    found = linearize(make(Kept_[float](), Eventful()))
    np.testing.assert_array_equal(found.A, np.diag([1.0, 1.0, 0.5, 1.0]))


def test_a_parameter_of_the_context_counts():
    diagram = make(Eventful())
    context = diagram.CreateDefaultContext()
    own = diagram.GetSubsystemByName("wall").GetMyMutableContextFromRoot(context)
    own.get_mutable_numeric_parameter(0).SetAtIndex(0, 0.25)
    found = linearize_sampled(diagram, context)
    np.testing.assert_array_equal(found.A, [[0.25, 0.0], [0.0, 1.0]])


def test_two_systems_with_two_periods_point_to_monodromy():
    slow = LinearSystem([[0.5]], [[1]], [[1]], [[0]], 0.002)
    fast = LinearSystem([[0.5]], [[1]], [[1]], [[0]], 0.001)
    with pytest.raises(ValueError, match=r"0.001 s \(servo\), 0.002 s \(wall\).*mono"):
        linearize(make(slow, fast))


def test_a_continuous_system_needs_a_period():
    with pytest.raises(ValueError, match=r"Drake's Linearize\(.*or give period_s"):
        linearize(make_mass())


@pytest.mark.parametrize("period", [0.0, -1.0, float("inf"), float("nan")])
def test_a_period_must_be_positive(period):
    with pytest.raises(ValueError, match="period_s must be positive"):
        linearize(make_loop(900.0), period_s=period)


def test_a_period_other_than_the_systems_own_is_refused():
    with pytest.raises(ValueError, match=r"0.002, but wall is updated every 0.001 s"):
        linearize(make_loop(900.0), period_s=0.002)
    assert linearize(make_loop(900.0), period_s=PERIOD).period_s == PERIOD


def test_a_system_without_state_is_refused():
    gain = LinearSystem(np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0)), [[2.0]])
    with pytest.raises(ValueError, match="no state"):
        linearize(gain, period_s=PERIOD)


def test_a_system_without_a_twin_is_named():
    class Plain(LeafSystem):
        pass

    with pytest.raises(ValueError, match=r"inner/plain \(Plain\) does not convert"):
        inner = make(Plain(), make_mass(), names=("plain", "mass"))
        linearize(make(inner, Eventful(), names=("inner", "memory")))


def make_plant(sampled_ports):
    plant = MultibodyPlant(PERIOD)
    plant.AddRigidBody("tool", SpatialInertia.SolidSphereWithMass(0.1, 0.02))
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
    plant.SetUseSampledOutputPorts(sampled_ports)
    plant.Finalize()
    return plant


def test_a_discrete_plant_must_not_sample_its_ports():
    with pytest.raises(
        ValueError, match=r"MultibodyPlant plant.*SetUseSampledOutputPorts"
    ):
        linearize(make(make_plant(True), names=("plant",)))


def test_a_discrete_plant_without_sampled_ports_is_linearized():
    diagram = make(make_plant(False), names=("plant",))
    found = linearize(diagram)
    context = diagram.GetSubsystemByName("plant").CreateDefaultContext()
    plant = diagram.GetSubsystemByName("plant")
    force = plant.get_applied_generalized_force_input_port()
    force.FixValue(context, np.zeros(6))
    own = Linearize(
        plant, context, force.get_index(), plant.GetOutputPort("state").get_index()
    )
    np.testing.assert_allclose(found.A, own.A(), atol=1e-15)
    assert found.state_names[4] == "plant/tool_x"
    assert found.A[4, 10] == pytest.approx(PERIOD)


def test_a_state_that_moves_is_no_equilibrium():
    loop = make_loop(900.0)
    context = loop.CreateDefaultContext()
    context.SetContinuousState([0.0, 2.0])
    with pytest.raises(
        ValueError, match=r"not an equilibrium: mass/xc\[1\].*find_equilibrium"
    ):
        linearize_sampled(loop, context)


def test_a_state_that_is_not_a_number_is_no_equilibrium():
    loop = make_loop(900.0)
    context = loop.CreateDefaultContext()
    context.SetContinuousState([np.nan, 0.0])
    with pytest.raises(ValueError, match="not an equilibrium"):
        linearize_sampled(loop, context)


@pytest.mark.parametrize(
    ("ports", "reason"),
    [
        ({"input_port": "force"}, r"input_port must be one of \[\]"),
        ({"output_port": 7}, r"output_port must be one of \['x'\] or its index, is 7"),
        ({"output_port": -1}, "must be one of"),
    ],
)
def test_a_port_must_be_there(ports, reason):
    with pytest.raises(ValueError, match=reason):
        linearize(make_loop(900.0), **ports)


def test_an_abstract_port_cannot_be_chosen():
    plant = make_plant(False)
    with pytest.raises(ValueError, match="body_poses is abstract"):
        linearize(plant, output_port="body_poses")


def test_an_input_must_have_a_value():
    with pytest.raises(ValueError, match="input_port u0 has no value: fix it"):
        linearize(make_mass(), period_s=PERIOD, input_port=0)


def test_an_open_input_elsewhere_is_said():
    with pytest.raises(ValueError, match="an input is open"):
        linearize(make(make_mass(), Eventful()))


@pytest.mark.parametrize(
    "analyze", [find_equilibrium, linearize_sampled, calc_monodromy]
)
def test_what_is_no_system_or_no_context_of_it_is_refused(analyze):
    loop, other = make_loop(900.0), make_loop(900.0)
    context = loop.CreateDefaultContext()
    with pytest.raises(
        TypeError, match=r"^diagram must be .* returns one in \.diagram"
    ):
        analyze(context, loop)
    with pytest.raises(TypeError, match=r"^context must be .*Simulator\.get_context"):
        analyze(loop, Simulator(loop))
    with pytest.raises(RuntimeError, match="was passed the Context of"):
        analyze(loop, other.CreateDefaultContext())


def test_modes_are_of_a_linear_map():
    with pytest.raises(TypeError, match=r"^linear must be .* make one"):
        find_modes(make_loop(900.0))
