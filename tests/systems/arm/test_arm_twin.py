"""A twin's parts: there only if named, and wired so that each does what it is for."""

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from diagram_parts import SYSTEMS, names
from other_arm import PRESET, write_preset
from pydrake.math import RigidTransform
from pydrake.systems.framework import Diagram, DiagramBuilder
from twin_rig import (
    HANDLE_PATH,
    MOTORS,
    X_WH,
    CoupledArm,
    load_plant,
    make_arm,
    make_simulator,
    make_twin,
)
from twin_rig import PRESET as PREMIUM

from drake_haptics.analysis.held_scene import hold_scene
from drake_haptics.analysis.sampled_linearization import linearize_sampled
from drake_haptics.bounds.held_handle import calc_force_delay
from drake_haptics.common.errors import SceneError
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import (
    DeviceImperfections,
    EncoderParameters,
    ForceDelayParameters,
    JointFrictionParameters,
    SaturationParameters,
)
from drake_haptics.simulation.run import run
from drake_haptics.systems.arm.hand_impedance import HandImpedance
from drake_haptics.systems.arm.simulated_arm import make_arm_plant, solve_arm_positions
from drake_haptics.systems.framework.vector_ports import export_parts

ALWAYS = {"arm", "hand_impedance", "parts"}
PARTS = {
    "encoder": ({"encoder_step_rad": MOTORS.encoder_step_rad}, {"joint_encoder"}),
    "friction": (
        {"coulomb_Nm": MOTORS.coulomb_friction_Nm},
        {"joint_friction", "generalized_force"},
    ),
    "delay": ({"delay_samples": 1}, {"force_delay"}),
    "saturation": (
        {"peak_torque_Nm": MOTORS.peak_torque_Nm},
        {"motor_torque", "no_wrench", "generalized_force"},
    ),
}
SCENE_PARTS = {
    "encoder": EncoderParameters(),
    "friction": JointFrictionParameters(),
    "delay": ForceDelayParameters(),
    "saturation": SaturationParameters(),
}
STILL = (0.0, 0.0, 0.0, 0.05)
GAINS = (800.0, 2.0, 1.0, 0.004)
BESIDE = [1e-3, 2e-3, -1e-3]


@pytest.mark.parametrize("part", PARTS)
def test_a_part_is_in_the_diagram_once_it_is_named(part):
    parameters, systems = PARTS[part]
    assert names(make_arm(make_twin(**parameters))) == ALWAYS | systems


@pytest.mark.parametrize("part", SCENE_PARTS)
def test_a_scene_names_it_and_the_preset_has_its_figures(tmp_path, part):
    scene = over_a_plate(tmp_path, [STILL])
    scene.device.twin = DeviceImperfections(**{part: SCENE_PARTS[part]})
    haptic = BuildHapticDiagram(scene)
    assert names(haptic.diagram) == SYSTEMS
    arm = haptic.loop.device.GetSubsystemByName("simulated_arm")
    assert names(arm) == ALWAYS | PARTS[part][1]


def test_a_scene_that_names_none_has_the_systems_it_always_had(tmp_path):
    haptic = BuildHapticDiagram(over_a_plate(tmp_path, [STILL]))
    device = haptic.loop.device
    assert names(device) == {"rendered_force_hold", "simulated_arm"}
    assert names(device.GetSubsystemByName("simulated_arm")) == ALWAYS


class PlainArm(Diagram):
    """Arm and hand wired by hand, as they are without a twin."""

    def __init__(self):
        super().__init__()
        builder = DiagramBuilder()
        plant = make_arm_plant(PREMIUM.model_path, RigidTransform())
        builder.AddNamedSystem("arm", plant)
        plant.Finalize()
        handle = plant.GetBodyByName("handle")
        q = solve_arm_positions(plant, handle, X_WH, np.zeros(6))
        plant.SetDefaultPositions(q)
        hand = builder.AddNamedSystem(
            "hand_impedance",
            HandImpedance(plant, handle, HANDLE_PATH, RigidTransform(), None),
        )
        builder.Connect(plant.get_state_output_port(), hand.GetInputPort("arm_state"))
        builder.Connect(
            hand.GetOutputPort("generalized_force"),
            plant.get_applied_generalized_force_input_port(),
        )
        builder.ExportInput(hand.GetInputPort("F_Ho_W_rendered"), "F_Ho_W_rendered")
        export_parts(
            builder, hand.GetOutputPort("handle_state"), {"X_WH": 7, "V_WH": 6}
        )
        builder.BuildInto(self)


def test_without_a_twin_every_bit_is_that_of_arm_and_hand_alone():
    plain = PlainArm()
    plain.set_name("simulated_arm")
    expected = CoupledArm(plain, GAINS, BESIDE).run(0.1)
    assert np.abs(expected[-1, 6:]).max() > 1e-3
    np.testing.assert_array_equal(
        CoupledArm(make_arm(), GAINS, BESIDE).run(0.1), expected
    )


def test_motors_below_their_limits_change_nothing():
    expected = CoupledArm(make_arm(), GAINS, BESIDE).run(0.1)
    twin = make_twin(peak_torque_Nm=MOTORS.peak_torque_Nm)
    np.testing.assert_allclose(
        CoupledArm(make_arm(twin), GAINS, BESIDE).run(0.1), expected, atol=1e-10
    )


def test_motors_that_give_little_are_felt():
    twin = make_twin(peak_torque_Nm=[0.02] * 6)
    strong, weak = (
        CoupledArm(make_arm(which), GAINS, BESIDE).run(0.02) for which in (None, twin)
    )
    assert np.abs(weak[-1, 6:9]).max() < 0.5 * np.abs(strong[-1, 6:9]).max()


def test_a_delay_lets_the_arm_rest_until_the_wrench_has_come():
    twin = make_twin(delay_samples=5)
    states = CoupledArm(make_arm(twin), GAINS, BESIDE).run(0.01)
    np.testing.assert_array_equal(states[:5, 6:], 0.0)
    # From there on it is the same start, later.
    expected = CoupledArm(make_arm(), GAINS, BESIDE).run(0.01)
    np.testing.assert_array_equal(states[5], expected[0])


def test_the_loop_feels_counted_angles():
    twin = make_twin(encoder_step_rad=[1e-2] * 6)
    arm = make_arm(twin)
    plant = load_plant()
    simulator = make_simulator(arm)
    context = simulator.get_mutable_context()
    inner = arm.GetSubsystemByName("arm")
    # Before the first sample the encoders have counted where the arm begins.
    inner.SetPositions(
        inner.GetMyMutableContextFromRoot(context),
        [0.013, 0.021, -0.026, 0.004, 0.006, -0.004],
    )
    arm.GetInputPort("F_Ho_W_rendered").FixValue(context, np.zeros(6))
    simulator.Initialize()
    truth = plant.CreateDefaultContext()
    # In motors: 0.013, 0.021 and 0.021 - 0.026 = -0.005, which is nearer to 0.
    plant.SetPositions(truth, [0.01, 0.02, -0.02, 0.0, 0.01, 0.0])
    expected = plant.EvalBodyPoseInWorld(truth, plant.GetBodyByName("handle"))
    np.testing.assert_array_equal(arm.GetOutputPort("V_WH").Eval(context), 0.0)
    found = vector_to_pose(arm.GetOutputPort("X_WH").Eval(context))
    assert found.IsNearlyEqualTo(expected, 1e-12)


@pytest.mark.parametrize(
    ("part", "words"),
    [
        ("encoder", "rounds angles: leave device.twin.encoder out"),
        ("friction", "sticks or slides: leave device.twin.friction out"),
    ],
)
def test_what_has_no_derivative_is_refused_by_name(tmp_path, part, words):
    loop = CoupledArm(make_arm(make_twin(**PARTS[part][0])), GAINS, BESIDE)
    path = rf"no derivatives: .*simulated_arm/joint_{part} {words}"
    with pytest.raises(ValueError, match=path):
        linearize_sampled(loop.diagram, loop.diagram.CreateDefaultContext())
    scene = over_a_plate(tmp_path, [STILL, (0.1, 0, 0, TOOL_HALF_HEIGHT - 1e-3)])
    scene.device.twin = DeviceImperfections(**{part: SCENE_PARTS[part]})
    with pytest.raises(ValueError, match=path):
        hold_scene(scene)


def test_a_figure_that_nobody_gives_is_asked_for(tmp_path):
    scene = over_a_plate(tmp_path, [STILL])
    scene.device.preset = str(write_preset(tmp_path, PRESET))
    scene.device.twin = DeviceImperfections(saturation=SaturationParameters())
    with pytest.raises(
        SceneError, match=r"device\.twin\.saturation\.peak_torque_Nm is"
    ):
        BuildHapticDiagram(scene)
    scene.device.twin = DeviceImperfections(
        saturation=SaturationParameters([0.5] * 6), encoder=EncoderParameters()
    )
    BuildHapticDiagram(scene)


def test_the_bounds_of_the_coupling_know_of_the_delay(tmp_path):
    scene = over_a_plate(tmp_path, [STILL])
    assert calc_force_delay(scene) == 0.0
    scene.device.twin = DeviceImperfections(delay=ForceDelayParameters(3))
    scene.device.rate_hz = 500.0
    assert calc_force_delay(scene) == 0.006


@pytest.mark.parametrize(
    ("twin", "complaint"),
    [
        ("encodr: {}", r"twin\.encodr: unknown key; did you mean 'encoder'"),
        ("encoder:", r"twin\.encoder: is empty; write {} for the defaults"),
        ("encoder: {step_rad: [1]}", r"encoder\.step_rad needs 6 numbers"),
        ("encoder: {velocity_window: 0}", r"velocity_window must be at least 1 and"),
        ("encoder: {velocity_window: 1000000000}", r"at most 1,000, is 1000000000"),
        ("encoder: {velocity_window: 1.5}", r"velocity_window: expected a whole"),
        ("delay: {samples: 0}", r"delay\.samples must be at least 1 and"),
        ("delay: {samples: 1000000}", r"at most 1,000, is 1000000"),
        ("delay: {samples: true}", r"delay\.samples: expected a whole number"),
        ("friction: {coulomb_Nm: [0, 0, 0, 0, 0, -1]}", r"Nm\[5\] must not be negat"),
        ("friction: {viscous_Nms_per_rad: [1]}", r"viscous_Nms_per_rad needs 6"),
        ("saturation: {peak_torque_Nm: [1, 1, 0, 1, 1, 1]}", r"\[2\] must be posit"),
        ("saturation: {peak_torque_Nm: .inf}", r"peak_torque_Nm: expected a list"),
        ("friction: {coulomb_Nm: [.nan, 0, 0, 0, 0, 0]}", r"expected a finite number"),
    ],
)
def test_a_bad_twin_is_named_with_its_key(tmp_path, twin, complaint):
    path = tmp_path / "scene.yaml"
    path.write_text(
        "tool: {mesh: a.obj}\nenvironment: [{name: b, mesh: b.obj}]\n"
        "hand: {path: {waypoints: [{time_s: 0}]}}\n"
        f"device: {{twin: {{{twin}}}}}\n"
    )
    with pytest.raises(SceneError, match=rf"scene\.yaml: device\..*{complaint}"):
        load_scene(path)


def test_all_parts_together_run(tmp_path):
    scene = over_a_plate(tmp_path, [STILL, (0.1, 0, 0, TOOL_HALF_HEIGHT - 0.01)])
    scene.device.twin = DeviceImperfections(**SCENE_PARTS)
    figures = run(BuildHapticDiagram(scene), 0.3).to_dict()
    assert 1.0 < figures["max_force_N"] <= 8.5 * (1.0 + 1e-12)
    assert figures["non_finite_events"] == 0
