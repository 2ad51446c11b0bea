"""A sentence on where this package and the paper agree or differ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Verdict = Literal["agrees", "passes", "differs", "lacks"]
MEANING: dict[Verdict, str] = {
    "agrees": "as the paper says",
    "passes": "better than the paper says",
    "differs": "not as the paper says, or worse",
    "lacks": "could not be measured",
}


@dataclass(frozen=True)
class Statement:
    """A sentence and what it comes to.

    Attributes:
        verdict: One of `MEANING`.
        text: The sentence, with figures.
    """

    verdict: Verdict
    text: str
