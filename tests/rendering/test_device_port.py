"""A user's device in a user's plant."""

import re
from dataclasses import replace

import numpy as np
import pytest
from fake_device import ScriptedDevice, make_reading
from plant_scenes import over_a_slab
from pydrake.geometry import Box
from pydrake.math import RigidTransform, RollPitchYaw

from drake_haptics import make_device_port
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.scene.schema import ContactParameters, CouplingParameters
from drake_haptics.scene.validation import SceneWarning

# 0.7 is more than its neighbor in single precision.
SENT = {"max_force_N": 5.0, "max_torque_Nm": 0.7}
LIMITS = {"period_s": 1e-3, **SENT}
# The base stands turned in the world.
X_WB = RigidTransform(RollPitchYaw(0.3, -0.5, 1.0), [0.1, 0.2, 0.3])
CUBE = Box(0.02, 0.02, 0.02)


def hold_at(z):
    """Returns a device that holds its handle still, upright at a height z, m."""
    q_BH = pose_to_vector(X_WB.inverse() @ RigidTransform([0.0, 0.0, z]))
    return ScriptedDevice(
        lambda call: make_reading(call, position=q_BH[4:], wxyz=q_BH[:4])
    )


def test_the_handle_is_where_the_device_says():
    _, X_WH = make_device_port(hold_at(0.05), X_WB, **LIMITS)
    assert X_WH.IsNearlyEqualTo(RigidTransform([0.0, 0.0, 0.05]), 1e-12)
    q_BH = hold_at(0.05).read().X_BH
    _, X_BH = make_device_port(hold_at(0.05), **LIMITS)
    np.testing.assert_allclose(X_BH.translation(), q_BH[4:], atol=1e-15)


def test_a_device_presses_a_body_of_a_plant():
    backend = hold_at(0.008)
    device, X_WH = make_device_port(backend, X_WB, **LIMITS)
    scene = over_a_slab(CUBE, mass=0.1, side=0.02)
    scene.render(
        contact=ContactParameters(stiffness_N_per_m=2e3, damping_Ns_per_m=10.0),
        coupling=CouplingParameters(stiffness_N_per_m=400.0, damping_Ns_per_m=1.0),
        device=device,
    )
    scene.start(tool=X_WH).simulator.AdvanceTo(1.0)
    # The coupling pulls to 8 mm, contact begins at half of the cube and the tolerance,
    # 12 mm; the cube rests where both carry its weight.
    z = (2000 * 0.012 + 400 * 0.008 - 0.1 * 9.81) / (2000 + 400)
    expected_N = 400 * (z - 0.008)
    F_Ho_B = backend.commands[-1].F_Ho_B
    force_W = X_WB.rotation() @ F_Ho_B[3:]
    np.testing.assert_allclose(force_W, [0.0, 0.0, expected_N], atol=1e-3)


def test_a_limit_that_cannot_be_is_refused():
    with pytest.raises(ValueError, match="max_force_N"):
        make_device_port(hold_at(0.05), **LIMITS | {"max_force_N": -1.0})
    with pytest.raises(ValueError, match="period_s"):
        make_device_port(hold_at(0.05), **LIMITS | {"period_s": 0.0})


@pytest.mark.parametrize(
    "less, sentence",
    [
        ({"max_force_N": 3.0}, "at most 3 N, less than the 5 N of max_force_N"),
        ({"max_torque_Nm": 0.0}, "at most 0 N·m, less than the 0.7 N·m of max_torque"),
    ],
)
def test_a_device_that_shows_less_is_told_of(less, sentence):
    """The loop would count force as shown that no hand feels."""
    reading = replace(hold_at(0.05).read(), **less)
    with pytest.warns(SceneWarning, match=sentence):
        make_device_port(ScriptedDevice(lambda call: reading), **LIMITS)


def test_the_limit_that_the_warning_names_is_one_that_the_device_shows(recwarn):
    reading = replace(hold_at(0.05).read(), max_force_N=float(np.float32(8 / 3)))
    make_device_port(ScriptedDevice(lambda call: reading), **LIMITS)
    named = re.search(
        r"max_force_N\) to ([\d.]+),", str(recwarn.pop(SceneWarning).message)
    )
    limits = LIMITS | {"max_force_N": float(named[1])}
    make_device_port(ScriptedDevice(lambda call: reading), **limits)
    assert not recwarn.list


def test_limits_of_single_precision_are_the_same(recwarn):
    as_sent = {key: float(np.float32(LIMITS[key])) for key in SENT}
    reading = replace(hold_at(0.05).read(), **as_sent)
    make_device_port(ScriptedDevice(lambda call: reading), **LIMITS)
    assert not recwarn.list


@pytest.mark.parametrize("period_s", [None, 5e-4])
def test_a_device_of_another_period_is_refused(period_s):
    device, _ = make_device_port(hold_at(0.05), **LIMITS | {"period_s": 3e-3})
    options = {"coupling": CouplingParameters(), "period_s": period_s}
    with pytest.raises(ValueError, match=r"device: its period_s must be .*, is 0.003"):
        over_a_slab(CUBE).render(device=device, **options)
