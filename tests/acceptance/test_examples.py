"""Every example runs, and what it prints agrees with what is known otherwise."""

import re
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from drake_haptics import find_scene, load_scene

EXAMPLES = Path(__file__).parents[2] / "examples"
NAMES = sorted(path.name for path in EXAMPLES.glob("*.py"))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Runs an example once and returns what it prints."""
    store = tmp_path_factory.mktemp("study") / "study.jsonl"
    arguments = {"cup_and_spoon.py": ["0.5"], "peg_stability_study.py": [str(store)]}
    printed = {}

    def run_once(name):
        if name not in printed:
            process = subprocess.run(
                [sys.executable, EXAMPLES / name, *arguments.get(name, [])],
                capture_output=True,
                text=True,
                timeout=600,
            )
            assert process.returncode == 0, process.stderr
            assert all(
                "Meshcat listening" in line for line in process.stderr.splitlines()
            )
            printed[name] = process.stdout
        return printed[name]

    return run_once


@pytest.mark.parametrize("name", NAMES)
def test_example_runs(name, run):
    text = (EXAMPLES / name).read_text(encoding="utf-8")
    assert f"\n    python examples/{name}" in text
    assert run(name)


def test_the_study_that_is_interrupted_says_what_is_done(monkeypatch):
    def interrupt(scene):
        raise KeyboardInterrupt("Stopped. 3 of 27 tasks are done.")

    monkeypatch.setattr("drake_haptics.analysis.hold_scene", interrupt)
    monkeypatch.setattr(sys, "argv", ["peg_stability_study.py"])
    with pytest.raises(SystemExit, match=r"3 of 27 tasks"):
        runpy.run_path(str(EXAMPLES / "peg_stability_study.py"), run_name="__main__")


@pytest.mark.parametrize(
    "name", ["arm_holding_a_tool.py", "cup_and_spoon.py", "peg_stability_study.py"]
)
@pytest.mark.parametrize(("option", "code"), [("--help", 0), ("--nope", 2)])
def test_an_example_with_arguments_tells_of_them_and_does_nothing_else(
    name, option, code, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [name, option])
    with pytest.raises(SystemExit) as end:
        runpy.run_path(str(EXAMPLES / name), run_name="__main__")
    assert end.value.code == code
    said = capsys.readouterr()
    assert (said.err if code else said.out).startswith(f"usage: {name}")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", NAMES)
def test_example_is_short(name):
    assert len((EXAMPLES / name).read_text(encoding="utf-8").splitlines()) < 100


def test_every_example_is_in_the_list():
    listed = re.findall(
        r"\]\((\w+\.\w+)\)", (EXAMPLES / "README.md").read_text("utf-8")
    )
    found = [path.name for path in EXAMPLES.iterdir() if path.suffix in (".py", ".c")]
    assert sorted(listed) == sorted(found)


def test_the_pen_touches_the_ring_on_both_sides_of_its_hole(run):
    edges_mm = numbers(
        r"from x = (\S+) mm to (\S+) mm", run("contact_query_without_drake.py")
    )
    # The ring's hole has a radius of 22 mm, the ring one of 46 mm, the pen of 4.5 mm;
    # all three are polygons that are drawn inside of those circles.
    np.testing.assert_allclose(edges_mm, [[-50.5, -17.5], [17.5, 50.5]], atol=0.16)


def test_the_loop_of_the_cup_ticks_once_in_a_millisecond(run):
    (ticks,) = numbers(r"(\d+) ticks of \d+ µs", run("cup_and_spoon.py"))
    assert ticks == pytest.approx(500, abs=1)


def test_a_softer_wall_is_penetrated_deeper(run):
    rows = [line.split() for line in run("softer_wall.py").splitlines()[1:]]
    depths_mm = [float(row[2]) for row in rows]
    assert depths_mm[0] < depths_mm[1] < depths_mm[2]
    tolerance_mm = 1e3 * load_scene(find_scene("torus_peg")).contact.tolerance_m
    for stiffness, force_N, depth_mm in (map(float, row) for row in rows):
        # Two springs in a row; contact also carries the tool's inertia, less than 5 %.
        deepest_mm = 1.05 * 1e3 * force_N / stiffness
        assert depth_mm <= max(0.0, deepest_mm - tolerance_mm) + 0.01
    # Softer than the coupling of 800 N/m: most of the hand's way goes into the contact.
    assert depths_mm[2] > 2.0


def numbers(pattern, text):
    """Returns the groups of each match as numbers."""
    return np.array(re.findall(pattern, text), dtype=float)


def test_ones_own_device_comes_to_rest_between_three_springs(run):
    printed = run("device_of_your_own.py")
    (height_mm,) = numbers(r"handle (\S+) mm", printed)
    (force_N,) = numbers(r"with (\S+) N", printed)
    # From 10 mm below the block's top to 2 mm above it, where contact begins.
    expected_N = 12e-3 / (1 / 300.0 + 1 / 800.0 + 1 / 2e4)
    assert force_N == pytest.approx(expected_N, abs=1e-3)
    assert height_mm == pytest.approx(-10.0 + 1e3 * expected_N / 300.0, abs=0.01)


def test_the_arms_pen_leans_on_the_inside_of_the_ring(run):
    printed = run("arm_holding_a_tool.py")
    (free, pressed) = numbers(
        r"\((\S+), (\S+), (\S+)\) mm, pushed with (\S+) N", printed
    )
    np.testing.assert_array_equal(free, [0.0, 0.0, -30.0, 0.0])
    # A hole of radius 22 mm, a pen of 4.5 mm, contact from 2 mm on at 5 N/mm.
    distance_mm, force_N = np.linalg.norm(pressed[:2]), pressed[3]
    assert distance_mm == pytest.approx(22.0 - 4.5 - 2.0 + force_N / 5.0, abs=0.1)
    assert force_N > 1.0


def test_the_arms_lift_swings_as_a_mass_on_a_spring_and_damper(run):
    """50 g, 200 N/m and 5 N·s/m; contact sideways has no part in it."""
    lift = numbers(
        r"(\S+) Hz, damped (\S+) % of critical, dies out in (\S+) s; .*lift_x",
        run("arm_holding_a_tool.py"),
    )
    m, k, d = 0.05, 200.0, 5.0
    expected = [
        np.sqrt(k / m - (d / (2 * m)) ** 2) / (2 * np.pi),
        100 * d / (2 * np.sqrt(k * m)),
        -np.log(0.02) * 2 * m / d,
    ]
    assert len(lift) == 2
    # The plant takes steps of 1 ms, of first order.
    np.testing.assert_allclose(lift, [expected, expected], rtol=0.06)


def test_contact_makes_the_arm_swing_faster(run):
    free, pressed = run("arm_holding_a_tool.py").split("Shoulder turned")
    fastest = [numbers(r"(\S+) Hz", part).max() for part in (free, pressed)]
    assert fastest[1] > 2 * fastest[0]


def test_the_designed_coupling_is_within_the_law_and_stable(run):
    printed = run("design_a_coupling.py")
    ((stiffness, damping),) = numbers(
        r"designed coupling, (\S+) N/m and (\S+) N·s/m", printed
    )
    assert stiffness <= 800.0
    # Half of (b + B)/(T/2), as if the device had no damping of its own.
    assert 0 < stiffness <= damping / 5e-4 / 2
    growth = numbers(r"multiplied by (\S+) in each tick", printed)
    assert growth.shape == (2,)
    assert (0.9 < growth).all()
    assert (growth < 1.0).all()


def test_the_studys_limits_rise_with_damping_above_those_of_a_rigid_wall(run):
    rows = numbers(r"(?m)^ +(\d+\.\d) +(\d+)$", run("peg_stability_study.py"))
    damping, stiffness = rows.T
    np.testing.assert_array_equal(damping, [0.0, 2.0, 4.0])
    assert (np.diff(stiffness) > 0).all()
    # (b + B)/(T/2) with the hand's damping b of 1 N·s/m holds for a tool that does not
    # move; this one is of 80 g and gives way.
    law = (1.0 + damping) / 5e-4
    assert (stiffness > law).all()
    assert (stiffness < 4 * law).all()
