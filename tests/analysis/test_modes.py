"""Eigenvalues in words."""

import json

import numpy as np
import pytest
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import SpatialInertia
from pydrake.systems.primitives import LinearSystem
from scipy.linalg import expm
from wall_loop import make_loop

from drake_haptics.analysis import Mode, ModeKind, find_modes, linearize_sampled
from drake_haptics.analysis.modes import PeriodMap

PERIOD = 2e-3


def make_map(A, period_s=PERIOD, names=None):
    A = np.atleast_2d(np.asarray(A, dtype=float))
    names = names or tuple(f"x{i}" for i in range(len(A)))
    return PeriodMap(A, period_s, names, np.zeros(len(A)), (), 0.0)


def make_oscillator(frequency_hz, damping_ratio):
    w = 2.0 * np.pi * frequency_hz / np.sqrt(1.0 - damping_ratio**2)
    return make_map(
        expm(np.array([[0.0, 1.0], [-(w**2), -2.0 * damping_ratio * w]]) * PERIOD),
        names=("arm/q", "arm/v"),
    )


def test_a_damped_oscillator():
    (mode,) = find_modes(make_oscillator(27.3, 0.04))
    assert mode.kind is ModeKind.MOTION
    assert mode.frequency_hz == pytest.approx(27.3)
    assert mode.damping_ratio == pytest.approx(0.04)
    decay = 0.04 * 2.0 * np.pi * 27.3 / np.sqrt(1.0 - 0.04**2)
    assert mode.decay_time_s == pytest.approx(np.log(50.0) / decay)
    assert mode.growth_per_period == pytest.approx(np.exp(-decay * PERIOD) - 1.0)
    assert mode.describe() == (
        "27.3 Hz, damped 4 % of critical, dies out in 0.57 s; mostly arm/q and arm/v"
    )


def test_a_growing_oscillator():
    (mode,) = find_modes(make_map(1.012 * make_oscillator(30.0, 0.0).A))
    assert mode.growth_per_period == pytest.approx(0.012)
    assert mode.damping_ratio < 0.0
    assert mode.decay_time_s == np.inf
    assert mode.describe().startswith("grows by 1.2 % each period: unstable; 30 Hz;")
    assert mode.to_dict()["decay_time_s"] is None


@pytest.mark.parametrize(
    ("eigenvalue", "words"),
    [
        (0.5, "no swing, dies out in 0.011 s"),
        (1.5, "grows by 50 % each period: unstable; no swing"),
        (-0.5, "250 Hz, damped 22 % of critical, dies out in 0.011 s"),
        (-1.0, "250 Hz, neither grows nor dies out"),
        (1.0, "neutral: nothing drives it back"),
        (1.0 - 1e-8, "neutral: nothing drives it back"),
        (0.0, "a held or remembered value, soon replaced"),
    ],
)
def test_each_eigenvalue_has_its_words(eigenvalue, words):
    (mode,) = find_modes(make_map(eigenvalue))
    assert mode.describe() == f"{words}; mostly x0"


def test_a_swing_that_neither_grows_nor_dies():
    c, s = 0.6, 0.8
    (mode,) = find_modes(make_map([[c, -s], [s, c]]))
    assert mode.describe().startswith("73.8 Hz, neither grows nor")
    assert abs(mode.damping_ratio) < 1e-15


def test_the_worst_motion_comes_first_and_spurious_ones_last():
    A = np.diag([0.0, 1.0, 0.5, 1.25, 0.75])
    modes = find_modes(make_map(A))
    assert [abs(mode.eigenvalue) for mode in modes] == [1.25, 0.75, 0.5, 1.0, 0.0]
    assert [mode.kind.name for mode in modes[3:]] == ["NEUTRAL", "MEMORY"]


def test_states_that_take_part_are_named_whatever_their_units():
    # Two oscillators, one in units a million times smaller, mixed a little.
    A = np.zeros((4, 4))
    A[:2, :2] = make_oscillator(10.0, 0.1).A
    A[2:, 2:] = make_oscillator(50.0, 0.1).A
    A[1, 2] = 1e-3
    scale = np.diag([1.0, 1.0, 1e-6, 1e-6])
    A = np.linalg.inv(scale) @ A @ scale
    slow, fast = find_modes(make_map(A, names=("p/q", "p/v", "tool/q", "tool/v")))
    assert {name for name, _ in slow.participation[:2]} == {"p/q", "p/v"}
    assert {name for name, _ in fast.participation[:2]} == {"tool/q", "tool/v"}
    assert sum(share for _, share in fast.participation) == pytest.approx(1.0)
    assert "mostly tool/" in fast.describe()


def test_a_delay_line_is_memory():
    A = np.diag([1.0, 1.0, 1.0], -1)
    assert all(mode.kind is ModeKind.MEMORY for mode in find_modes(make_map(A)))


def test_a_free_body_is_neutral_but_for_the_length_of_its_quaternion():
    plant = MultibodyPlant(0.0)
    plant.AddRigidBody("tool", SpatialInertia.SolidSphereWithMass(0.1, 0.02))
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, 0.0])
    plant.Finalize()
    context = plant.CreateDefaultContext()
    x = np.zeros(13)
    x[:4] = np.array([1.0, -2.0, 3.0, 4.0]) / np.sqrt(30.0)
    context.SetContinuousState(x)
    modes = find_modes(linearize_sampled(plant, context, period_s=0.01))
    assert len(modes) == 13
    assert [mode.kind for mode in modes[:12]] == [ModeKind.NEUTRAL] * 12
    length = modes[12]
    assert length.kind is ModeKind.QUATERNION_LENGTH
    shares = dict(length.participation)
    assert set(shares) == {"tool_qw", "tool_qx", "tool_qy", "tool_qz"}
    assert length.describe().startswith(
        "no motion: the length of the quaternion tool_q"
    )


def test_a_quaternion_whose_length_is_not_kept_is_no_constraint():
    A = np.diag([0.9, 1.0, 1.0, 1.0])
    state = np.array([1.0, 0.0, 0.0, 0.0])
    linear = PeriodMap(A, PERIOD, tuple("wxyz"), state, ((0, 1, 2, 3),), 0.0)
    modes = find_modes(linear)
    assert modes[0].kind is ModeKind.MOTION
    assert len(modes) == 4


def test_a_loop_over_its_limit_says_what_grows():
    loop = make_loop(1100.0)
    modes = find_modes(linearize_sampled(loop, loop.CreateDefaultContext()))
    assert modes[0].describe().startswith("grows by 0.025 % each period: unstable; 16")
    assert "mostly mass/xc[0] and mass/xc[1]" in modes[0].describe()
    assert [mode.kind for mode in modes[1:]] == [ModeKind.MEMORY] * 2


def test_growth_in_words_is_growth_in_a_simulation():
    linear = make_map(1.004 * make_oscillator(13.0, 0.0).A)
    (mode,) = find_modes(linear)
    x, count = np.array([1.0, 0.0]), 500
    amplitudes = []
    for _ in range(2 * count):
        x = linear.A @ x
        amplitudes.append(abs(x[0]))
    rise = max(amplitudes[count:]) / max(amplitudes[:count])
    assert rise == pytest.approx((1.0 + mode.growth_per_period) ** count, rel=0.02)


def test_all_goes_to_json():
    loop = make_loop(900.0)
    modes = find_modes(linearize_sampled(loop, loop.CreateDefaultContext()))
    stored = json.loads(json.dumps([mode.to_dict() for mode in modes]))
    assert stored[0]["description"] == modes[0].describe()
    assert stored[0]["kind"] == "motion"


def test_a_mode_by_hand():
    mode = Mode(ModeKind.MOTION, 1j, 1.0, (("x", 1.0),))
    assert mode.frequency_hz == 0.25
    assert mode.damping_ratio == 0.0


def test_modes_of_drakes_own_linear_system():
    system = LinearSystem([[0, 1], [-100, -2]], [[0], [1]], [[1, 0]], [[0]])
    context = system.CreateDefaultContext()
    system.get_input_port().FixValue(context, [0.0])
    (mode,) = find_modes(linearize_sampled(system, context, period_s=0.05))
    # w_n = 10, zeta = 0.1.
    assert mode.damping_ratio == pytest.approx(0.1)
    assert mode.frequency_hz == pytest.approx(np.sqrt(99.0) / (2.0 * np.pi))
