"""Writes the paper's evaluation, made again, into docs/paper.md.

python docs/generate/paper_table.py --write --meshes FOLDER

Without --write it prints what it would write. Some two minutes. On a machine that does
other things too, --keep-times writes all but times, which stay as the page has them.
"""

from __future__ import annotations

import io
import re
import sys
from pathlib import Path

from page_parts import make_parser, read_part, replace_part, to_markdown
from page_stamp import amend_page, write_page
from PIL import Image

from drake_haptics.evaluation.paper.evaluation import (
    QUICK,
    PaperEvaluation,
    evaluate_paper,
)
from drake_haptics.evaluation.paper.report import (
    Picture,
    Section,
    count_verdicts,
    describe_machine_line,
    make_sections,
    summarize,
)
from drake_haptics.report.page import draw_png

_DOCS = Path(__file__).parents[2] / "docs"
PAGE = _DOCS / "paper.md"
_DPI, _COLORS = 80, 128
# Tables whose figures are in pictures and sentences.
DRAWN = (
    "Times of a tick",
    "One depth",
    "Query over penetrating pairs",
    "Force over contacts",
)
# Heads of columns, and words of sentences, in which times are.
_TIMED_COLUMN = re.compile(r"µs|seconds|Hz|under 1 ms|^(query|force|whole tick)$")
_TIMED_SENTENCE = re.compile(r"µs|time (?:that )?grows|takes .* % more")


def file_of(picture: Picture) -> str:
    """Returns the name of a picture's file in the folder of the page."""
    return f"paper_{picture.key.replace('-', '_')}.png"


def show_section(section: Section) -> str:
    """Returns a section of the page."""
    parts = [f"## {section.title}\n"]
    for block in section.blocks:
        if block.title:
            parts.append(f"### {block.title}\n")
        lines = (f"- **{s.verdict}**: {s.text}\n" for s in block.statements)
        parts.append("".join(lines))
        parts += [f"![{p.alt}]({file_of(p)})\n" for p in block.pictures]
    parts += [x.to_markdown() for x in section.tables if x.title not in DRAWN]
    return "\n".join(parts)


def with_figures(page: str, evaluation: PaperEvaluation) -> str:
    """Returns the page with these figures."""
    sections = make_sections(evaluation)
    parts = [f"{summarize(sections)} {describe_machine_line(evaluation)}\n"]
    parts += map(show_section, sections)
    return replace_part(page, "\n".join(parts))


def make_summary(evaluation: PaperEvaluation) -> str:
    """Returns how many statements have which verdict, as a sentence and a table."""
    sections = make_sections(evaluation)
    counts = count_verdicts(sections)
    return f"{summarize(sections)}\n\n{to_markdown([counts.header, *counts.rows])}"


def keep_times(new: str, old: str) -> str:
    """Returns new figures of the page with the times of old ones.

    Raises:
        ValueError: They have other lines, or a sentence that stays would not fit: all
            must be made.
    """
    head: list[str] = []
    lines = []
    for now, before in zip(new.split("\n"), old.split("\n"), strict=True):
        if now.startswith("| "):
            cells, kept = (line[2:-2].split(" | ") for line in (now, before))
            if not head:
                head = cells
            pairs = zip(head, cells, kept, strict=True)
            chosen = [b if _TIMED_COLUMN.search(name) else a for name, a, b in pairs]
            now = f"| {' | '.join(chosen)} |"
        else:
            head = []
            if _TIMED_SENTENCE.search(now) or now.startswith("Of "):
                now = before
            elif now.partition(":")[0] != before.partition(":")[0]:
                raise ValueError(f"'{now}' was '{before}': the sum of them is another")
        lines.append(now)
    return "\n".join(lines)


def write_pictures(evaluation: PaperEvaluation) -> None:
    """Writes the pictures, small, and removes those that are no longer shown."""
    for old in _DOCS.glob("paper_*.png"):
        old.unlink()
    for section in make_sections(evaluation):
        for picture in section.pictures:
            image = Image.open(io.BytesIO(draw_png(picture.draw(), _DPI))).convert(
                "RGB"
            )
            small = image.quantize(_COLORS, dither=Image.Dither.NONE)
            small.save(_DOCS / file_of(picture), optimize=True)


def main() -> None:
    """Measures, and writes page and pictures if asked to."""
    parser = make_parser(__doc__, PAGE)
    parser.add_argument("--meshes", type=Path, help="folder of real meshes")
    parser.add_argument("--quick", action="store_true", help="measure less")
    parser.add_argument(
        "--keep-times", action="store_true", help="leave the page's times and pictures"
    )
    arguments = parser.parse_args()
    evaluation = evaluate_paper(
        effort=QUICK if arguments.quick else None,
        meshes=arguments.meshes,
        progress=lambda what, share: print(f"{share:4.0%} {what}", file=sys.stderr),
    )
    old = PAGE.read_text(encoding="utf-8")
    page = with_figures(old, evaluation)
    if arguments.keep_times:
        now, before = read_part(page), read_part(old)
        page = old.replace(before, keep_times(now, before))
    if not arguments.write:
        print(read_part(page))
        return
    if arguments.keep_times:
        amend_page(PAGE, page, __file__, "all but times and pictures")
        return
    page = replace_part(page, make_summary(evaluation), "summary")
    write_page(PAGE, page, __file__)
    write_pictures(evaluation)


if __name__ == "__main__":
    main()
