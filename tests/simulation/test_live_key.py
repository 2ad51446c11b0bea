"""What a scene offers to be changed while it runs."""

from dataclasses import fields, replace

from drake_haptics import find_scene, load_scene
from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    EnvironmentObject,
    Material,
    Scene,
)
from drake_haptics.scene.validation import check_values
from drake_haptics.simulation.live_values import live_keys

SOFT = Material(stiffness_N_per_m=300.0, damping_Ns_per_m=1.0)


def make_scene(*materials, **contact):
    objects = [
        EnvironmentObject(name=f"object_{i}", material=material)
        for i, material in enumerate(materials or [Material()])
    ]
    return Scene(environment=objects, contact=ContactParameters(**contact))


def names(scene):
    return [key.key for key in live_keys(scene)]


def test_gains_and_tolerance_are_live():
    assert names(make_scene()) == [
        *(f"coupling.{field.name}" for field in fields(CouplingParameters)),
        "contact.stiffness_N_per_m",
        "contact.damping_Ns_per_m",
        "contact.tolerance_m",
    ]


def test_the_cluster_size_is_live_where_there_are_clusters():
    octree = make_scene(clustering="octree", cluster_size_m=4e-3)
    assert set(names(octree)) - set(names(make_scene())) == {"contact.cluster_size_m"}


def test_a_gain_that_every_material_gives_is_not_offered():
    gains = {"contact.stiffness_N_per_m", "contact.damping_Ns_per_m"}
    assert set(names(make_scene())) - set(names(make_scene(SOFT, SOFT))) == gains
    assert names(make_scene(SOFT, Material())) == names(make_scene())


def test_a_key_reads_and_changes_its_value_in_a_scene():
    scene = make_scene(clustering="octree", cluster_size_m=4e-3)
    for key in live_keys(scene):
        group, name = key.key.split(".")
        assert key.group == group
        assert key.read(scene) == getattr(getattr(scene, group), name)
        changed = key.change(scene, 0.125)
        assert key.read(changed) == 0.125
        assert key.change(changed, key.read(scene)) == scene


def test_ranges_hold_what_the_scene_says_and_are_valid():
    wild = replace(
        make_scene(tolerance_m=0.0, stiffness_N_per_m=3e6),
        coupling=CouplingParameters(stiffness_N_per_m=1.0, damping_Ns_per_m=99.0),
    )
    for scene in (make_scene(), wild):
        for key in live_keys(scene):
            assert key.low <= key.read(scene) <= key.high
            assert key.low < key.high
            # A scale of equal ratios has no zero.
            assert key.is_logarithmic == (key.low > 0.0)


def test_all_that_is_offered_makes_a_valid_scene():
    scene = load_scene(find_scene("cup_spoon"))
    for key in live_keys(scene):
        for value in (key.low, key.high):
            check_values(key.change(scene, value))


def test_the_help_is_what_the_scene_says_of_its_keys():
    found = {key.key: key.help for key in live_keys(make_scene())}
    assert found["contact.tolerance_m"] == (
        "Distance below which pieces push each other apart, m (the paper's t)."
    )
    assert found["coupling.rotational_damping_Nms_per_rad"] == (
        "Torque per relative angular speed of handle and tool, N·m·s/rad."
    )
    assert all(found.values())
