"""Docstrings that the site does not show are reStructuredText all the same.

Those that it shows are checked where it is built.
"""

import inspect
import io
from collections.abc import Iterator
from importlib import import_module

import docutils.core
from module_pages import LEFT_OUT, group_modules, list_modules
from sphinx.ext.napoleon import Config, GoogleDocstring

# Modules that measure these import them, and may be without.
PEERS = ("coal", "fcl", "mujoco", "pybullet")


def list_docstrings(module_name: str) -> Iterator[tuple[str, str]]:
    """Yields names and docstrings of a module and of what is public in it.

    Nothing of one that needs a library which is not installed.
    """
    try:
        module = import_module(f"drake_haptics.{module_name}")
    except ModuleNotFoundError as error:
        if error.name not in PEERS:
            raise
        return
    yield module_name, inspect.getdoc(module) or ""
    for name, value in vars(module).items():
        if name.startswith("_") or getattr(value, "__module__", "") != module.__name__:
            continue
        yield f"{module_name}.{name}", inspect.getdoc(value) or ""
        if inspect.isclass(value):
            for inner, member in vars(value).items():
                if not inner.startswith("_") and callable(member):
                    yield f"{module_name}.{name}.{inner}", inspect.getdoc(member) or ""


def find_errors(docstring: str) -> str:
    """Returns what docutils says of a docstring, as Napoleon hands it on."""
    config = Config(napoleon_use_ivar=True, napoleon_use_param=False)
    errors = io.StringIO()
    docutils.core.publish_doctree(
        str(GoogleDocstring(docstring, config, what="function")),
        settings_overrides={"warning_stream": errors, "report_level": 2},
    )
    return errors.getvalue()


def test_docstrings_that_no_page_shows_can_be_read():
    modules = [m for m in group_modules(list_modules())[LEFT_OUT] if "__" not in m]
    docstrings = {k: v for module in modules for k, v in list_docstrings(module)}
    assert len(docstrings) > 500
    errors = {name: find_errors(text) for name, text in docstrings.items()}
    assert not {name: error for name, error in errors.items() if error}


def test_a_docstring_that_cannot_be_read_is_found():
    assert "substitution" in find_errors("Returns |x|.")
    assert not find_errors("Returns `|x|`.\n\nArgs:\n    x: Any number, `a*`.")
