"""Keys of a scene: every value has one, and each is taken by a scene file."""

from dataclasses import asdict

from drake_haptics.scene.schema import (
    BrakingParameters,
    Effects,
    EnvironmentObject,
    Scene,
)
from drake_haptics.scene.settings import list_keys


def find_leaves(data, where=""):
    """Returns the keys of plain data, parts that are None among them."""
    for name, value in data.items():
        if isinstance(value, dict):
            yield from find_leaves(value, f"{where}{name}.")
        else:
            yield f"{where}{name}"


def test_every_value_of_a_scene_has_a_key():
    keys = list_keys(Scene)
    assert len(set(keys)) == len(keys)
    scene = Scene(effects=Effects(braking=BrakingParameters()))
    for leaf in find_leaves(asdict(scene)):
        # A part that is not there has its keys in the list.
        assert leaf in keys or any(key.startswith(f"{leaf}.") for key in keys)
    assert {"effects.braking.distance_m", "device.base.rpy_deg", "environment"} < set(
        keys
    )


def test_keys_begin_with_what_is_asked():
    assert "environment.pose.position_m" in list_keys(EnvironmentObject, "environment.")
