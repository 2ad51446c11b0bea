"""A plant that is pushed by the contact chain moves as one pushed by the ports."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest
from cube_scene import CONTACT, HALF, MASS, G, make_scene
from diagram_parts import sources
from plant_scenes import PLANTS
from pydrake.math import RigidTransform, RollPitchYaw
from slider_device import make_device

from drake_haptics.rendering import wiring
from drake_haptics.scene.schema import (
    BrakingParameters,
    CouplingParameters,
    Effects,
    FrictionParameters,
    ShadingParameters,
)
from drake_haptics.scene.validation import SceneWarning
from drake_haptics.systems.contact.contact_clustering import ClusteringRule

ON_AN_EDGE = RigidTransform(RollPitchYaw(0.4, 0.3, 0.0), [0.0, 0.0, 2.0 * HALF])


def has_chain(rendering) -> bool:
    return rendering.GetSubsystemByName("contact_query").HasOutputPort("contact_chain")


def make_both(monkeypatch: pytest.MonkeyPatch, make, tool=ON_AN_EDGE):
    """Starts what is made both ways: by the chain, and by the ports."""
    scenes = [make()]
    with monkeypatch.context() as patch:
        patch.setattr(wiring, "can_chain", lambda *_: False)
        scenes.append(make())
    assert [has_chain(rendering) for _, rendering in scenes] == [True, False]
    for scene, _ in scenes:
        scene.start(tool=tool)
    return scenes


def advance(scene, rendering, duration_s: float) -> np.ndarray:
    """Returns the plant's state and the force on the tool after each step."""
    found: list[np.ndarray] = []

    def note(root) -> None:
        state = scene.plant.GetPositionsAndVelocities(scene.context)
        found.append(np.append(state, scene.read(rendering, "F_To_W")))

    scene.simulator.set_monitor(note)
    scene.simulator.AdvanceTo(scene.root.get_time() + duration_s)
    return np.array(found)


@pytest.mark.parametrize("config", PLANTS.values(), ids=PLANTS)
def test_a_body_falls_and_rolls_bit_by_bit_alike(monkeypatch, config) -> None:
    scenes = make_both(monkeypatch, lambda: make_scene(config=config))
    one, other = (advance(*scene, 0.2) for scene in scenes)
    np.testing.assert_array_equal(one, other)
    assert one[:, -1].max() > 1.0


def test_friction_holds_a_body_by_the_chain_as_by_the_ports(monkeypatch) -> None:
    rough = Effects(friction=FrictionParameters())
    scenes = make_both(monkeypatch, lambda: make_scene(effects=rough))
    fed = sources(scenes[0][1])
    assert fed["stick_slip_friction.contact_chain"] == "contact_query.contact_chain"
    one, other = (advance(*scene, 0.2) for scene in scenes)
    # The ports find the contacts of a pose twice: after a step and before the next. The
    # second time can change the last bit.
    np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-9)
    smooth = advance(*make_both(monkeypatch, make_scene)[0], 0.2)
    assert np.abs(one - smooth).max() > 1e-3


def test_braking_and_shading_act_in_the_chain(monkeypatch) -> None:
    effects = Effects(
        braking=BrakingParameters(damping_Ns_per_m=20.0),
        shading=ShadingParameters(crease_angle_deg=120.0),
    )
    scenes = make_both(monkeypatch, lambda: make_scene(effects=effects))
    fed = sources(scenes[0][1])
    assert fed["contact_query.shading"] == "force_shading.shading"
    assert fed["pre_contact_braking.contact_chain"] == "contact_query.contact_chain"
    one, other = (advance(*scene, 0.2) for scene in scenes)
    # As with friction, above.
    np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-9)
    plain = advance(*make_both(monkeypatch, make_scene)[0], 0.2)
    assert np.abs(one - plain).max() > 1e-3


def make_held():
    return make_scene(coupling=CouplingParameters(), device=make_device())


def test_a_device_and_its_coupling_act_in_the_chain(monkeypatch) -> None:
    pressed = RigidTransform([0.0, 0.0, 0.9 * HALF])
    scenes = make_both(monkeypatch, make_held, pressed)
    fed = sources(scenes[0][1])
    assert fed["applied_wrenches.contact_chain"] == "contact_query.contact_chain"
    one, other = (advance(*scene, 0.05) for scene in scenes)
    np.testing.assert_array_equal(one, other)
    shown = [scene.read(rendering, "F_Ho_W_rendered") for scene, rendering in scenes]
    np.testing.assert_array_equal(*shown)
    assert np.abs(shown[0]).max() > 0.1


def double_stiffness(force, context) -> None:
    gains = force.get_gains(context)
    doubled = replace(gains, stiffness_N_per_m=2.0 * gains.stiffness_N_per_m)
    force.set_gains(context, doubled)


def cluster_less(clustering, context) -> None:
    tolerance_m = 1.5 * CONTACT.tolerance_m
    clustering.set_rule(context, ClusteringRule("octree", tolerance_m, 1e-3))


def see_nothing(query, context) -> None:
    query.set_tolerance(context, 0.0)


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("penalty_force", double_stiffness),
        ("contact_clustering", cluster_less),
        ("contact_query", see_nothing),
    ],
)
def test_what_changes_mid_run_counts_at_once(monkeypatch, name, change) -> None:
    at_rest_m = HALF + CONTACT.tolerance_m - MASS * G / CONTACT.stiffness_N_per_m
    assert at_rest_m > HALF
    at_rest = RigidTransform([0.0, 0.0, at_rest_m])
    forces = []
    for scene, rendering in make_both(monkeypatch, make_scene, at_rest):
        before = advance(scene, rendering, 5e-3)[-1]
        system = rendering.GetSubsystemByName(name)
        change(system, system.GetMyMutableContextFromRoot(scene.root))
        forces.append([before, advance(scene, rendering, 1e-3)[-1]])
    np.testing.assert_array_equal(*forces)
    before, after = forces[0]
    assert before[-1] == pytest.approx(MASS * G, rel=1e-6)
    assert abs(after[-1] - before[-1]) > 0.1 * MASS * G


@pytest.mark.parametrize("make", [make_scene, make_held])
def test_a_deep_contact_is_warned_of_once_either_way(monkeypatch, make) -> None:
    deep = RigidTransform([0.0, 0.0, HALF - 12.0 * CONTACT.tolerance_m])
    for scene, rendering in make_both(monkeypatch, make, deep):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            scene.simulator.AdvanceTo(3e-3)
            scene.read(rendering, "clusters")
        told = [w for w in caught if issubclass(w.category, SceneWarning)]
        assert len(told) == 1
        assert "12 times contact.tolerance_m" in str(told[0].message)


@pytest.mark.parametrize("make", [make_scene, make_held])
def test_a_deep_contact_is_warned_of_again_after_it_ended(monkeypatch, make) -> None:
    deep = RigidTransform([0.0, 0.0, HALF - 12.0 * CONTACT.tolerance_m])
    touching = RigidTransform([0.0, 0.0, HALF + 0.5 * CONTACT.tolerance_m])
    away = RigidTransform([0.0, 0.0, 3.0 * HALF])
    for scene, rendering in make_both(monkeypatch, make, deep):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            for X_WT in (deep, touching, deep, away, deep):
                scene.place("tool", X_WT)
                scene.simulator.Initialize()
                scene.simulator.AdvanceTo(scene.root.get_time() + 1e-3)
                scene.read(rendering, "clusters")
        told = [w for w in caught if issubclass(w.category, SceneWarning)]
        assert len(told) == 2


def test_an_object_that_moves_leaves_the_chain_out() -> None:
    assert not has_chain(make_scene(cart=True)[1])
