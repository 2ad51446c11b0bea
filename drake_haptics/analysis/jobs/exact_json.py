"""Converts Python data to JSON text and back, without any change."""

from __future__ import annotations

import base64
import json
import math
from typing import Any

import numpy as np

# Values that JSON has no form for are objects with one of these keys.
_ARRAY = "$array"
_COMPLEX = "$complex"
_DICT = "$dict"
_FLOAT = "$float"
_TUPLE = "$tuple"
# Booleans, integers, floating point, complex, strings, bytes, dates, durations.
_ARRAY_KINDS = "biufcUSMm"


def to_exact_json(value: Any) -> str:
    """Returns one line of JSON (RFC 8259), which depends only on the value.

    Floats keep every bit, infinities and NaN included (a NaN's payload is lost);
    arrays keep type, shape and every bit; tuples stay tuples and dicts may have any
    keys. Scalars of NumPy become Python's.

    Args:
        value: None, bool, int, float, complex, str, np.ndarray without objects, and
            lists, tuples and dicts of these.

    Raises:
        ValueError: The value holds something else; the message says where.
    """
    return json.dumps(_encode(value, ""), separators=(",", ":"), allow_nan=False)


def from_exact_json(text: str) -> Any:
    """Returns the value of a text that `to_exact_json` wrote; arrays are new.

    Raises:
        ValueError: The text was not written by `to_exact_json`.
    """
    try:
        return _decode(json.loads(text))
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"not a text of to_exact_json: {error!r}") from error


def _encode(value: Any, where: str) -> Any:
    """Returns a value for json.dumps; refuses subclasses, whose type would be lost."""
    kind = type(value)
    if value is None or kind in (bool, int, str):
        return value
    if kind is float:
        return value if math.isfinite(value) else {_FLOAT: str(value)}
    if kind is list:
        return [_encode(v, f"{where}[{i}]") for i, v in enumerate(value)]
    if kind is tuple:
        return {_TUPLE: [_encode(v, f"{where}[{i}]") for i, v in enumerate(value)]}
    if kind is dict:
        return _encode_dict(value, where)
    if kind is complex:
        return {_COMPLEX: [_encode(value.real, where), _encode(value.imag, where)]}
    if kind is np.ndarray and value.dtype.kind in _ARRAY_KINDS:
        data = base64.b64encode(value.tobytes()).decode()
        return {_ARRAY: [value.dtype.str, list(value.shape), data]}
    if isinstance(value, np.generic) and not isinstance(value.item(), np.generic):
        return _encode(value.item(), where)
    raise ValueError(
        f"{where or 'it'} is of type {kind.__module__}.{kind.__qualname__}, which"
        " exact JSON cannot hold: use None, bool, int, float, complex, str, arrays"
        " of NumPy without objects, and lists, tuples and dicts of these"
    )


def _encode_dict(value: dict[Any, Any], where: str) -> dict[str, Any]:
    if all(type(key) is str and not key.startswith("$") for key in value):
        return {key: _encode(v, f"{where}[{key!r}]") for key, v in value.items()}
    return {
        _DICT: [
            [_encode(key, f"{where}.keys()"), _encode(v, f"{where}[{key!r}]")]
            for key, v in value.items()
        ]
    }


def _decode(plain: Any) -> Any:
    if isinstance(plain, list):
        return [_decode(v) for v in plain]
    if not isinstance(plain, dict):
        return plain
    if len(plain) != 1 or not next(iter(plain)).startswith("$"):
        return {key: _decode(v) for key, v in plain.items()}
    ((kind, data),) = plain.items()
    if kind == _FLOAT:
        return float(data)
    if kind == _TUPLE:
        return tuple(_decode(v) for v in data)
    if kind == _DICT:
        return {_decode(key): _decode(v) for key, v in data}
    if kind == _COMPLEX:
        return complex(*(_decode(part) for part in data))
    if kind == _ARRAY:
        dtype, shape, text = data
        flat = np.frombuffer(base64.b64decode(text), dtype=np.dtype(dtype))
        return flat.reshape(shape).copy()  # an array of frombuffer is read-only
    raise ValueError(f"not a text of to_exact_json: {kind!r} is unknown")
