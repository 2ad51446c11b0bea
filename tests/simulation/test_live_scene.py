"""Values of a scene, changed while it runs."""

from dataclasses import replace

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, over_a_plate

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import (
    BrakingParameters,
    FrictionParameters,
    Material,
    PassivityParameters,
)
from drake_haptics.simulation.energy import EnergyLedger
from drake_haptics.simulation.live_values import (
    is_live_change,
    live_keys,
    write_live_values,
)
from drake_haptics.simulation.run import make_simulator
from drake_haptics.simulation.transfer_state import transfer_context

ABOVE = (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.005)
PRESSING = (0.15, 0.0, 0.0, TOOL_HALF_HEIGHT - 0.01)


@pytest.fixture(scope="module")
def haptic(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scene")
    scene = over_a_plate(folder, [ABOVE, PRESSING])
    scene.effects.braking = BrakingParameters(distance_m=4e-3)
    return BuildHapticDiagram(scene)


@pytest.fixture(scope="module")
def pressed(haptic):
    """A context in which the tool is pressed onto the plate."""
    simulator = make_simulator(haptic)
    simulator.AdvanceTo(0.3)
    return simulator.get_context().Clone()


def change(scene, **values):
    """Returns a scene with other live values, by the names of their fields."""
    for name, value in values.items():
        group, _, field = name.partition("__")
        part = replace(getattr(scene, group), **{field: value})
        scene = replace(scene, **{group: part})
    return scene


def advance(haptic, context, ticks):
    """Returns the state so many ticks later."""
    simulator = make_simulator(haptic, context)
    simulator.AdvanceTo(context.get_time() + ticks * haptic.period_s)
    context = simulator.get_context()
    groups = map(context.get_discrete_state, range(context.num_discrete_state_groups()))
    return np.concatenate(
        [
            context.get_continuous_state_vector().CopyToVector(),
            *(group.CopyToVector() for group in groups),
        ]
    )


@pytest.mark.parametrize("clustering", ["shared", "octree"])
def test_what_is_written_acts_as_what_is_built(haptic, pressed, clustering):
    """Live values at random: a context with them, and a diagram built with them."""
    rng = np.random.default_rng(4)
    size = 5e-3 if clustering == "octree" else None
    start = change(
        haptic.scene, contact__clustering=clustering, contact__cluster_size_m=size
    )
    before = advance(haptic, pressed.Clone(), 20)
    for _ in range(3):
        scene = start
        for key in live_keys(start):
            # Gains at which a step of the explicit arm is stable.
            scene = key.change(scene, key.read(start) * rng.uniform(0.4, 1.6))
        assert is_live_change(haptic.scene, scene)
        written = pressed.Clone()
        write_live_values(haptic, written, scene)
        built = BuildHapticDiagram(scene, reuse=haptic)
        there = transfer_context(haptic, pressed, built)
        found = advance(haptic, written, 20)
        np.testing.assert_allclose(found, advance(built, there, 20), atol=1e-9)
        assert not np.allclose(found, before, atol=1e-6)
    # Another context has its own values.
    np.testing.assert_array_equal(advance(haptic, pressed.Clone(), 20), before)


def test_contacts_are_looked_for_as_far_as_both_need_that_look(haptic):
    query = haptic.loop.contact_query
    for tolerance_m, looked_m in [(1e-3, 4e-3), (6e-3, 6e-3), (2e-3, 4e-3)]:
        root = haptic.diagram.CreateDefaultContext()
        scene = change(haptic.scene, contact__tolerance_m=tolerance_m)
        write_live_values(haptic, root, scene)
        context = query.GetMyContextFromRoot(root)
        assert query.get_tolerance(context) == looked_m


def test_a_material_keeps_the_gains_that_it_gives(haptic):
    plate = replace(
        haptic.scene.environment[0], material=Material(stiffness_N_per_m=300.0)
    )
    hard = BuildHapticDiagram(replace(haptic.scene, environment=[plate]), reuse=haptic)
    root = hard.diagram.CreateDefaultContext()
    scene = change(
        hard.scene, contact__stiffness_N_per_m=7.0, contact__damping_Ns_per_m=8.0
    )
    write_live_values(hard, root, scene)
    force = hard.loop.penalty_force
    gains = force.get_gains(force.GetMyContextFromRoot(root))
    assert gains.stiffness_N_per_m.tolist() == [300.0]
    assert gains.damping_Ns_per_m.tolist() == [8.0]


def test_another_order_is_refused_by_name(haptic):
    root = haptic.diagram.CreateDefaultContext()
    with pytest.raises(TypeError, match=r"^haptic must be .* is their order"):
        write_live_values(haptic.scene, root, haptic)
    with pytest.raises(TypeError, match=r"^old_context must be .* is their order"):
        transfer_context(haptic, haptic, root)


def test_what_needs_a_diagram_of_its_own_is_not_live(haptic):
    scene = haptic.scene
    for other in (
        replace(scene, effects=replace(scene.effects, friction=FrictionParameters())),
        replace(scene, tool=replace(scene.tool, mass_kg=0.2)),
        change(scene, contact__depth="global"),
        change(scene, device__rate_hz=500.0),
        change(scene, contact__query_rate_hz=250.0),
    ):
        assert not is_live_change(scene, other)
        root = haptic.diagram.CreateDefaultContext()
        with pytest.raises(ValueError, match="build its diagram and carry on there"):
            write_live_values(haptic, root, other)


@pytest.mark.parametrize(("reserve_J", "is_live"), [(None, False), (0.2, True)])
def test_a_reserve_that_comes_of_springs_needs_another_diagram(
    haptic, reserve_J, is_live
):
    effects = replace(
        haptic.scene.effects, passivity=PassivityParameters(reserve_J=reserve_J)
    )
    scene = replace(haptic.scene, effects=effects)
    stiffer = change(scene, coupling__stiffness_N_per_m=900.0)
    assert is_live_change(scene, stiffer) == is_live
    assert is_live_change(scene, change(scene, contact__damping_Ns_per_m=9.0))


@pytest.mark.parametrize(
    ("name", "bad"),
    [
        ("contact__tolerance_m", -1.0),
        ("contact__stiffness_N_per_m", np.nan),
        ("coupling__damping_Ns_per_m", -0.1),
        ("contact__clustering", "octree"),
    ],
)
def test_a_bad_value_leaves_all_as_it_was(haptic, name, bad):
    root = haptic.diagram.CreateDefaultContext()
    scene = change(haptic.scene, coupling__stiffness_N_per_m=900.0, **{name: bad})
    with pytest.raises(ValueError, match=r"must be finite|at least 0|must be given"):
        write_live_values(haptic, root, scene)
    coupling = haptic.loop.virtual_coupling
    gains = coupling.get_gains(coupling.GetMyContextFromRoot(root))
    assert gains.stiffness_N_per_m == haptic.scene.coupling.stiffness_N_per_m


def test_what_a_change_puts_into_springs_is_nobodys_energy(haptic):
    """Springs four times as stiff hold some 30 mJ more than no motion has given."""
    stiff = change(
        haptic.scene,
        coupling__stiffness_N_per_m=3200.0,
        contact__stiffness_N_per_m=8e4,
        contact__tolerance_m=3e-3,
    )
    simulator = make_simulator(haptic)
    ledger = EnergyLedger(haptic.loop, simulator.get_context())
    simulator.Initialize()
    ledger.add()
    simulator.set_monitor(lambda context: ledger.add())
    simulator.AdvanceTo(0.3)
    before = ledger.to_dict()
    write_live_values(haptic, simulator.get_mutable_context(), stiff)
    simulator.AdvanceTo(0.35)
    after = ledger.to_dict()
    assert after["coupling"]["stored"] != pytest.approx(before["coupling"]["stored"])
    for part in ("coupling", "contact", "device"):
        assert after[part]["beyond"] < 1e-4
        assert after[part]["lost"] >= before[part]["lost"] - 1e-3
    for books in after.values():
        assert np.isfinite(list(books.values())).all()
