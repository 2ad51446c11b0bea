"""The cells of the price list say what was measured, and no more."""

import math
from dataclasses import replace

import pytest
from accuracy_samples import make_row, make_study

from drake_haptics.evaluation.accuracy.report import (
    COLUMNS,
    INSTRUCTIONS,
    format_us,
    get_columns,
    group_rows,
    make_cells,
    make_label,
)

ROW = make_row("contact.tolerance_m", "0.5 mm", 138.0, 13.0, 0.0204)


def cells_of(row, study=None):
    columns = get_columns(study or make_study(row))
    heads = [column.head for column in columns]
    return dict(zip(heads, make_cells(row, columns), strict=True))


def test_a_row_has_its_figures():
    assert cells_of(ROW) == {
        "tick": "138/276",
        "core": "13.0",
        "force": "0.020/0.082",
        "depth": "20.4",
        "jump": "0.2",
        "energy": "0.020",
        "stable": "30000",
    }


@pytest.mark.parametrize(
    ("time_us", "words"),
    [(1234.6, "1235"), (99.94, "99.9"), (1.236, "1.24"), (0, "0.00")],
)
def test_times_have_three_digits(time_us, words):
    assert format_us(time_us) == words


def test_round_off_is_zero_and_what_there_is_none_of_a_dash():
    odd = replace(
        ROW.errors,
        force_rms_N=4e-13,
        depth_max_m=math.nan,
        energy_created_J=math.inf,
        normal_jump_deg=-1e-9,
        stable_stiffness_N_per_m=None,
    )
    cells = cells_of(replace(ROW, errors=odd))
    assert cells["force"] == "0/0.082"
    assert [cells[head] for head in ("depth", "jump", "energy", "stable")] == [
        "–", "0", "∞", "–",
    ]  # fmt: skip
    endless = replace(ROW.errors, stable_stiffness_N_per_m=math.inf)
    assert cells_of(replace(ROW, errors=endless))["stable"] == "any"


def test_a_row_without_figures_has_dashes():
    missing = replace(ROW, cost=None, failure_reason="not installed")
    assert set(cells_of(missing, make_study(ROW, missing)).values()) == {"–"}


def test_instructions_have_a_column_where_they_were_counted():
    counted = make_row("a", "b", 1.0, 1.0, 1.0, instructions=54_321.0)
    study = make_study(ROW, counted)
    assert get_columns(study) == (*COLUMNS, INSTRUCTIONS)
    assert cells_of(counted, study)["instr."] == "54.3"
    assert cells_of(ROW, study)["instr."] == "–"
    assert get_columns(make_study(ROW)) == COLUMNS


def test_labels_tell_the_scenes_own_and_differences_of_model():
    assert make_label(make_row("a", "b", 1, 1, 1)) == "  b"
    assert make_label(make_row("a", "b", 1, 1, 1, is_scene=True)) == "* b"
    assert make_label(make_row("a", "b", 1, 1, 1, contact__depth="global")) == " †b"
    # Any key of a setting makes it another model.
    both = make_row("a", "b", 1, 1, 1, tool__scale=2, effects__friction=None)
    assert make_label(both) == " †b"


def test_rows_of_a_knob_stay_together():
    groups = [(knob, len(rows)) for knob, rows in group_rows(make_study())]
    assert groups == [
        ("scene", 1),
        ("contact.depth", 2),
        ("contact.tolerance_m", 3),
        ("decomposition", 2),
        ("tool.max_triangles", 1),
        ("effects.gravity", 1),
    ]
