"""What commands that take a SCENE share: --set, and the scene that it makes."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import click

from drake_haptics.cli.complete import complete_setting
from drake_haptics.common.errors import SceneError, UserError

if TYPE_CHECKING:
    from drake_haptics.scene.schema import Scene

# A scale that the library asks for, as a key of a scene or an argument.
_SCALE = re.compile(r"(tool|environment)(?:\[0\]\.|\.|_)scale(?:: |=)([\d.e-]+)")

_Function = TypeVar("_Function", bound=Callable[..., Any])


def set_option(function: _Function) -> _Function:
    """Adds --set KEY=VALUE, as `settings`."""
    return click.option(
        "--set",
        "settings",
        multiple=True,
        metavar="KEY=VALUE",
        shell_complete=complete_setting,
        help="Change a value of the scene, like contact.stiffness_N_per_m=4000 or"
        " tool.mesh=my.obj, a path from this folder; may be given again. Without"
        " VALUE: its default, and an effect is off.",
    )(function)


def load_set_scene(scene: str, settings: Sequence[str]) -> Scene:
    """Returns a scene with what --set changes.

    Args:
        scene: A shipped scene's name, or a file.
        settings: Of `set_option`.

    Raises:
        SceneError: There is no such scene, or it cannot be used.
        UserError: As `set_values`.
    """
    from drake_haptics.scene.library import find_scene
    from drake_haptics.scene.scene_file import load_scene

    return set_values(load_scene(find_scene(scene)), settings)


def set_values(scene: Scene, settings: Sequence[str]) -> Scene:
    """Returns a scene with what --set changes; the same one where that is nothing.

    Raises:
        UserError: It is no key, or an impossible value.
    """
    from drake_haptics.scene.settings import change_scene

    if not settings:
        return scene
    try:
        return change_scene(scene, settings)
    except SceneError as error:
        raise UserError(f"--set {error}") from error


def write_call(command: str, scene: str, settings: Sequence[str]) -> str:
    """Returns the words that give another command the same scene, for a shell."""
    pairs = [word for setting in settings for word in ("--set", setting)]
    return shlex.join(["drake-haptics", command, scene, *pairs])


def name_scale_options(words: str) -> str:
    """Returns words of the library with the options of the scales that they ask for."""
    return _SCALE.sub(r"\g<0> (with --tool and --environment: --\1-scale \2)", words)
