"""What the library says is of keys and arguments, and agrees with its numbers."""

import ast
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "drake_haptics"
SOURCES = sorted(
    path
    for path in PACKAGE.rglob("*.py")
    if not {"systems", "models"} & set(path.relative_to(PACKAGE).parts[:1])
)
# A whole command, to be typed, may be named anywhere; an option alone only by `cli`.
OPTION = re.compile(r"(?<![\w-])--[a-z]")
COMMAND = "drake-haptics "
# Files whose business is a command line, another program's, or a style sheet.
ARE_OPTIONS = {
    "evaluation/accuracy/setting.py": "format_setting returns options",
    "evaluation/measuring/valgrind.py": "calls valgrind",
    "evaluation/paper/report.py": "tells of the command `paper`",
    "evaluation/paper/words.py": "tells of the command `paper`",
}
COUNTING = ("accuracy", "benchmark", "measuring", "paper")
NOUNS = (
    "bytes|clusters|components|contacts|edges|files|packets|parts|pieces|readings|rims"
    "|solids|ticks|triangles|vertices"
)
COUNTED = re.compile(rf"^ (?:[a-z-]+ )?(?:{NOUNS})\b")


def find_texts(path):
    """Yields each text of a module that is no docstring, and its line."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    nodes = [node for node in ast.walk(tree) if hasattr(node, "body")]
    bodies = [node.body for node in nodes if isinstance(node.body, list)]
    silent = {
        id(body[0].value) for body in bodies if body and isinstance(body[0], ast.Expr)
    }
    parts = {
        id(part)
        for node in ast.walk(tree)
        if isinstance(node, ast.JoinedStr)
        for part in node.values
    }
    for node in ast.walk(tree):
        if id(node) in silent | parts:
            continue
        if isinstance(node, ast.JoinedStr):
            constants = [x for x in node.values if isinstance(x, ast.Constant)]
            yield node.lineno, "{}".join(x.value for x in constants)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def test_options_of_the_command_line_are_named_there_alone():
    found = {}
    for path in SOURCES:
        name = path.relative_to(PACKAGE).as_posix()
        for line, text in find_texts(path) if not name.startswith("cli/") else ():
            if OPTION.search(text) and COMMAND not in text:
                found.setdefault(name, []).append((line, text))
    named = {name: texts for name, texts in found.items() if name not in ARE_OPTIONS}
    assert named == {}
    # Nothing is excused that does not need it.
    assert ARE_OPTIONS.keys() <= found.keys()


@pytest.mark.parametrize(
    "path",
    # Pages of studies count their hundreds of ticks and triangles.
    [x for x in SOURCES if x.parent.name not in COUNTING],
    ids=lambda path: path.name,
)
def test_numbers_agree_with_their_nouns(path):
    """`count` of `one_line` knows one edge, which joins, from many, which join."""
    wrong = [
        (node.lineno, ast.unparse(number), words.value)
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.JoinedStr)
        for number, words in zip(node.values, node.values[1:], strict=False)
        if isinstance(number, ast.FormattedValue)
        and isinstance(words, ast.Constant)
        and COUNTED.match(words.value)
        and ast.unparse(number.format_spec or ast.Constant("")) in ("''", "f','")
        and "count(" not in ast.unparse(number)
    ]
    assert wrong == []
