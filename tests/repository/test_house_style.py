"""The prose of code and pages keeps to the house style of CONTRIBUTING.md."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CODE = ("drake_haptics", "systems", "models", "examples")
# Where prose is held to the words below, too.
MORE_CODE = ("tests", "docs")
# In the package these are links, or files of text where a system has no links.
LINKS = {"drake_haptics/systems", "drake_haptics/models"}
# A first line says what a module is or does; an indirect question says neither.
QUESTION = re.compile(r"(?:What|Where|Whether|How|Who|Whose|Which|Why|When)\b")
# An entry of an argument or attribute that begins with one of these is no phrase of
# its own: "scene: Of the tool."
FRAGMENT = re.compile(
    r"(?:Of|Whose|As|What|Where|For|To|With|In|On|At|By|From|Which|That|Those|Than"
    r"|Each|The same|If|Until|Between|Along|How|Is)\b"
)
_SECTION = re.compile(r"^( *)(?:Args|Attributes):\n((?:\1 +\S.*\n|\n)*)", re.M)
_ENTRY = re.compile(r"^( *)\*{0,2}\w+: (.*)", re.M)
_VERBS = (
    "discret|equal|final|general|initial|linear|local|maxim|minim|normal|optim|organ"
    "|parametr|recogn|serial|special|stabil|summar|synchron|util|vector|visual"
)
# What to write for words that readers stumble over, and for British spellings.
BETTER = {
    r"\bone's own\b": "your own, its own, their own",
    r"\banew\b": "again",
    r"\b(?:there )?(?:is|are) none\b": "is not a ...",
    r"\bcan(?:not)? be had\b": "is (not) available",
    r"\bcomes? along\b": "is included",
    r"\b\w*(?:metre|litre)s?\b": "meter, liter",
    r"\b\w*(?:colour|behaviour|favour|honour|neighbour)\w*": "color",
    r"\bcent(?:re|res|red|ring)\b": "center",
    r"\banalys(?:e|ed|er|ing)\b": "analyze",
    rf"\b(?:{_VERBS})is(?:e|ed|es|er|ing|ation|ations)\b": "-ize",
    r"\b(?:cancel|label|model|travel)l(?:ed|er|ing)\b": "modeled",
    r"\bgrey\b": "gray",
}
_COMMENT = re.compile(r"/\*.*?\*/|(?<![:\"'])//[^\n]*", re.S)
_FENCE = re.compile(r"^ *(```|~~~).*?^ *\1[^\n]*$", re.M | re.S)
_SPAN = re.compile(r"(`+)[^`]+\1")


def list_files(*suffixes: str, folders: Iterable[str] = CODE) -> list[Path]:
    """The sources with one of these suffixes, and no file that a program wrote."""
    return [
        path
        for folder in folders
        for path in sorted((ROOT / folder).rglob("*"))
        if path.suffix in suffixes
        and not any(path.is_relative_to(ROOT / link) for link in LINKS)
    ]


def list_pages() -> list[Path]:
    """The Markdown pages that people write."""
    folders = [ROOT / name for name in (*CODE, "docs")]
    pages = [page for folder in folders for page in sorted(folder.rglob("*.md"))]
    return [
        *sorted(ROOT.glob("*.md")),
        *(page for page in pages if "generated" not in page.parts),
    ]


def find_python_prose(source: str) -> Iterator[tuple[int, str]]:
    """Yields each docstring and comment of a Python file, with its first line."""
    for node in ast.walk(ast.parse(source)):
        match node:  # those of attributes and enumerators too
            case ast.Expr(value=ast.Constant(value=str(docstring))):
                yield node.lineno, docstring
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string


def find_entries(source: str) -> Iterator[str]:
    """Yields the first line of each argument or attribute that a file documents."""
    for _, prose in find_python_prose(source):
        for section in _SECTION.finditer(f"{prose}\n"):
            entries = list(_ENTRY.finditer(section[2]))
            indent = min((len(entry[1]) for entry in entries), default=0)
            yield from (entry[2] for entry in entries if len(entry[1]) == indent)


def find_comments(source: str) -> Iterator[tuple[int, str]]:
    """Yields each comment of a C, C++, JavaScript or CSS file, with its first line."""
    for match in _COMMENT.finditer(source):
        yield source.count("\n", 0, match.start()) + 1, match[0]


def find_page_prose(source: str) -> Iterator[tuple[int, str]]:
    """Yields the text of a Markdown page: what is fenced becomes empty lines."""
    yield 1, _FENCE.sub(lambda fenced: "\n" * fenced[0].count("\n"), source)


def find_words(prose: Iterable[tuple[int, str]]) -> list[str]:
    """The words to mend, each with its line; names in backticks are of the code."""
    found = []
    for first, text in prose:
        plain = _SPAN.sub(lambda span: re.sub(r"[^\n]", "`", span[0]), text)
        for words, better in BETTER.items():
            for match in re.finditer(words.replace(" ", r"\s+"), plain, re.I):
                line = first + plain.count("\n", 0, match.start())
                said = " ".join(match[0].split())
                # "There is none" is good English, and "is None" is Python.
                if not re.match("[Tt]here |.*None$", said):
                    found.append(f"{line}: {said!r}, better {better!r}")
    return found


def find_offenders(
    files: Iterable[Path], find_prose: Callable[[str], Iterator[tuple[int, str]]]
) -> list[str]:
    """The words to mend in files, each with its place."""
    return [
        f"{path.relative_to(ROOT)}:{word}"
        for path in files
        for word in find_words(find_prose(path.read_text(encoding="utf-8")))
    ]


def test_the_first_line_of_a_module_says_what_it_is_or_does():
    lines = {
        path.relative_to(ROOT).as_posix(): doc.splitlines()[0]
        for path in list_files(".py")
        if (doc := ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))))
    }
    assert len(lines) > 250
    questions = [f"{p}: {line}" for p, line in lines.items() if QUESTION.match(line)]
    assert questions == []


def test_arguments_and_attributes_are_described_by_noun_phrases():
    entries = [
        (path.relative_to(ROOT).as_posix(), entry)
        for path in list_files(".py")
        for entry in find_entries(path.read_text(encoding="utf-8"))
    ]
    assert len(entries) > 1000
    assert [f"{p}: {e}" for p, e in entries if FRAGMENT.match(e)] == []


def test_entries_are_those_of_arguments_and_attributes():
    source = (
        'def f(a, b):\n    """Does: nothing.\n\n    Args:\n        a: Of the tool,\n'
        "            note: two lines.\n        **b: Name of it.\n\n    Raises:\n"
        '        ValueError: Of no use.\n    """\n'
    )
    assert list(find_entries(source)) == ["Of the tool,", "Name of it."]


@pytest.mark.parametrize("suffixes", [(".py",), (".cc", ".h", ".c", ".js", ".css")])
def test_docstrings_and_comments_have_words_that_readers_know(suffixes):
    find_prose = find_python_prose if ".py" in suffixes else find_comments
    files = list_files(*suffixes, folders=(*CODE, *MORE_CODE))
    assert len(files) > 100
    assert find_offenders(files, find_prose) == []


def test_pages_have_words_that_readers_know():
    pages = list_pages()
    assert len(pages) > 20
    assert find_offenders(pages, find_page_prose) == []


def test_words_are_found_in_prose_alone():
    python = (
        '"""Makes a centre; there is none."""\n'
        "centre = 'colour'  # not anew,\n"
        "def analyse():\n"
        '    """Returns `neighbour`, or None if there is none; this is\n'
        '    none of the others."""\n'
    )
    assert find_words(find_python_prose(python)) == [
        "1: 'centre', better 'center'",
        "4: 'is none', better 'is not a ...'",
        "2: 'anew', better 'again'",
    ]
    core = 'int grey; // as "http://centre" anew\n/* Half a\n millimetre. */\n'
    assert find_words(find_comments(core)) == [
        "1: 'anew', better 'again'",
        "1: 'centre', better 'center'",
        "3: 'millimetre', better 'meter, liter'",
    ]
    page = "Not `grey`\n```text\ngrey\n```\nbut *grey*.\n"
    assert find_words(find_page_prose(page)) == ["5: 'grey', better 'gray'"]
