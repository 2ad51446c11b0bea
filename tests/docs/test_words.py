"""The page of words knows the ending of every key, and what it names is there."""

import re
from pathlib import Path

import pytest
import yaml

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "concepts.md").read_text(encoding="utf-8")
UNITS = PAGE.partition("## Units")[2].partition("## Symbols")[0]
ENDINGS = tuple(
    ending
    for row in re.findall(r"(?m)^\| (`_.+?) \|", UNITS)
    for ending in re.findall(r"`(_\w+)`", row)
)
# Numbers of things, and ratios.
WITHOUT_UNIT = {
    "actuated_axes",
    "coefficient",
    "friction_coefficient",
    "joint_per_motor",
    "max_triangles",
    "max_walk_steps",
    "samples",
    "scale",
    "velocity_window",
}


def find_numeric_keys(value, key=""):
    """Yields the keys of numbers, and of lists of them, in a file."""
    if isinstance(value, dict):
        for name, part in value.items():
            yield from find_numeric_keys(part, name)
    elif isinstance(value, list):
        for part in value:
            yield from find_numeric_keys(part, key)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield key


@pytest.mark.parametrize("name", ["every-key.yaml", "every-key-of-a-device.yaml"])
def test_the_ending_of_every_key_is_explained(name):
    text = (DOCS / "reference" / name).read_text(encoding="utf-8")
    keys = set(find_numeric_keys(yaml.safe_load(text)))
    assert len(keys) > 10
    assert not {key for key in keys - WITHOUT_UNIT if not key.endswith(ENDINGS)}


def test_words_are_in_the_order_of_the_alphabet():
    section = PAGE.partition("## Words\n")[2]
    tables = re.findall(r"(?m)(?:^\|.*\n)+", section)
    assert len(tables) == 2
    for table in tables:
        words = re.findall(r"(?m)^\| ([^|]+?) \|", table)[1:]
        assert len(words) > 10
        assert words == sorted(words, key=str.casefold)


@pytest.mark.parametrize(
    "key",
    sorted(set(re.findall(r"`((?:contact|coupling|device|hand|tool)\.\w+)", PAGE))),
)
def test_keys_are_those_of_a_scene(key):
    text = (DOCS / "reference" / "every-key.yaml").read_text(encoding="utf-8")
    section, name = key.split(".")
    assert name in yaml.safe_load(text)[section]
