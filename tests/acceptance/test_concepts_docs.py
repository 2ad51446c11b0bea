"""What docs/concepts.md names exists, and its pictures are made by their command."""

import importlib.util
import re
from functools import reduce
from pathlib import Path

import matplotlib as mpl
import pytest
from markdown_page import find_spans

import drake_haptics
from drake_haptics import _core
from drake_haptics.device import gate
from drake_haptics.scene.schema import Scene

DOCS = Path(__file__).parents[2] / "docs"
TEXT = (DOCS / "concepts.md").read_text(encoding="utf-8")
# Of each section the paragraph of names, without the titles of its links.
NAMES = [
    name
    for paragraph in re.findall(r"(?ms)^API: (.*?)(?= More:|\n\n)", TEXT)
    for name in find_spans(paragraph)
]


def has_scene_key(name):
    """Whether a scene has a key, `contact.depth` or `effects:`."""
    part = Scene()
    for key in name.removesuffix(":").split("."):
        if not hasattr(part, key):
            return False
        part = getattr(part, key)
    return True


@pytest.mark.parametrize("name", NAMES)
def test_names_are_keys_of_a_scene_or_names_of_the_package(name):
    assert has_scene_key(name) or any(
        reduce(lambda part, key: getattr(part, key, None), name.split("."), place)
        for place in (drake_haptics, _core, gate)
    )


@pytest.fixture(scope="module")
def maker():
    """The program that makes the pictures."""
    file = DOCS / "generate" / "make_concept_pictures.py"
    specification = importlib.util.spec_from_file_location(file.stem, file)
    module = importlib.util.module_from_spec(specification)
    with mpl.rc_context():
        specification.loader.exec_module(module)
        yield module


def test_the_pictures_are_those_of_the_command(maker, tmp_path, monkeypatch):
    monkeypatch.setattr(maker, "_FOLDER", tmp_path)
    maker.main()
    made = sorted(file.name for file in tmp_path.iterdir())
    assert made == sorted(file.name for file in DOCS.glob("concept_*"))
    assert made == sorted(re.findall(r"\((concept_\w+\.png)\)", TEXT))
