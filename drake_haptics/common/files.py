"""Finds files in packages, and describes missing files."""

from __future__ import annotations

import difflib
import os
from pathlib import Path

from drake_haptics.common.errors import MeshError
from drake_haptics.models import FOLDER

_SCHEME = "package://"
_OURS = "drake_haptics"


def resolve_package_url(file: str | os.PathLike[str]) -> str:
    """Returns the path of a file that may be named `package://PACKAGE/...`.

    PACKAGE is `drake_haptics`, or a package in Drake's `PackageMap`. Any other name is
    a path, and is returned unchanged.

    Raises:
        MeshError: There is no such package, or Drake would have to download it.
    """
    file = os.fspath(file)
    if not file.startswith(_SCHEME):
        return file
    name, _, rest = file.removeprefix(_SCHEME).partition("/")
    if name == _OURS:
        folder, _, inner = rest.partition("/")
        if folder == FOLDER.name:
            return str(FOLDER / inner)
        return str(Path(__file__).parents[1] / rest)
    from pydrake.multibody.parsing import PackageMap  # meshes do not need Drake

    packages = PackageMap()
    if not packages.Contains(name):
        known = ", ".join([_OURS, *packages.GetPackageNames()])
        raise MeshError(f"{file}: there is no package {name!r}; known: {known}")
    try:
        return str(Path(packages.GetPath(name)) / rest)
    except RuntimeError as error:
        raise MeshError(f"{file}: {error}") from error


def describe_missing(path: str | os.PathLike[str]) -> str:
    """Returns where a file was looked for, and which one may have been meant."""
    path = Path(path)
    if path.is_dir():
        return f"{path}: is a folder, not a file"
    where = "" if path.is_absolute() else f"; looked in {Path.cwd() / path.parent}"
    words = f"{path}: no such file{where}"
    if not path.parent.is_dir():
        return f"{path}: no such file: there is no folder {path.parent}"
    try:
        names = [item.name for item in path.parent.iterdir()]
    except OSError:  # The folder cannot be listed.
        return words
    near = difflib.get_close_matches(path.name, names, n=1)
    return f"{words}; did you mean '{near[0]}'?" if near else words


def get_include() -> str:
    """Returns the include folder for a C or C++ compiler (`-I`).

    It contains `drake_haptics/wire.h` (the packets) and `drake_haptics/gate.h` (the
    gate of a driver).
    """
    return str(Path(__file__).parents[1] / "include")
