"""A scene for two meshes of a user: it must simply run."""

import re

import numpy as np
import pytest
import trimesh

from drake_haptics.authoring.scene_from_meshes import make_scene_for_meshes
from drake_haptics.common.errors import SceneError
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.validation import check_values
from drake_haptics.simulation.run import run


def write(folder, name, mesh):
    path = folder / name
    mesh.export(path)
    return path


SHAPES = {
    "block": trimesh.creation.box([0.1, 0.08, 0.03]),
    "ball": trimesh.creation.icosphere(subdivisions=2, radius=0.05),
    "ring": trimesh.creation.torus(0.04, 0.015, 24, 16),
    "tube": trimesh.creation.annulus(0.03, 0.04, 0.08),
    "stick": trimesh.creation.cylinder(0.004, 0.12, sections=12),
}


@pytest.mark.parametrize(
    ("environment", "median_contacts"),
    # From the rim of the tube the stick slips into the hollow for a while.
    [("block", 1), ("ball", 1), ("ring", 1), ("tube", 0)],
)
def test_it_touches_and_presses_gently(tmp_path, environment, median_contacts):
    scene = make_scene_for_meshes(
        write(tmp_path, "stick.stl", SHAPES["stick"]),
        write(tmp_path, "environment.ply", SHAPES[environment]),
    )
    check_values(scene)
    period = scene.hand.path.waypoints[-1].time_s
    figures = run(BuildHapticDiagram(scene), 0.5 * period).to_dict()
    assert figures["contacts"]["median"] >= median_contacts
    assert 0.5 < figures["max_force_N"] < 4.0
    assert (figures["limit_hits"], figures["non_finite_events"]) == (0, 0)


def test_its_numbers_are_short_to_read(tmp_path):
    third = SHAPES["stick"].copy()
    third.apply_scale(1.0 / 3.0)
    stick = write(tmp_path, "stick.stl", third)
    scene = make_scene_for_meshes(stick, write(tmp_path, "ball.ply", SHAPES["ball"]))
    numbers = [scene.contact.tolerance_m, *scene.tool.grasp.position_m]
    for waypoint in scene.hand.path.waypoints:
        numbers += [waypoint.time_s, *waypoint.position_m]
    assert {type(number) for number in numbers} == {float}
    # As a person would write them, to the nanometer and microsecond.
    assert all(number == float(f"{number:.9f}") for number in numbers)
    assert "-0.0" not in map(repr, numbers)
    # The page shows it, in millimeters.
    assert float(f"{1e3 * scene.contact.tolerance_m:.2g}") == pytest.approx(
        1e3 * scene.contact.tolerance_m, rel=1e-12
    )
    assert scene.contact.tolerance_m < 2e-3


def test_scales_are_meters_per_unit(tmp_path):
    in_mm = SHAPES["block"].copy()
    in_mm.apply_scale(1000.0)
    stick = write(tmp_path, "stick.stl", SHAPES["stick"])
    meters = make_scene_for_meshes(stick, write(tmp_path, "m.ply", SHAPES["block"]))
    scaled = make_scene_for_meshes(
        stick, write(tmp_path, "mm.ply", in_mm), environment_scale=1e-3
    )
    for one, two in zip(
        meters.hand.path.waypoints, scaled.hand.path.waypoints, strict=True
    ):
        np.testing.assert_allclose(one.position_m, two.position_m, atol=1e-6)


@pytest.mark.parametrize("size", [3.0, 1e-4])
def test_a_tool_of_an_unlikely_size_is_refused(tmp_path, size):
    tool = write(tmp_path, "tool.stl", trimesh.creation.box([size] * 3))
    block = write(tmp_path, "block.stl", SHAPES["block"])
    with pytest.raises(SceneError, match=r"the tool tool.stl is .*m long, and must"):
        make_scene_for_meshes(tool, block)


@pytest.mark.parametrize("size", [6000.0, 3.0, 1e-4, 1e-9])
def test_the_scale_that_a_refusal_names_is_accepted(tmp_path, size):
    tool = write(tmp_path, "tool.ply", trimesh.creation.box([size] * 3))
    block = write(tmp_path, "block.stl", SHAPES["block"])
    with pytest.raises(SceneError) as refusal:
        make_scene_for_meshes(tool, block)
    (scale,) = re.findall(r"tool_scale=([\d.e+-]+)", str(refusal.value))
    make_scene_for_meshes(tool, block, tool_scale=float(scale))


def test_a_tool_far_from_its_origin_is_held_as_if_it_were_not(tmp_path):
    ball = write(tmp_path, "ball.ply", SHAPES["ball"])
    near = make_scene_for_meshes(write(tmp_path, "near.stl", SHAPES["stick"]), ball)
    moved = SHAPES["stick"].copy()
    moved.apply_translation([0.5, -0.25, 0.125])
    far = make_scene_for_meshes(write(tmp_path, "far.stl", moved), ball)
    assert (near.tool.center, far.tool.center) == (False, True)
    # STL has single precision: half a meter away, 30 nm.
    np.testing.assert_allclose(
        far.tool.grasp.position_m, near.tool.grasp.position_m, atol=1e-7
    )
    for one, two in zip(near.hand.path.waypoints, far.hand.path.waypoints, strict=True):
        np.testing.assert_allclose(one.position_m, two.position_m, atol=1e-6)
    figures = run(BuildHapticDiagram(far), 3.0).to_dict()
    assert figures["contacts"]["max"] >= 1
    assert figures["limit_hits"] == 0


def test_a_tool_that_is_held_at_its_end_keeps_its_origin(tmp_path):
    # The origin is 5 mm beyond the end of a stick of 120 mm.
    stick = SHAPES["stick"].copy()
    stick.apply_translation([0.0, 0.0, 0.065])
    scene = make_scene_for_meshes(
        write(tmp_path, "stick.stl", stick), write(tmp_path, "ball.ply", SHAPES["ball"])
    )
    assert not scene.tool.center
