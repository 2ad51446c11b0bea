"""Writes what was changed on the page as keys of a scene file."""

from __future__ import annotations

from typing import Any


def write_changes(changes: dict[str, Any]) -> str:
    """Returns YAML to put into the scene's file in the place of the same keys.

    Args:
        changes: By section, values by key, as `SceneChanges.changes` has them.
    """
    if not changes:
        return ""
    # Only where it is needed: starting is quicker without.
    import yaml

    text: str = yaml.safe_dump(changes, sort_keys=False, default_flow_style=None)
    return text
