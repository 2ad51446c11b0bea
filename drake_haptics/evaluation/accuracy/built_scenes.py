"""Builds each scene once in a process."""

from __future__ import annotations

from dataclasses import asdict

from drake_haptics.analysis.held_scene import build_quietly
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.scene.schema import Scene

# A diagram that Python systems are part of is never freed: that it is kept here costs
# nothing, and another one for the next measurement of the scene would.
_BUILT: dict[str, HapticDiagram] = {}


def build_once(scene: Scene) -> HapticDiagram:
    """Returns the diagram of a scene, the same one for the same scene.

    All that a run changes is in its context, so that runs know nothing of each other.
    A mesh file that changes meanwhile is not seen.
    """
    key = repr(asdict(scene))  # all of it: a scene's own repr is a line
    if key not in _BUILT:
        _BUILT[key] = build_quietly(scene)
    return _BUILT[key]
