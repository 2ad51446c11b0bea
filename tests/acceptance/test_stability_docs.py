"""What docs/stability.md shows runs, and prints what it says."""

import re
import textwrap
from pathlib import Path

import pytest

from drake_haptics.bounds.sampled_spring import calc_stable_stiffness

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "stability.md").read_text(encoding="utf-8")
COUPLING, SCENE, DIAGRAM, *_ = (
    textwrap.dedent(snippet)
    for snippet in re.findall(r"(?ms)^ *```python\n(.*?)^ *```$", TEXT)
)


def run(snippet, capsys):
    exec(compile(snippet, "stability.md", "exec"), {})
    return capsys.readouterr().out.splitlines()


def test_a_scene(capsys):
    *limits, slowest = run(SCENE, capsys)
    found = [
        re.fullmatch(r"(\w+, [\w ]+): stable up to [\d.e+]+ (.*)", line).groups()
        for line in limits
    ]
    assert found == [
        ("translation, this contact", "N/m"),
        ("rotation, this contact", "N·m/rad"),
        ("translation, a rigid wall", "N/m"),
        ("rotation, a rigid wall", "N·m/rad"),
    ]
    assert "dies out in" in slowest


def test_the_coupling_of_a_handle_has_half_of_what_the_formula_allows(capsys):
    """Or less, for its margin in every grip."""
    printed = "\n".join(run(COUPLING, capsys))
    stiffness = float(re.search(r"(?m)^stiffness ([\d.]+) N/m, limited by", printed)[1])
    damping = float(re.search(r"(?m)^damping ([\d.]+) N·s/m", printed)[1])
    allowed = calc_stable_stiffness(0.5, damping, 1e-3, 1e-3)
    assert 0.2 * allowed < stiffness <= 0.5 * allowed * (1 + 1e-3)


def test_what_a_tick_of_delay_and_the_rate_give():
    def stiffest(period_s, ticks):
        return calc_stable_stiffness(5.0, 2.0, period_s, ticks * period_s)

    assert stiffest(1e-3, 0) == pytest.approx(3.0 * stiffest(1e-3, 1))
    assert stiffest(5e-4, 1) == pytest.approx(2.0 * stiffest(1e-3, 1))


def test_any_diagram(capsys):
    radius, slowest = run(DIAGRAM, capsys)
    # Colgate and Schenkel's 2 b/T is 1000 N/m here: 900 is just stable.
    assert 0.999 < float(radius.split()[-1]) < 1.0
    assert slowest.startswith("15.1 Hz") or slowest.startswith("15 Hz")


@pytest.mark.parametrize("name", re.findall(r"`((?:docs|tests)/[\w/]+\.py)`", TEXT))
def test_files_that_are_named_exist(name):
    assert (ROOT / name).is_file()
