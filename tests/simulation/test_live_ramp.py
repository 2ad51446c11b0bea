"""Values on their way, against the arithmetic of the way."""

from itertools import pairwise

import pytest

from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    EnvironmentObject,
    Scene,
)
from drake_haptics.simulation.live_values import GLIDE_S, LiveValueRamp, live_keys

PERIOD_S = 1e-3
STEPS = round(GLIDE_S / PERIOD_S)
BLOCK = EnvironmentObject(name="block")


def make_scene(stiffness_N_per_m=800.0, damping_Ns_per_m=2.0, **contact):
    coupling = CouplingParameters(
        stiffness_N_per_m=stiffness_N_per_m, damping_Ns_per_m=damping_Ns_per_m
    )
    return Scene(
        environment=[BLOCK], coupling=coupling, contact=ContactParameters(**contact)
    )


def glide(*scenes, after=STEPS):
    """Returns a glide on its way to each scene from the one before, so many ticks."""
    glide = LiveValueRamp(PERIOD_S)
    for scene in scenes:
        glide.aim(scene)
        for _ in range(after):
            glide.advance()
    return glide


def test_the_first_values_are_there_at_once():
    scene = make_scene()
    glide = LiveValueRamp(PERIOD_S)
    glide.aim(scene)
    assert not glide.is_moving
    assert glide.apply(make_scene(stiffness_N_per_m=50.0)) == scene


def test_a_stiffness_goes_in_equal_ratios_and_a_length_in_equal_steps():
    goal = make_scene(3200.0, tolerance_m=6e-3)
    glide = LiveValueRamp(PERIOD_S)
    glide.aim(make_scene())
    glide.aim(goal)
    now = []
    while glide.is_moving:
        glide.advance()
        now.append(glide.apply(goal))
    assert len(now) == STEPS
    assert now[-1] == goal
    half = now[STEPS // 2 - 1]
    assert half.coupling.stiffness_N_per_m == pytest.approx(1600.0)
    assert half.contact.tolerance_m == pytest.approx(4e-3)
    stiffness = [scene.coupling.stiffness_N_per_m for scene in now]
    ratios = [b / a for a, b in pairwise(stiffness)]
    assert ratios == pytest.approx([4.0 ** (1 / STEPS)] * (STEPS - 1))


def test_to_nothing_and_back_it_goes_in_equal_steps():
    no_damping = make_scene(damping_Ns_per_m=0.0)
    for start, goal in [(make_scene(), no_damping), (no_damping, make_scene())]:
        glide = LiveValueRamp(PERIOD_S)
        glide.aim(start)
        glide.aim(goal)
        for _ in range(STEPS // 4):
            glide.advance()
        there = 0.75 * start.coupling.damping_Ns_per_m
        there += 0.25 * goal.coupling.damping_Ns_per_m
        assert glide.apply(goal).coupling.damping_Ns_per_m == pytest.approx(there)


def test_who_changes_his_mind_goes_on_from_where_it_is():
    way = glide(make_scene(), make_scene(3200.0), after=STEPS // 2)
    way.aim(make_scene(400.0))
    there = way.apply(make_scene())
    assert there.coupling.stiffness_N_per_m == pytest.approx(1600.0)
    for _ in range(STEPS):
        way.advance()
    assert way.apply(make_scene()).coupling.stiffness_N_per_m == 400.0
    assert not way.is_moving


def test_what_is_there_already_does_not_move():
    way = glide(make_scene(), make_scene(3200.0))
    way.aim(make_scene(3200.0))
    assert not way.is_moving


def test_a_key_may_come_and_go():
    """The cluster size, with the clusters; a scene without them has none."""
    octree = make_scene(900.0, clustering="octree", cluster_size_m=4e-3)
    way = glide(make_scene(), octree, after=1)
    there = way.apply(octree)
    assert there.contact.cluster_size_m == 4e-3
    assert 800.0 < there.coupling.stiffness_N_per_m < 900.0
    way = glide(octree, make_scene(), after=1)
    assert way.apply(make_scene()).contact == make_scene().contact


def test_all_that_is_live_glides():
    scene = make_scene(clustering="octree", cluster_size_m=4e-3)
    for item in live_keys(scene):
        goal = item.change(scene, 0.5 * item.read(scene))
        value = item.read(glide(scene, goal, after=STEPS // 2).apply(goal))
        assert item.read(goal) < value < item.read(scene)
        assert glide(scene, goal).apply(scene) == goal


@pytest.mark.parametrize("period_s", [0.0, -1e-3])
def test_a_period_that_is_not_positive_is_refused(period_s):
    with pytest.raises(ValueError, match="period_s must be positive and finite"):
        LiveValueRamp(period_s)
