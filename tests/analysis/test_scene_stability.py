"""The analysis of a scene: its parts are those of the held loop."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from held_samples import load_held, make_limits
from matplotlib.collections import PathCollection
from matplotlib.colors import to_rgba_array
from matplotlib.container import BarContainer
from matplotlib.patches import Patch

from drake_haptics.analysis import scene_stability
from drake_haptics.analysis.delay_margin import calc_delay_margin
from drake_haptics.analysis.held_loop import analyze_held_scene
from drake_haptics.analysis.jobs.pool import SerialExecutor
from drake_haptics.analysis.scene_stability import analyze_scene
from drake_haptics.bounds.held_handle import check_scene_coupling
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import CouplingParameters


@pytest.fixture(scope="module")
def scene():
    return load_scene(find_scene("hammer_block"))


@pytest.fixture(scope="module")
def reports():
    return []


@pytest.fixture(scope="module")
def found(scene, reports):
    with pytest.MonkeyPatch.context() as patch:
        shorten_limits(patch)
        return analyze_scene(
            scene,
            map_size=3,
            executor=SerialExecutor(),
            progress=lambda what, share: reports.append((what, share)),
        )


def shorten_limits(patch):
    """Leaves out the search for limits, which has tests of its own."""

    def find(held, kind, against, progress):
        progress(1.0)
        limits = make_limits(5e5 if against == "this contact" else 2e4, against)
        return replace(limits, kind=kind)

    patch.setattr(scene_stability, "find_stiffness_limits", find)


@pytest.fixture
def quick_limits(monkeypatch):
    shorten_limits(monkeypatch)


def test_it_is_what_the_held_loop_is(found):
    held = load_held("hammer_block")
    loop = analyze_held_scene(held)
    assert found.time_s == held.time_s
    assert found.growth == pytest.approx(loop.growth, abs=1e-9)
    assert found.is_stable
    assert found.delay_margin_s == pytest.approx(calc_delay_margin(loop), rel=1e-3)
    force = np.linalg.norm(held.F_To_W[3:])
    assert found.contact_force_N == pytest.approx(force, abs=1e-6)
    # The hammer's face lies on one flat block.
    assert found.num_contacts == 1
    assert max(abs(mode.eigenvalue) for mode in found.modes) >= found.growth - 1e-9
    device = loop.haptic.loop.device
    assert list(found.broken_bounds) == check_scene_coupling(held.scene, device)


def test_there_are_limits_of_both_stiffnesses_against_both(found):
    assert [(limit.kind, limit.against) for limit in found.limits] == [
        ("translation", "this contact"),
        ("rotation", "this contact"),
        ("translation", "a rigid wall"),
        ("rotation", "a rigid wall"),
    ]


def test_a_tool_that_touches_nothing_has_limits_against_a_wall_alone(
    scene, quick_limits
):
    free = analyze_scene(scene, 0.0, map_size=0)
    assert free.num_contacts == 0
    assert {limit.against for limit in free.limits} == {"a rigid wall"}


def test_the_map_has_the_limits_edge_and_the_scenes_gains(found):
    contact = found.limits[0]
    K, B = found.map.stiffness, found.map.damping
    assert K[0] < 800.0 < contact.eigenvalue < K[-1]
    assert B[0] == 0.0 and B[-1] > 2.0
    assert (found.map.spectral_radius[:, 0] < 1.0).all()
    assert (found.map.spectral_radius[:, -1] >= 1.0).any()


def test_progress_names_what_is_done(found, reports):
    names = {what for what, _ in reports}
    assert "looking for the firmest contact" in names
    assert "map of 9 points" in names
    assert "limit of rotation against a rigid wall" in names
    assert all(0.0 <= share <= 1.0 for _, share in reports)


def test_all_of_it_is_strict_json(found):
    data = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert data["is_stable"] is found.is_stable
    assert data["is_passive"] is found.is_passive
    assert len(data["modes"]) == len(found.modes)
    assert np.shape(data["map"]["spectral_radius"]) == (3, 3)


@pytest.fixture(scope="module")
def figure(found):
    """The sheet, drawn."""
    figure = found.plot()
    figure.draw_without_rendering()
    return figure


def test_it_draws_four_panels_with_a_map_and_three_without(found, figure):
    panels = [axes.get_title() for axes in figure.axes]
    assert len(panels) == 4
    assert any("stable in this contact, of 3 × 3" in title for title in panels)
    assert len(replace(found, map=None).plot().axes) == 3
    (title, *_) = replace(found, num_contacts=0).plot().axes
    assert "stable in free space, of 3 × 3" in title.get_title()


def read_meanings(figure):
    """Returns pairs of a color and what it means in a panel's legend."""
    pairs = set()
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            artist = handle.patches[0] if isinstance(handle, BarContainer) else handle
            color = (
                artist.get_facecolor()
                if isinstance(artist, Patch | PathCollection)
                else artist.get_color()
            )
            if len(color := to_rgba_array(color)):  # hollow markers have none
                meaning = label.partition(":")[0].partition(",")[0]
                meaning = re.sub("^the scene's.*", "the scene's", meaning)
                pairs.add((tuple(np.round(color[0, :3], 6)), meaning))
    return pairs


def test_each_color_means_one_thing_in_all_panels(figure):
    pairs = read_meanings(figure)
    colors, meanings = zip(*pairs, strict=True)
    assert len(pairs) == len(set(colors)) == len(set(meanings))
    assert set(meanings) >= {
        "stable",
        "unstable",
        "eigenvalue",
        "simulation",
        "one axis",
        "formula",
        "passivity",
        "the scene's",
    }


def test_every_legend_is_as_large_as_it_can_be_read_and_within_the_sheet(figure):
    for axes in figure.axes:
        legend = axes.get_legend()
        assert min(text.get_fontsize() for text in legend.get_texts()) >= 10
        extent = legend.get_window_extent()
        assert figure.bbox.x0 <= extent.x0 and extent.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= extent.y0 and extent.y1 <= figure.bbox.y1


def test_no_label_is_cut(figure):
    box = figure.bbox
    limits = figure.axes[-1]
    for text in [*limits.texts, *limits.get_yticklabels()]:
        extent = text.get_window_extent()
        assert box.x0 <= extent.x0 and extent.x1 <= box.x1
    right = limits.get_window_extent().x1
    assert all(text.get_window_extent().x1 <= right for text in limits.texts)


def test_an_unstable_coupling_is_analysed_all_the_same(scene, quick_limits):
    wild = replace(scene, coupling=CouplingParameters(stiffness_N_per_m=2e6))
    found = analyze_scene(wild, 0.35, map_size=0)
    assert not found.is_stable and found.delay_margin_s == 0.0
    assert not found.is_passive
    assert found.map is None and found.broken_bounds


def test_a_map_of_a_coupling_that_only_turns_has_stiffnesses_to_show(scene):
    turns = replace(scene, coupling=CouplingParameters(stiffness_N_per_m=0.0))
    stiffness_N_per_m, _ = scene_stability._choose_grid(turns, (), 3)
    assert 0.0 < stiffness_N_per_m[0] < stiffness_N_per_m[-1]


@pytest.mark.parametrize("size", [-1, 1])
def test_a_map_of_one_point_is_refused(scene, size):
    with pytest.raises(
        ValueError, match=f"map_size must be 0 or at least 2, is {size}"
    ):
        analyze_scene(scene, map_size=size)


def test_a_store_keeps_the_map(scene, quick_limits, tmp_path):
    done = []
    names = set()

    def note(what, share):
        if what.startswith("map"):
            done.append(share)
            names.add(what)

    settings = {"map_size": 2, "store": tmp_path / "map.jsonl", "progress": note}
    first = analyze_scene(scene, 0.35, executor=SerialExecutor(), **settings)
    assert done[0] == 0.0 and done[-1] == 1.0
    done.clear()
    names.clear()
    again = analyze_scene(scene, 0.35, executor=None, **settings)
    assert set(done) == {1.0}
    # Of a pool of all cores it is known how long the map takes.
    (words,) = names
    assert re.fullmatch(r"map of 4 points, about \d+ s", words)
    np.testing.assert_array_equal(first.map.spectral_radius, again.map.spectral_radius)
