"""A sentence on where this package and the paper agree or differ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Verdict = Literal["agrees", "better", "differs", "not measured"]
# What statements of each verdict do, as the end of a sentence that counts them.
MEANING: dict[Verdict, str] = {
    "agrees": "agree with the paper",
    "better": "are better than the paper says",
    "differs": "differ from it, or are worse",
    "not measured": "were not measured",
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
