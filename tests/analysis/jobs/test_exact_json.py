"""Data as text, and back to the bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from drake_haptics.analysis.jobs.exact_json import from_exact_json, to_exact_json


@pytest.mark.parametrize(
    "value",
    [
        None,
        True,
        10**40,
        0.1 + 0.2,
        5e-324,
        -0.0,
        float("inf"),
        -float("inf"),
        "ä\n\ud800",
        complex(float("nan"), -0.0),
        (1, [2.0, (3,)], {"a": None}),
        {1: "x", (2, 3): "y", "$array": "z"},
        {"$tuple": [1]},
    ],
)
def test_data_come_back_as_they_went(value):
    text = to_exact_json(value)
    assert "\n" not in text
    again = from_exact_json(text)
    assert repr(again) == repr(value)
    assert type(again) is type(value)


def test_nan_comes_back():
    assert np.isnan(from_exact_json(to_exact_json(float("nan"))))


@pytest.mark.parametrize("dtype", ["<f8", ">f4", "c16", "i2", "?", "U3", "M8[ns]"])
@pytest.mark.parametrize("shape", [(), (0,), (4,), (2, 0, 3), (3, 2)])
def test_arrays_come_back_with_type_shape_and_bits(dtype, shape):
    raw = np.random.default_rng(1).integers(0, 2, size=shape)
    array = np.asarray(raw.astype(dtype), order="F")
    again = from_exact_json(to_exact_json(array))
    assert again.dtype == array.dtype
    assert again.shape == array.shape
    assert again.tobytes() == array.tobytes()
    assert again.flags.writeable


def test_a_scalar_of_numpy_is_the_number():
    assert to_exact_json(np.float64(0.1)) == to_exact_json(0.1)
    assert to_exact_json(np.int32(7)) == "7"


@pytest.mark.parametrize(
    "value", [object(), {1, 2}, np.array([None]), b"raw", np.longdouble(1), Path("x")]
)
def test_what_has_no_exact_form_is_named_with_its_place(value):
    with pytest.raises(ValueError, match=r"\['a'\]\[1\] is of type"):
        to_exact_json({"a": [0, value]})


@pytest.mark.parametrize("text", ['{"$new":1}', '{"$array":[1]}', "{", "\x00"])
def test_a_text_of_another_kind_is_refused(text):
    with pytest.raises(ValueError):
        from_exact_json(text)
