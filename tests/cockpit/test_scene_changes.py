"""What people make of a scene, and how its file says so."""

import pytest
import yaml

from drake_haptics.cockpit.scene_changes import EFFECTS, ChangeError, SceneChanges
from drake_haptics.scene.library import find_scene, list_scenes
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.web.process import write_changes

EVERYTHING = [
    {"do": "set", "key": "coupling.stiffness_N_per_m", "to": 1000},
    {"do": "set", "key": "contact.tolerance_m", "to": 1.25e-3},
    {"do": "choose", "key": "contact.clustering", "to": "octree"},
    {"do": "set", "key": "contact.cluster_size_m", "to": 1e-2},
    *({"do": "effect", "name": name, "on": True} for name in EFFECTS),
    {"do": "set", "key": "effects.friction.break_away_m", "to": 2e-4},
    {"do": "set", "key": "effects.braking.distance_m", "to": 5e-3},
    {"do": "effect", "name": "gravity", "on": False},
]
OF_SPRINGS = ("shading", "braking")


@pytest.fixture
def changes():
    return SceneChanges(load_scene(find_scene("cup_spoon")))


def paste(name, changes, folder):
    """Returns a shipped scene with what was changed put into its file."""
    file = find_scene(name)
    data = yaml.safe_load(file.read_text())
    for section, keys in yaml.safe_load(write_changes(changes)).items():
        # Values of a section are replaced one by one, effects as a whole.
        whole = section == "effects"
        data[section] = keys if whole else {**data.get(section, {}), **keys}
    for item in [data["tool"], *data["environment"]]:
        if not item["mesh"].startswith("package:"):
            item["mesh"] = str((file.parent / item["mesh"]).resolve())
    pasted = folder / "pasted.yaml"
    pasted.write_text(yaml.safe_dump(data))
    return load_scene(pasted)


@pytest.mark.parametrize("count", range(len(EVERYTHING) + 1))
def test_the_changes_pasted_into_the_file_give_the_scene(changes, tmp_path, count):
    for request in EVERYTHING[:count]:
        changes.obey(request)
    told = changes.describe()["changes"]
    assert bool(told) == (count > 0)
    if told:
        assert paste("cup_spoon", told, tmp_path) == changes.scene


@pytest.mark.parametrize("name", list_scenes())
def test_every_shipped_scene_can_be_changed_and_taken_back(name, tmp_path):
    scene = load_scene(find_scene(name))
    changes = SceneChanges(scene)
    done = 0
    for request in EVERYTHING:
        try:
            changes.obey(request)
            done += 1
        except ChangeError:
            # All that is of springs, and no more, where contact has none.
            assert scene.contact.law == "constraint"
            of = request.get("key") or f"effects.{request['name']}"
            assert of.startswith(("contact.", *(f"effects.{n}" for n in OF_SPRINGS)))
    assert done >= 4
    assert paste(name, changes.describe()["changes"], tmp_path) == changes.scene
    changes.obey({"do": "reset"})
    assert changes.scene == scene
    assert changes.describe()["changes"] == {}


@pytest.mark.parametrize("name", OF_SPRINGS)
def test_what_does_nothing_under_the_scenes_law_is_refused(name):
    scene = load_scene(find_scene("peg_in_hole"))
    changes = SceneChanges(scene)
    with pytest.raises(ChangeError, match=rf"effects\.{name} does nothing"):
        changes.switch_effect(name, True)
    with pytest.raises(ChangeError, match="does nothing under"):
        changes.choose("contact.clustering", "octree")
    assert changes.scene == scene


def test_only_what_differs_is_told(changes):
    changes.obey(EVERYTHING[0])
    changes.obey({"do": "set", "key": "contact.damping_Ns_per_m", "to": 7})
    changes.obey({"do": "set", "key": "contact.damping_Ns_per_m", "to": 5})
    assert changes.describe()["changes"] == {"coupling": {"stiffness_N_per_m": 1000.0}}


def test_it_tells_how_things_are(changes):
    changes.obey(EVERYTHING[0])
    changes.obey({"do": "effect", "name": "friction", "on": True})
    told = changes.describe()
    assert told["values"]["coupling.stiffness_N_per_m"] == 1000.0
    assert told["values"]["contact.tolerance_m"] == 5e-4
    assert told["choices"] == {"contact.clustering": "shared"}
    assert told["effects"] == {name: name == "friction" for name in EFFECTS}


def test_the_size_of_clusters_can_be_set_where_there_are_some(changes):
    def keys():
        return [item.key for item in changes.list_keys()]

    assert "contact.cluster_size_m" not in keys()
    changes.choose("contact.clustering", "octree")
    assert "contact.cluster_size_m" in keys()
    changes.choose("contact.clustering", "octree")
    changes.choose("contact.clustering", "shared")
    assert "contact.cluster_size_m" not in keys()
    assert changes.scene == changes.file


def test_a_size_that_the_file_does_not_have_goes_back_to_what_octree_brought(changes):
    assert changes.file.contact.cluster_size_m is None
    changes.choose("contact.clustering", "octree")
    (size,) = (k for k in changes.list_keys() if k.key == "contact.cluster_size_m")
    changes.set(size.key, 0.02)
    assert changes.read_file(size) == 5e-3
    changes.set(size.key, changes.read_file(size))
    changes.choose("contact.clustering", "shared")
    assert changes.scene == changes.file


def test_an_effect_comes_back_as_the_file_has_it(changes):
    changes = SceneChanges(load_scene(find_scene("rubbed_sphere")))
    for on in (False, True):
        changes.switch_effect("friction", on)
    assert changes.scene == changes.file


def test_a_material_without_its_effect_says_nothing_of_it():
    changes = SceneChanges(load_scene(find_scene("cup_spoon")))
    changes.switch_effect("friction", True)
    material = changes.scene.environment[0].material
    material.friction_coefficient = 0.7
    changes = SceneChanges(changes.scene)
    changes.switch_effect("friction", False)
    assert changes.scene.environment[0].material.friction_coefficient is None
    changes.switch_effect("friction", True)
    assert changes.scene == changes.file


def test_ranges_stay_where_the_file_has_them(changes):
    before = changes.list_keys()
    changes.set("coupling.stiffness_N_per_m", 5000)
    changes.set("coupling.stiffness_N_per_m", 50)
    changes.choose("contact.clustering", "octree")
    assert changes.list_keys()[: len(before)] == before


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ({"do": "set", "key": "coupling.stiffness_N_per_m", "to": 1e300}, "from 50 to"),
        ({"do": "set", "key": "coupling.stiffness_N_per_m", "to": -1}, "is -1"),
        ({"do": "set", "key": "contact.cluster_size_m", "to": 1e-3}, "no value"),
        ({"do": "set", "key": "tool.mass_kg", "to": 1}, "no value"),
        ({"do": "set", "key": "", "to": 1}, "no value"),
        ({"do": "choose", "key": "contact.clustering", "to": "none"}, "no choice"),
        ({"do": "choose", "key": "contact.depth", "to": "global"}, "no choice"),
        ({"do": "effect", "name": "magic", "on": True}, "no effect"),
        ({"do": "effect", "name": "__class__", "on": False}, "no effect"),
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(changes, request_, message):
    with pytest.raises(ChangeError, match=message):
        changes.obey(request_)
    assert changes.scene is changes.file


def test_values_of_an_effect_can_be_set_while_it_is_on(changes):
    key = "effects.friction.coefficient"

    def find():
        return [item for item in changes.list_keys() if item.key == key]

    assert find() == []
    with pytest.raises(ChangeError, match="no value"):
        changes.set(key, 0.5)
    changes.switch_effect("friction", True)
    [item] = find()
    # What the file does not name is at its default.
    assert changes.read_file(item) == item.read(changes.scene) == 0.3
    changes.set(key, 0.5)
    assert changes.scene.effects.friction.coefficient == 0.5
    assert find() == [item]
    with pytest.raises(ChangeError, match="from 0 to 1, is 2"):
        changes.set(key, 2.0)
    changes.switch_effect("friction", False)
    assert find() == []


def test_a_coefficient_that_every_material_overrides_is_not_offered(changes):
    changes.switch_effect("friction", True)
    for item in changes.scene.environment:
        item.material.friction_coefficient = 0.2
    changes.restore(changes.scene)
    keys = {item.key for item in changes.list_keys()}
    assert "effects.friction.break_away_m" in keys
    assert "effects.friction.coefficient" not in keys
