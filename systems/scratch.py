"""Scratch memory of a system: per Context, never an input of any result."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pydrake.common.value import AbstractValue
from pydrake.systems.framework import CacheEntry, LeafSystem, ValueProducer


def declare_scratch(
    system: LeafSystem, description: str, make: Callable[[], Any]
) -> CacheEntry:
    """Declares a cache entry that holds a mutable object for each Context.

    Drake copies it when it clones a Context, so the object needs `__deepcopy__`.

    Args:
        system: The owner.
        description: Name of the entry.
        make: Makes the object for a new Context.
    """
    return system.DeclareCacheEntry(
        description=description,
        value_producer=ValueProducer(
            lambda: AbstractValue.Make(make()), ValueProducer.NoopCalc
        ),
        prerequisites_of_calc={system.nothing_ticket()},
    )


def get_scratch(entry: CacheEntry, context: Any) -> Any:
    """Returns the object of a Context."""
    # Nothing ever puts it out of date, so that this is the object and one call.
    return entry.Eval(context)
