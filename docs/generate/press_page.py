"""The press table as parts of a page, docs/verification/contact-laws.md."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from page_parts import read_part, read_table, to_markdown
from page_stamp import describe_commit, write_parts
from press_cells import TITLES
from press_rig import GAINS, LARGEST_FORCE_N

PAGE = Path(__file__).parents[2] / "docs" / "verification" / "contact-laws.md"
GENERATOR = Path(__file__).with_name("press_table.py")
COMMAND = f"python docs/generate/{GENERATOR.name}"

MOTIONS = ("press", "jab")
# Columns of the page: each cell has the text of a press and that of a jab. The program
# prints more of them.
SHOWN = ("met", "lost", "through", "hooked", "energy", "deepest mm")
HEAD = ["solid", "gains", *SHOWN]
GAINS_HEAD = [
    "gains",
    "tolerance",
    "stiffness",
    f"{LARGEST_FORCE_N:g} N are carried",
    "points",
    "inward",
    "NaN",
    "commit",
]
_BETWEEN = "/"


def write_presses(rows: Sequence[Sequence[str]], points: int) -> None:
    """Writes the page; gains that are not among the rows keep those that they had.

    Args:
        rows: Rows of press_cells.row, of both motions for each solid.
        points: Number of points of each row.
    """
    made = [dict(zip(TITLES, row, strict=True)) for row in rows]
    pressed = {row["gains"] for row in made}
    kept = [row for row in read_rows() if row["gains"] not in pressed]
    told = {row["gains"]: row for row in read_gains()}
    for name in pressed:
        told[name] = _describe_gains(name, points, made)
    parts = {
        "gains": to_markdown(
            [GAINS_HEAD, *(_cells(told[g], GAINS_HEAD) for g in GAINS)]
        ),
        "shares": describe_shares([*kept, *made]),
        "presses": to_markdown(make_rows([*kept, *made])),
    }
    write_parts(PAGE, parts, GENERATOR)


def make_rows(results: Iterable[dict[str, str]]) -> list[list[str]]:
    """Returns the rows of the page, its head first, of results by title."""
    by_place: dict[tuple[int, str], dict[str, dict[str, str]]] = {}
    for row in results:
        place = (list(GAINS).index(row["gains"]), row["solid"])
        by_place.setdefault(place, {})[row["motion"]] = row
    return [
        HEAD,
        *(
            [
                solid,
                list(GAINS)[gains],
                *(
                    _BETWEEN.join(by_motion[m][title] for m in MOTIONS)
                    for title in SHOWN
                ),
            ]
            for (gains, solid), by_motion in sorted(by_place.items())
        ),
    ]


def describe_shares(results: Iterable[dict[str, str]]) -> str:
    """Returns how many presses got through with shipped gains and with soft ones."""
    shipped, soft = (
        _share_through([row for row in results if row["gains"] == name])
        for name in ("shipped", "soft")
    )
    return (
        f"**With the gains of the shipped scenes {shipped} got through; with soft"
        f" gains {soft}.**\n"
    )


def read_rows() -> list[dict[str, str]]:
    """Returns the page's results by title, one for each solid, gains and motion."""
    rows = []
    for cells in _read_cells("presses"):
        row = dict(zip(HEAD, cells, strict=True))
        rows += [
            {
                "solid": row["solid"],
                "motion": motion,
                "gains": row["gains"],
                **{title: row[title].split(_BETWEEN)[i] for title in SHOWN},
            }
            for i, motion in enumerate(MOTIONS)
        ]
    return rows


def read_gains() -> list[dict[str, str]]:
    """Returns the page's rows of gains by heading."""
    return [dict(zip(GAINS_HEAD, x, strict=True)) for x in _read_cells("gains")]


def _read_cells(part: str) -> list[list[str]]:
    return read_table(read_part(PAGE.read_text(encoding="utf-8"), part))[1:]


def _describe_gains(
    name: str, points: int, results: Iterable[dict[str, str]]
) -> dict[str, str]:
    gains = GAINS[name]
    pressed = [row for row in results if row["gains"] == name]
    cells = [
        name,
        f"{1e3 * gains.tolerance_m:g} mm",
        f"{gains.stiffness_N_per_m:g} N/m",
        _carried(LARGEST_FORCE_N / gains.stiffness_N_per_m - gains.tolerance_m),
        f"{points:,}",
        *(str(sum(int(row[title]) for row in pressed)) for title in ("inward", "NaN")),
        describe_commit(),
    ]
    return dict(zip(GAINS_HEAD, cells, strict=True))


def _cells(row: dict[str, str], head: Sequence[str]) -> list[str]:
    return [row[title] for title in head]


def _share_through(rows: Sequence[dict[str, str]]) -> str:
    """Returns how many presses got through, of all that met."""
    met, through = (sum(int(row[key]) for row in rows) for key in ("met", "through"))
    return f"{through} of {met:,} presses and jabs ({100 * through / met:.0f} %)"


def _carried(depth_m: float) -> str:
    where = "inside" if depth_m > 0 else "before the shapes touch"
    return f"{abs(1e3 * depth_m):.2g} mm {where}"
