"""What a page asks of a run is done between two ticks, or answered."""

import dataclasses
import json

import numpy as np
import pytest
from cockpit_rig import FRICTION, MOUSE, STIFFER, find_tool

from drake_haptics.cockpit.scene_changes import EFFECTS
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.scene.schema import (
    Effects,
    EnvironmentObject,
    PassivityParameters,
    Scene,
)
from drake_haptics.simulation.live_values import live_keys, write_live_values
from drake_haptics.simulation.run import run
from drake_haptics.systems.output.haptic_picture import PICTURE_VIEWS
from drake_haptics.visualization.meshcat import CAMERAS
from drake_haptics.web.messages import LARGEST_DATAGRAM, read_page_request


def test_a_page_is_told_what_there_is_to_see_and_to_change(make, scene):
    rig = make({})
    rig.run(0.01)
    [hello] = rig.page.hellos
    assert (hello["scene"], hello["locked"]) == ("test", "")
    assert hello["meshcat"] == rig.page.meshcat_url
    assert hello["period_s"] == 1e-3
    site = find_device_site(scene)
    assert hello["limits"] == {
        "force_N": site.max_force_N,
        "torque_Nm": site.max_torque_Nm,
    }
    keys = {item["key"]: item for item in hello["keys"]}
    assert list(keys) == [item.key for item in live_keys(scene)]
    stiffness = keys["contact.stiffness_N_per_m"]
    assert stiffness["file"] == scene.contact.stiffness_N_per_m
    assert (stiffness["unit"], stiffness["group"]) == ("N/m", "contact")
    assert stiffness["low"] < stiffness["file"] < stiffness["high"]
    assert stiffness["help"].startswith("Force per meter")
    assert [item["name"] for item in hello["effects"]] == list(EFFECTS)
    assert all(item["help"] and item["file"] is False for item in hello["effects"])
    [choice] = hello["choices"]
    assert (choice["key"], choice["file"]) == ("contact.clustering", "shared")
    names = {key: [item["name"] for item in hello[key]] for key in ("handles", "views")}
    assert names == {
        "handles": ["hand", "mouse", "sliders"],
        "views": list(PICTURE_VIEWS),
    }
    assert hello["cameras"] == list(CAMERAS)


def test_a_value_glides_from_the_next_tick_on(make, scene):
    rig = make({300: [STIFFER]}, watch=find_tool)
    rig.run(0.6)
    poses = []
    haptic = BuildHapticDiagram(scene)

    def end_tick(root):
        poses.append(find_tool(haptic, root))
        share = min(max(len(poses) - 299, 0) / 200, 1.0)
        K_N_per_m = 800.0 ** (1 - share) * 1200.0**share
        coupling = dataclasses.replace(scene.coupling, stiffness_N_per_m=K_N_per_m)
        write_live_values(haptic, root, dataclasses.replace(scene, coupling=coupling))

    run(haptic, 0.6, on_tick=end_tick)
    np.testing.assert_allclose(rig.seen, poses, atol=1e-12)
    assert len(rig.haptics) == 1
    state = rig.page.states[-1]
    assert state["values"]["coupling.stiffness_N_per_m"] == 1200.0
    assert state["changes"] == {"coupling": {"stiffness_N_per_m": 1200.0}}


def test_effects_switched_together_build_one_diagram(make):
    rig = make({100: [FRICTION], 150: [{**FRICTION, "name": "gravity"}]})
    rig.run(0.6)
    assert len(rig.haptics) == 2
    effects = rig.haptics[-1].loop.effects
    assert effects.friction is not None and effects.gravity is not None


def test_the_reserve_of_passivity_waits_until_a_slider_rests(make):
    script = {100: [{"do": "effect", "name": "passivity", "on": True}]}
    for tick in range(500, 700, 10):
        script[tick] = [{**STIFFER, "to": 1000 + tick}]
    rig = make(script)
    rig.run(1.2)
    assert len(rig.haptics) == 3
    assert rig.last.scene.coupling.stiffness_N_per_m == 1690.0


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({**STIFFER, "to": 1e300}, "from 50 to 5000"),
        ({**STIFFER, "key": "no.key"}, "no value 'no.key'"),
        ({"do": "choose", "key": "contact.clustering", "to": "x"}, "no choice 'x'"),
        ({"do": "effect", "name": "x", "on": True}, "no effect 'x'"),
        ({"do": "handle", "to": "x"}, "no holder called 'x'"),
        ({"do": "handle", "to": "device"}, "no holder called 'device'"),
        ({"do": "view", "name": "x", "on": True}, "view"),
        ({"do": "camera", "to": "x"}, "view"),
        ({"do": "camera", "to": "fit", "within": 0.0}, "within"),
    ],
)
def test_what_cannot_be_is_refused_and_the_run_goes_on(make, asked, message):
    rig = make({10: [asked]})
    assert rig.run(0.12)["ticks"] == 120
    assert message in rig.page.states[-1]["error"]
    assert len(rig.haptics) == 1


def test_an_error_is_told_until_something_else_is_asked(make):
    rig = make({10: [{**STIFFER, "to": -1}], 150: [STIFFER]})
    rig.run(0.2)
    assert [bool(state["error"]) for state in rig.page.states] == [False, True, False]


def test_a_switch_is_answered_by_its_number(make):
    view = {"do": "view", "name": "pieces", "on": True, "number": 7}
    refused = {"do": "effect", "name": "x", "on": True, "number": 8}
    rig = make({10: [view], 150: [refused], 300: [STIFFER]})
    rig.run(0.4)
    assert [state["answered"] for state in rig.page.states] == [0, 7, 8, 8]


def test_requests_of_no_concern_are_ignored(make):
    nothing = [{"refused": 1}, {"do": "home"}, {"do": "take"}, {}, {"do": "fly"}]
    rig = make({10: nothing})
    rig.run(0.1)
    assert len(rig.page.states) == 1


def test_a_locked_run_is_only_looked_at(make):
    clustering = {"do": "choose", "key": "contact.clustering", "to": "octree"}
    wishes = [STIFFER, FRICTION, MOUSE, clustering, {"do": "reset"}, {"do": "restart"}]
    rig = make(
        {150 * k + 10: [asked] for k, asked in enumerate(wishes)}
        | {920: [{"do": "view", "name": "pieces", "on": True}]},
        locked="It is logged.",
    )
    figures = rig.run(1.1, energy=True)
    assert figures["energy_J"]["tool"]["stored"] > 0.0
    assert len(rig.haptics) == 1
    assert rig.changes.scene is rig.changes.file
    errors = [state["error"] for state in rig.page.states]
    assert errors == ["", *["It is logged."] * len(wishes), ""]
    assert rig.page.states[-1]["views"]["pieces"] is True
    assert rig.page.hellos[0]["locked"] == "It is logged."


def test_the_coupling_is_judged_as_it_is_now(make):
    damped = {"do": "set", "key": "coupling.damping_Ns_per_m", "to": 20}
    rig = make({10: [damped], 150: [{"do": "reset"}]})
    rig.run(0.3)
    warned = [bool(state["warnings"]) for state in rig.page.states]
    assert warned == [False, True, False]
    [warning] = rig.page.states[1]["warnings"]
    assert warning["key"] == "coupling.damping_Ns_per_m"
    assert warning["words"].startswith("A loose grip may vibrate: device and hand")
    assert warning["why"].startswith("damping_Ns_per_m is 20: not passive")


def test_ticks_that_take_too_long_are_told_with_the_key_that_helps(
    make, scene, monkeypatch
):
    asked = []

    def find_key(costs_us, scene):
        asked.append((costs_us, scene))
        return "contact.tolerance_m: a smaller one."

    monkeypatch.setattr("drake_haptics.cockpit.cockpit.find_key_that_helps", find_key)
    # Less than any tick takes.
    device = dataclasses.replace(scene.device, tick_budget_us=10.0)
    rig = make({}, scene=dataclasses.replace(scene, device=device))
    rig.run(0.2)
    assert rig.page.outlooks[-1].shed > 0
    assert rig.page.states[0]["relief"] == ""
    assert rig.page.states[-1]["relief"] == "contact.tolerance_m: a smaller one."
    [(costs_us, slow)] = asked
    assert costs_us["contact_query"] > 0.0 and slow is rig.changes.scene


def make_requests(rng, count):
    """Returns requests of every kind, right and wrong, as pages are allowed to ask."""
    keys = [*(item.key for item in live_keys(Scene(environment=[EnvironmentObject()]))),
            "contact.clustering", "contact.cluster_size_m", "x"]  # fmt: skip
    names = [*EFFECTS, *PICTURE_VIEWS, *CAMERAS, "hand", "mouse", "device", "octree",
             "shared", "__class__", ""]  # fmt: skip
    numbers = [0, -1, 1e300, -1e300, 1e-300, 10**200, 2e-3, 5, 1000, 0.5, 1.0]
    steps = [-1, 1, 0.3, 1e-300]

    def draw(values):
        return values[rng.integers(len(values))]

    kinds = {
        "set": lambda: {"key": draw(keys), "to": draw(numbers)},
        "choose": lambda: {"key": draw(keys), "to": draw(names)},
        "effect": lambda: {"name": draw(names), "on": bool(rng.integers(2))},
        "handle": lambda: {"to": draw(names)},
        "view": lambda: {"name": draw(names), "on": bool(rng.integers(2))},
        "camera": lambda: {"to": draw(names), "within": draw(numbers)},
        "move": lambda: {"by": [draw(steps) for _ in range(3)]},
        "turn": lambda: {"by": [draw(steps) for _ in range(3)]},
        "home": dict, "take": dict, "reset": dict, "restart": dict,
    }  # fmt: skip
    verbs = [draw(list(kinds)) for _ in range(count)]
    asked = [{"do": verb, **kinds[verb]()} for verb in verbs]
    assert all(read_page_request(json.dumps(item)) == item for item in asked)
    return asked


def read_live_values(haptic, root):
    """What the loop runs with: gains, rule of clustering, contact's stiffness."""
    loop = haptic.loop
    coupling, clustering = loop.virtual_coupling, loop.contact_clustering
    gains = coupling.get_gains(coupling.GetMyContextFromRoot(root))
    rule = clustering.get_rule(clustering.GetMyContextFromRoot(root))
    force = loop.penalty_force
    contact = force.get_gains(force.GetMyContextFromRoot(root))
    return {
        **{key: getattr(gains, key) for key in dataclasses.asdict(Scene().coupling)},
        "clustering": rule.method,
        "tolerance_m": rule.tolerance_m,
        "contact": contact.stiffness_N_per_m[0],
    }


@pytest.mark.parametrize("passivity", [None, PassivityParameters()])
def test_whatever_is_asked_in_whatever_order_the_run_goes_on(make, scene, passivity):
    """And runs in the end with what the page says."""
    rng = np.random.default_rng(8)
    octree = {"do": "choose", "key": "contact.clustering", "to": "octree"}
    rig = make(
        {tick: make_requests(rng, 30) for tick in range(5, 200, 20)}
        | {201: [STIFFER, octree]},
        watch=read_live_values,
        scene=dataclasses.replace(scene, effects=Effects(passivity=passivity)),
    )
    assert rig.run(0.8)["ticks"] == 800
    json.dumps([rig.page.hellos, rig.page.states], allow_nan=False)
    assert len(rig.haptics) > 3
    now = rig.changes.scene
    assert now.coupling.stiffness_N_per_m == 1200.0
    assert rig.seen[-1] == {
        **dataclasses.asdict(now.coupling),
        "clustering": now.contact.clustering,
        "tolerance_m": now.contact.tolerance_m,
        "contact": now.contact.stiffness_N_per_m,
    }


def test_a_page_is_told_of_a_long_description_what_it_can_be_told(make, scene):
    """A hello that is longer than a datagram would never come."""
    rig = make({}, scene=dataclasses.replace(scene, description="Längs " * 20_000))
    rig.run(0.01)
    [hello] = rig.page.hellos
    assert hello["description"].startswith("Längs Längs")
    assert len(json.dumps({"hello": hello})) < LARGEST_DATAGRAM
