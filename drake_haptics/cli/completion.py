"""Completes words by the Tab key; `drake-haptics completion`."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

import click
from click.shell_completion import CompletionItem, get_completion_class

from drake_haptics.cli.command_help import CommandWithExamples
from drake_haptics.common.errors import HapticsError

_ADDRESSES = {
    "udp://127.0.0.1:7400": "a driver, such as `drake-haptics device`",
    "mouse:": "the mouse, on the page",
    "meshcat:": "sliders and gamepad, on the page",
    "haply://127.0.0.1": "Haply's service",
    "lcm:": "a driver on LCM",
    "replay:": "the handle of a log",
}


def complete_scene(
    _: click.Context, __: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """Completes names of shipped scenes, else files."""
    from drake_haptics.scene.library import list_scenes

    return _complete(list_scenes(), incomplete) or [
        CompletionItem(incomplete, type="file")
    ]


def complete_address(
    _: click.Context, __: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """Completes kinds of devices."""
    return [
        CompletionItem(address, help=what)
        for address, what in _ADDRESSES.items()
        if address.startswith(incomplete)
    ]


def complete_setting(
    _: click.Context, __: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """Completes KEY=VALUE of a scene: keys, and devices after `device.preset=`."""
    from drake_haptics.scene.settings import list_setting_keys

    if "=" not in incomplete:
        return _complete([f"{key}=" for key in list_setting_keys()], incomplete)
    if not incomplete.startswith("device.preset="):
        return []
    from drake_haptics.scene.device_preset import list_device_presets

    return _complete(
        [f"device.preset={name}" for name in list_device_presets()], incomplete
    )


def _complete(words: Iterable[str], incomplete: str) -> list[CompletionItem]:
    return [CompletionItem(word) for word in words if word.startswith(incomplete)]


_PROGRAM = "drake-haptics"
_FISH = "~/.config/fish/completions/drake-haptics.fish"
_HOW = {
    "bash": 'add this line to ~/.bashrc: eval "$(drake-haptics completion bash)"',
    "zsh": "add this line to ~/.zshrc, below compinit:"
    ' eval "$(drake-haptics completion zsh)"',
    "fish": f"run once: drake-haptics completion fish > {_FISH}",
}


@click.command(cls=CommandWithExamples)
@click.argument("shell", type=click.Choice(list(_HOW)), required=False)
def completion(shell: str | None) -> None:
    """Print a script that lets the Tab key complete commands, options and scenes.

    SHELL is that of $SHELL if not given. The first line that is printed says where it
    belongs.
    """
    shell = shell or Path(os.environ.get("SHELL", "")).name
    kind = get_completion_class(shell)
    if shell not in _HOW or kind is None:
        raise HapticsError(f"no completion for '{shell}': name {', '.join(_HOW)}")
    root = click.get_current_context().find_root().command
    script = kind(root, {}, _PROGRAM, "_DRAKE_HAPTICS_COMPLETE").source()
    click.echo(f"# For good, {_HOW[shell]}")
    click.echo(script)
