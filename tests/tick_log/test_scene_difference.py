"""What differs between two scenes, by key."""

from drake_haptics.tick_log.scene_difference import find_changes

BEFORE = """\
tool: {mass_kg: 0.1}
environment: [{scale: 1}, {scale: 2}]
a: [1, 2]
"""
AFTER = """\
tool: {mass_kg: 0.2}
environment: [{scale: 1}, {scale: 3}]
a: [1, 2]
b: 4
"""


def test_what_differs_between_two_scenes_is_found():
    BEFORE = "tool: {mass_kg: 0.1}\nenvironment: [{scale: 1}, {scale: 2}]\na: [1, 2]\n"
    AFTER = (
        "tool: {mass_kg: 0.2}\nenvironment: [{scale: 1}, {scale: 3}]\na: [1, 2]\nb: 4"
    )
    assert find_changes(BEFORE, BEFORE) == []
    assert find_changes(BEFORE, AFTER) == [
        "tool.mass_kg: 0.1, 0.2",
        "environment[1].scale: 2, 3",
        "b: not there, 4",
    ]
