"""Scene files: what is read, and what is refused by name."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from drake_haptics.common.errors import SceneError
from drake_haptics.loop.simulated_device import make_hand_path, make_simulated_device
from drake_haptics.scene.library import find_scene, list_scenes
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import (
    BrakingParameters,
    ContactParameters,
    CouplingParameters,
    DeviceImperfections,
    DeviceParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
    HandPathParameters,
    Material,
    PassivityParameters,
    Pose,
    ShadingParameters,
    Waypoint,
)

GOOD = """
description: A peg above a plate.
tool:
  mesh: peg.obj
  mass_kg: 0.08
  grasp: {position_m: [0, 0, 0.04], rpy_deg: [0, 0, 90]}
environment:
- name: plate
  mesh: package://drake_haptics/models/meshes/block.obj
  scale: 1e-3
  pose: {position_m: [0.1, 0, 0]}
hand:
  grip: light
  path:
    periodic: false
    waypoints:
    - {time_s: 0, position_m: [0, 0, 0.1]}
    - {time_s: 1.5, position_m: [0, 0, 0.05], rpy_deg: [0, 10, 0]}
"""


def load(tmp_path, text):
    path = tmp_path / "scene.yaml"
    path.write_text(text)
    for name in ("peg.obj", "arm.sdf"):
        (tmp_path / name).touch()
    return load_scene(path)


def test_a_scene_is_parsed_once_for_its_checks_and_once_by_drake(tmp_path, monkeypatch):
    parsed = []
    parse = yaml.SafeLoader.get_single_node
    monkeypatch.setattr(
        yaml.SafeLoader,
        "get_single_node",
        lambda loader: parsed.append(loader) or parse(loader),
    )
    load(tmp_path, GOOD)
    assert len(parsed) == 2


def test_a_scene_is_read_with_defaults_for_the_rest(tmp_path):
    scene = load(tmp_path, GOOD)
    assert scene.tool.mass_kg == 0.08
    assert scene.environment[0].scale == 1e-3
    assert scene.hand.path.waypoints[1].rpy_deg == [0, 10, 0]
    assert (scene.contact, scene.coupling) == (
        ContactParameters(),
        CouplingParameters(),
    )
    assert scene.device == DeviceParameters()
    assert scene.environment[0].material == Material()
    assert scene.effects == Effects(None, None, None, None, None)


def test_an_effect_is_there_once_it_is_named(tmp_path):
    every = (
        "effects: {shading: {}, friction: {coefficient: 0.5}, braking: {},"
        " gravity: {acceleration_m_per_s2: [0, 0, -1.62]}, passivity: {}}\nhand:"
    )
    scene = load(tmp_path, GOOD.replace("hand:", every))
    assert scene.effects == Effects(
        ShadingParameters(),
        FrictionParameters(coefficient=0.5),
        BrakingParameters(),
        GravityParameters([0, 0, -1.62]),
        PassivityParameters(),
    )


def test_a_material_takes_the_place_of_the_scenes(tmp_path):
    given = (
        "  material: {stiffness_N_per_m: 900, friction_coefficient: 0, shading: no}\n"
        "effects: {friction: {}, shading: {}}\nhand:"
    )
    scene = load(tmp_path, GOOD.replace("hand:", given))
    assert scene.environment[0].material == Material(900.0, None, 0.0, False)


def test_an_object_says_how_exact_its_shape_is(tmp_path):
    exact = "scale: 1e-3\n  max_triangles: 200\n  chord_error_m: 1e-5"
    text = GOOD.replace("package://drake_haptics/models/meshes/block.obj", "arm.sdf")
    (plate,) = load(tmp_path, text.replace("scale: 1e-3", exact)).environment
    assert (plate.max_triangles, plate.chord_error_m) == (200, 1e-5)
    tool = load(tmp_path, GOOD).tool
    assert tool.max_triangles is tool.chord_error_m is None


def test_mesh_paths_no_longer_depend_on_the_folder(tmp_path):
    scene = load(tmp_path, GOOD)
    assert scene.tool.mesh == str(tmp_path / "peg.obj")
    assert scene.environment[0].mesh.endswith("/models/meshes/block.obj")
    assert scene.environment[0].mesh.startswith("/")


def test_a_pose_is_drakes():
    X = Pose([1, 2, 3], [0, 0, 90]).to_rigid_transform()
    np.testing.assert_allclose(X @ np.array([1.0, 0, 0]), [1, 3, 3], atol=1e-15)


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("tool:", "tol:", r"tol: unknown key; did you mean 'tool'\?"),
        ("mass_kg: 0.08", "mass: 0.08", r"tool\.mass: unknown key; did you mean 'mass"),
        ("scale: 1e-3", "scales: 1", r"environment\[0\]\.scales: unknown key"),
        ("periodic: false", "periodc: no", r"hand\.path\.periodc: unknown key"),
        ("{time_s: 0,", "{time: 0,", r"hand\.path\.waypoints\[0\]\.time: unknown"),
        ("mass_kg: 0.08", "mass_kg: heavy", r"tool\.mass_kg: expected a finite number"),
        ("mass_kg: 0.08", "mass_kg: .nan", r"tool\.mass_kg: expected a finite number"),
        ("mass_kg: 0.08", "mass_kg:", r"tool\.mass_kg: expected a finite number"),
        ("mass_kg: 0.08", "mass_kg: 0", r"tool\.mass_kg must be positive, is 0"),
        ("periodic: false", "periodic: 3", r"hand\.path\.periodic: expected true or"),
        ("hand:", "contact: {depth: 3}\nhand:", r"contact\.depth: expected text"),
        ("scale: 1e-3", "scale: -1", r"environment\[0\]\.scale must be positive"),
        (
            "hand:",
            "device: {tick_budget_us: 0}\nhand:",
            r"device\.tick_budget_us must be positive and at most a tick \(1000 µs\)",
        ),
        (
            "hand:",
            "device: {rate_hz: 2000, tick_budget_us: 501}\nhand:",
            r"device\.tick_budget_us must be .* at most a tick \(500 µs\), is 501",
        ),
        (
            "mass_kg",
            "decomposition: merged\n  mass_kg",
            r"decomposition_error_m is miss",
        ),
        ("mass_kg", "decomposition_error_m: 0\n  mass_kg", r"only for .* merged"),
        (
            "mass_kg",
            "decomposition: hul\n  mass_kg",
            r"tool\.decomposition is 'hul'; did you mean 'hull'",
        ),
        ("mass_kg", "chord_error_m: 1e-4\n  mass_kg", r"tool\.chord_error_m is"),
        ("peg.obj", "peg.ob", r"tool\.mesh: .*no such file; did .*'peg\.obj'"),
        ("peg.obj", "no/peg.obj", r"tool\.mesh: .*: there is no folder .*no"),
        ("mesh: peg.obj", "", r"tool\.mesh is missing"),
        (
            "scale: 1e-3",
            "max_triangles: 3",
            r"environment\[0\]\.max_triangles must be 4",
        ),
        (
            "mass_kg",
            "max_triangles: 2.5\n  mass_kg",
            r"max_triangles: expected a whole",
        ),
        (
            "scale: 1e-3",
            "chord_error_m: 0",
            r"\]\.chord_error_m must be positive, is 0",
        ),
        ("[0, 0, 0.04]", "[0, 0]", r"position_m needs 3 numbers, is \[0\.0, 0\.0\]"),
        ("[0, 0, 0.04]", "[0, 0, -1e200]", r"tool\.grasp\.position_m must be within"),
        ("[0.1, 0, 0]", "[1e300, 0, 0]", r"pose\.position_m must be within 1e\+09 m"),
        ("[0, 0, 0.04]", "0.04", r"tool\.grasp\.position_m: expected a list"),
        (
            "- name: plate",
            "- name: a b",
            r"environment\[0\]\.name must be of letters, digits .* is 'a b'",
        ),
        ("time_s: 1.5", "time_s: 0", r"waypoints\[1\]\.time_s must be later"),
        ("time_s: 0,", "time_s: 1,", r"waypoints\[0\]\.time_s must be 0"),
        ("hand:", "contact: {stiffness_N_per_m: -1}\nhand:", r"contact\.stiffness"),
        ("hand:", "contact: {tolerance_m: -1}\nhand:", r"contact\.tolerance_m must"),
        ("hand:", "contact: {cluster_size_m: 0}\nhand:", r"contact\.cluster_size_m"),
        (
            "hand:",
            "contact: {cluster_size_m: 5e-3}\nhand:",
            r"only for clustering: oct",
        ),
        ("hand:", "contact: {clustering: octree}\nhand:", r"cluster_size_m is missing"),
        ("hand:", "contact: {clustering: ocree}\nhand:", r"'ocree'; did you mean 'oct"),
        ("hand:", "contact: {depth: globl}\nhand:", r"'globl'; did you mean 'global'"),
        ("hand:", "contact: {max_walk_steps: 0}\nhand:", r"max_walk_steps must be at"),
        ("hand:", "contact: {max_walk_steps: 1.5}\nhand:", r"expected a whole number"),
        (
            "hand:",
            "contact: {max_walk_steps: 1000000000000}\nhand:",
            r"max_walk_steps must be at least 1 and at most 2,147,483,647, is 1000",
        ),
        ("hand:", "contact: {query_rate_hz: 0}\nhand:", r"at least 20, is 0"),
        (
            "hand:",
            "contact: {query_rate_hz: 300}\nhand:",
            r"query_rate_hz must be device\.rate_hz \(1000\) divided by a whole number,"
            r" is 300; 333\.3333333 is the nearest",
        ),
        (
            "hand:",
            "contact: {query_rate_hz: 2000}\nhand:",
            r"is 2000; 1000 is the near",
        ),
        ("hand:", "effects: {gravty: {}}\nhand:", r"gravty: .* did you mean 'gravity'"),
        ("hand:", "effects: {gravity:}\nhand:", r"gravity: is empty; write {} for"),
        ("hand:", "effects: {gravity: 9.81}\nhand:", r"gravity: expected keys"),
        ("hand:", "coupling: {damping_Ns_per_m: -1}\nhand:", r"coupling\.damping"),
        ("hand:", "device: {rate_hz: 0}\nhand:", r"device\.rate_hz must be from 10 to"),
        (
            "hand:",
            "device: {rate_hz: 1e9}\nhand:",
            r"device\.rate_hz must be from 10 to 100,000, is 1000000000",
        ),
        ("hand:", "device: {servo_rate_hz: 1e9}\nhand:", r"servo_rate_hz .* 100,000"),
        ("hand:", "device: {max_force_N: -1}\nhand:", r"device\.max_force_N must not"),
        ("hand:", "device: 3\nhand:", r"device: expected keys, found 3"),
        (
            "hand:",
            "contact: {tolerance_m: 1e-3}\ncontact:\n  depth: global\nhand:",
            r"contact: given in line \d+ and again in line \d+",
        ),
        ("mass_kg", "scale: 2\n  scale: 1\n  mass_kg", r"tool\.scale: given in line"),
        ("scale: 1e-3", "scale: 1e-3\n  scale: 1", r"environment\[0\]\.scale: given"),
    ],
)
def test_what_is_wrong_is_named_with_file_and_key(tmp_path, old, new, complaint):
    assert old in GOOD
    with pytest.raises(SceneError, match=r"scene\.yaml: .*" + complaint):
        load(tmp_path, GOOD.replace(old, new, 1))


@pytest.mark.parametrize(
    ("effect", "complaint"),
    [
        ("shading: {crease_angle_deg: 181}", "must be between 0 and 180, is 181"),
        ("shading: {crease_angle_deg: -1}", "must be between 0 and 180, is -1"),
        ("friction: {coefficient: -0.1}", "must not be negative, is -0.1"),
        ("friction: {break_away_m: 0}", "must be positive, is 0"),
        ("braking: {damping_Ns_per_m: -1}", "must not be negative"),
        ("braking: {distance_m: 0}", "must be positive, is 0"),
        ("gravity: {acceleration_m_per_s2: [9.81]}", r"needs 3 numbers, is \[9\.81\]"),
        ("passivity: {reserve_J: -1}", "must not be negative, is -1"),
        ("passivity: {max_damping_Ns_per_m: -1}", "must not be negative, is -1"),
    ],
)
def test_a_bad_effect_is_named_with_its_bound(tmp_path, effect, complaint):
    key = effect.replace(": {", ".", 1).split(":")[0]
    with pytest.raises(SceneError, match=rf"effects\.{key}.* {complaint}"):
        load(tmp_path, GOOD.replace("hand:", f"effects: {{{effect}}}\nhand:"))


@pytest.mark.parametrize(
    ("material", "complaint"),
    [
        ("stiffness_N_per_m: -5", "must be positive, is -5"),
        ("damping_Ns_per_m: -5", "must not be negative, is -5"),
        ("friction_coefficient: 0.2", r"means nothing without effects\.friction"),
        ("shading: true", r"means nothing without effects\.shading"),
        ("stifness_N_per_m: 5", "unknown key; did you mean 'stiffness_N_per_m'"),
    ],
)
def test_a_bad_material_is_named_with_its_bound(tmp_path, material, complaint):
    key = material.split(":")[0]
    with pytest.raises(
        SceneError, match=rf"environment\[0\].material.{key}.* {complaint}"
    ):
        load(tmp_path, GOOD.replace("hand:", f"  material: {{{material}}}\nhand:"))


def test_friction_below_zero_is_refused_of_a_material_too(tmp_path):
    given = "  material: {friction_coefficient: -1}\neffects: {friction: {}}\nhand:"
    with pytest.raises(SceneError, match="friction_coefficient must not be negative"):
        load(tmp_path, GOOD.replace("hand:", given))


def test_a_name_used_twice_is_refused(tmp_path):
    twice = GOOD.replace("hand:", "- {name: plate, mesh: b.obj}\nhand:")
    with pytest.raises(SceneError, match="name is used twice: 'plate'"):
        load(tmp_path, twice)


def test_a_scene_needs_something_to_meet_and_a_path(tmp_path):
    with pytest.raises(SceneError, match="environment needs at least one"):
        load(tmp_path, "tool: {mesh: a.obj}")
    with pytest.raises(SceneError, match=r"hand\.path\.waypoints is empty"):
        load(tmp_path, GOOD[: GOOD.index("hand:")])


@pytest.mark.parametrize("text", ["{", "", "[1, 2]", "just words", "\t- x"])
def test_what_is_no_scene_at_all_is_refused(tmp_path, text):
    with pytest.raises(SceneError, match=r"scene\.yaml"):
        load(tmp_path, text)


def test_a_missing_file_is_named():
    with pytest.raises(SceneError, match="nowhere"):
        load_scene("/nowhere.yaml")


def test_shipped_scenes_are_found_by_name_and_can_be_held():
    scenes = list_scenes()
    assert {"cup_spoon", "torus_peg", "hammer_block", "sphere_pen"} <= set(scenes)
    for name, path in scenes.items():
        assert find_scene(name) == path
        scene = load_scene(path)
        assert scene.description
        make_simulated_device(scene, make_hand_path(scene.hand.path))


def test_a_path_is_a_scene_too(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(GOOD)
    assert find_scene(str(path)) == path


def test_an_unknown_scene_is_answered_with_those_there_are():
    with pytest.raises(SceneError, match=r"'cup_spon' is neither.*cup_spoon"):
        find_scene("cup_spon")


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"preset": "omega"}, r"device\.preset: 'omega' is not one of .*'omega_6'"),
        ({"base": Pose([1.0, 0, 0])}, "from the middle of the device's workspace"),
    ],
)
def test_a_device_that_cannot_hold_it_is_refused(tmp_path, change, complaint):
    scene = load(tmp_path, GOOD)
    scene.device = DeviceParameters(**change)
    with pytest.raises(SceneError, match=complaint):
        make_simulated_device(scene, make_hand_path(scene.hand.path))


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("[0, 0, 0.05]", "[0, 0.3, 0]", r"radius is 0\.12 m"),
        ("grip: light", "grip: iron", r"hand\.grip: 'iron' is not one of none"),
    ],
)
def test_a_hand_that_cannot_hold_the_device_is_refused(tmp_path, old, new, complaint):
    scene = load(tmp_path, GOOD.replace(old, new))
    with pytest.raises(SceneError, match=complaint):
        make_simulated_device(scene, make_hand_path(scene.hand.path))


def test_a_path_that_turns_too_far_is_refused():
    path = HandPathParameters(waypoints=[Waypoint(0), Waypoint(1, rpy_deg=[0, 0, 150])])
    with pytest.raises(SceneError, match=r"hand\.path\.waypoints: .* 0 and 1"):
        make_hand_path(path)


def test_default_coupling_is_stable_on_the_shipped_device():
    # Gil et al.: K < (b + B) / (T / 2) without further delay; the arm gives almost
    # no damping of its own, and the hand's is left out, so this is the worst case.
    coupling = CouplingParameters()
    half_tick = 0.5 / DeviceParameters().rate_hz
    assert coupling.stiffness_N_per_m < 0.5 * coupling.damping_Ns_per_m / half_tick
    assert (
        coupling.rotational_stiffness_Nm_per_rad
        < 0.5 * coupling.rotational_damping_Nms_per_rad / half_tick
    )
    # Sampled damping itself is bounded: B T / m of the lightest handle motion.
    assert coupling.damping_Ns_per_m / DeviceParameters().rate_hz / 0.12 < 0.2


def test_a_mesh_may_come_from_drake(tmp_path):
    url = "package://drake/examples/kuka_iiwa_arm/models/objects/open_top_box.urdf"
    text = GOOD.replace("package://drake_haptics/models/meshes/block.obj", url)
    assert Path(load(tmp_path, text).environment[0].mesh).is_file()


def test_an_unknown_package_is_refused(tmp_path):
    text = GOOD.replace("package://drake_haptics/", "package://drak/")
    with pytest.raises(SceneError, match=r"no package 'drak'; known: .*drake_haptics"):
        load(tmp_path, text)


def test_a_name_that_a_scene_does_not_have_cannot_be_set():
    """It would be silent otherwise: the value that was meant stays as it was."""
    scene = load_scene(find_scene("cup_spoon"))
    parts = (scene, scene.contact, scene.coupling, scene.device, scene.effects)
    for part in (
        *parts,
        scene.hand.path.waypoints[0],
        FrictionParameters(),
        DeviceImperfections(),
    ):
        with pytest.raises(AttributeError, match="stiffnes_N_per_m"):
            part.stiffnes_N_per_m = 1.0


def test_the_name_of_a_shipped_scene_is_no_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SceneError, match=r"load_scene\(find_scene\('cup_spoon'\)\)"):
        load_scene("cup_spoon")
    Path("cup_spoon").write_text("tool: {}")
    with pytest.raises(SceneError, match=r"tool\.mesh is missing"):
        load_scene("cup_spoon")
