"""Motions of a haptic loop in words."""

import pytest

from drake_haptics import BuildHapticDiagram, find_scene, load_scene
from drake_haptics.analysis.diagram_systems import find_state_layout
from drake_haptics.analysis.modes import list_parts

ARM = "device/simulated_arm/arm"


def test_a_joint_is_named_once_for_its_angle_and_its_rate():
    states = (f"{ARM}/gimbal_yaw_joint_w", f"{ARM}/gimbal_yaw_joint_q", f"{ARM}/j1_q")
    assert list_parts(states) == ["gimbal yaw joint", "j1"]


def test_the_tool_moves_along_and_about_axes():
    states = ("vx", "x", "wz", "y")
    names = (f"haptic_tool/step/{state}" for state in states)
    assert list_parts(names) == ["tool along x", "tool about z", "tool along y"]


def test_a_quaternion_has_no_axis():
    turning = "haptic_tool/step/qx"
    assert list_parts([turning, "haptic_tool/step/qw"]) == ["tool turning"]
    assert list_parts([turning, "haptic_tool/step/wx"]) == ["tool about x"]


@pytest.mark.parametrize("name", ["plant/haptic_tool/x", "mass/xc[0]", "arm_q", "x0"])
def test_what_is_not_of_each_loop_keeps_its_name(name):
    assert list_parts([name]) == [name]


def test_each_loops_own_paths_are_shorter():
    assert list_parts(["device/rendered_force_hold/sample/F"]) == [
        "rendered_force_hold/F"
    ]


def test_the_words_fit_the_states_of_a_scene():
    haptic = BuildHapticDiagram(load_scene(find_scene("sphere_pen")))
    parts = list_parts(find_state_layout(haptic.diagram).names)
    joints = [part for part in parts if part.endswith(" joint")]
    assert len(joints) == 6
    moves = {part for part in parts if part.startswith("tool ")}
    assert moves == {
        f"tool {way} {axis}" for way in ("along", "about") for axis in "xyz"
    }
    assert not any("arm/" in part or "haptic_tool" in part for part in parts)
