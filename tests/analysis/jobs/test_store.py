"""What a study keeps in its file."""

from __future__ import annotations

import copy
import functools
import json
import math
import threading
import warnings
from pathlib import Path

import numpy as np
import pytest
from study_functions import (
    BrokenPool,
    Journal,
    add_three_scaled,
    as_bits,
    calc_matrix_figures,
    square,
)

from drake_haptics.analysis.jobs.pool import SerialExecutor
from drake_haptics.analysis.jobs.store import StudyFunction, StudyWarning
from drake_haptics.analysis.jobs.study import run_study

SERIAL = SerialExecutor()


@pytest.fixture
def journal(tmp_path) -> Journal:
    return Journal(str(tmp_path / "journal"))


def test_what_is_done_is_not_computed_again(journal, tmp_path):
    store = tmp_path / "store.jsonl"
    first = run_study(journal, [1, 2], executor=SERIAL, store=store)
    again = run_study(journal, [2, 3, 1], executor=SERIAL, store=store)
    assert [again[2], again[0]] == first
    assert journal.read() == ["1", "2", "3"]


def test_results_from_a_store_have_the_same_bits(tmp_path):
    store = tmp_path / "store"
    fresh = run_study(calc_matrix_figures, [1, 2], executor=SERIAL, store=store)
    kept = run_study(calc_matrix_figures, [1, 2], executor=BrokenPool(), store=store)
    assert as_bits(fresh) == as_bits(kept)


def test_each_line_of_a_store_is_json_that_tells_function_task_and_result(tmp_path):
    store = tmp_path / "store"
    run_study(square, [2, 3], executor=SERIAL, store=store)
    records = [json.loads(line) for line in store.read_text().splitlines()]
    assert [(r["task"], r["result"]) for r in records] == [(2, 4), (3, 9)]
    assert {r["function"] for r in records} == {"study_functions.square"}


@pytest.mark.parametrize("cut", [1, 2, 40, 150])
def test_a_torn_last_line_is_computed_again(journal, tmp_path, cut):
    store = tmp_path / "store"
    run_study(journal, [1, 2, 3], executor=SERIAL, store=store)
    whole = store.read_bytes()
    store.write_bytes(whole[:-cut])
    with pytest.warns(StudyWarning, match="line 3 is damaged"):
        results = run_study(journal, [1, 2, 3], executor=SERIAL, store=store)
    assert [r[0] for r in results] == [1, 2, 3]
    assert journal.read() == ["1", "2", "3", "3"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StudyWarning)
        run_study(journal, [1, 2, 3], executor=BrokenPool(), store=store)


def test_a_store_that_was_torn_in_its_first_line_is_used(journal, tmp_path):
    store = tmp_path / "store"
    store.write_bytes(b'{"for')
    with pytest.warns(StudyWarning, match="line 1 is damaged"):
        run_study(journal, [1], executor=SERIAL, store=store)


def test_any_changed_byte_costs_its_own_line_only(tmp_path):
    store = tmp_path / "store"
    run_study(square, [1.25, 2.5, 3.75], executor=SERIAL, store=store)
    whole = store.read_bytes()
    start = whole.index(b"\n") + 1
    end = whole.index(b"\n", start)
    for place in range(start, end, 5):
        damaged = bytearray(whole)
        damaged[place] ^= 0x04  # one digit becomes another
        store.write_bytes(damaged)
        with pytest.warns(StudyWarning, match="line 2 is damaged"):
            results = run_study(square, [1.25, 2.5, 3.75], executor=SERIAL, store=store)
        assert results == [1.5625, 6.25, 14.0625]


@pytest.mark.parametrize("content", [b"a,b\n1,2\n", b"\x00" * 300, b"\x89PNG\n\xff"])
def test_a_file_of_somebody_else_is_left_alone(tmp_path, content):
    store = tmp_path / "table.csv"
    store.write_bytes(content)
    with pytest.raises(ValueError, match=r"table\.csv is not a file of a study"):
        run_study(square, [1], executor=SERIAL, store=store)
    assert store.read_bytes() == content


def test_a_store_of_another_function_is_refused(journal, tmp_path):
    store = tmp_path / "store"
    run_study(square, [1], executor=SERIAL, store=store)
    with pytest.raises(
        ValueError, match=r"results of study_functions\.square, not of .*Journal"
    ):
        run_study(journal, [1], executor=SERIAL, store=store)


def test_a_store_of_other_bound_values_is_refused(tmp_path):
    store = tmp_path / "store"
    run_study(add_three_scaled, [1], executor=SERIAL, store=store)
    assert run_study(add_three_scaled, [1], executor=BrokenPool(), store=store) == [5]
    other = functools.partial(add_three_scaled.func, 3, b=2.5)
    with pytest.raises(ValueError, match="with other values bound to it"):
        run_study(other, [1], executor=SERIAL, store=store)


@pytest.mark.parametrize(
    ("bound", "other"),
    [
        (1, 1.0),
        (1, True),
        (0.0, -0.0),
        (1.0, math.nextafter(1.0, 2.0)),
        ("x", Path("x")),
        (np.zeros(2), np.zeros(2, dtype=np.float32)),
        (np.zeros((2, 1)), np.zeros((1, 2))),
        (square, add_three_scaled),
    ],
)
def test_bound_values_are_told_apart_to_the_bit(bound, other):
    def digest(value):
        return StudyFunction.of(functools.partial(add_three_scaled.func, value)).digest

    assert digest(bound) == digest(copy.deepcopy(bound)) != digest(other)


def test_a_store_of_another_version_is_refused(tmp_path, monkeypatch):
    store = tmp_path / "store"
    name = "drake_haptics.analysis.jobs.store.PACKAGE_VERSION"
    monkeypatch.setattr(name, "0.0.1")
    run_study(square, [1], executor=SERIAL, store=store)
    monkeypatch.undo()
    with pytest.raises(ValueError, match=r"by version 0\.0\.1, and this is"):
        run_study(square, [1], executor=SERIAL, store=store)


def test_a_store_in_use_is_refused(tmp_path):
    store = tmp_path / "store"

    def look(task):
        with pytest.raises(ValueError, match="is in use by another program"):
            run_study(square, [1], executor=SERIAL, store=store)
        return True

    seen = []
    run_study(
        square,
        [1],
        executor=SERIAL,
        store=store,
        progress=lambda done, total: seen.append(look(done)),
    )
    assert seen == [True, True]


@pytest.mark.parametrize(
    "function",
    [lambda task: task, functools.partial(square, threading.Lock()), [].append],
    ids=["lambda", "lock bound", "method"],
)
def test_a_store_needs_a_function_that_a_name_tells(tmp_path, function):
    with pytest.raises(ValueError, match="a store "):
        run_study(function, [1], executor=SERIAL, store=tmp_path / "store")
