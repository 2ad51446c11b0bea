"""An object that is put into the tool is found, said, and led out without a kick."""

from __future__ import annotations

import numpy as np
import pytest
from constraint_rig import REST, ConstraintLoop, check_led_out, take_turns
from press_rig import START_M
from press_tools import MODELS

from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.mesh.mesh import load_mesh


def shifted(p_W):
    return np.concatenate([REST[:4], p_W])


@pytest.mark.parametrize("name", ["cup", "torus"])
def test_an_object_that_jumps_a_millimeter_into_the_tool_lets_it_out(name):
    """20 of 20, by half a second, with less than 3 N on the hand and no kick.

    It jumps without a velocity that would have told so, as one that is tracked does.
    """
    mesh = load_mesh(MODELS / f"{name}.obj", scale=1.0)
    solid, num_led = decompose(mesh).core, 0
    for tool, press in take_turns(mesh):
        beside, inside = press.q_WH(START_M - 1e-3, 0), press.q_WH(START_M + 1e-3, 0)
        loop = ConstraintLoop(tool, [solid], beside)
        if not loop.tick(beside).is_apart:
            continue
        loop.stepper.set_object_pose(0, shifted(beside[4:] - inside[4:]))
        if loop.tick(beside).is_apart:
            continue
        check_led_out(loop, beside, 499)
        num_led += 1
        if num_led == 20:
            break
