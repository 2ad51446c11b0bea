"""A tool that steps by the contact chain moves as one that reads its wrench ports."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from diagram_parts import read_output, read_port
from fake_device import ScriptedDevice, make_reading
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context

from drake_haptics import find_scene, load_scene
from drake_haptics._core import ContactChain
from drake_haptics.analysis.diagram_systems import find_timings
from drake_haptics.analysis.sampled_map import SampledMap
from drake_haptics.loop import add_haptic_loop
from drake_haptics.loop.builder import BuildHapticDiagram, HapticDiagram
from drake_haptics.scene.schema import (
    BrakingParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
    Scene,
    ShadingParameters,
)
from drake_haptics.scene.validation import SceneWarning
from drake_haptics.simulation.run import make_simulator
from drake_haptics.simulation.run import run as run_scene
from drake_haptics.systems.contact.contact_clustering import ClusteringRule
from drake_haptics.systems.tool.haptic_tool import HapticTool

_TICK = 1e-3
# Each is in contact by then.
_SCENES = {"cup_spoon": 0.7, "torus_peg": 0.8, "sphere_pen": 0.6}


def build(scene: Scene, chained: bool, device=None):
    with pytest.MonkeyPatch.context() as patch:
        if not chained:
            patch.setattr(add_haptic_loop, "can_chain", lambda *_: False)
        haptic = BuildHapticDiagram(scene, device=device)
    assert haptic.loop.haptic_tool.HasInputPort("contact_chain") == chained
    return haptic


@pytest.fixture(scope="module", params=_SCENES)
def pair(request):
    """A scene both ways, and when it is in contact, s."""
    scene = load_scene(find_scene(request.param))
    both = [build(scene, chained) for chained in (True, False)]
    return *both, _SCENES[request.param]


def cup(change: Callable[[Scene], None] = id):
    scene = load_scene(find_scene("cup_spoon"))
    change(scene)
    return [build(scene, chained) for chained in (True, False)]


def cluster(scene: Scene, clustering: str) -> None:
    scene.contact.clustering = clustering
    scene.contact.cluster_size_m = 5e-3 if clustering == "octree" else None


@pytest.fixture(scope="module")
def plain():
    """States of the cup's scene without an effect, up to 0.9 s, by its clustering."""
    found = {}
    for clustering in ("shared", "octree"):
        scene = load_scene(find_scene("cup_spoon"))
        cluster(scene, clustering)
        found[clustering] = run(build(scene, True), 0.9)
    return found


def add_friction(scene: Scene) -> None:
    scene.effects.friction = FrictionParameters()


def read_state(haptic: HapticDiagram, root: Context) -> np.ndarray:
    """The state of the tool and what the device shows."""
    return np.concatenate(
        [
            haptic.diagram.GetOutputPort(name).Eval(root)
            for name in ("X_WT", "V_WT", "F_Ho_W_rendered")
        ]
    )


def read_between(haptic: HapticDiagram, root: Context) -> np.ndarray:
    """All that is between query and tool."""
    loop = haptic.loop
    contacts, clusters, wrench = (
        haptic.diagram.GetOutputPort(name).Eval(root)
        for name in ("contacts", "clusters", "contact_wrench")
    )
    models = [read_port(port, root) for port in loop.wrench_sources.values()]
    return np.concatenate(
        [
            contacts.distance,
            contacts.nhat_BA_W.ravel(),
            contacts.p_WCa.ravel(),
            clusters.compression,
            clusters.coupling.ravel(),
            wrench.wrench_model,
            *models,
        ]
    )


def run(haptic: HapticDiagram, end_s: float, read=read_state, context=None):
    """What is read after each tick."""
    simulator = make_simulator(haptic, context)
    found: list[np.ndarray] = []

    def note(root: Context) -> None:
        found.append(read(haptic, root))

    if context is None:
        simulator.Initialize()
    simulator.set_monitor(note)
    simulator.AdvanceTo(end_s)
    return found


def assert_same(one: list[np.ndarray], other: list[np.ndarray]) -> None:
    assert len(one) == len(other) > 0
    for a, b in zip(one, other, strict=True):
        np.testing.assert_array_equal(a, b)


def test_the_tool_moves_bit_by_bit_as_by_the_ports_of_its_wrenches(pair) -> None:
    chained, separate, contact_s = pair
    states = run(chained, contact_s + 0.1)
    assert_same(states, run(separate, contact_s + 0.1))
    assert max(np.abs(state[-3:]).max() for state in states) > 0.1
    # What is between is the same, and reading it changes nothing.
    between = run(chained, contact_s + 0.1, read_between)
    assert_same(between, run(separate, contact_s + 0.1, read_between))
    assert len(between[-1]) > len(between[0])
    read: list[np.ndarray] = []

    def read_both(haptic: HapticDiagram, root: Context) -> np.ndarray:
        read.append(read_between(haptic, root))
        return read_state(haptic, root)

    assert_same(run(chained, contact_s + 0.1, read_both), states)


def test_a_run_counts_the_same_contacts_and_clusters(pair) -> None:
    chained, separate, contact_s = pair
    one, other = (
        run_scene(haptic, contact_s + 0.1).to_dict() for haptic in (chained, separate)
    )
    for counted in ("contacts", "clusters", "max_penetration_m", "max_force_N"):
        assert one[counted] == other[counted]
    assert one["clusters"]["max"] > 0


def test_a_query_that_a_step_has_made_is_not_made_again() -> None:
    """What a query took is that of the query itself, and never twice the same."""
    chained, _ = cup()
    simulator = make_simulator(chained)
    simulator.AdvanceTo(0.7 + 0.5 * _TICK)
    root = simulator.get_mutable_context()
    tool = chained.loop.haptic_tool
    query = chained.loop.contact_query
    own = query.GetMyContextFromRoot(root)
    before = query.GetOutputPort("contacts").Eval(own).query_seconds
    updated = tool.EvalUniquePeriodicDiscreteUpdate(tool.GetMyContextFromRoot(root))
    assert np.isfinite(updated.value()).all()
    chain = query.GetOutputPort("contact_chain").Eval(own)
    X_WT = read_output(tool, "X_WT", root)
    assert chain.query(X_WT).query_seconds == before > 0.0
    chain.set_object_pose(0, np.array([1.0, 0, 0, 0, 1e-9, 0, 0]))
    assert chain.query(X_WT).query_seconds != before


def test_a_copied_context_goes_on_by_itself(pair) -> None:
    chained, separate, contact_s = pair
    ends = []
    for haptic in (chained, separate):
        simulator = make_simulator(haptic)
        simulator.AdvanceTo(contact_s + 0.5 * _TICK)
        copied = simulator.get_context().Clone()
        simulator.AdvanceTo(contact_s + 0.05)
        # Not disturbed by what the other did meanwhile.
        own = run(haptic, contact_s + 0.05, context=copied)
        np.testing.assert_array_equal(
            own[-1], read_state(haptic, simulator.get_context())
        )
        ends.append(own)
    assert_same(*ends)


def test_a_tool_that_is_put_back_mid_run_goes_on_alike(pair) -> None:
    chained, separate, contact_s = pair
    ends = []
    for haptic in (chained, separate):
        simulator = make_simulator(haptic)
        simulator.AdvanceTo(contact_s + 0.5 * _TICK)
        root = simulator.get_mutable_context()
        tool = haptic.loop.haptic_tool.GetMyMutableContextFromRoot(root)
        kept = tool.get_discrete_state(0).CopyToVector()
        simulator.AdvanceTo(contact_s + 0.02)
        tool.SetDiscreteState(0, kept)
        simulator.AdvanceTo(contact_s + 0.04)
        ends.append([read_state(haptic, root), read_between(haptic, root)])
    assert_same(*ends)


def test_gains_rule_and_tolerance_that_change_mid_run_count_at_once() -> None:
    ends = []
    for haptic in cup():
        simulator = make_simulator(haptic)
        simulator.AdvanceTo(0.7 + 0.5 * _TICK)
        root = simulator.get_mutable_context()
        loop, found = haptic.loop, []

        def own(system, root=root):
            return system.GetMyMutableContextFromRoot(root)

        def advance(simulator=simulator, haptic=haptic, root=root, found=found):
            simulator.AdvanceTo(root.get_time() + 2.0 * _TICK)
            found.append(read_state(haptic, root))

        advance()
        force = loop.penalty_force
        gains = force.get_gains(own(force))
        doubled = replace(gains, stiffness_N_per_m=2.0 * gains.stiffness_N_per_m)
        force.set_gains(own(force), doubled)
        advance()
        clustering = loop.contact_clustering
        clustering.set_rule(own(clustering), ClusteringRule("octree", 5e-4, 2e-3))
        advance()
        query = loop.contact_query
        query.set_tolerance(own(query), 4e-4)
        advance()
        coupling = loop.virtual_coupling
        coupling.set_gains(
            own(coupling), type(coupling.get_gains(own(coupling)))(500, 1, 1, 0.01)
        )
        advance()
        ends.append(found)
    assert_same(*ends)
    # None of the changes left the tool where it would have been.
    steps = np.diff(np.array(ends[0])[:, 13:], axis=0)
    assert np.abs(steps).max(axis=1).min() > 1e-3


def test_other_wrenches_count_beside_the_chain(plain) -> None:
    def add_gravity(scene: Scene) -> None:
        scene.effects.gravity = GravityParameters()

    chained, separate = cup(add_gravity)
    heavy = run(chained, 0.75)
    assert_same(heavy, run(separate, 0.75))
    weightless = plain["shared"][len(heavy) - 1]
    assert np.abs(heavy[-1] - weightless).max() > 1e-6


def test_friction_is_found_from_the_chain_bit_by_bit(plain) -> None:
    chained, separate = cup(add_friction)
    assert chained.loop.effects.friction.HasInputPort("contact_chain")
    assert not separate.loop.effects.friction.HasInputPort("contact_chain")

    def read_friction(haptic: HapticDiagram, root: Context) -> np.ndarray:
        step = haptic.diagram.GetOutputPort("friction_force").Eval(root)
        return np.concatenate(
            [step.f_cluster_W.ravel(), step.next_state, read_state(haptic, root)]
        )

    def read_all(haptic: HapticDiagram, root: Context) -> np.ndarray:
        between = read_between(haptic, root)
        return np.concatenate([between, read_friction(haptic, root)])

    rough, separately = run(chained, 0.9, read_friction), run(separate, 0.9, read_all)
    assert np.abs(rough[-1][-19:] - plain["shared"][-1]).max() > 1e-3
    # Reading what is between changes nothing, and is the same.
    assert_same(run(chained, 0.9, read_all), separately)
    assert_same(rough, [x[-len(y) :] for x, y in zip(separately, rough, strict=True)])


def test_a_wrench_that_is_not_connected_counts_as_zero_beside_the_chain() -> None:
    chained, _ = cup()
    simulator = make_simulator(chained)
    simulator.AdvanceTo(0.7 + 0.5 * _TICK)
    root, loop = simulator.get_context(), chained.loop
    own = loop.haptic_tool.GetMyContextFromRoot(root)
    expected = loop.haptic_tool.EvalUniquePeriodicDiscreteUpdate(own).value()
    names = ["coupling", "contact", "other"]
    tool = HapticTool(
        loop.haptic_tool.dynamics, _TICK, names, RigidTransform(), enable_chain=True
    )
    context = tool.CreateDefaultContext()
    tool.get_input_port(0).FixValue(context, np.full(78, 1e3))
    tool.get_input_port(1).FixValue(context, np.full(78, 1e3))
    for name in ("contact_chain", "motions_and_gains"):
        value = loop.haptic_tool.GetInputPort(name).Eval(own)
        if name == "contact_chain":
            value = Value[object](value)
        tool.GetInputPort(name).FixValue(context, value)
    found = tool.EvalUniquePeriodicDiscreteUpdate(context).value()
    np.testing.assert_array_equal(found, expected)


SHADING = ShadingParameters(crease_angle_deg=60.0)
ALL = Effects(
    shading=SHADING, braking=BrakingParameters(), friction=FrictionParameters()
)


@pytest.mark.parametrize(
    ("clustering", "effects"),
    [
        ("shared", Effects(shading=SHADING)),
        ("shared", Effects(braking=BrakingParameters())),
        ("shared", ALL),
        ("octree", ALL),
    ],
    ids=["shading", "braking", "all", "octree"],
)
def test_effects_that_read_contacts_find_them_in_the_chain_bit_by_bit(
    plain, effects: Effects, clustering: str
) -> None:
    def add_effects(scene: Scene) -> None:
        cluster(scene, clustering)
        scene.effects = effects

    def read_all(haptic: HapticDiagram, root: Context) -> np.ndarray:
        return np.concatenate([read_between(haptic, root), read_state(haptic, root)])

    chained, separate = cup(add_effects)
    felt, separately = run(chained, 0.9), run(separate, 0.9, read_all)
    assert np.abs(felt[-1] - plain[clustering][-1]).max() > 1e-4
    # Reading what is between changes nothing, and is the same.
    assert_same(run(chained, 0.9, read_all), separately)
    assert_same(felt, [x[-19:] for x in separately])


@pytest.mark.filterwarnings(f"ignore::{SceneWarning.__module__}.SceneWarning")
def test_a_device_is_told_the_same_wrench_and_slopes() -> None:
    told = []
    for chained in (True, False):
        scene = load_scene(find_scene("cup_spoon"))
        device = ScriptedDevice(
            lambda k: make_reading(k, position=(-4e-5 * k, 0.0, -2e-5 * k))
        )
        haptic = build(scene, chained, device)
        device.reads = 0
        Simulator(haptic.diagram).AdvanceTo(0.9)
        told.append(
            [
                np.concatenate([c.F_Ho_B, c.X_BH, c.K_B.ravel(), c.B_B.ravel()])
                for c in device.commands
            ]
        )
    assert_same(*told)
    stiffness = [np.abs(command[13:49]).max() for command in told[0]]
    assert min(stiffness) < 1e-6 < 1.0 < max(stiffness)


@pytest.mark.parametrize("change", [id, add_friction])
def test_the_twin_has_the_derivatives_of_the_separate_chain(
    change: Callable[[Scene], None],
) -> None:
    found = []
    for haptic in cup(change):
        simulator = make_simulator(haptic)
        simulator.AdvanceTo(0.7 + 0.5 * _TICK)
        context = simulator.get_context()
        one_period = SampledMap(
            haptic.diagram, context, find_timings(haptic.diagram, context)
        )
        held = one_period.hold(one_period.x, one_period.u)
        gradients = one_period.differentiate(one_period.x, held, one_period.u)
        found.append([gradients.update, gradients.rates])
    assert_same(*found)
    assert np.abs(found[0][0]).max() > 1.0


def test_a_chain_knows_what_its_tracker_knew() -> None:
    """Where a diagram is made of another, the one with the chain, the other without."""
    chained, separate = cup()
    simulator = make_simulator(separate)
    simulator.AdvanceTo(0.7 + 0.5 * _TICK)
    old = separate.loop.contact_query
    old_context = old.GetMyContextFromRoot(simulator.get_context())
    root = chained.diagram.CreateDefaultContext()
    query = chained.loop.contact_query
    own = query.GetMyMutableContextFromRoot(root)
    query.take_hint(own, old, old_context)
    tool = chained.loop.haptic_tool.GetMyMutableContextFromRoot(root)
    tool.SetDiscreteState(0, read_state(separate, simulator.get_context())[:13])
    chain = query.GetOutputPort("contact_chain").Eval(own)
    assert isinstance(chain, ContactChain)
    # The search begins where the other one ended, which can change the last bit.
    np.testing.assert_allclose(
        query.GetOutputPort("contacts").Eval(own).distance,
        old.GetOutputPort("contacts").Eval(old_context).distance,
        rtol=1e-12,
    )
