"""Passivity over frequency, against closed forms and loads that would show its lack."""

import math

import numpy as np
import pytest
from pydrake.systems.primitives import LinearSystem
from scipy.linalg import expm

from drake_haptics.analysis.passivity import calc_passivity, make_spring_damper
from drake_haptics.bounds.sampled_spring import calc_passive_damping

T = 1e-3


def calc_condition(H, frequency_Hz):
    """The condition as it is published."""
    wT = 2 * np.pi * np.asarray(frequency_Hz) * T
    z = np.exp(1j * wT)
    values = np.array([complex(np.squeeze(H(w))) for w in z])
    return T / (2 * (1 - np.cos(wT))) * ((1 - 1 / z) * values).real


@pytest.mark.parametrize(("K", "B"), [(800.0, 2.0), (5000.0, -1.0), (0.0, 1.0)])
def test_of_a_spring_and_damper_it_is_known(K, B):
    """K T/2 - B cos ωT, at most K T/2 + |B|."""
    found = calc_passivity(make_spring_damper(K, B, T), T)
    wT = 2 * np.pi * found.frequencies_Hz * T
    expected = K * T / 2 - B * np.cos(wT)
    assert found.required_damping == pytest.approx(expected, abs=1e-7)
    assert found.worst_damping == pytest.approx(calc_passive_damping(K, B, T))
    assert found.worst_frequency_Hz == pytest.approx(500.0 if B > 0 else 0.0)


@pytest.mark.parametrize("delay", [1, 2, 5])
@pytest.mark.parametrize("B", [0.0, 2.0])
def test_with_a_delay_it_is_known_too(delay, B):
    """K T/2 sin((d + ½) ωT) / sin(ωT/2) - B cos((d + 1) ωT)."""
    K = 900.0
    found = calc_passivity(make_spring_damper(K, B, T, delay), T)
    wT = np.maximum(2 * np.pi * found.frequencies_Hz * T, 1e-4)
    kernel = np.sin((delay + 0.5) * wT) / np.sin(wT / 2)
    expected = K * T / 2 * kernel - B * np.cos((delay + 1) * wT)
    assert found.required_damping == pytest.approx(expected, abs=1e-7)
    fine = np.linspace(1e-4, np.pi, 200001)
    kernel = np.sin((delay + 0.5) * fine) / np.sin(fine / 2)
    worst = (K * T / 2 * kernel - B * np.cos((delay + 1) * fine)).max()
    assert found.worst_damping == pytest.approx(worst, rel=1e-7)
    assert worst <= calc_passive_damping(K, B, T, delay * T) * (1 + 1e-9)


RADIUS, ANGLE = 0.999999, 0.7123456


def resonant(z):
    """A spring and damper, and what rings sharply between the points of any grid."""
    pole = RADIUS * np.exp(1j * ANGLE)
    return 50.0 + 3e3 * (1 - 1 / z) + 1e-2 / ((z - pole) * (z - pole.conjugate()))


def test_any_law_gives_the_published_condition():
    f = np.linspace(1.0, 500.0, 300)
    found = calc_passivity(resonant, T, f)
    assert found.frequencies_Hz == pytest.approx(f)
    assert found.required_damping == pytest.approx(calc_condition(resonant, f))


def test_a_linear_system_is_refined_at_its_sharpest_peak():
    A = np.zeros((3, 3))
    A[:2, :2] = [[2 * RADIUS * np.cos(ANGLE), -(RADIUS**2)], [1.0, 0.0]]
    B, C = np.array([[1.0], [0.0], [1.0]]), np.array([[0.0, 1e-2, -3e3]])
    matrices = A, B, C, np.array([[50.0 + 3e3]])
    found = calc_passivity(LinearSystem(*matrices, T), T)
    # By brute force, close around the peak.
    f = (ANGLE + np.linspace(-2e-5, 2e-5, 40001)) / (2 * np.pi * T)
    assert found.worst_damping == pytest.approx(
        calc_condition(resonant, f).max(), rel=1e-6
    )
    by_function = calc_passivity(resonant, T, found.frequencies_Hz)
    # An array answers for both (m, m) and the pole's angle.
    assert by_function.required_damping == pytest.approx(found.required_damping)


def test_the_matrix_form_is_the_least_that_any_motion_needs():
    """Energy of aliases: D must pay, for every motion, what the held force brings.

    The motions of two axes at ω + 2πn/T with |n| <= 60, their damping and the held
    force's work as quadratic forms, without the step from many aliases to their sum.
    """
    random = np.random.default_rng(3)
    K, B = (m @ m.T for m in random.normal(size=(2, 2, 2)) * [[[30.0]], [[1.0]]])
    skew = 0.3 * np.array([[0.0, 1.0], [-1.0, 0.0]])

    def H(z):
        return make_spring_damper(K, B + skew, T)(z)

    D = np.array([[2.0, 0.5], [0.5, 1.0]])
    n = np.arange(-60, 61)
    for f in (20.0, 130.0, 333.0, 480.0):
        found = calc_passivity(H, T, [f])
        w = 2 * np.pi * (f + n / T)
        z = np.exp(2j * np.pi * f * T)
        # x of the samples is G v, the held force's part at each alias is C f.
        G = np.kron(1 / (1j * w), np.eye(2)) / T
        C = np.kron(((1 - 1 / z) / (1j * w))[:, None], np.eye(2))
        work = C @ H(z) @ G
        work = (work + work.conj().T) / 2
        root = np.kron(np.eye(len(n)), np.linalg.inv(np.linalg.cholesky(D)))
        used = -np.linalg.eigvalsh(root @ work @ root.T)[0]
        assert found.calc_usage(D)[0] == pytest.approx(used, rel=5e-3)
        alike = -np.linalg.eigvalsh(work)[0]
        assert found.required_damping[0] == pytest.approx(alike, rel=5e-3)


def test_two_axes_that_do_not_meet_are_two_walls():
    both = calc_passivity(
        make_spring_damper(np.diag([800.0, 2.0]), np.diag([3.0, 0.1]), T), T
    )
    each = [
        calc_passivity(make_spring_damper(*gains, T), T, both.frequencies_Hz)
        for gains in [(800.0, 3.0), (2.0, 0.1)]
    ]
    b = np.array([4.0, 0.05])
    usage = [wall.required_damping / d for wall, d in zip(each, b, strict=True)]
    assert both.calc_usage(np.diag(b)) == pytest.approx(np.max(usage, axis=0))
    # 3.4 of 4 N·s/m is enough; 0.101 of 0.05 N·m·s/rad is not.
    assert both.calc_usage(np.diag(b)).max() == pytest.approx(0.101 / 0.05)


def calc_loaded_radii(K, B, b, loads):
    """Spectral radii of the wall on 0.1 kg that a spring ties to a second mass.

    Loads are (m_l, k_l); nothing damps them, so that they are passive and no more.
    """
    m = 0.1
    rate = np.zeros((len(loads), 5, 5))
    for r, (ml, kl) in zip(rate, loads, strict=True):
        # x, v, x of the load, v of the load, force.
        r[0, 1] = r[2, 3] = 1
        r[1] = np.array([-kl, -b, kl, 0, 1]) / m
        r[3, :3] = np.array([kl, 0, -kl]) / ml
    flow = expm(rate * T)
    step = np.zeros((len(loads), 5, 5))
    step[:, :4, :4] = flow[:, :4, :4]
    step[:, :4, 0] -= flow[:, :4, 4] * (K + B / T)
    step[:, :4, 4] += flow[:, :4, 4] * B / T
    step[:, 4, 0] = 1
    return np.abs(np.linalg.eigvals(step)).max(axis=1)


LOADS = [
    (ml, kl) for ml in np.geomspace(1e-3, 1e2, 29) for kl in np.geomspace(1e2, 1e7, 50)
]


@pytest.mark.parametrize("B", [0.0, 0.5, 1.0, 1.5])
def test_below_the_bound_no_passive_load_makes_it_unstable(B):
    b = 2.0
    K = 2 * (b - B) / T
    assert calc_passive_damping(K, B, T) == pytest.approx(b)
    assert calc_loaded_radii(0.9999 * K, B, b, LOADS).max() < 1 + 1e-9


def test_without_a_damper_the_bound_is_attained():
    b = 2.0
    K = 2 * b / T
    assert calc_loaded_radii(1.0005 * K, 0.0, b, LOADS).max() > 1 + 1e-9


def test_the_plot_shows_what_is_needed_and_what_there_is():
    pytest.importorskip("matplotlib").use("Agg")
    found = calc_passivity(make_spring_damper(800.0, 2.0, T), T)
    axes = found.plot(available={"device": 0.05, "device and hand": 5.05})
    required, worst, device, both = axes.lines
    assert np.array_equal(required.get_ydata(), found.required_damping)
    assert worst.get_ydata() == [found.worst_damping]
    assert (device.get_ydata()[0], both.get_ydata()[0]) == (0.05, 5.05)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [
        "required",
        "device",
        "device and hand",
    ]
    assert found.to_dict()["worst_damping"] == found.worst_damping


H = make_spring_damper(800.0, 2.0, T)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((H, 0.0), "period_s must be positive and finite, is 0"),
        ((H, T, [501.0]), "frequencies_Hz must be from 0 to"),
        ((H, T, []), "frequencies_Hz must be from 0 to"),
        ((lambda z: np.ones((2, 1)), T), "H must be square"),
        ((lambda z: math.nan, T), "H is not finite"),
        ((LinearSystem(*[np.eye(1)] * 4, 2 * T), T), "period_s is 0.001, but"),
        ((LinearSystem(*[2 * np.eye(1)] * 4, T), T), "H is unstable, .z. = 2"),
        ((LinearSystem(*[np.eye(1)] * 4, 0.0), T), "it is continuous"),
    ],
)
def test_what_cannot_be_is_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        calc_passivity(*arguments)


def test_a_damping_that_is_none_is_refused():
    found = calc_passivity(H, T, [100.0])
    with pytest.raises(ValueError, match=r"damping must be \(1, 1\), is \(2, 2\)"):
        found.calc_usage(np.eye(2))
    with pytest.raises(ValueError, match="damping must be positive definite"):
        found.calc_usage(np.zeros((1, 1)))
