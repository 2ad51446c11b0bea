"""The picture shows every row, and its words neither meet nor are cut off."""

from itertools import combinations

import pytest
from accuracy_samples import make_peers, make_row, make_study
from matplotlib.figure import Figure
from matplotlib.text import Text

from drake_haptics.accuracy.pareto import ERROR_FLOOR_N
from drake_haptics.accuracy.plot import draw_study
from drake_haptics.accuracy.plot_labels import label_points

STUDY = make_study(peers=make_peers())


def lines_of(axes):
    return {line.get_label(): line for line in axes.get_lines()}


@pytest.fixture(scope="module")
def figure():
    return draw_study(STUDY)


def test_every_row_is_where_its_figures_are(figure):
    left, right = figure.axes
    for axes, kind in ((left, "native"), (right, "tick")):
        lines = lines_of(axes)
        for row in STUDY.rows[1:-1]:
            time_us = getattr(row.cost, kind).median_us
            error_N = max(row.errors.force_rms_N, ERROR_FLOOR_N)
            points = lines[row.setting.knob].get_xydata().tolist()
            assert [time_us, error_N] in points
        ((x, y),) = lines["the scene as it is"].get_xydata()
        assert (x, y) == ({"native": 24.0, "tick": 150.0}[kind], 0.004)


def test_every_knob_looks_different(figure):
    knobs = {row.setting.knob for row in STUDY.rows} - {"scene"}
    lines = lines_of(figure.axes[0])
    looks = {(lines[knob].get_marker(), lines[knob].get_color()) for knob in knobs}
    assert len(looks) == len(knobs)


def test_peers_are_hollow_and_only_beside_the_core(figure):
    left, right = map(lines_of, figure.axes)
    peer = left["MuJoCo 3.3.0, its own contacts"]
    assert peer.get_markerfacecolor() == "none"
    assert peer.get_xydata().tolist() == [[30.0, 0.6]]
    assert not any("MuJoCo" in label for label in right)
    assert not any("coal" in label for label in left)


def test_axes_have_units_and_are_logarithmic_where_that_helps(figure):
    left, right = figure.axes
    assert "µs" in left.get_xlabel() and "µs" in right.get_xlabel()
    assert ", N" in left.get_ylabel()
    # Of 2 to 31 µs, and of 124 to 158.
    assert (left.get_xscale(), right.get_xscale()) == ("log", "linear")
    assert left.get_yscale() == right.get_yscale() == "log"


def test_no_words_are_cut_off_or_meet(figure):
    figure.draw_without_rendering()
    names, others = (legend.get_window_extent() for legend in figure.legends)
    assert not names.overlaps(others)
    for box in (names, others):
        assert box.x0 >= 0.0 and box.x1 <= figure.bbox.x1 and box.y0 >= 0.0
        for axes in figure.axes:
            assert box.y1 <= axes.get_tightbbox().y0
    title = figure.legends[0].get_title().get_text()
    assert "a <processor>" in title and "every contact by itself" in title


def test_knees_are_named_by_the_words_of_their_settings(figure):
    (note,) = figure.axes[0].texts
    assert note.get_text() == "knee: tool.max_triangles\n200: 0.050 N"
    assert note.xy == (8.0, 0.05)


POINTS = {
    "a heap": [(1.0 + 0.01 * i, 1.0 - 0.01 * i) for i in range(5)],
    "the corner": [(0.0, 0.0), (0.01, 0.0)],
    "a diagonal": [(0.1 * i, 1.0 - 0.1 * i) for i in range(10)],
}


@pytest.mark.parametrize("name", POINTS)
def test_labels_neither_meet_nor_leave_the_axes(name):
    figure = Figure(figsize=(9.0, 7.0), layout="constrained")
    axes = figure.subplots()
    axes.set(xlim=(0.0, 1.2), ylim=(0.0, 1.2))
    figure.draw_without_rendering()
    notes = label_points(
        axes, [(x, y, f"a long name of it\n{x:.2f}") for x, y in POINTS[name]]
    )
    frame = axes.get_window_extent()
    boxes = []
    for note in notes:
        note.get_window_extent()
        boxes.append(Text.get_window_extent(note))
    for box in boxes:
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1
        assert frame.y0 <= box.y0 and box.y1 <= frame.y1
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))


def test_a_study_of_one_row_is_drawn():
    row = make_row("the scene", "as it is", 1.0, 1.0, 0.0, is_scene=True)
    assert len(draw_study(make_study(row)).axes) == 2
