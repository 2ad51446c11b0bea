"""What docs/geometry.md shows runs, and prints what it says."""

import re
from pathlib import Path

import pytest
from markdown_page import find_blocks, run_snippets

import drake_haptics

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "geometry.md").read_text(encoding="utf-8")
NAMES_OF_OTHERS = ("SignedDistancePair", "RigidTransform", "ValueError")


@pytest.fixture(scope="module")
def printed():
    """What each snippet prints."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        return [values for (values,) in run_snippets(TEXT)]


def test_each_snippet_is_ten_lines_or_less():
    snippets = [block for block in find_blocks(TEXT) if block.language == "python"]
    assert len(snippets) == 5
    for snippet in snippets:
        assert len([line for line in snippet.text.splitlines() if line.strip()]) <= 10


def test_a_pair(printed):
    distance, normal, status = printed[0]
    assert distance == pytest.approx(-0.01, abs=1e-12)
    assert tuple(normal) == (0, 0, 1)
    assert status == "PENETRATING"


def test_a_trajectory(printed):
    least, seconds = printed[1]
    assert least == pytest.approx(-0.1, abs=1e-12)
    assert 0 < seconds < 1e-5


def test_two_meshes(printed):
    distance, piece, feature = printed[2]
    assert len(distance) == len(piece) == len(feature) > 0
    assert distance.min() == pytest.approx(-0.0007, abs=5e-5)


def test_a_scene(printed):
    objects, distance = printed[3]
    assert set(objects) == {1}
    assert distance.min() == pytest.approx(-0.0007, abs=5e-5)


def test_depths_of_two_kinds(printed):
    assert printed[4] == pytest.approx([-0.0007, -0.0007], abs=5e-5)


def test_names_in_the_text_exist():
    enums = (drake_haptics.ContactStatus, drake_haptics.FeatureKind)
    known = [*drake_haptics.__all__, *(item.name for enum in enums for item in enum)]
    for name in re.findall(r"`([A-Z]\w+)[.(`]", TEXT):
        assert name in known or name in NAMES_OF_OTHERS
