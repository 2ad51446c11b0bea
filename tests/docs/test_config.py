"""The pages of scene and device files: all keys, and examples that can be loaded."""

import dataclasses
import re
import typing
from pathlib import Path

import pytest
import yaml
from config_keys import list_parts
from config_reference import FILES
from config_rules import find_rules

from drake_haptics import BuildHapticDiagram, HapticsError, load_scene, run
from drake_haptics.authoring.plausibility import make_start_warnings
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS

DOCS = Path(__file__).parents[2] / "docs"


def list_keys(schema: typing.Any) -> set[str]:
    """Returns the names of all keys below a dataclass."""
    names = set()
    for kind in typing.get_type_hints(schema).values():
        inner = [kind, *typing.get_args(kind)]
        for item in filter(dataclasses.is_dataclass, inner):
            names |= list_keys(item)
    return names | {field.name for field in dataclasses.fields(schema)}


@pytest.mark.parametrize("kind", FILES)
def test_the_page_has_every_key_with_words(kind):
    parts = list(list_parts(FILES[kind].schema))
    keys = [key for part in parts for key in part.keys]
    names = {key.name for key in keys}
    names |= {part.path.rpartition(".")[2].removesuffix("[]") for part in parts}
    assert names - {""} == list_keys(FILES[kind].schema)
    assert all(key.text and key.type_words for key in keys)
    assert all(part.text for part in parts if part.path)


@pytest.mark.parametrize("kind", FILES)
def test_the_example_has_every_key_and_can_be_loaded(kind):
    example = DOCS / FILES[kind].example
    FILES[kind].load(example)
    keys = re.findall(r"(?:^|[ {])(\w+): ", example.read_text() + " ", re.MULTILINE)
    keys += re.findall(
        r"^ *(?:- )?(\w+):$", re.sub(" *#.*", "", example.read_text()), re.M
    )
    assert set(keys) >= list_keys(FILES[kind].schema)


def test_the_example_runs_and_is_felt():
    haptic = BuildHapticDiagram(load_scene(DOCS / FILES["scene"].example))
    assert run(haptic, duration_s=1.2).to_dict()["max_force_N"] > 0.1


def test_the_small_example_comes_from_outside_and_is_felt(tmp_path):
    page = (DOCS / "reference" / "scene-file.md").read_text()
    (text,) = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    meshes = DOCS.parent / "models" / "meshes"
    file = tmp_path / "scene.yaml"
    file.write_text(re.sub(r"\w+\.obj", lambda mesh: str(meshes / mesh[0]), text))
    haptic = BuildHapticDiagram(load_scene(file))
    assert not make_start_warnings(haptic)
    assert 1.0 < run(haptic, duration_s=1.5).max_force_N < 8.0, "below the limit"


@pytest.fixture(scope="module")
def scene_rules():
    return find_rules(FILES["scene"].load, DOCS / FILES["scene"].example)


def test_the_words_are_those_that_are_known(scene_rules):
    page = (DOCS / "reference" / "scene-file.md").read_text()
    (table,) = re.findall(r"\| key \| value .*?\n\n", page, re.DOTALL)
    cells = [line.split("|")[2] for line in table.splitlines() if line]
    words = re.findall(r"`(\w+)`", " ".join(cells))
    keys = ("tool.decomposition", "contact.clustering", "contact.depth")
    known = [*(scene_rules[key] for key in keys), f"known: {', '.join(HAND_GRIPS)}"]
    expected = ", ".join(text.removeprefix("known: ") for text in known)
    assert words == expected.split(", ")


def test_rules_are_what_the_program_says(scene_rules, tmp_path):
    assert scene_rules["contact.stiffness_N_per_m"] == "must be positive"
    assert scene_rules["contact.depth"] == "known: tracked, global"
    assert scene_rules["tool.mesh"] == "is missing"
    time_rule = scene_rules["hand.path.waypoints[].time_s"]
    assert time_rule == "must be later than the one before"
    assert "device.twin" not in scene_rules

    def load(path):
        if yaml.safe_load(path.read_text())["a"] < 0:
            raise HapticsError(f"{path}: a must be 0 or more, is -1")

    example = tmp_path / "a.yaml"
    example.write_text("a: 1.0\nb: 1.0")
    assert find_rules(load, example) == {"a": "must be 0 or more"}


def test_a_type_without_words_is_refused():
    schema = dataclasses.make_dataclass("S", [("a", dict[str, int])])
    with pytest.raises(TypeError, match="no words"):
        list(list_parts(schema))
