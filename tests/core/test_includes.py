"""Includes of the core go one way, as CMake links its folders; files have no circle."""

import re
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "drake_haptics"
CORE = PACKAGE / "core"
FILES = {
    path.relative_to(CORE).as_posix(): path
    for path in sorted(CORE.rglob("*"))
    if path.suffix in {".h", ".cc"}
}
CMAKE = (CORE / "CMakeLists.txt").read_text("utf-8")


def read_links():
    """The folders that each folder's library is linked to, as CMakeLists.txt has it."""
    links = {}
    for entries in re.findall(r'core_folders\s+((?:"[a-z ]+"\s*)+)\)', CMAKE):
        for entry in re.findall(r'"([a-z ]+)"', entries):
            folder, *links[folder] = entry.split()
    bound = re.findall(r"target_link_libraries\(_core PRIVATE ([a-z_ ]+)\)", CMAKE)
    links["bind"] = [
        library.removeprefix("haptics_") for line in bound for library in line.split()
    ]
    return links


def reach(folder, links):
    """The folder and all that it is linked to, directly or not."""
    return {folder}.union(*(reach(below, links) for below in links[folder]))


def read_includes(name):
    """What a file of the core includes in quotes."""
    text = FILES[name].read_text("utf-8")
    return re.findall(r'^\s*#\s*include\s*"([^"]+)"', text, re.MULTILINE)


def test_every_file_stands_in_a_folder_that_cmake_knows():
    assert {name.split("/")[0] for name in FILES} == set(read_links())


def test_every_include_names_its_folder():
    for name in FILES:
        for included in read_includes(name):
            is_known = included in FILES or (PACKAGE / "include" / included).exists()
            assert is_known, f'{name}: #include "{included}"'


@pytest.mark.parametrize("folder", read_links())
def test_no_include_goes_up(folder):
    allowed = reach(folder, read_links())
    upward = [
        f'{name}: #include "{included}"'
        for name in FILES
        if name.startswith(f"{folder}/")
        for included in read_includes(name)
        if included in FILES and included.split("/")[0] not in allowed
    ]
    assert upward == []


def test_no_files_include_each_other_in_a_circle():
    graph = {name: set(read_includes(name)) & set(FILES) for name in FILES}
    TopologicalSorter(graph).prepare()  # raises CycleError, which names the circle
