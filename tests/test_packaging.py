"""Test that the sdist is whole, and that what is installed from it works anywhere.

The C++ core takes minutes to compile, so that it is not compiled again: its sources in
the sdist are held to those of this clone, from which the core of this environment was
built, and that one is put beside the Python that the sdist installs.
"""

from __future__ import annotations

import subprocess
import sys
import sysconfig
import tarfile
import venv
from pathlib import Path

import pytest

from drake_haptics import _core

REPO = Path(__file__).resolve().parents[1]
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


@pytest.fixture(scope="module")
def environment(sdist: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty environment with what the sdist installs, outside of the clone."""
    folder = tmp_path_factory.mktemp("empty")
    venv.create(folder, symlinks=True)
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check"]
    build = ["wheel", "--no-deps", "--no-build-isolation"]
    build += ["-C", "wheel.cmake=false", "-C", "wheel.py-api=py3"]
    run(*pip, *build, "-w", folder, sdist, cwd=folder)
    [wheel] = folder.glob("*.whl")
    python = folder / "bin" / "python"
    run(*pip, "--python", python, "install", "--no-deps", wheel, cwd=folder)
    [site] = folder.glob("lib/python*/site-packages")
    core = Path(_core.__file__)
    (site / "drake_haptics" / core.name).symlink_to(core)
    (site / "others.pth").write_text(sysconfig.get_path("purelib"))  # Drake, NumPy, ...
    return folder


def test_it_holds_what_builds_the_package_and_nothing_else(sdist: Path) -> None:
    if not (REPO / ".git").exists():
        pytest.skip("git alone knows what belongs to this tree")
    kinds = ("--cached", "--others", "--exclude-standard")
    folders = ("drake_haptics", "systems", "models")
    tracked = run("git", "ls-files", *kinds, *folders, cwd=REPO).split()
    links = {"drake_haptics/systems", "drake_haptics/models"}
    expected = {"LICENSE", "README.md", "pyproject.toml", *tracked} - links
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
