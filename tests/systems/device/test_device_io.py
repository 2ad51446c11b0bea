"""The exchange with a device: which value, in which frame, at which instant."""

from dataclasses import fields, replace

import numpy as np
import pytest
from device_diagram import PERIOD, X_WB, make_diagram
from diagram_parts import read_output
from fake_device import ScriptedDevice, make_reading
from pydrake.math import RigidTransform, RollPitchYaw, RotationMatrix
from pydrake.multibody.math import SpatialForce
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import LeafSystem
from pydrake.systems.primitives import ConstantVectorSource

from drake_haptics.common.pose_vector import pose_to_vector, vector_to_pose
from drake_haptics.device.backend import DeviceReading, Fault, GateState, check_reading
from drake_haptics.systems.device.device_io import DeviceIo


class Spring(LeafSystem):
    """Draws the handle to the world's origin: f = -K p, with no state of its own."""

    def __init__(self, stiffness):
        super().__init__()
        self._stiffness = stiffness
        self._X_WH = self.DeclareVectorInputPort("X_WH", 7)
        self.DeclareVectorOutputPort("F_Ho_W_commanded", 6, self._calc)

    def _calc(self, context, output):
        force = -self._stiffness * self._X_WH.Eval(context)[4:]
        output.SetFromVector([0, 0, 0, *force])


def test_the_handle_is_shown_in_the_world():
    turned = RollPitchYaw(1.0, 0.2, -0.5).ToQuaternion().wxyz()
    reading = make_reading(
        position=(0.1, 0.2, 0.3), velocity=(1.0, -2.0, 0.5), wxyz=turned
    )
    reading.V_BH[:3] = [3.0, 1.0, -1.0]
    diagram, device = make_diagram(ScriptedDevice(lambda _: reading))
    simulator = Simulator(diagram)
    simulator.AdvanceTo(PERIOD / 2)
    context = device.GetMyContextFromRoot(simulator.get_context())
    X_WH = vector_to_pose(device.GetOutputPort("X_WH").Eval(context))
    assert X_WH.IsNearlyEqualTo(X_WB @ vector_to_pose(reading.X_BH), 1e-14)
    V_WH = device.GetOutputPort("V_WH").Eval(context)
    R_WB = X_WB.rotation().matrix()
    np.testing.assert_allclose(V_WH[:3], R_WB @ [3.0, 1.0, -1.0], atol=1e-14)
    np.testing.assert_allclose(V_WH[3:], R_WB @ [1.0, -2.0, 0.5], atol=1e-14)


def test_the_wrench_is_written_in_the_base_frame():
    F_W = np.array([0.1, 0.2, -0.3, 4.0, -5.0, 6.0])
    backend = ScriptedDevice()
    diagram, _ = make_diagram(backend, source=ConstantVectorSource(F_W))
    Simulator(diagram).AdvanceTo(2 * PERIOD)
    R_BW = X_WB.rotation().inverse()
    F_B = SpatialForce(F_W).Rotate(R_BW).get_coeffs()
    np.testing.assert_allclose(backend.commands[-1].F_Ho_B, F_B, atol=1e-14)


def test_a_tick_answers_the_handle_that_it_read():
    """Truth: f = -K p of the very reading; a tick later would be the next position."""
    stiffness = 100.0
    backend = ScriptedDevice(lambda k: make_reading(k, position=(1e-3 * k, 0, 0)))
    diagram, _ = make_diagram(backend, X_WB=RigidTransform(), source=Spring(stiffness))
    simulator = Simulator(diagram)
    simulator.Initialize()
    assert [c.F_Ho_B[3] for c in backend.commands] == [0.0], "enabled with no force"
    simulator.AdvanceTo(5 * PERIOD)
    # The update of tick k reads position k; its wrench is out before tick k + 1 reads.
    assert backend.reads == 5
    forces = [command.F_Ho_B[3] for command in backend.commands[1:]]
    np.testing.assert_allclose(forces, [-stiffness * 1e-3 * k for k in range(1, 6)])
    for command in backend.commands[1:]:
        assert command.F_Ho_B[3] == pytest.approx(-stiffness * command.X_BH[4])


def test_slopes_are_turned_into_the_base_frame():
    """Truth: a small motion of the handle changes the same wrench in either frame."""
    rng = np.random.default_rng(5)
    K_W, B_W = rng.normal(size=(2, 6, 6))
    backend = ScriptedDevice()
    diagram, _ = make_diagram(
        backend, slopes=np.concatenate([K_W.ravel(), B_W.ravel()])
    )
    Simulator(diagram).AdvanceTo(PERIOD)
    R: RotationMatrix = X_WB.rotation()
    for in_base, in_world in [
        (backend.commands[-1].K_B, K_W),
        (backend.commands[-1].B_B, B_W),
    ]:
        motion_B = rng.normal(size=6)
        motion_W = np.concatenate([R @ motion_B[:3], R @ motion_B[3:]])
        F_W = in_world @ motion_W
        F_B = np.concatenate([R.inverse() @ F_W[:3], R.inverse() @ F_W[3:]])
        np.testing.assert_allclose(in_base @ motion_B, F_B, atol=1e-13)


@pytest.mark.parametrize("uses_slopes", [False, True])
def test_without_slopes_none_are_written(uses_slopes):
    backend = ScriptedDevice()
    backend.uses_slopes = uses_slopes
    diagram, device = make_diagram(backend)
    assert device.wants_slopes == uses_slopes
    Simulator(diagram).AdvanceTo(PERIOD)
    assert backend.commands[-1].K_B is None
    assert backend.commands[-1].B_B is None


def test_a_device_with_nothing_new_stays_where_it_was():
    first = make_reading(7, position=(0.01, 0.02, 0.03))
    diagram, device = make_diagram(ScriptedDevice(lambda _: None), first=first)
    simulator = Simulator(diagram)
    simulator.AdvanceTo(3 * PERIOD)
    np.testing.assert_allclose(
        read_output(device, "X_WH", simulator.get_context()),
        pose_to_vector(X_WB @ vector_to_pose(first.X_BH)),
        atol=1e-14,
    )


def test_the_reading_is_shown_as_the_device_gave_it():
    given = DeviceReading(
        sequence=41,
        time_s=0.25,
        X_BH=np.array([0.5, -0.5, 0.5, 0.5, 0.1, 0.2, 0.3]),
        V_BH=np.arange(1.0, 7.0),
        F_Ho_B=np.arange(7.0, 13.0),
        buttons=5,
        gate=GateState.FAULT,
        fault=Fault.OVERSPEED,
    )
    diagram, device = make_diagram(ScriptedDevice(lambda _: given))
    simulator = Simulator(diagram)
    simulator.AdvanceTo(PERIOD / 2)
    shown = read_output(device, "reading", simulator.get_context())
    for field in fields(DeviceReading):
        value, expected = (getattr(one, field.name) for one in (shown, given))
        assert type(value) is type(expected)
        np.testing.assert_array_equal(value, expected)


def test_a_handle_that_is_nowhere_ends_the_simulation():
    lost = make_reading(position=(0.0, np.nan, 0.0))
    diagram, _ = make_diagram(ScriptedDevice(lambda _: lost))
    with pytest.raises(FloatingPointError, match="device's reading is not finite"):
        Simulator(diagram).AdvanceTo(PERIOD)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"X_BH": [1.0, 0, 0, 0, 0, 0, 0]}, "X_BH .* must be 7 finite numbers in"),
        ({"V_BH": np.zeros(3)}, "V_BH .* must be 6 finite numbers"),
        ({"F_Ho_B": None}, "F_Ho_B .* must be 6 numbers in .* is None"),
        ({"X_BH": np.zeros(7)}, "quaternion in X_BH .* length 1, has 0"),
        ({"X_BH": 2 * make_reading().X_BH}, "quaternion in X_BH .* length 1, has 2"),
    ],
)
def test_a_later_reading_that_is_invalid_is_told_as_the_first_would_be(wrong, words):
    backend = ScriptedDevice(lambda k: replace(make_reading(k), **wrong))
    diagram, _ = make_diagram(backend)
    with pytest.raises(ValueError, match=words):
        Simulator(diagram).AdvanceTo(PERIOD)


def test_a_device_that_returns_something_else_than_a_reading_is_told():
    backend = ScriptedDevice(lambda _: (np.zeros(7), np.zeros(6)))
    diagram, _ = make_diagram(backend)
    with pytest.raises(TypeError, match="DeviceReading or None, is of type tuple"):
        Simulator(diagram).AdvanceTo(PERIOD)


def test_the_wrench_that_a_device_reports_need_not_be_finite():
    reading = replace(make_reading(), F_Ho_B=np.full(6, np.nan))
    check_reading(reading)
    diagram, _ = make_diagram(ScriptedDevice(lambda _: reading), first=reading)
    Simulator(diagram).AdvanceTo(PERIOD)


def test_the_period_must_be_positive():
    with pytest.raises(ValueError, match="period_s must be positive and finite, is 0"):
        DeviceIo(ScriptedDevice(), X_WB, 0.0, make_reading())
