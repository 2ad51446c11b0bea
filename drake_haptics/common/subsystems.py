"""Walks through the systems of a diagram."""

from __future__ import annotations

from collections.abc import Iterator

from pydrake.autodiffutils import AutoDiffXd
from pydrake.systems.framework import Diagram, Diagram_, System

_DIAGRAMS = (Diagram, Diagram_[AutoDiffXd])


def walk_systems(system: System) -> Iterator[System]:
    """Yields a system and, if it is a Diagram, all systems in it, depth first."""
    yield system
    if isinstance(system, _DIAGRAMS):
        for part in system.GetSystems():
            yield from walk_systems(part)


def walk_leaves(system: System) -> Iterator[System]:
    """Yields the leaf systems, in the order of Drake's states."""
    return (part for part in walk_systems(system) if not isinstance(part, _DIAGRAMS))
