"""Keys of scene files that pages show or name are those that a scene has."""

import re
import typing
from dataclasses import is_dataclass
from pathlib import Path

import pytest
from markdown_page import find_blocks, find_spans
from pydrake.common.yaml import yaml_load

from drake_haptics import Contact, HapticRenderingConfig
from drake_haptics.scene.device_preset import DevicePreset
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import SceneError
from drake_haptics.scene.yaml_loading import check_keys

ROOT = Path(__file__).parents[2]
PAGES = sorted([*(ROOT / "docs").rglob("*.md"), ROOT / "README.md"])
PARTS = "|".join(typing.get_type_hints(Scene))
_KEY = re.compile(rf"(?:{PARTS})(?:\.[a-z][\w]*)+$")
# The variable `contact` of snippets is another one.
NO_KEYS = {f"contact.{name}" for name in vars(Contact)}

BLOCKS = [
    pytest.param(block.text, id=f"{page.name}, line {block.line}")
    for page in PAGES
    for block in find_blocks(page.read_text(encoding="utf-8"))
    if block.language == "yaml"
]
KEYS = [
    pytest.param(span.split(":")[0], id=f"{page.name}: {span}")
    for page in PAGES
    for span in sorted({*find_spans(page.read_text(encoding="utf-8"))})
    if _KEY.match(span.split(":")[0]) and span not in NO_KEYS
]


def find_schema(key):
    """Returns the type of a key of a scene; `environment.` is each object."""
    schema = Scene
    for name in key.split("."):
        kind = typing.get_type_hints(schema)[name]
        inner = [part for part in (kind, *typing.get_args(kind)) if is_dataclass(part)]
        schema = inner[0] if inner else kind
    return schema


@pytest.mark.parametrize("text", BLOCKS)
def test_parts_of_files_have_known_keys(text):
    data = yaml_load(data=text)
    # What no scene has tells the other kinds of files.
    others = {"model": DevicePreset, "tool_body": HapticRenderingConfig}
    found = [schema for key, schema in others.items() if key in data]
    check_keys(*(found or [Scene]), data)


@pytest.mark.parametrize("key", KEYS)
def test_keys_that_sentences_name_are_known(key):
    find_schema(key)


def test_a_key_that_is_none_is_found_out():
    with pytest.raises(KeyError):
        find_schema("contact.stifness_N_per_m")
    with pytest.raises(SceneError, match="stifness"):
        check_keys(Scene, {"contact": {"stifness_N_per_m": 1}})
    assert find_schema("environment.material.friction_coefficient") is not None
