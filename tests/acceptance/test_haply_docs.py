"""What the docs show of Haply runs, and their figures are those of the code."""

import inspect
import re
from pathlib import Path

from haply_service import HaplyService, Inverse3

from drake_haptics.device.haply.haply_device import HaplyDevice

PAGE = (Path(__file__).parents[2] / "docs" / "connect-a-device.md").read_text(
    encoding="utf-8"
)
TEXT = re.split(r"(?m)^## ", PAGE[PAGE.index("## Haply Inverse3") :])[1]
(SNIPPET,) = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)


def test_the_floor_holds_the_hand():
    mass = Inverse3(push_N=(0.0, 0.0, -1.0))
    printed = []
    with HaplyService({"049D": mass}) as service:
        assert "ws://127.0.0.1:10001" in SNIPPET
        code = SNIPPET.replace("ws://127.0.0.1:10001", service.uri)
        exec(compile(code, "the page", "exec"), {"print": lambda *v: printed.append(v)})
    # On a computer that stalls, the gate may have ended the loop's force.
    ((gate, has_grip),) = printed
    assert gate in ("ACTIVE", "FAULT")
    assert has_grip is False
    assert 0.5 < mass.largest_N <= 2.0
    assert not mass.forces[-1][1].any()


def test_defaults_of_the_table():
    parameters = inspect.signature(HaplyDevice).parameters
    rows = dict(re.findall(r"^\| `(\w+)` \| ([^|]+) \|", TEXT, re.MULTILINE))
    assert set(rows) == set(parameters) - {"uri", "timeout_s"}
    for name, text in rows.items():
        default = parameters[name].default
        assert text == (
            "the first one listed"
            if default is None
            else f"`{default}`"
            if isinstance(default, str)
            else f"{default:g}"
        )
