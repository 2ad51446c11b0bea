"""Going on in another diagram, as if it had been that one all along."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from box_scenes import PLATE_TOP, TOOL_HALF_HEIGHT, over_a_plate, write
from diagram_parts import read_output, read_port, read_tool

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import (
    BrakingParameters,
    CouplingParameters,
    DeviceImperfections,
    Effects,
    EncoderParameters,
    ForceDelayParameters,
    FrictionParameters,
    GravityParameters,
    JointFrictionParameters,
    PassivityParameters,
    Pose,
    ShadingParameters,
)
from drake_haptics.simulation.run import run
from drake_haptics.simulation.transfer_state import find_handle, transfer_context

ABOVE = (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.005)
DOWN = (0.05, 0.0, 0.0, TOOL_HALF_HEIGHT - 0.005)
ALONG = (0.3, 0.02, 0.01, TOOL_HALF_HEIGHT - 0.005)
ALL = Effects(
    shading=ShadingParameters(),
    friction=FrictionParameters(),
    braking=BrakingParameters(),
    gravity=GravityParameters(),
    passivity=PassivityParameters(),
)
FAULTS = DeviceImperfections(
    encoder=EncoderParameters(velocity_window=4),
    friction=JointFrictionParameters(),
    delay=ForceDelayParameters(samples=2),
)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """A ball that comes down on a plate and is drawn along it."""
    folder = tmp_path_factory.mktemp("scene")
    return over_a_plate(folder, [ABOVE, DOWN, ALONG], tool="ball")


@pytest.fixture(scope="module")
def plain(scene):
    return BuildHapticDiagram(scene)


def run_until(haptic, time_s, context=None):
    """Returns a context in which a run was ended at a tick, and what it showed."""
    ends, shown = [], []

    def end_tick(root):
        shown.append(read_output(haptic.loop.device, "F_Ho_W_rendered", root))
        if root.get_time() > time_s - 1e-6:
            ends.append(root.Clone())
        return bool(ends)

    run(haptic, on_tick=end_tick, context=context)
    return ends[0], np.array(shown)


def read_wrench(haptic, root, name="contact"):
    """Returns the wrench (6) of a source on the tool."""
    return read_port(haptic.loop.wrench_sources[name], root)[:6]


@pytest.mark.parametrize(
    ("effects", "twin", "query_rate_hz"),
    [
        (Effects(), DeviceImperfections(), None),
        (ALL, FAULTS, None),
        (ALL, DeviceImperfections(), 250.0),
    ],
)
def test_in_an_equal_diagram_all_goes_on_as_it_would_have(
    scene, plain, effects, twin, query_rate_hz
):
    scene = replace(
        scene,
        effects=effects,
        device=replace(scene.device, twin=twin),
        contact=replace(scene.contact, query_rate_hz=query_rate_hz),
    )
    first, second = (BuildHapticDiagram(scene, reuse=plain) for _ in range(2))
    _, whole = run_until(first, 0.25)
    assert np.linalg.norm(whole[-1]) > 0.5
    # Between two queries, and just as one is due.
    for time_s in (0.201, 0.204):
        context, start = run_until(first, time_s)
        context, rest = run_until(
            second, 0.25, transfer_context(first, context, second)
        )
        assert context.get_time() == pytest.approx(0.25)
        np.testing.assert_allclose(np.vstack([start, rest]), whole, atol=1e-9)


def test_what_was_is_left_as_it_is(scene, plain):
    other = BuildHapticDiagram(replace(scene, effects=ALL), reuse=plain)
    context, _ = run_until(plain, 0.2)
    _, before = run_until(plain, 0.22, context.Clone())
    run_until(other, 0.22, transfer_context(plain, context, other))
    _, after = run_until(plain, 0.22, context)
    np.testing.assert_array_equal(after, before)


@pytest.mark.parametrize("name", ["shading", "friction", "braking", "passivity"])
def test_an_effect_comes_and_goes_without_a_jolt(scene, plain, name):
    """What is shown changes in no tick by more than it did, but for the effect."""
    effects = Effects(**{name: getattr(ALL, name)})
    other = BuildHapticDiagram(replace(scene, effects=effects), reuse=plain)
    context, shown = run_until(plain, 0.15)
    largest_N = np.linalg.norm(np.diff(shown[60:, 3:], axis=0), axis=1).max()
    context, with_it = run_until(other, 0.2, transfer_context(plain, context, other))
    context, without = run_until(plain, 0.25, transfer_context(other, context, plain))
    shown = np.vstack([shown[-1:], with_it, without])
    assert np.linalg.norm(shown[:, 3:], axis=1).min() > 0.5
    steps_N = np.linalg.norm(np.diff(shown[:, 3:], axis=0), axis=1)
    assert steps_N.max() < largest_N + (0.1 if name == "friction" else 0.01)


def test_the_tool_weighs_at_once_what_gravity_says(scene, plain):
    heavy = BuildHapticDiagram(
        replace(scene, effects=Effects(gravity=GravityParameters())), reuse=plain
    )
    context, _ = run_until(plain, 0.2)
    there = transfer_context(plain, context, heavy)
    assert read_wrench(heavy, there, "gravity")[5] == pytest.approx(-0.981)
    np.testing.assert_array_equal(read_tool(heavy, there), read_tool(plain, context))


def test_forces_are_the_same_on_both_sides(scene, plain):
    other = BuildHapticDiagram(replace(scene, effects=ALL), reuse=plain)
    context, _ = run_until(plain, 0.2)
    there = transfer_context(plain, context, other)
    assert there.get_time() == context.get_time()
    np.testing.assert_array_equal(read_tool(other, there), read_tool(plain, context))
    F = read_wrench(plain, context)
    assert F[5] > 0.5
    # A ball of facets on a plane: shading turns its normals by nothing to speak of.
    np.testing.assert_allclose(read_wrench(other, there)[3:], F[3:], atol=1e-6)
    for haptic, root in [(plain, context), (other, there)]:
        np.testing.assert_array_equal(
            read_wrench(haptic, root, "coupling"),
            read_wrench(plain, context, "coupling"),
        )


def test_what_is_new_reads_at_its_beginning_what_is_there(scene, plain):
    """Contacts sampled at every fourth tick, and encoders of a handle."""
    other = replace(
        scene,
        contact=replace(scene.contact, query_rate_hz=250.0),
        device=replace(
            scene.device, twin=DeviceImperfections(encoder=EncoderParameters())
        ),
    )
    other = BuildHapticDiagram(other, reuse=plain)
    context, _ = run_until(plain, 0.201)
    there = transfer_context(plain, context, other)
    F = read_wrench(plain, context)
    np.testing.assert_allclose(read_wrench(other, there), F, atol=1e-6)
    handles = [find_handle(plain, context), find_handle(other, there)]
    assert handles[0].IsNearlyEqualTo(handles[1], 5e-4)
    assert not handles[0].IsExactlyEqualTo(handles[1])


def test_bristles_stay_bent_where_both_have_friction(scene, plain):
    effects = Effects(friction=FrictionParameters())
    first = BuildHapticDiagram(replace(scene, effects=effects), reuse=plain)
    effects = replace(effects, passivity=PassivityParameters())
    second = BuildHapticDiagram(replace(scene, effects=effects), reuse=plain)
    context, _ = run_until(first, 0.2)
    F = read_wrench(first, context, "friction")
    assert np.linalg.norm(F[3:]) > 0.1
    there = transfer_context(first, context, second)
    np.testing.assert_allclose(read_wrench(second, there, "friction"), F, atol=1e-9)
    # Where one has none, there is none at first.
    again = transfer_context(plain, transfer_context(first, context, plain), first)
    np.testing.assert_array_equal(read_wrench(first, again, "friction"), np.zeros(6))


def test_the_way_in_is_the_way_out_there_too(tmp_path):
    """A thin sheet that the tool has all but passed."""
    sheet = write(tmp_path, "sheet", trimesh.creation.box([0.2, 0.2, 1e-3]))
    scene = over_a_plate(tmp_path, [ABOVE])
    scene.environment[0].mesh = sheet
    scene.environment[0].pose = Pose(position_m=[0.0, 0.0, PLATE_TOP])
    first = BuildHapticDiagram(scene)
    context = first.diagram.CreateDefaultContext()
    for z in np.linspace(PLATE_TOP + 0.012, PLATE_TOP - 0.004, 40):
        tool = first.loop.haptic_tool.GetMyMutableContextFromRoot(context)
        tool.SetDiscreteState([1, 0, 0, 0, 0, 0, z, *np.zeros(6)])
        F = read_wrench(first, context)
    assert F[5] > 100.0
    effects = Effects(friction=FrictionParameters())
    other = BuildHapticDiagram(replace(scene, effects=effects), reuse=first)
    np.testing.assert_allclose(
        read_wrench(other, transfer_context(first, context, other)), F, atol=1e-6
    )
    # Pieces that were cut again are others.
    apart = BuildHapticDiagram(scene)
    assert read_wrench(apart, transfer_context(first, context, apart))[5] < 0.0


def test_gains_are_those_of_the_scene_where_it_goes_on(scene, plain):
    stiff = replace(scene, coupling=CouplingParameters(stiffness_N_per_m=500.0))
    other = BuildHapticDiagram(replace(stiff, effects=ALL), reuse=plain)
    context, _ = run_until(plain, 0.2)
    there = transfer_context(plain, context, other)
    coupling = other.loop.virtual_coupling
    gains = coupling.get_gains(coupling.GetMyContextFromRoot(there))
    assert gains.stiffness_N_per_m == 500.0
