"""Writes the study of a scene as an HTML page."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from drake_haptics.evaluation.accuracy import report
from drake_haptics.evaluation.accuracy.figures import ERROR_FLOOR_N, AccuracyStudy, Row
from drake_haptics.evaluation.accuracy.plot import draw_study
from drake_haptics.evaluation.accuracy.setting import format_setting
from drake_haptics.report.page import write_page, write_picture

_PEER_COLUMNS = (
    report.Column("library", "", "With its version."),
    report.Column("asked for", "", "What it was asked for."),
    report.Column("core", "µs", "Time inside the library.", "median / p99"),
    *report.COLUMNS[2:5],
)


def write_accuracy_page(study: AccuracyStudy, path: Path, command: str) -> None:
    """Writes the page as one HTML file, and its picture as a PNG file next to it.

    The page shows the command line that measured the study, for measuring rows again.

    Raises:
        ValueError: The path has the picture's suffix.
        OSError: A file cannot be written.
    """
    png = write_picture(draw_study(study), path)
    columns = report.get_columns(study)
    write_page(
        path,
        "evaluation/accuracy/page.html",
        name=study.scene,
        description=study.description,
        verdict=" ".join(report.describe_verdict(study)),
        knees=report.describe_knees(study),
        png=png,
        scene_mark=report.SCENE_MARK,
        model_mark=report.MODEL_MARK,
        floor=report.format_N(ERROR_FLOOR_N),
        groups=list(_make_groups(study, columns)),
        models=report.describe_models(study),
        missing=report.describe_missing(study),
        peers=[
            (
                peer.library,
                peer.method,
                report.format_times(peer.native),
                *report.make_error_cells(peer.errors)[:3],
            )
            for peer in study.peers
            if peer.native is not None and peer.errors is not None
        ],
        peer_columns=_PEER_COLUMNS,
        columns=columns,
        reference=report.describe_reference(study),
        machine=report.describe_machine(study),
        command=command,
    )


def _make_groups(
    study: AccuracyStudy, columns: tuple[report.Column, ...]
) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """Yields each knob with its rows."""
    measured = [row for row in study.rows if row.is_measured]
    slowest_us = max((row.native_us for row in measured), default=1.0)
    worst_N = max((row.force_error_N for row in measured), default=ERROR_FLOOR_N)
    for knob, rows in report.group_rows(study):
        shown = []
        for row in rows:
            bars = dict(_find_bars(row, slowest_us, worst_N))
            cells = zip(columns, report.make_cells(row, columns), strict=True)
            shown.append(
                {
                    "is_scene": row.is_scene,
                    "label": report.make_label(row).strip(),
                    "cells": [(cell, bars.get(column.head)) for column, cell in cells],
                    "again": format_setting(row.setting),
                }
            )
        yield knob, shown


def _find_bars(
    row: Row, slowest_us: float, worst_N: float
) -> Iterator[tuple[str, tuple[str, float]]]:
    """Yields columns with the kind and relative length of their bars."""
    if not row.is_measured:
        return
    yield "core", ("time", row.native_us / slowest_us)
    if worst_N > ERROR_FLOOR_N:
        decades = math.log(row.force_error_N / ERROR_FLOOR_N)
        yield "force", ("error", decades / math.log(worst_N / ERROR_FLOOR_N))
