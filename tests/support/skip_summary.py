"""The sentence that ends a test run: the tests it skipped, and the remedies."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

# What a reason mentions, and what somebody does to have those tests run.
REMEDIES = {
    "Chromium": "for want of Chromium (Debian: apt-get install chromium)",
    "valgrind": "for want of valgrind (Debian: apt-get install valgrind)",
    "real mesh": "for want of the real meshes, which are not in the repository",
}
OTHER = "for the reasons that are listed above"


def skip_summary(reasons: Iterable[str]) -> str:
    """Returns one line for the reasons that skipped tests gave, one each."""
    counts = Counter(
        next((remedy for word, remedy in REMEDIES.items() if word in reason), OTHER)
        for reason in reasons
    )
    if not counts:
        return "No test was skipped."
    order = [*REMEDIES.values(), OTHER]
    parts = [f"{counts[remedy]} {remedy}" for remedy in order if counts[remedy]]
    return f"Skipped tests: {'; '.join(parts)}."
