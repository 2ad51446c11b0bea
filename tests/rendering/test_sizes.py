"""A body of a plant whose mesh is in another unit than meters is asked about."""

import warnings

import pytest
from plant_scenes import PlantScene
from pydrake.geometry import Box

from drake_haptics.scene.schema import ContactParameters
from drake_haptics.scene.validation import SceneWarning

SOFT = ContactParameters(stiffness_N_per_m=10.0, damping_Ns_per_m=0.0)


def render(tool_m, object_m, contact=SOFT):
    """Returns what is asked about a cube that meets another, by their sides in m."""
    scene = PlantScene()
    scene.add("tool", Box(tool_m, tool_m, tool_m))
    scene.add("block", Box(object_m, object_m, object_m))
    scene.finalize()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", SceneWarning)
        scene.render(contact=contact)
    return [str(item.message) for item in caught if " wide" in str(item.message)]


@pytest.mark.parametrize(
    "tool_m, unit, factor", [(80.0, "mm", "0.001"), (12.0, "cm", "0.01")]
)
def test_a_tool_in_another_unit_is_asked_about(tool_m, unit, factor):
    (sentence,) = render(tool_m, 0.1)
    for part in ("tool_body: 'tool'", f"{tool_m:g} m wide", f"in {unit}", factor):
        assert part in sentence


def test_a_tolerance_in_millimeters_is_asked_about():
    (sentence,) = render(
        0.04, 0.1, ContactParameters(tolerance_m=2.0, stiffness_N_per_m=10.0)
    )
    assert sentence.startswith("contact.tolerance_m: is 2 m, more than 'tool'")


def test_what_was_scaled_twice_is_asked_about():
    (sentence,) = render(0.05, 1e-4)
    assert "environment: 'block' is 100 µm wide" in sentence


@pytest.mark.parametrize("object_m", [2e-3, 0.1, 500.0])
def test_what_a_tool_meets_may_be_a_ground(object_m):
    assert render(0.05, object_m) == []
