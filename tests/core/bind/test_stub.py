"""Test that the committed type stub is that of the compiled core."""

from __future__ import annotations

from pathlib import Path

from nanobind.stubgen import StubGen

import drake_haptics
from drake_haptics import _core


def test_the_stub_is_fresh() -> None:
    """Else: python -m nanobind.stubgen -m drake_haptics._core -o <the file>."""
    generator = StubGen(_core)
    generator.put(_core)
    committed = Path(drake_haptics.__file__).with_name("_core.pyi").read_text()
    assert committed == generator.get()
