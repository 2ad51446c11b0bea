"""Pairs of solids that tests of the contact law share."""

from __future__ import annotations

import pytest
from contact_samples import box, shipped

from drake_haptics import _core


@pytest.fixture(scope="session")
def pairs() -> dict[str, tuple[_core.ConvexPieces, _core.ConvexPieces]]:
    """A tool and an object by the name of both."""
    return {
        "box on box": (box([0.02, 0.03, 0.01]), box([0.03, 0.02, 0.02])),
        "spoon in cup": (shipped("spoon"), shipped("cup")),
        "peg in torus": (shipped("peg"), shipped("torus")),
        "cup on block": (shipped("cup"), shipped("block")),
    }
