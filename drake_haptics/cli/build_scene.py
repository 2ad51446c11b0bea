"""Builds a scene under the eyes of whoever waits for it."""

from __future__ import annotations

import warnings

from pydrake.geometry import Meshcat
from rich.console import Console
from rich.progress import Progress, TaskID

from drake_haptics.authoring.plausibility import question_scene
from drake_haptics.cli.failures import warn
from drake_haptics.cli.scene_options import name_scale_options
from drake_haptics.device.backend import DeviceBackend
from drake_haptics.loop.builder import BuildHapticDiagram, HapticDiagram
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import SceneWarning
from drake_haptics.tick_log.tick_recorder import TickRecorder


def build_scene(
    console: Console,
    scene: Scene,
    meshcat: Meshcat | None,
    device: DeviceBackend | None = None,
    recorder: TickRecorder | None = None,
) -> HapticDiagram:
    """Builds the diagram, with a bar while meshes are cut into pieces.

    What the scene may do wrong is then written to stderr, a line each.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", SceneWarning)
        haptic = _build(console, scene, meshcat, device, recorder)
    # Only now, when the bar is gone.
    for warning in caught:
        warn(str(warning.message))
    for question in question_scene(haptic):
        warn(name_scale_options(question))
    return haptic


def _build(
    console: Console,
    scene: Scene,
    meshcat: Meshcat | None,
    device: DeviceBackend | None,
    recorder: TickRecorder | None,
) -> HapticDiagram:
    """Builds the diagram behind the bar."""
    quiet = not console.is_terminal
    with Progress(console=console, transient=True, disable=quiet) as bars:
        tasks: dict[str, TaskID] = {}

        def report(name: str, share: float) -> None:
            if name not in tasks:
                tasks[name] = bars.add_task(
                    f"Cutting {name} into convex pieces", total=1
                )
            bars.update(tasks[name], completed=share)

        return BuildHapticDiagram(
            scene, device=device, recorder=recorder, meshcat=meshcat, progress=report
        )
