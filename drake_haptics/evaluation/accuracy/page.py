"""Writes the study of a scene as one page that any browser shows."""

from __future__ import annotations

import base64
import html
import io
import math
from collections.abc import Iterator, Sequence
from importlib.resources import files
from pathlib import Path
from string import Template

from drake_haptics.evaluation.accuracy.figures import AccuracyStudy, PeerRow, Row
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
from drake_haptics.report.page import check_page_path

_DPI = 110
_PEER_COLUMNS = (
    Column("library", "", "With its version."),
    Column("asked for", "", "What it was asked for."),
    Column("core", "µs", "Time inside the library.", "median / p99"),
    *COLUMNS[2:5],
)


def write_accuracy_page(study: AccuracyStudy, path: Path, command: str) -> None:
    """Writes the page as one HTML file, and its picture beside it as PNG.

    Args:
        study: What to show.
        path: Of the HTML file; the picture has the suffix `.png` instead.
        command: The words of the command line that measured it, for those that are
            told; without them a row would be another motion's.

    Raises:
        ValueError: The path has the picture's suffix.
        OSError: A file cannot be written.
    """
    check_page_path(path)
    picture = io.BytesIO()
    draw_study(study).savefig(picture, format="png", dpi=_DPI)
    path.with_suffix(".png").write_bytes(picture.getvalue())
    template = files("drake_haptics.evaluation.accuracy").joinpath("page.html")
    page = Template(template.read_text(encoding="utf-8")).substitute(
        name=html.escape(study.scene),
        description=html.escape(study.description),
        verdict=html.escape(" ".join(describe_verdict(study))),
        knees=_make_list("", describe_knees(study)),
        picture=base64.b64encode(picture.getvalue()).decode(),
        scene_mark=SCENE_MARK,
        model_mark=MODEL_MARK,
        floor=format_N(ERROR_FLOOR_N),
        rows=_make_price_list(study),
        models=_make_list("Differences of model", describe_models(study)),
        missing=_make_list("Not measured", describe_missing(study)),
        peers=_make_peers(study.peers),
        columns=_make_meanings(get_columns(study)),
        reference=html.escape(describe_reference(study)),
        machine=html.escape(describe_machine(study)),
        command=html.escape(command),
    )
    path.write_text(page, encoding="utf-8")


def _make_price_list(study: AccuracyStudy) -> str:
    """Returns the table of all rows, each knob under its name."""
    columns = get_columns(study)
    measured = [row for row in study.rows if row.cost and row.errors]
    slowest_us = max(map(get_native_us, measured), default=1.0)
    worst_N = max(map(get_force_error_N, measured), default=ERROR_FLOOR_N)
    heads = "".join(map(_make_head, columns))
    lines = [f"<tr><th>setting</th>{heads}<th class='words'>again</th></tr>"]
    for knob, rows in group_rows(study):
        lines.append(
            f"<tr class='knob'><td colspan='{len(columns) + 2}'>"
            f"{html.escape(knob)}</td></tr>"
        )
        lines += [_make_row(row, columns, slowest_us, worst_N) for row in rows]
    return f"<table>{''.join(lines)}</table>"


def _make_row(
    row: Row, columns: tuple[Column, ...], slowest_us: float, worst_N: float
) -> str:
    shares = dict(_find_bars(row, slowest_us, worst_N))
    cells = "".join(
        f"<td{_make_bar(shares.get(column.head))}>{html.escape(cell)}</td>"
        for column, cell in zip(columns, make_cells(row, columns), strict=True)
    )
    kind = " class='scene'" if row.is_scene else ""
    again = html.escape(format_setting(row.setting))
    return (
        f"<tr{kind}><td>{html.escape(make_label(row).strip())}</td>{cells}"
        f"<td class='words again'><code>{again}</code></td></tr>"
    )


def _find_bars(
    row: Row, slowest_us: float, worst_N: float
) -> Iterator[tuple[str, tuple[str, float]]]:
    """Yields columns with the kind of their bar and its share of the longest."""
    if row.cost is None or row.errors is None:
        return
    yield "core", ("time", get_native_us(row) / slowest_us)
    if worst_N > ERROR_FLOOR_N:
        decades = math.log(get_force_error_N(row) / ERROR_FLOOR_N)
        yield "force", ("error", decades / math.log(worst_N / ERROR_FLOOR_N))


def _make_bar(bar: tuple[str, float] | None) -> str:
    """Returns the attributes of a cell with a bar along its foot."""
    if bar is None:
        return ""
    kind, share = bar
    return f" class='bar {kind}' style='--share: {100.0 * share:.1f}%'"


def _make_peers(peers: Sequence[PeerRow]) -> str:
    """Returns the table of the other libraries that were measured."""
    rows = []
    for peer in peers:
        if peer.native is None or peer.errors is None:
            continue
        cells = (format_times(peer.native), *make_error_cells(peer.errors)[:3])
        words = (peer.library, peer.method)
        rows.append(
            "<tr>"
            + "".join(f"<td class='words'>{html.escape(word)}</td>" for word in words)
            + "".join(f"<td>{cell}</td>" for cell in cells)
            + "</tr>"
        )
    if not rows:
        return ""
    heads = "".join(map(_make_head, _PEER_COLUMNS))
    return (
        "<h2>Other libraries on the same motion</h2><p class='note'>Against the same"
        " reference, without the scene's effects; what differs is their contact model"
        " as well as their exactness. Of the same pieces they also report contacts on"
        " facets where pieces were cut apart, which are not on the mesh; this package"
        " and its reference leave those out, so that they count as errors here."
        f"</p><div class='wide'><table><tr>{heads}</tr>{''.join(rows)}</table></div>"
    )


def _make_head(column: Column) -> str:
    kind = "" if column.unit else " class='words'"
    small = "<br>".join(filter(None, (column.unit, column.parts)))
    return f"<th{kind}>{column.head}<small>{small}</small></th>"


def _make_meanings(columns: tuple[Column, ...]) -> str:
    items = "".join(
        f"<dt>{column.head}, {column.unit}</dt><dd>{html.escape(column.meaning)}</dd>"
        for column in columns
    )
    return f"<dl>{items}</dl>"


def _make_list(heading: str, sentences: Sequence[str]) -> str:
    """Returns sentences as a list under a heading; nothing if there are none."""
    if not sentences:
        return ""
    head = f"<h2>{heading}</h2>" if heading else ""
    items = "".join(f"<li>{html.escape(sentence)}</li>" for sentence in sentences)
    return f"{head}<ul>{items}</ul>"
