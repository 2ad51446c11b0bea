"""A hand presses the tool onto a plate: it comes to rest, and stays."""

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, TOOL_MASS, over_a_plate

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.simulation.run import run
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS

PRESS_N = 2.0
SETTLED_S, END_S = 3.0, 5.0


def press(folder, tool, grip):
    """Returns a scene in which a hand, after 0.3 s, presses with about 2 N.

    The contact answers at its tolerance already, so there the spring is stretched.
    """
    scene = over_a_plate(folder, [], tool=tool, grip=grip)
    depth = PRESS_N / HAND_GRIPS[grip].stiffness_N_per_m - scene.contact.tolerance_m
    return over_a_plate(
        folder,
        [
            (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.01),
            (0.3, 0.0, 0.0, TOOL_HALF_HEIGHT - depth),
        ],
        tool=tool,
        grip=grip,
    )


def run_and_record(scene):
    """Returns the figures of a run and what was seen after it had settled."""
    haptic = BuildHapticDiagram(scene)
    loop = haptic.loop
    ports = {
        "pose": (loop.haptic_tool, loop.haptic_tool.GetOutputPort("X_WT")),
        "velocity": (loop.haptic_tool, loop.haptic_tool.GetOutputPort("V_WT")),
        "contact": (loop.penalty_force, loop.penalty_force.GetOutputPort("F_To_W")),
        "handle": (loop.device, loop.device.GetOutputPort("X_WH")),
        "shown": (loop.device, loop.device.GetOutputPort("F_Ho_W_rendered")),
    }
    seen = {name: [] for name in ports}

    def record(context):
        if context.get_time() >= SETTLED_S:
            for name, (system, port) in ports.items():
                seen[name].append(port.Eval(system.GetMyContextFromRoot(context)))

    figures = run(haptic, END_S, on_tick=record).to_dict()
    assert (figures["limit_hits"], figures["non_finite_events"]) == (0, 0)
    return {name: np.array(values) for name, values in seen.items()}


def hand_force(scene, handle):
    """Returns what the hand's spring does to a handle at rest, N."""
    target = np.array(scene.hand.path.waypoints[-1].position_m)
    return HAND_GRIPS[scene.hand.grip].stiffness_N_per_m * (target - handle[:, 4:])


@pytest.mark.parametrize("grip", ["light", "nominal", "firm"])
@pytest.mark.parametrize("tool", ["ball", "cube"])
def test_a_tool_pressed_onto_a_plate_rests(tmp_path, tool, grip):
    """On a corner-free ball, and on a flat face, whose contact must not jump."""
    scene = press(tmp_path, tool, grip)
    seen = run_and_record(scene)
    # No drift, and no energy but that of round-off.
    assert np.ptp(seen["pose"], axis=0).max() < 1e-7
    energy = 0.5 * TOOL_MASS * np.sum(seen["velocity"][:, 3:] ** 2, axis=1)
    assert energy.max() < 1e-15
    # The plate carries what the hand presses, and the hand feels it.
    shown, contact = seen["shown"][:, 3:], seen["contact"][:, 3:]
    np.testing.assert_allclose(shown, contact, atol=1e-4)
    np.testing.assert_allclose(hand_force(scene, seen["handle"]), -shown, atol=1e-4)
    # Hand and coupling are springs in a row.
    k_hand = HAND_GRIPS[grip].stiffness_N_per_m
    k_coupling, k_contact = (
        scene.coupling.stiffness_N_per_m,
        scene.contact.stiffness_N_per_m,
    )
    share = (1 / k_hand) / (1 / k_hand + 1 / k_coupling + 1 / k_contact)
    np.testing.assert_allclose(shown[:, 2], share * PRESS_N, rtol=0.02)


def test_sliding_and_tapping_stays_finite_and_within_the_limits(tmp_path):
    low = TOOL_HALF_HEIGHT - 0.01
    circle = [
        (0.2 + 0.05 * i, 0.02 * np.cos(a), 0.02 * np.sin(a), low)
        for i, a in enumerate(np.linspace(0, 2 * np.pi, 9))
    ]
    above = (0.0, 0.02, 0.0, TOOL_HALF_HEIGHT + 0.02)
    path = [above, *circle, (0.8, *above[1:])]
    scene = over_a_plate(tmp_path, path, periodic=True, grip="firm")
    haptic = BuildHapticDiagram(scene)
    force = haptic.loop.penalty_force

    def never_pulls(context):
        F = force.GetOutputPort("F_To_W").Eval(force.GetMyContextFromRoot(context))
        assert F[5] >= 0.0

    figures = run(haptic, 4.0, on_tick=never_pulls).to_dict()
    assert figures["ticks"] == 4000
    assert figures["max_force_N"] <= 8.5 * (1 + 1e-12)
    assert figures["max_torque_Nm"] <= 0.188 * (1 + 1e-12)
    # The device's largest force is less than the contact's at its tolerance.
    assert figures["max_penetration_m"] < 1e-3
