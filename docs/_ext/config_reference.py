"""The directive that describes all keys of scene or device files.

In a page, ::

    ```{config-keys} scene
    ```

is a section for each part of a scene file, with type, unit, default, meaning and bounds
of each key. All of it is read from the program.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from config_keys import Key, Part, join, list_parts
from config_rules import find_rules
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from drake_haptics.scene.device_preset import DevicePreset, load_device_preset
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.live_values import is_live_change, live_keys

_EVERY_KEY = "reference/every-key.yaml"
_LIVE = "[Live](../compose.md#change-gains-while-it-runs):"
_PRESET = "reference/every-key-of-a-device.yaml"


@dataclass(frozen=True)
class ConfigFile:
    """A kind of file.

    Attributes:
        schema: The dataclass that it is loaded into.
        load: Loads one, or raises HapticsError.
        example: One with every key, from the folder of the pages.
        find_live: Returns the keys of a loaded one that can be changed while it runs.
        is_indexed: Whether its keys are in the index; two kinds have some in common.
    """

    schema: type
    load: Callable[[Path], Any]
    example: str
    find_live: Callable[[Any], set[str]]
    is_indexed: bool = False


def _find_live_keys(scene: Scene) -> set[str]:
    """Returns the live keys of a scene with clusters, with what makes the clusters."""
    other = replace(scene.contact, clustering="shared", cluster_size_m=None)
    keys = {key.key for key in live_keys(scene)}
    if is_live_change(scene, replace(scene, contact=other)):
        keys.add("contact.clustering")
    return keys


def _load_device(path: Path) -> DevicePreset:
    return load_device_preset(str(path))


FILES = {
    "scene": ConfigFile(Scene, load_scene, _EVERY_KEY, _find_live_keys, True),
    "device": ConfigFile(DevicePreset, _load_device, _PRESET, lambda _: set()),
}


@dataclass(frozen=True)
class _Facts:
    """What is known of keys beyond their dataclasses, by path; see `ConfigFile`."""

    rules: dict[str, str]
    live: set[str]
    is_indexed: bool


class ConfigKeys(SphinxDirective):
    """The directive `config-keys`; its argument is a name in `FILES`."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Returns the sections."""
        kind = FILES[self.arguments[0]]
        example = Path(self.env.srcdir) / kind.example
        self.env.note_dependency(str(example))
        facts = _Facts(
            find_rules(kind.load, example),
            kind.find_live(kind.load(example)),
            kind.is_indexed,
        )
        parts = list_parts(kind.schema)
        text = "\n".join(line for part in parts for line in _write_part(part, facts))
        return self.parse_text_to_nodes(text, allow_section_headings=True)


def _write_part(part: Part, facts: _Facts) -> Iterator[str]:
    """Yields the Markdown of a part."""
    yield f"## `{part.path}`\n" if part.path else "## The whole file\n"
    yield " ".join(dict.fromkeys(text for text in (part.text, part.summary) if text))
    yield ""
    if part.is_optional:
        name = part.path.rpartition(".")[2]
        yield f"Not there unless it is named; `{name}: {{}}` takes all defaults.\n"
    for key in part.keys:
        yield from _write_key(key, join(part.path, key.name), facts)
    if part.parts:
        links = (f"[`{path}`](#{_make_anchor(path)})" for path in part.parts)
        yield f"In it: {', '.join(links)}.\n"


def _write_key(key: Key, path: str, facts: _Facts) -> Iterator[str]:
    """Yields the Markdown of a key."""
    unit = f", {key.unit}" if key.unit else ""
    yield f"```{{confval}} {path}"
    yield f":type: {key.type_words}{unit}"
    if not facts.is_indexed:
        yield ":no-index:"
    if key.default:
        yield f":default: {key.default}"
    words = [key.text, _write_rule(facts.rules.get(path, ""))]
    if path in facts.live:
        words.append(f"{_LIVE} it can be changed while the scene runs.")
    yield f"\n{' '.join(filter(None, words))}"
    yield "```\n"


def _write_rule(rule: str) -> str:
    """Returns what a value must be as a sentence."""
    if rule.startswith("known: "):
        names = rule.removeprefix("known: ").split(", ")
        return f"One of {', '.join(f'`{name}`' for name in names)}."
    if rule == "is missing":
        return "Must be given."
    return f"{rule[0].upper()}{rule[1:]}." if rule else ""


def _make_anchor(path: str) -> str:
    """Returns the anchor that a heading of this text gets."""
    return path.lower().replace(".", "").replace("[]", "")


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the directive."""
    app.add_directive("config-keys", ConfigKeys)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
