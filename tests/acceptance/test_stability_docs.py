"""What docs/stability.md shows runs, and prints what it says."""

import re
import textwrap
from pathlib import Path

import pytest
from held_samples import skip_search

from drake_haptics.analysis import scene_stability
from drake_haptics.bounds.sampled_spring import calc_stable_stiffness
from drake_haptics.scene.validation import SceneWarning

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "stability.md").read_text(encoding="utf-8")
COUPLING, SCENE, PLANT, *_ = (
    textwrap.dedent(snippet)
    for snippet in re.findall(r"(?ms)^ *```python\n(.*?)^ *```$", TEXT)
)


def run(snippet, capsys):
    exec(compile(snippet, "stability.md", "exec"), {})
    return capsys.readouterr().out.splitlines()


def test_a_scene(capsys, monkeypatch):
    monkeypatch.setattr(scene_stability, "find_stiffness_limits", skip_search)
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


def test_a_plant_of_your_own(capsys):
    """An explicit step holds 4 m/h², 400,000 N/m here, less what damping takes."""
    (mode,) = run(PLANT, capsys)
    assert "dies out in" in mode
    (mode,) = run(PLANT.replace("2e3", "3.8e5"), capsys)
    assert "dies out in" in mode
    with pytest.warns(SceneWarning, match="time_step"):
        least_stable, *_ = run(PLANT.replace("2e3", "4.1e5"), capsys)
    assert "unstable" in least_stable


@pytest.mark.parametrize("name", re.findall(r"`((?:docs|tests)/[\w/]+\.py)`", TEXT))
def test_files_that_are_named_exist(name):
    assert (ROOT / name).is_file()
