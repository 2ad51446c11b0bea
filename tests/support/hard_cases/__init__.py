"""The hard cases of the convex pair query, by name.

Each case is a function that yields passages: two bodies and a list of poses. A passage
is asked in order by one warm pair, and each of its poses once more by a fresh one.
"""

from hard_cases import contacts, motions, numbers, overlaps, shapes
from hard_cases.passages import HARD_CASES, Passage

__all__ = [
    "HARD_CASES",
    "Passage",
    "contacts",
    "motions",
    "numbers",
    "overlaps",
    "shapes",
]
