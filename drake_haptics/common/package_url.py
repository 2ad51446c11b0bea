"""Files that are named by the package they come with, as `package://drake/...`."""

from __future__ import annotations

import os
from pathlib import Path

from drake_haptics.common.errors import MeshError
from drake_haptics.models import FOLDER

_SCHEME = "package://"
_OURS = "drake_haptics"


def resolve_package_url(file: str | os.PathLike[str]) -> str:
    """Returns the path of a file that may be named `package://PACKAGE/...`.

    PACKAGE is this one, `drake_haptics`, or one that Drake's `PackageMap` knows. Any
    other name is a path, and is returned as it is.

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
    from pydrake.multibody.parsing import PackageMap  # not for meshes of our own

    packages = PackageMap()
    if not packages.Contains(name):
        known = ", ".join([_OURS, *packages.GetPackageNames()])
        raise MeshError(f"{file}: there is no package {name!r}; known: {known}")
    try:
        return str(Path(packages.GetPath(name)) / rest)
    except RuntimeError as error:
        raise MeshError(f"{file}: {error}") from error
