"""Studies of accuracy as JSON, which has neither infinities nor NaN."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from drake_haptics.evaluation.accuracy.figures import AccuracyStudy

# Stand for numbers that JSON lacks.
_NUMBERS = {"infinite": math.inf, "-infinite": -math.inf, "none": math.nan}


def to_json_data(study: AccuracyStudy) -> dict[str, Any]:
    """Returns a study as what `json.dumps(allow_nan=False)` takes.

    Infinite numbers are the text "infinite", those that there are none of "none"; a
    null is a figure that was not sought.
    """
    data: dict[str, Any] = _encode(study.to_dict())
    return data


def from_json_data(data: Mapping[str, Any]) -> AccuracyStudy:
    """Returns the study that `to_json_data` made data of."""
    rows = [_decode_figures(row) for row in data["rows"]]
    peers = [_decode_figures(peer) for peer in data["peers"]]
    return AccuracyStudy.from_dict({**data, "rows": rows, "peers": peers})


def _encode(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _encode(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_encode(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        if math.isnan(value):
            return "none"
        return "infinite" if value > 0.0 else "-infinite"
    return value


def _decode_figures(row: Mapping[str, Any]) -> dict[str, Any]:
    """Returns a row with the numbers of its errors; words elsewhere stay words."""
    errors = row["errors"]
    if errors is None:
        return dict(row)
    numbers = {
        key: value if key.endswith("why_not") else _NUMBERS.get(value, value)
        for key, value in errors.items()
    }
    return {**row, "errors": numbers}
