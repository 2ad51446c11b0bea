"""Reads the block in which a system's docstring lists its ports.

The block is Drake's own, YAML under a directive, so that pydrake's tools draw it too::

    .. pydrake_system::

        name: VirtualCoupling
        input_ports:
        - X_WH
        - load_shedding (with load shedding)
        output_ports:
        - F_Ho_W_commanded

What is in parentheses says when a port is there; `<...>` stands for a part of its name.
"""

from __future__ import annotations

import re
import textwrap
from dataclasses import dataclass

import yaml

_BLOCK = re.compile(r"^( *)\.\. pydrake_system::\n\n((?:\1 +.*\n|\n)+)", re.MULTILINE)
_KEYS = {"name", "input_ports", "output_ports"}


@dataclass(frozen=True)
class Port:
    """A port of a system.

    Attributes:
        name: Its name, with `<...>` where it depends on what is constructed.
        condition: When it is there, as words; empty if always.
    """

    name: str
    condition: str

    def matches(self, name: str) -> bool:
        """Whether a port of a constructed system is this one."""
        parts = re.split(r"<[^>]*>", self.name)
        return bool(re.fullmatch(".+".join(map(re.escape, parts)), name))


@dataclass(frozen=True)
class SystemBlock:
    """What a block says.

    Attributes:
        name: Of the system's class.
        input_ports: In order.
        output_ports: In order.
    """

    name: str
    input_ports: tuple[Port, ...]
    output_ports: tuple[Port, ...]


def parse_block(text: str) -> SystemBlock:
    """Reads the content of a block.

    Raises:
        ValueError: It is not YAML, or has other keys than a name and ports.
    """
    try:
        data = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ValueError(f"pydrake_system: no YAML: {error}") from error
    if not isinstance(data, dict) or not {"name"} <= data.keys() <= _KEYS:
        raise ValueError(f"pydrake_system: needs a name, and takes {sorted(_KEYS)}")
    return SystemBlock(
        data["name"],
        tuple(map(_parse_port, data.get("input_ports", ()))),
        tuple(map(_parse_port, data.get("output_ports", ()))),
    )


def find_blocks(docstring: str) -> list[SystemBlock]:
    """Returns the blocks in a docstring."""
    text = textwrap.dedent(docstring) + "\n"
    return [parse_block(block[2]) for block in _BLOCK.finditer(text)]


def _parse_port(text: str) -> Port:
    name, _, condition = text.partition(" (")
    return Port(name, condition.removesuffix(")"))
