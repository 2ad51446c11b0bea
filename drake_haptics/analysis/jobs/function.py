"""What a study computes, named so that the same name means the same results."""

from __future__ import annotations

import functools
import hashlib
import json
import sys
import types
from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass
from enum import Enum
from importlib.metadata import version
from pathlib import Path, PurePath
from typing import Any

from drake_haptics.analysis.jobs.exact_json import to_exact_json

PACKAGE_VERSION = version("drake_haptics")


@dataclass(frozen=True)
class StudyFunction:
    """The identity of a function with what is bound to it.

    Attributes:
        name: Module and qualified name, for people.
        digest: Hash of the name, of all that is bound to it and of this package's
            version, hex. The source of the function is not in it.
    """

    name: str
    digest: str

    @staticmethod
    def of(function: Callable[[Any], Any]) -> StudyFunction:
        """Identifies a top-level function, a partial of one, or a callable dataclass.

        Raises:
            ValueError: It is another thing, or something that is no data is bound.
        """
        described = json.dumps([PACKAGE_VERSION, _describe(function, "function")])
        digest = hashlib.sha256(described.encode()).hexdigest()[:16]
        return StudyFunction(_name_whole(function), digest)

    def make_key(self, task: str) -> str:
        """Returns the hash of this function with a task (exact JSON), hex."""
        return hashlib.sha256(f"{self.digest} {task}".encode()).hexdigest()[:32]


def _name_whole(function: Any) -> str:
    """Returns the name, with those of functions that are bound to it in brackets."""
    if _has_name(function):
        return _name(function)
    if isinstance(function, functools.partial):
        name = _name_whole(function.func)
        bound = [*function.args, *function.keywords.values()]
    else:
        name = _name(type(function))
        bound = [getattr(function, field.name) for field in fields(function)]
    inner = [_name_whole(value) for value in bound if callable(value)]
    return f"{name}({', '.join(inner)})" if inner else name


def _has_name(value: Any) -> bool:
    if isinstance(value, types.BuiltinFunctionType):
        return value.__module__ is not None  # not a method of an object
    return isinstance(value, (types.FunctionType, type))


def _name(value: Any) -> str:
    """Returns module and qualified name; a program is known by its file."""
    module = value.__module__
    if module == "__main__":
        program = getattr(sys.modules["__main__"], "__file__", None)
        module = Path(program).name if program else module
    return f"{module}.{value.__qualname__}"


def _describe(value: Any, where: str) -> Any:
    """Returns JSON data that two values share only if they are the same."""
    if isinstance(value, functools.partial):
        return {
            "partial": _describe(value.func, where),
            "args": _describe(value.args, f"{where}.args"),
            "keywords": _describe(value.keywords, f"{where}.keywords"),
        }
    if _has_name(value):
        if "<" in value.__qualname__:  # <lambda>, <locals>
            raise ValueError(
                f"{where} is {value.__qualname__}: a store needs functions of the top"
                " level of a module, whose name says what they are"
            )
        return {"name": _name(value)}
    if is_dataclass(value):
        of = {
            field.name: _describe(
                getattr(value, field.name), f"{where or 'function'}.{field.name}"
            )
            for field in fields(value)
        }
        return {"dataclass": _name(type(value)), "fields": of}
    if isinstance(value, PurePath):
        return {"path": str(value)}
    if isinstance(value, Enum):
        return {"enum": _name(type(value)), "member": value.name}
    if isinstance(value, (list, tuple)):
        return [_describe(v, f"{where}[{i}]") for i, v in enumerate(value)]
    if isinstance(value, dict) and all(isinstance(key, str) for key in value):
        return {
            "dict": [[k, _describe(v, f"{where}[{k!r}]")] for k, v in value.items()]
        }
    try:
        return {"value": to_exact_json(value)}
    except ValueError as error:
        raise ValueError(
            f"a store cannot tell one {where} from another: {error}. Bind data, paths,"
            " dataclasses and functions, and build the rest inside the function"
        ) from error
