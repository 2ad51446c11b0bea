"""Writes the study of a scene as an HTML page."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from drake_haptics.evaluation.accuracy.figures import AccuracyStudy, Row
from drake_haptics.evaluation.accuracy.pareto import (
    ERROR_FLOOR_N,
    get_force_error_N,
    get_native_us,
)
from drake_haptics.evaluation.accuracy.plot import draw_study
from drake_haptics.evaluation.accuracy.report import (
    COLUMNS,
    MODEL_MARK,
    SCENE_MARK,
    Column,
    describe_knees,
    describe_machine,
    describe_missing,
    describe_models,
    describe_reference,
    describe_verdict,
    format_N,
    format_times,
    get_columns,
    group_rows,
    make_cells,
    make_error_cells,
    make_label,
)
from drake_haptics.evaluation.accuracy.setting import format_setting
from drake_haptics.report.page import check_page_path, draw_png, write_page

_PEER_COLUMNS = (
    Column("library", "", "With its version."),
    Column("asked for", "", "What it was asked for."),
    Column("core", "µs", "Time inside the library.", "median / p99"),
    *COLUMNS[2:5],
)


def write_accuracy_page(study: AccuracyStudy, path: Path, command: str) -> None:
    """Writes the page as one HTML file, and its picture as a PNG file next to it.

    Args:
        study: Study to show.
        path: Path of the HTML file; the picture has the suffix `.png` instead.
        command: Command line that measured the study, which the page shows for
            measuring rows again.

    Raises:
        ValueError: The path has the picture's suffix.
        OSError: A file cannot be written.
    """
    check_page_path(path)
    png = draw_png(draw_study(study))
    path.with_suffix(".png").write_bytes(png)
    columns = get_columns(study)
    write_page(
        path,
        "evaluation/accuracy/page.html",
        name=study.scene,
        description=study.description,
        verdict=" ".join(describe_verdict(study)),
        knees=describe_knees(study),
        png=png,
        scene_mark=SCENE_MARK,
        model_mark=MODEL_MARK,
        floor=format_N(ERROR_FLOOR_N),
        groups=list(_make_groups(study, columns)),
        models=describe_models(study),
        missing=describe_missing(study),
        peers=[
            (
                peer.library,
                peer.method,
                format_times(peer.native),
                *make_error_cells(peer.errors)[:3],
            )
            for peer in study.peers
            if peer.native is not None and peer.errors is not None
        ],
        peer_columns=_PEER_COLUMNS,
        columns=columns,
        reference=describe_reference(study),
        machine=describe_machine(study),
        command=command,
    )


def _make_groups(
    study: AccuracyStudy, columns: tuple[Column, ...]
) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """Yields each knob with its rows."""
    measured = [row for row in study.rows if row.cost and row.errors]
    slowest_us = max(map(get_native_us, measured), default=1.0)
    worst_N = max(map(get_force_error_N, measured), default=ERROR_FLOOR_N)
    for knob, rows in group_rows(study):
        shown = []
        for row in rows:
            bars = dict(_find_bars(row, slowest_us, worst_N))
            cells = zip(columns, make_cells(row, columns), strict=True)
            shown.append(
                {
                    "is_scene": row.is_scene,
                    "label": make_label(row).strip(),
                    "cells": [(cell, bars.get(column.head)) for column, cell in cells],
                    "again": format_setting(row.setting),
                }
            )
        yield knob, shown


def _find_bars(
    row: Row, slowest_us: float, worst_N: float
) -> Iterator[tuple[str, tuple[str, float]]]:
    """Yields columns with the kind and relative length of their bars."""
    if row.cost is None or row.errors is None:
        return
    yield "core", ("time", get_native_us(row) / slowest_us)
    if worst_N > ERROR_FLOOR_N:
        decades = math.log(get_force_error_N(row) / ERROR_FLOOR_N)
        yield "force", ("error", decades / math.log(worst_N / ERROR_FLOOR_N))
