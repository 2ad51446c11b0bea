"""Writes what was changed on the page as keys of a scene file."""

from __future__ import annotations

import json
from typing import Any


def write_changes(changes: dict[str, Any], indent: str = "") -> str:
    """Returns YAML to put into the scene's file in the place of the same keys.

    Args:
        changes: Sections of a scene with keys and values, as `SceneChanges` has them.
        indent: Before each line.
    """
    lines = []
    for key, value in changes.items():
        if isinstance(value, dict) and value:
            lines.append(f"{indent}{key}:\n{write_changes(value, f'{indent}  ')}")
        else:
            # JSON is YAML.
            lines.append(f"{indent}{key}: {json.dumps(value)}\n")
    return "".join(lines)
