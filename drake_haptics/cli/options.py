"""Options that several commands share."""

from __future__ import annotations

import errno
import json
import math
import os
import re
import shlex
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

import click

from drake_haptics.cli.completion import complete_setting
from drake_haptics.common.errors import HapticsError, SceneError
from drake_haptics.common.files import resolve_package_url
from drake_haptics.geometry.mesh.decimation import decimate
from drake_haptics.geometry.mesh.mesh import Mesh, load_mesh
from drake_haptics.geometry.mesh.units import METERS_PER_UNIT

if TYPE_CHECKING:
    from drake_haptics.scene.schema import Scene


class FiniteRange(click.FloatRange):
    """A number in a range, which is neither `nan` nor `inf`."""

    name = "number"  # in messages

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Returns the number."""
        number: float = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"{value} is not a finite number.", param, ctx)
        return number


_Function = TypeVar("_Function", bound=Callable[..., Any])


def unit_options(function: _Function) -> _Function:
    """Adds --unit and --scale."""
    scale = click.option(
        "--scale",
        type=click.FloatRange(min=0, min_open=True),
        metavar="METERS",
        help="Meters per unit of the file, instead of --unit.",
    )
    return unit_option("the file")(scale(function))


def unit_option(what: str) -> Callable[[_Function], _Function]:
    """Adds --unit.

    Args:
        what: Name of what is in that unit, for --help.
    """
    return click.option(
        "--unit",
        type=click.Choice(list(METERS_PER_UNIT)),
        metavar="UNIT",
        help=f"Length unit of {what}: {', '.join(METERS_PER_UNIT)}.  [default: m]",
    )


max_triangles_option = click.option(
    "--max-triangles",
    type=click.IntRange(min=4),
    metavar="N",
    help="Reduce the mesh to at most N triangles first.",
)


def read_mesh(
    file: str, unit: str | None, scale: float | None, max_triangles: int | None
) -> Mesh:
    """Reads the mesh of a command.

    Raises:
        HapticsError: An option of the command would overwrite the file.
        drake_haptics.common.errors.MeshError: The mesh cannot be used.
        click.UsageError: Both unit and scale are given.
    """
    if unit is not None and scale is not None:
        raise click.UsageError("--unit and --scale exclude each other: give one")
    refuse_overwriting([file])
    mesh = load_mesh(file, unit=unit, scale=scale)
    return mesh if max_triangles is None else decimate(mesh, max_triangles)


def meshes_option(what: str) -> Callable[[_Function], _Function]:
    """Adds --meshes FOLDER.

    Args:
        what: Sentence about what is done with the meshes, for --help.
    """
    return click.option(
        "--meshes",
        type=click.Path(exists=True, file_okay=False, path_type=Path),
        metavar="FOLDER",
        help=f"{what} (cup_500.obj, ...).",
    )


def json_option(
    words: str = "Also write the report as JSON; - writes it to stdout, alone.",
) -> Callable[[_Function], _Function]:
    """Adds --json FILE, where - is stdout."""
    return click.option(
        "--json",
        "json_file",
        type=click.Path(dir_okay=False, allow_dash=True),
        metavar="FILE",
        callback=require_folder,
        help=words,
    )


def file_option(*names: str, **settings: Any) -> Callable[[_Function], _Function]:
    """Adds an option that takes the path of a file to be written."""
    return click.option(
        *names,
        type=click.Path(dir_okay=False, path_type=Path),
        callback=require_folder,
        **{"metavar": "FILE"} | settings,
    )


def require_folder(
    ctx: click.Context, option: click.Parameter, file: str | Path | None
) -> str | Path | None:
    """Returns the file of an option, after checking that it can be written.

    Raises:
        HapticsError: The file cannot be written, see `require_writable`, or another
            option writes it.
        click.BadParameter: It is - of an option that does not write to stdout.
    """
    is_stdout = str(file) == "-"
    if is_stdout and not cast(click.Path, option.type).allow_dash:
        raise click.BadParameter("cannot go to stdout: name a file.")
    if file is not None and not is_stdout:
        require_writable(Path(file), option.opts[0])
        for other, path in _list_written(ctx).items():
            if path.absolute() == Path(file).absolute():
                raise HapticsError(
                    f"{other} and {option.opts[0]}: each needs its own file"
                )
    return file


def refuse_overwriting(
    inputs: Iterable[str | os.PathLike[str]], written: Mapping[str, Path] | None = None
) -> None:
    """Refuses an option of the running command that would overwrite an input.

    Args:
        inputs: Files that the command reads; those that do not exist are left out.
        written: Files that it writes, by option. Defaults to those of the options.

    Raises:
        HapticsError: An option names one of them as the file to write.
    """
    files = [path for path in map(Path, inputs) if path.is_file()]
    if written is None:
        written = _list_written(click.get_current_context())
    for option, path in written.items():
        if path.is_file() and any(path.samefile(file) for file in files):
            raise HapticsError(
                f"{option}: {path} is an input of this command; give another file"
            )


def _list_written(ctx: click.Context) -> dict[str, Path]:
    """Returns the files that the options read so far write, by option."""
    written = {
        option.opts[0]: ctx.params.get(option.name or "")
        for option in ctx.command.params
        if option.callback is require_folder
    }
    return {
        name: Path(file) for name, file in written.items() if file not in (None, "-")
    }


def require_writable(path: Path, option: str) -> None:
    """Checks that a file can be written.

    Raises:
        HapticsError: The folder does not exist, or the file cannot be written.
    """
    folder = path.absolute().parent
    if not folder.is_dir():
        raise HapticsError(f"{option}: there is no folder {path.parent}")
    if reason := _try_to_open(path):
        raise HapticsError(
            f"{option}: {path} cannot be written ({reason}); name a file in a folder"
            " that you can write to"
        )


def _try_to_open(path: Path) -> str:
    """Returns why a file cannot be opened for writing, or "".

    The file is not changed. It is really opened, because permissions do not reveal a
    folder in which no file can be made, or a name that is too long.
    """
    try:
        target = Path(os.path.realpath(path))
        is_new = not target.exists()
        # Opening a pipe or a device may wait for its reader.
        if not is_new and not target.is_file():
            return "" if os.access(target, os.W_OK) else os.strerror(errno.EACCES)
        os.close(os.open(target, os.O_WRONLY | os.O_CREAT, 0o666))
    except OSError as error:
        return error.strerror or str(error)
    if is_new:
        target.unlink()
    return ""


def write_json(data: dict[str, Any], file: str | None) -> None:
    """Writes JSON to the file of --json, if it is given; to stdout for "-"."""
    if file is None:
        return
    text = json.dumps(data, indent=2, allow_nan=False)
    if file == "-":
        click.echo(text)
        return
    try:
        Path(file).write_text(text + "\n", encoding="utf-8")
    except OSError as error:  # a full disk names no file
        raise OSError(error.errno, error.strerror, file) from error


# A scale in a message of the library, as an argument or a key of a scene.
_SCALE_ARGUMENT = re.compile(r"(tool|environment)_scale=([\d.e+-]+)")
_SCALE_KEY = re.compile(r"(tool|environment)(?:\[0\])?\.scale: ([\d.e+-]+)")


set_option = click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="KEY=VALUE",
    shell_complete=complete_setting,
    help="Change a value of the scene, like contact.stiffness_N_per_m=4000 or"
    " tool.mesh=my.obj, a path from this folder; may be given again. Without"
    " VALUE: its default, and an effect is off.",
)


def load_set_scene(scene: str, settings: Sequence[str]) -> Scene:
    """Returns a scene with the changes of --set.

    Raises:
        SceneError: There is no such scene, or it cannot be used.
        HapticsError: A setting is invalid, see `set_values`, or an option of the
            command would overwrite the scene or one of its meshes.
    """
    from drake_haptics.scene.library import find_scene
    from drake_haptics.scene.scene_file import load_scene

    file = find_scene(scene)
    refuse_overwriting([file])
    return set_values(load_scene(file), settings)


def set_values(scene: Scene, settings: Sequence[str]) -> Scene:
    """Returns a scene with the changes of --set; the same one if there are none.

    Raises:
        HapticsError: A setting has an unknown key or an invalid value, or an option of
            the command would overwrite a mesh of the scene.
    """
    from drake_haptics.scene.settings import change_scene

    if settings:
        try:
            scene = change_scene(scene, settings)
        except SceneError as error:
            # A setting may have made another key of the scene wrong.
            given = shlex.join(settings)
            raise HapticsError(f"--set {given}: {error}") from error
    meshes = [scene.tool.mesh, *(item.mesh for item in scene.environment)]
    refuse_overwriting(map(resolve_package_url, meshes))
    return scene


def write_call(command: str, scene: str, settings: Sequence[str]) -> str:
    """Returns the command line that gives a command the same scene."""
    pairs = [word for setting in settings for word in ("--set", setting)]
    return shlex.join(["drake-haptics", command, scene, *pairs])


def name_scale_options(words: str) -> str:
    """Adds the options that set a scale to a message that names it."""
    words = _SCALE_ARGUMENT.sub(r"--\1-scale \2", words)
    return _SCALE_KEY.sub(
        r"\g<0> (with --tool and --environment: --\1-scale \2)", words
    )
