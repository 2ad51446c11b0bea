"""A scene with every effect under AutoDiffXd: derivatives of a period, in contact."""

from dataclasses import replace

import numpy as np
import pytest
from diagram_parts import EVERY
from loop_gradients import calc_gradients, contact_states

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.loading import load_scene
from drake_haptics.scene.schema import Effects


@pytest.fixture(scope="module")
def loop():
    scene = load_scene(find_scene("sphere_pen"))
    return BuildHapticDiagram(replace(scene, effects=Effects(**EVERY)))


def test_derivatives_of_a_period_with_every_effect_are_those_of_doubles(loop):
    names = {system.get_name() for system in loop.diagram.ToAutoDiffXd().GetSystems()}
    assert {
        "force_shading",
        "stick_slip_friction",
        "pre_contact_braking",
        "tool_gravity",
        "passivity_control",
    } <= names
    checked = 0
    for context in contact_states(loop, 2, 0.8):
        gradients = calc_gradients(loop, context)
        assert gradients.is_kink.mean() < 0.2
        assert np.nanmax(gradients.errors) < 1e-6
        checked += np.isfinite(gradients.errors).all(axis=0).sum()
    assert checked > 60
