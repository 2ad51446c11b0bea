"""The picture shows every row, and its words neither meet nor are cut off."""

import math
from dataclasses import replace
from itertools import combinations

import pytest
from accuracy_samples import make_peers, make_row, make_study
from matplotlib.figure import Figure
from matplotlib.text import Text

from drake_haptics.common.colors import FRONT
from drake_haptics.evaluation.accuracy.figures import ERROR_FLOOR_N
from drake_haptics.evaluation.accuracy.plot import draw_study
from drake_haptics.evaluation.accuracy.report import group_rows
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.report.plot_labels import Label, label_points

STUDY = make_study(peers=make_peers())


def make_crowded_study():
    """More knobs than there are markers, and all but one of them near the scene."""
    scene = make_row("scene", "as it is", 150.0, 24.0, 0.0, is_scene=True)
    rows = [scene]
    for i in range(17):
        knob, key = f"contact.one_of_many_{i}", f"contact__key_{i}"
        rows.append(replace(scene, setting=Setting(knob, "as it is")))
        for share in (0.2, 0.6, 1.0):
            x = 1.0 + share * (0.5 if i else 20.0) * math.sin(i + 1.0)
            error_N = 0.002 * 10.0 ** (share * (i % 4))
            row = make_row(knob, f"{share}", 150.0 * abs(x), 24.0 * abs(x), error_N,
                           **{key: share})  # fmt: skip
            rows.append(row)
    return make_study(*rows, peers=make_peers())


STUDIES = {"usual": STUDY, "crowded": make_crowded_study()}


def lines_of(axes):
    return {line.get_label(): line for line in axes.get_lines()}


def knobs_of(study):
    """Each knob that has another setting than the scene's, with its measured rows."""
    for knob, rows in group_rows(study):
        measured = [row for row in rows if row.cost and row.errors]
        if measured and not all(row.is_scene for row in measured):
            yield knob, measured


def find_line(axes, rows):
    """The one line that has all points of a knob, and no other."""
    points = sorted(
        [row.cost.native.median_us, max(row.errors.force_rms_N, ERROR_FLOOR_N)]
        for row in rows
    )
    lines = [line for line in axes.get_lines() if line.get_linestyle() == ":"]
    (line,) = (x for x in lines if x.get_xydata().tolist() == points)
    return line


def note_boxes_of(figure, axes):
    """Where labels are, in pixels, without their lines."""
    figure.draw_without_rendering()
    return [Text.get_window_extent(note) for note in axes.texts]


@pytest.fixture(scope="module")
def figures():
    return {name: draw_study(study) for name, study in STUDIES.items()}


@pytest.fixture(scope="module")
def figure(figures):
    return figures["usual"]


def test_every_row_is_where_its_figures_are(figure):
    (axes,) = figure.axes
    for _, rows in knobs_of(STUDY):
        assert find_line(axes, rows)
    ((x, y),) = lines_of(axes)["the scene as it is"].get_xydata()
    assert (x, y) == (24.0, 0.004)


def test_every_knob_looks_different(figure):
    lines = [find_line(figure.axes[0], rows) for _, rows in knobs_of(STUDY)]
    looks = {(line.get_marker(), line.get_color()) for line in lines}
    assert len(looks) == len(lines)


@pytest.mark.parametrize("name", STUDIES)
def test_every_knob_is_named_at_a_point_of_its_own(name, figures):
    (axes,) = figures[name].axes
    notes = {note.get_text().partition("\n")[0]: note for note in axes.texts}
    for knob, rows in knobs_of(STUDIES[name]):
        note = notes.get(f"knee: {knob}") or notes[knob]
        line = find_line(axes, rows)
        assert list(note.xy) in line.get_xydata().tolist()
        if note.get_text().partition("\n")[0] == knob:
            assert note.get_color() == line.get_color()


@pytest.mark.parametrize("name", STUDIES)
def test_no_name_meets_another_or_hides_a_point(name, figures):
    (axes,) = figures[name].axes
    boxes, frame = note_boxes_of(figures[name], axes), axes.get_window_extent()
    for box in boxes:
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1
        assert frame.y0 <= box.y0 and box.y1 <= frame.y1
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    for line in axes.get_lines():
        if line.get_marker() != "None":
            for x, y in axes.transData.transform(line.get_xydata()):
                assert not any(box.contains(x, y) for box in boxes)


def test_peers_that_were_measured_are_hollow(figure):
    lines = lines_of(figure.axes[0])
    peer = lines["MuJoCo 3.3.0, its own contacts"]
    assert peer.get_markerfacecolor() == "none"
    assert peer.get_xydata().tolist() == [[30.0, 0.6]]
    assert not any("coal" in label for label in lines)


def test_axes_have_units_and_are_logarithmic(figure):
    (axes,) = figure.axes
    assert "µs" in axes.get_xlabel() and ", N" in axes.get_ylabel()
    # Times of 2 to 31 µs.
    assert axes.get_xscale() == axes.get_yscale() == "log"


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
    note = figure.axes[0].texts[0]
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
    label_points(
        axes,
        [
            Label(x, y, f"a long name of it\n{x:.2f}", FRONT, True)
            for x, y in POINTS[name]
        ],
    )
    assert len(axes.texts) == len(POINTS[name])
    frame, boxes = axes.get_window_extent(), note_boxes_of(figure, axes)
    for box in boxes:
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1
        assert frame.y0 <= box.y0 and box.y1 <= frame.y1
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))


def test_a_study_of_one_row_is_drawn():
    row = make_row("the scene", "as it is", 1.0, 1.0, 0.0, is_scene=True)
    assert len(draw_study(make_study(row)).axes) == 1
