"""Imports go one way, as `import_graph.ORDER` has the folders, without exception."""

from pathlib import Path

import pytest
from import_graph import (
    ORDER,
    PACKAGE,
    find_circles,
    find_folder_circles,
    find_imports,
    find_modules,
    find_upward,
)

ROOT = Path(__file__).parents[2]
# So many modules may stand loose in the package; the compiled core is one of them.
MOST_LOOSE = 6


@pytest.fixture(scope="module")
def modules():
    """The file of each module of the package."""
    return find_modules(ROOT)


@pytest.fixture(scope="module")
def imports(modules):
    """All imports among them."""
    return find_imports(modules)


def test_every_folder_has_a_place_in_the_order(modules):
    folders = {name.split(".")[1] for name in modules if "." in name}
    assert folders == set(ORDER)


def test_few_modules_stand_loose_in_the_package(modules):
    # A package is one whose file is an __init__.py.
    loose = [
        name
        for name, path in modules.items()
        if name.count(".") == 1 and path.name != "__init__.py"
    ]
    assert len([PACKAGE, "_core", *loose]) <= MOST_LOOSE


def test_no_import_goes_up(imports):
    assert [str(one) for one in find_upward(imports)] == []


def test_no_modules_import_one_another_in_a_circle(imports):
    assert find_circles(imports) == []


def test_no_folders_import_one_another_in_a_circle(imports):
    assert find_folder_circles(imports) == []


def test_every_kind_of_import_is_seen(tmp_path):
    common, report = tmp_path / PACKAGE / "common", tmp_path / PACKAGE / "report"
    common.mkdir(parents=True)
    report.mkdir()
    (common / "words.py").write_text(
        "from typing import TYPE_CHECKING\n"
        "if TYPE_CHECKING:\n"
        "    from drake_haptics.report import table\n"
    )
    (common / "poses.py").write_text(
        "def late():\n    import drake_haptics.report.table\n"
    )
    (report / "table.py").write_text(
        "from drake_haptics.common.words import say\n"
        "from drake_haptics.report.figure import draw\n"
    )
    (report / "figure.py").write_text("import drake_haptics.report.table as table\n")
    modules = find_modules(tmp_path)
    imports = find_imports(modules)
    words, poses = f"{PACKAGE}.common.words", f"{PACKAGE}.common.poses"
    figure, table = f"{PACKAGE}.report.figure", f"{PACKAGE}.report.table"
    assert sorted(map(str, find_upward(imports))) == [
        f"{poses}:2 imports {table}",
        f"{words}:3 imports {table}",
    ]
    assert find_circles(imports) == [[words, figure, table]]
    assert find_folder_circles(imports) == [
        [f"{PACKAGE}.common", f"{PACKAGE}.report"],
        [figure, table],
    ]
