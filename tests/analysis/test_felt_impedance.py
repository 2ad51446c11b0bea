"""What the device feels, against springs in series and against the loop itself."""

from dataclasses import replace

import numpy as np
import pytest
from held_samples import load_held
from pydrake.math import RotationMatrix

from drake_haptics.analysis.delay_margin import find_shown_wrench
from drake_haptics.analysis.felt_impedance import calc_felt_impedance
from drake_haptics.analysis.held_loop import analyze_held_scene
from drake_haptics.analysis.held_scene import hold_scene
from drake_haptics.analysis.passivity import calc_passivity
from drake_haptics.common.pose_vector import vector_to_pose
from drake_haptics.scene.schema import DeviceImperfections, ForceDelayParameters

# Ticks in which the tool comes to rest while the handle stands still.
TICKS = 3000
STEP = 1e-5


@pytest.fixture(scope="module")
def pen():
    """One contact, of a vertex of the pen on the sphere."""
    return analyze_held_scene(load_held("sphere_pen"))


def calc_at_standstill(felt):
    """Returns H(1), without what is kept apart."""
    settled = np.linalg.solve(np.eye(len(felt.A)) - felt.A, felt.B)
    return felt.C @ settled + felt.D


def make_cross(v):
    """Returns the matrix of v ×."""
    return np.cross(np.eye(3), v)


def read_torque(loop):
    """Returns the torque that the handle is shown (3,), N·m."""
    names = loop.linearization.state_names
    shown = [i for i, name in enumerate(names) if "rendered_force_hold" in name]
    return loop.linearization.state[shown[:3]]


def read_handle(loop, context):
    device = loop.haptic.loop.device
    pose = device.GetOutputPort("X_WH").Eval(device.GetMyContextFromRoot(context))
    return vector_to_pose(pose)


def measure_static_force(loop, joint, offset):
    """Returns the handle's pose and the force on it after the tool has come to rest."""
    diagram = loop.haptic.diagram
    context = loop.context.Clone()
    state = context.get_mutable_continuous_state_vector()
    q = state.GetAtIndex(joint) + offset
    for _ in range(TICKS):
        state.SetAtIndex(joint, q)
        updated = diagram.EvalUniquePeriodicDiscreteUpdate(context)
        context.SetDiscreteState(updated.Clone())
    hold = loop.haptic.loop.device.GetSubsystemByName("rendered_force_hold")
    shown = hold.GetMyContextFromRoot(context).get_discrete_state(0).CopyToVector()
    return read_handle(loop, context), shown[:6]


def measure_stiffness(loop):
    """Returns -dF/dx (6, 6) of the loop's own steps, by central differences."""
    moves, forces = [], []
    for joint in range(6):
        (X_more, more), (X_less, less) = (
            measure_static_force(loop, joint, sign * STEP) for sign in (1.0, -1.0)
        )
        turn = RotationMatrix(X_more.rotation() @ X_less.rotation().inverse())
        axis = turn.ToAngleAxis()
        moves.append(
            np.concatenate(
                [
                    axis.angle() * axis.axis(),
                    X_more.translation() - X_less.translation(),
                ]
            )
        )
        forces.append(more - less)
    return -np.linalg.solve(np.array(moves), np.array(forces)).T


def test_one_contact_is_a_gradient(pen):
    felt = calc_felt_impedance(pen)
    stiffness = np.abs(calc_at_standstill(felt)).max()
    assert np.abs(felt.curl).max() < 1e-6 * stiffness
    # The torque on the handle would look like one, if its part had another sign.
    assert np.linalg.norm(read_torque(pen)) > 1e3 * np.abs(felt.curl).max()


def test_coupling_and_contact_are_springs_in_series(pen):
    # The pen's origin is at its tip: the contact turns nothing.
    K = pen.haptic.scene.coupling.stiffness_N_per_m
    k = pen.haptic.scene.contact.stiffness_N_per_m
    force = load_held("sphere_pen").F_To_W[3:]
    normal = force / np.linalg.norm(force)
    found = calc_at_standstill(calc_felt_impedance(pen))[3:, 3:]
    expected = K * k / (K + k) * np.outer(normal, normal)
    np.testing.assert_allclose(found, expected, atol=1e-6 * K)


@pytest.mark.parametrize("name", ["sphere_pen", "hammer_block"])
def test_the_stiffness_is_that_of_the_loops_own_steps(name):
    loop = analyze_held_scene(load_held(name))
    felt = calc_felt_impedance(loop)
    found = measure_stiffness(loop)
    np.testing.assert_allclose(
        calc_at_standstill(felt), (found + found.T) / 2.0, atol=1e-3
    )
    # What is not symmetric is half the torque on the handle, and curl.
    rest = (found - found.T) / 2.0 - felt.curl
    np.testing.assert_allclose(rest[3:], 0.0, atol=1e-5)
    np.testing.assert_allclose(
        rest[:3, :3], make_cross(read_torque(loop) / 2.0), atol=1e-7
    )


@pytest.mark.parametrize("name", ["sphere_pen", "cup_spoon"])
def test_against_a_rigid_tool_half_a_period_of_stiffness_and_damping_are_needed(name):
    held = load_held(name).against_rigid_wall()
    coupling = replace(held.scene.coupling, rotational_stiffness_Nm_per_rad=20.0)
    loop = analyze_held_scene(held, coupling)
    felt = calc_felt_impedance(loop)
    T = felt.period_s
    (needed,) = calc_passivity(felt, T, [0.5 / T]).required_matrix
    K, B = coupling.stiffness_N_per_m, coupling.damping_Ns_per_m
    np.testing.assert_allclose(needed[3:, 3:], (K * T / 2.0 + B) * np.eye(3), atol=1e-9)
    # Rotations are felt at the handle, and the coupling turns about the tool.
    R_WH = read_handle(loop, loop.context).rotation()
    p_HT_W = R_WH @ np.array(held.scene.tool.grasp.position_m)
    to_tool = np.eye(6)
    to_tool[3:, :3] = -make_cross(p_HT_W)
    from_tool = np.linalg.inv(to_tool)
    at_tool = from_tool.T @ needed.real @ from_tool
    K = coupling.rotational_stiffness_Nm_per_rad
    B = coupling.rotational_damping_Nms_per_rad
    # So stiff that the coupling is turned by a few milliradians only.
    np.testing.assert_allclose(
        at_tool[:3, :3], (K * T / 2.0 + B) * np.eye(3), atol=5e-3 * K * T
    )
    np.testing.assert_allclose(at_tool[:3, 3:], 0.0, atol=1e-9)


def test_the_damping_is_the_hands_and_the_joints(pen):
    felt = calc_felt_impedance(pen)
    free = replace(pen.haptic.scene, hand=replace(pen.haptic.scene.hand, grip="none"))
    of_arm = calc_felt_impedance(
        replace(pen, haptic=replace(pen.haptic, scene=free))
    ).handle_damping
    np.testing.assert_allclose(
        felt.handle_damping - of_arm, np.diag([0.05] * 3 + [15.0] * 3), atol=1e-12
    )
    assert np.linalg.eigvalsh(of_arm).min() > 0.0


def respond(felt, z):
    """Returns H(z) of the translation (3, 3)."""
    states = np.linalg.solve(z * np.eye(len(felt.A)) - felt.A, felt.B)
    return (felt.C @ states + felt.D)[3:, 3:]


@pytest.mark.parametrize("samples", [1, 2])
def test_a_late_wrench_is_felt_so_many_ticks_later(pen, samples):
    held = load_held("sphere_pen")
    device = replace(
        held.scene.device, twin=DeviceImperfections(delay=ForceDelayParameters(samples))
    )
    late = hold_scene(replace(held.scene, device=device), held.time_s)
    loop = analyze_held_scene(late)
    at_once, later = calc_felt_impedance(pen), calc_felt_impedance(loop)
    for z in np.exp(1j * np.array([0.01, 0.3, 1.0, 2.5])):
        expected = z**-samples * respond(at_once, z)
        size = np.abs(expected).max()
        np.testing.assert_allclose(respond(later, z), expected, atol=1e-3 * size)
    # Of all wrenches that wait, the arm is moved by the one that is shown, alone.
    names = loop.linearization.state_names
    waiting = [i for i, name in enumerate(names) if "force_delay" in name]
    assert len(waiting) == 6 * samples
    moves = np.abs(loop.linearization.rates).max(axis=0) > 0.0
    np.testing.assert_array_equal(
        [i for i in waiting if moves[i]], find_shown_wrench(names)
    )
