"""Pieces of a scene: cut once, taken over where they are cut the same."""

from dataclasses import replace

import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.geometry import cut_scene
from drake_haptics.scene.schema import FrictionParameters


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scene")
    return over_a_plate(folder, [(0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.02)])


@pytest.fixture(scope="module")
def haptic(scene):
    return BuildHapticDiagram(scene)


def test_a_rebuild_takes_the_pieces_as_they_are(scene, haptic):
    plate = scene.environment[0]
    other = replace(
        scene,
        tool=replace(scene.tool, mass_kg=0.3),
        environment=[replace(plate, name="floor"), replace(plate, name="roof")],
        effects=replace(scene.effects, friction=FrictionParameters()),
    )
    again = BuildHapticDiagram(other, reuse=haptic)
    assert again.tool is haptic.tool
    assert all(pieces is haptic.environment[0] for pieces in again.environment)
    assert BuildHapticDiagram(scene).tool is not haptic.tool


@pytest.mark.parametrize(
    "change",
    [{"scale": 2.0}, {"decomposition": "hull"}, {"max_triangles": 8}, {"center": True}],
)
def test_what_is_cut_in_another_way_is_cut(scene, haptic, change):
    other = replace(scene, tool=replace(scene.tool, **change))
    known = [(scene.tool, haptic.tool), (scene.environment[0], haptic.environment[0])]
    tool, environment = cut_scene(other, known)
    assert tool is not haptic.tool
    assert environment == haptic.environment
