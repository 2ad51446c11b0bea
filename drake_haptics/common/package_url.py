"""Files that are named by the package they come with, as `package://drake/...`."""

from __future__ import annotations

import os
from pathlib import Path

import drake_haptics
from drake_haptics.common.errors import MeshError

_SCHEME = "package://"


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
    if name == drake_haptics.__name__:
        return str(Path(drake_haptics.__file__).parent / rest)
    from pydrake.multibody.parsing import PackageMap  # not for meshes of our own

    packages = PackageMap()
    if not packages.Contains(name):
        known = ", ".join([drake_haptics.__name__, *packages.GetPackageNames()])
        raise MeshError(f"{file}: there is no package {name!r}; known: {known}")
    try:
        return str(Path(packages.GetPath(name)) / rest)
    except RuntimeError as error:
        raise MeshError(f"{file}: {error}") from error
