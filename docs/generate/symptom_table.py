"""Makes each symptom of docs/troubleshooting.md happen, cures it, and writes both down.

python docs/generate/symptom_table.py --write
python docs/generate/symptom_table.py --scenes FOLDER

The second writes the scenes, so that `drake-haptics run` shows them. Half a minute.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from page_parts import make_parser, to_markdown
from page_stamp import write_parts
from symptom_cases import CASES
from symptom_run import Case

from drake_haptics.scene.scene_file import write_scene
from drake_haptics.scene.schema import EncoderParameters
from drake_haptics.scene.validation import SceneWarning

PAGE = Path(__file__).parents[2] / "docs" / "troubleshooting.md"
HEAD = ["shown by", "cured by", "is measured", "shown", "cured"]


def describe(changes: Mapping[str, Any], motion: str = "") -> str:
    """Returns changed keys as a scene file has them."""
    words = [f"`{key}: {_describe_value(value)}`" for key, value in changes.items()]
    return ", ".join([*words, motion] if motion else words) or "as it ships"


def _describe_value(value: Any) -> str:
    """Returns a value as YAML on one line; one that is not given is named so."""
    if value is None:
        return "not given"
    if isinstance(value, float | int | str):
        text = f"{value:g}" if isinstance(value, float) else str(value)
        return text.replace("e+0", "e")
    if isinstance(value, EncoderParameters):
        return f"{{velocity_window: {value.velocity_window}}}, steps of 1 mrad"
    return "{" + ", ".join(f"{k}: {_describe_value(v)}" for k, v in _plain(value)) + "}"


def _plain(value: Any) -> Iterator[tuple[str, Any]]:
    """Yields the keys that a line has room for: those that are one number."""
    return ((k, v) for k, v in asdict(value).items() if isinstance(v, float | int))


def make_row(case: Case) -> list[str]:
    """Measures a case, provoked and cured."""
    with warnings.catch_warnings():
        # What the builder warns of is what is asked for here.
        warnings.simplefilter("ignore", SceneWarning)
        before, after = (case.measure(cured=cured) for cured in (False, True))
    return [*describe_case(case), _round(before), _round(after)]


def describe_case(case: Case) -> list[str]:
    """Returns the changes of a case, the cure, and the measured figure."""
    changes = {**case.provoked, **case.given}
    return [
        f"{case.scene}: {describe(changes, case.motion)}",
        describe(case.cure),
        case.figure,
    ]


def _round(value: float) -> str:
    return "0" if abs(value) < 5e-4 else f"{value:.3g}"


def write_scenes(folder: Path) -> None:
    """Writes the scenes of all cases, provoked and cured."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, case in enumerate(CASES, 1):
        for cured in (False, True):
            name = f"{number:02}_{case.section}{'_cured' if cured else ''}.yaml"
            write_scene(case.make_scene(cured=cured), folder / name)


def main() -> None:
    """Prints the tables, or writes them into the page, or the scenes to a folder."""
    parser = make_parser(__doc__, PAGE)
    parser.add_argument("--scenes", type=Path, help="write the scenes there instead")
    arguments = parser.parse_args()
    if arguments.scenes is not None:
        write_scenes(arguments.scenes)
        return
    tables: dict[str, list[list[str]]] = {}
    for case in CASES:
        print(case.section, file=sys.stderr)
        tables.setdefault(case.section, []).append(make_row(case))
    for section, rows in tables.items():
        table = to_markdown([HEAD, *rows])
        print(f"{section}\n\n{table}")
        if arguments.write:
            write_parts(PAGE, {section: table}, __file__)


if __name__ == "__main__":
    main()
