"""What is named where ticks take too long: the costliest part that a key lowers."""

import pytest

from drake_haptics.authoring.speedup import find_key_that_helps, suggest_speedup
from drake_haptics.scene.schema import (
    ContactParameters,
    DeviceParameters,
    EnvironmentObject,
    Scene,
    Tool,
)
from drake_haptics.simulation.profiling import Part


def scene(**changes):
    whole = dict(
        tool=Tool(mesh="a.obj"), environment=[EnvironmentObject("b", mesh="b.obj")]
    )
    return Scene(**(whole | changes))


def parts(**costs_us):
    whole = sum(costs_us.values())
    return [Part(name, "S", "why", us, us / whole) for name, us in costs_us.items()]


def test_nothing_is_said_of_a_tick_that_fits():
    fits = parts(contact_clustering=500.0, contact_query=200.0)
    assert suggest_speedup(fits, scene()) is None
    within = scene(device=DeviceParameters(tick_budget_us=600.0))
    assert "may take 600 µs" in suggest_speedup(fits, within)
    faster = scene(device=DeviceParameters(rate_hz=2000.0))
    assert "takes 700 µs and may take 400 µs" in suggest_speedup(fits, faster)


@pytest.mark.parametrize(
    ("costliest", "changes", "key"),
    [
        ("contact_clustering", {}, "contact.clustering: octree"),
        ("penalty_force", {}, "contact.clustering: octree"),
        (
            "contact_clustering",
            {"contact": ContactParameters(clustering="octree", cluster_size_m=5e-3)},
            "tool.decomposition: merged",
        ),
        ("contact_query", {}, "tool.decomposition: merged"),
        (
            "contact_query",
            {"tool": Tool(mesh="a.obj", decomposition="hull")},
            "environment[0].decomposition: merged",
        ),
        (
            "contact_query",
            {
                "tool": Tool(mesh="a.obj", decomposition="hull"),
                "environment": [EnvironmentObject("b", decomposition="hull")],
            },
            "contact.tolerance_m",
        ),
        ("force_shading", {}, "effects.shading"),
        ("stick_slip_friction", {}, "effects.friction"),
        ("haptic_visualizer", {}, "device.tick_budget_us"),
    ],
)
def test_the_key_is_that_of_the_costliest_part(costliest, changes, key):
    others = {"contact_query": 200.0, "contact_clustering": 190.0, "simulated_arm": 900}
    said = suggest_speedup(parts(**others | {costliest: 500.0}), scene(**changes))
    assert f"{costliest} takes most, 500 µs" in said
    assert key in said


def test_what_no_key_lowers_is_not_named():
    assert suggest_speedup(parts(simulated_arm=2e3, haptic_tool=50.0), scene()) is None


def test_what_takes_little_is_not_worth_a_change():
    slow = parts(simulated_arm=2e3, contact_query=90.0)
    assert suggest_speedup(slow, scene()) is None
    assert find_key_that_helps({"contact_query": 110.0}, scene()) is not None
    assert find_key_that_helps({}, scene()) is None
