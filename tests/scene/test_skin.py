"""What is said of contact that is deeper than its skin, and which speed skips it."""

from __future__ import annotations

import json
import re
import warnings
from contextlib import contextmanager

import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate
from click.testing import CliRunner
from plant_scenes import over_a_slab
from pydrake.geometry import Box
from pydrake.math import RigidTransform

from drake_haptics.cli import endings, main, run_session
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.scene_file import write_scene
from drake_haptics.scene.schema import BrakingParameters, ContactParameters, Effects
from drake_haptics.scene.validation import SceneWarning
from drake_haptics.simulation.run import run
from drake_haptics.simulation.statistics import RunStatistics

HALF = 0.01
CUBE = Box(2 * HALF, 2 * HALF, 2 * HALF)
DEEP, SHALLOW = 0.015, 0.003


@contextmanager
def listening():
    """Yields a list that gets what is said of deep contacts."""
    said = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        yield said
    for warning in caught:
        if issubclass(warning.category, SceneWarning) and " deep, " in str(
            warning.message
        ):
            said.append(str(warning.message))


def make_plant(tolerance_m=1e-3, **contact):
    """Returns a cube over a slab, whose top is z = 0, and what renders it."""
    scene = over_a_slab(CUBE)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SceneWarning)
        rendering = scene.render(
            contact=ContactParameters(tolerance_m=tolerance_m, **contact),
        )
    return scene, rendering


def advance_plant(depth_m, **contact):
    scene, _ = make_plant(**contact)
    scene.start(tool=RigidTransform([0, 0, HALF - depth_m]))
    scene.simulator.AdvanceTo(0.02)


def make_pressed(folder, depth_m, tolerance_m=1e-3):
    """Returns a scene whose hand begins, and stays, so deep in a plate."""
    height = TOOL_HALF_HEIGHT - depth_m
    scene = over_a_plate(folder, [(0.0, 0.0, 0.0, height), (1.0, 0.01, 0.0, height)])
    scene.contact.tolerance_m = tolerance_m
    return scene


def test_a_plant_says_once_that_a_tool_is_deep_in_a_block():
    with listening() as said:
        advance_plant(DEEP)
    (sentence,) = said
    assert "15 mm deep, 15 times contact.tolerance_m (1 mm)" in sentence
    # Of several renderings it says which one, and since when.
    assert sentence.startswith("'haptic_rendering' at 0 s: ")


def test_a_plant_says_so_where_it_looks_for_contacts_as_far_as_braking_needs():
    scene = over_a_slab(CUBE)
    with listening() as said:
        scene.render(
            contact=ContactParameters(tolerance_m=1e-3),
            effects=Effects(braking=BrakingParameters(distance_m=0.01)),
        )
        scene.start(tool=RigidTransform([0, 0, HALF - DEEP]))
        scene.simulator.AdvanceTo(0.02)
    assert len(said) == 1


@pytest.mark.parametrize(
    ("depth_m", "tolerance_m"), [(SHALLOW, 1e-3), (DEEP, 2e-3), (DEEP, 0.0)]
)
def test_a_plant_says_nothing_of_less_and_nothing_without_a_skin(depth_m, tolerance_m):
    with listening() as said:
        advance_plant(depth_m, tolerance_m=tolerance_m)
    assert said == []


def test_a_run_says_once_that_a_tool_is_deep_in_a_block(tmp_path):
    with listening() as said:
        haptic = BuildHapticDiagram(make_pressed(tmp_path, DEEP))
        statistics = RunStatistics(haptic.period_s)
        run(haptic, 0.02, statistics=statistics)
        run(haptic, 0.02, statistics=statistics)
    (sentence,) = said
    # The first tick has led the tool out a little before it is measured.
    depth_mm = 1e3 * statistics.max_penetration_m
    assert 10.0 < depth_mm < 15.0
    words = f"{depth_mm:.4g} mm deep, {depth_mm:.0f} times contact.tolerance_m (1 mm)"
    assert words in sentence


def test_a_run_that_ctrl_c_ends_says_so_too(tmp_path):
    def stop(context):
        raise KeyboardInterrupt

    with listening() as said:
        haptic = BuildHapticDiagram(make_pressed(tmp_path, DEEP))
        with pytest.raises(KeyboardInterrupt):
            run(haptic, 0.02, on_tick=stop)
    assert len(said) == 1


def test_no_tick_of_a_run_waits_until_it_is_said(tmp_path):
    """A terminal may take nothing, and a loop that hangs leaves its last force on."""
    haptic = BuildHapticDiagram(make_pressed(tmp_path, DEEP))
    times_s = []
    with warnings.catch_warnings():
        warnings.simplefilter("error", SceneWarning)
        with pytest.raises(SceneWarning, match="deep"):
            run(haptic, 0.02, on_tick=lambda root: times_s.append(root.get_time()))
    assert len(times_s) == 20


@pytest.mark.parametrize(
    ("depth_m", "tolerance_m"), [(SHALLOW, 1e-3), (DEEP, 2e-3), (DEEP, 0.0)]
)
def test_a_run_says_nothing_of_less_and_nothing_without_a_skin(
    tmp_path, depth_m, tolerance_m
):
    with listening() as said:
        run(BuildHapticDiagram(make_pressed(tmp_path, depth_m, tolerance_m)), 0.02)
    assert said == []


def invoke_run(folder, scene, *options):
    file, figures = folder / "scene.yaml", folder / "figures.json"
    write_scene(scene, file, [])
    arguments = ["run", file, "--headless", "--duration", 0.02, "--json", figures]
    result = CliRunner().invoke(main, [str(part) for part in [*arguments, *options]])
    assert result.exit_code == 0, result.output
    return result, json.loads(figures.read_text())


def test_the_command_line_says_it_in_a_line_and_knows_the_speed(tmp_path):
    scene = make_pressed(tmp_path, DEEP)
    result, figures = invoke_run(tmp_path, scene)
    (line,) = [line for line in result.stderr.splitlines() if " deep, " in line]
    depth = f"{1e3 * figures['max_penetration_m']:.4g} mm deep"
    assert line.startswith(f"Warning: a contact is {depth}")
    assert figures["skin_speed_m_per_s"] == pytest.approx(1.0)
    assert "m/s" not in result.stdout


def test_the_command_line_writes_no_warning_before_a_device_is_closed(
    tmp_path, monkeypatch
):
    written, of_building = [], []
    for module in (endings, run_session):
        monkeypatch.setattr(module, "warn", written.append)

    def run_and_look(*args, **kwargs):
        of_building.extend(written)
        run(*args, **kwargs)
        assert written == of_building

    monkeypatch.setattr(run_session, "run", run_and_look)
    invoke_run(tmp_path, make_pressed(tmp_path, DEEP))
    (sentence,) = written[len(of_building) :]
    assert " deep, " in sentence


def test_explain_says_which_speed_crosses_the_tolerance_in_one_step(tmp_path):
    scene = make_pressed(tmp_path, SHALLOW)
    scene.contact.query_rate_hz = 100.0
    result, figures = invoke_run(tmp_path, scene, "--explain")
    (speed,) = re.findall(r"Above ([\d.]+) m/s the tool crosses", result.stdout)
    # 1 mm of skin, 10 ms from query to query.
    assert float(speed) == pytest.approx(0.1)
    assert figures["skin_speed_m_per_s"] == pytest.approx(0.1)


def test_a_scene_and_a_plant_say_the_speed_of_the_query_not_of_the_tick(tmp_path):
    _, each_step = make_plant()
    _, seldom = make_plant(query_rate_hz=100.0)
    assert each_step.skin_speed_m_per_s == pytest.approx(1.0)
    assert seldom.skin_speed_m_per_s == pytest.approx(0.1)
    scene = make_pressed(tmp_path, SHALLOW)
    assert BuildHapticDiagram(scene).skin_speed_m_per_s == pytest.approx(1.0)
    scene.contact.query_rate_hz = 100.0
    assert BuildHapticDiagram(scene).skin_speed_m_per_s == pytest.approx(0.1)
