"""The examples that Hypothesis tries: few and always the same, or many and new ones.

No test fails because the computer is slow.
`HYPOTHESIS_PROFILE=fuzz pytest tests/fuzz` tries thousands of new ones.
"""

from __future__ import annotations

import os

from hypothesis import HealthCheck, settings

_SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much]


def load() -> None:
    """Makes the profile that the environment names the one of this run."""
    settings.register_profile(
        "stable",
        max_examples=150,
        derandomize=True,
        deadline=None,
        database=None,
        suppress_health_check=_SLOW,
    )
    settings.register_profile(
        "fuzz", max_examples=20_000, deadline=None, suppress_health_check=_SLOW
    )
    settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "stable"))
