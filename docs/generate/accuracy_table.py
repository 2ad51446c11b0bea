"""Tabulates what accuracy costs in some scenes.

python docs/generate/accuracy_table.py --write

Some minutes, on a machine that does nothing else. Ctrl-C keeps what is measured where
--store names a folder. On any machine, this makes the errors of some knobs again and
leaves the rest of the page as it is:

python docs/generate/accuracy_table.py --write --errors KNOB ...
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from page_parts import find_part, make_parser, to_markdown
from page_stamp import amend_page, show_parts

from drake_haptics.cli.console import progress_bar
from drake_haptics.evaluation.accuracy.figures import (
    NOT_SOUGHT,
    AccuracyStudy,
    Errors,
    Row,
)
from drake_haptics.evaluation.accuracy.knobs import (
    AS_IT_IS,
    list_settings,
    make_reference,
)
from drake_haptics.evaluation.accuracy.peers.run import add_peers
from drake_haptics.evaluation.accuracy.plot import draw_study
from drake_haptics.evaluation.accuracy.recorded_motion import record_motion
from drake_haptics.evaluation.accuracy.report import (
    COLUMNS,
    describe_knees,
    describe_machine,
    describe_missing,
    describe_peers,
    describe_reference,
    describe_verdict,
    get_columns,
    group_rows,
    make_cells,
    make_error_cells,
)
from drake_haptics.evaluation.accuracy.setting import Setting, find_model_change
from drake_haptics.evaluation.accuracy.study import (
    Measurement,
    make_task,
    run_accuracy_study,
)
from drake_haptics.evaluation.accuracy.truth import find_truth
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene

_DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE = _DOCS / "accuracy.md"
# Each scene, and what the keys of its rows begin with.
SCENES = {"cup_spoon": "", "rubbed_sphere": "effects."}
COLUMNS_NAME, ADVICE_NAME = "columns", "advice"
# Knob, setting, and times of tick and core are before the errors; energy is the last.
ERRORS = slice(4, 8)
_DPI = 90


def get_picture(name: str) -> Path:
    """Returns the file of the picture of a scene."""
    return _DOCS / f"accuracy_{name}.png"


def make_columns() -> str:
    """Returns a list of the meanings of the columns."""
    return "\n".join(f"- **{c.head}**, {c.unit}: {c.meaning}" for c in COLUMNS) + "\n"


def make_prices(study: AccuracyStudy, keys: str = "") -> str:
    """Returns the price list of a scene with its sentences.

    Args:
        study: Figures of the scene.
        keys: Beginning of the keys that have rows; "" for all keys, and lists of knees
            and other libraries. The scene as it is has the first row, and its own
            settings no others.
    """
    columns = get_columns(study)
    heads = [f"{column.head}, {column.unit}" for column in columns]
    rows = [
        [knob, _make_label(row), *make_cells(row, columns)]
        for knob, group in group_rows(study)
        for row in group
        if knob == AS_IT_IS.knob or (knob.startswith(keys) and not row.is_scene)
    ]
    parts = [
        " ".join([*describe_verdict(study), describe_reference(study)]) + "\n",
        to_markdown([["key", "setting", *heads], *rows]),
        "" if keys else _make_lists(study),
        describe_machine(study) + "\n",
    ]
    return "\n".join(part for part in parts if part)


def make_advice(studies: dict[str, AccuracyStudy]) -> str:
    """Returns what to set in each scene, and why, as a list."""
    return "".join(
        f"- **{name}**: {' '.join(describe_verdict(study))}\n"
        for name, study in studies.items()
    )


def measure_prices(name: str, store: Path | None) -> AccuracyStudy:
    """Measures all settings of a scene, and other libraries."""
    scene = load_scene(find_scene(name))
    kept = None if store is None else store / f"{name}.jsonl"
    with progress_bar() as show:
        study = run_accuracy_study(scene, name, store=kept, progress=show)
        return add_peers(study, scene, progress=show)


def measure_errors(
    name: str, is_meant: Callable[[Setting], bool]
) -> dict[tuple[str, str], list[str]]:
    """Returns cells of the errors of settings, by knob and setting.

    Args:
        name: Name of the scene.
        is_meant: Function that tells whether a setting is meant.
    """
    scene = load_scene(find_scene(name))
    motion = record_motion(scene)
    truth = find_truth(make_reference(scene).apply(scene), motion)
    measurement = Measurement(scene, motion, truth, NOT_SOUGHT)
    found = {}
    for setting in filter(is_meant, list_settings(scene)):
        print(f"{name}: {setting.knob} {setting.label}", file=sys.stderr)
        result = measurement(make_task("errors", setting))
        cells = make_error_cells(Errors(**result["errors"]))
        found[setting.knob, setting.label] = list(cells)
    return found


def with_errors(page: str, name: str, errors: dict[tuple[str, str], list[str]]) -> str:
    """Returns the page with these errors in the rows of a scene."""
    span = find_part(page, name)
    lines = page[span].split("\n")
    for i, line in enumerate(lines):
        cells = line[2:-2].split(" | ")
        found = errors.get((cells[0], cells[1].strip("*† ")) if cells[1:] else ("", ""))
        if found is not None:
            cells[ERRORS] = found
            lines[i] = f"| {' | '.join(cells)} |"
    return page[: span.start] + "\n".join(lines) + page[span.stop :]


def _make_label(row: Row) -> str:
    """Returns a setting; the scene itself is bold, and † is another model."""
    if row.is_scene:
        return f"**{row.setting.label}**"
    return (
        f"{row.setting.label} †"
        if find_model_change(row.setting)
        else (row.setting.label)
    )


def _make_lists(study: AccuracyStudy) -> str:
    """Returns knees, other libraries, and what was not measured."""
    lists = {
        "Knee: ": describe_knees(study),
        "Beside it: ": describe_peers(study),
        "Not measured: ": describe_missing(study),
    }
    return "\n".join(
        _make_list(beginning, sentences)
        for beginning, sentences in lists.items()
        if sentences
    )


def _make_list(beginning: str, sentences: list[str]) -> str:
    return "".join(f"- {beginning}{sentence}\n" for sentence in sentences)


def main() -> None:
    """Measures, prints, and writes the page if asked to."""
    parser = make_parser(__doc__, PAGE)
    parser.add_argument("--store", type=Path, help="folder that keeps results")
    parser.add_argument(
        "--errors", nargs="+", metavar="KNOB", help="of these knobs alone"
    )
    arguments = parser.parse_args()
    if arguments.errors:
        page = PAGE.read_text(encoding="utf-8")
        for name in SCENES:
            errors = measure_errors(name, lambda x: x.knob in arguments.errors)
            page = with_errors(page, name, errors)
            for key, cells in errors.items():
                print(name, *key, *cells)
        if arguments.write:
            what = f"errors of {', '.join(arguments.errors)}"
            amend_page(PAGE, page, __file__, what)
        return
    if arguments.store is not None:
        arguments.store.mkdir(parents=True, exist_ok=True)
    studies = {name: measure_prices(name, arguments.store) for name in SCENES}
    parts = {
        COLUMNS_NAME: make_columns(),
        **{name: make_prices(study, SCENES[name]) for name, study in studies.items()},
        ADVICE_NAME: make_advice(studies),
    }
    show_parts(PAGE, parts, __file__, arguments.write)
    if arguments.write:
        for name, study in studies.items():
            draw_study(study).savefig(get_picture(name), dpi=_DPI)


if __name__ == "__main__":
    main()
