"""The files of the page."""

from __future__ import annotations

from importlib.resources import files

_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}


def read_page_file(path: str) -> tuple[bytes, str] | None:
    """Returns a file and its media type; None where there is no such file.

    Args:
        path: Of the address, like "/" or "/main.js". Only names of files in the
            package's folder are found, whatever stands in it.
    """
    name = "index.html" if path == "/" else path.removeprefix("/")
    for file in files("drake_haptics.web").joinpath("page").iterdir():
        media_type = _TYPES.get("." + file.name.rpartition(".")[2])
        if file.name == name and media_type is not None:
            return file.read_bytes(), media_type
    return None
