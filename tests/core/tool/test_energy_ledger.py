"""The books of the tool, and of a whole loop, against mechanics in NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from energy_rig import (
    IDENTITY,
    INERTIA,
    MASS,
    NO_GAINS,
    NO_WRENCH,
    H,
    X,
    add,
    coupling_model,
    make_ledger,
    model,
    pose,
    random_model,
    rotation_of,
    tool_at,
)
from scipy.spatial.transform import Rotation

from drake_haptics import _core


def kinetic_energy(state, c):
    """From the velocity of the center of mass and the principal inertia."""
    R = rotation_of(state).as_matrix()
    w, v = state[7:10], state[10:]
    w_T = R.T @ w
    v_cm = v + np.cross(w, R @ c)
    return 0.5 * MASS * v_cm @ v_cm + 0.5 * w_T @ INERTIA @ w_T


def spatial_inertia(state, c):
    """M with ½ VᵀM V the kinetic energy, by polarization of that."""
    units = np.eye(6)

    def energy(V):
        return kinetic_energy(np.concatenate([state[:7], V]), c)

    M = np.zeros((6, 6))
    for i in range(6):
        for j in range(6):
            M[i, j] = energy(units[i] + units[j]) - energy(units[i]) - energy(units[j])
    return M


def velocity_terms(state, M, c):
    """Returns b of M dV/dt + b = F."""
    w, c_W = state[7:10], rotation_of(state).apply(c)
    return np.concatenate(
        [np.cross(w, M[:3, :3] @ w), MASS * np.cross(w, np.cross(w, c_W))]
    )


def test_the_tool_balances_under_any_wrenches():
    rng = np.random.default_rng(0)
    c = np.array([0.03, -0.02, 0.05])
    names = ["contact", "friction"]
    tool, ledger = make_ledger(names, c=c)
    state = np.concatenate([pose(Rotation.random(random_state=1), [1, 2, 3]), X])
    state[7:] = 10 * rng.normal(size=6)
    work = {name: 0.0 for name in ["coupling", *names]}
    taken = gyroscopic = 0.0
    E_start = kinetic_energy(state, c)
    for _ in range(100):
        models = [random_model(rng, 0.1) for _ in range(3)]
        add(ledger, state, models[1:], coupling=models[0])
        after = tool.step(state, np.sum(models, axis=0), H)
        V, V_after = state[7:], after[7:]
        dV, delta = V_after - V, H * V_after
        for name, m in zip(work, models, strict=True):
            F, K, B = m[:6], m[6:42].reshape(6, 6), m[42:].reshape(6, 6)
            work[name] += delta @ (F - B @ dV - K @ delta)
        M, M_after = spatial_inertia(state, c), spatial_inertia(after, c)
        taken += 0.5 * dV @ M @ dV
        gyroscopic += 0.5 * V_after @ (M_after - M) @ V_after
        gyroscopic -= delta @ velocity_terms(state, M, c)
        state = after
    add(ledger, state, [NO_WRENCH] * 2)
    books = ledger.accounts
    scale = books["tool"].in_J + books["tool"].out_J
    for name, W in work.items():
        assert books[name].out_J - books[name].in_J == pytest.approx(
            W, abs=1e-13 * scale
        )
    E = kinetic_energy(state, c)
    assert books["tool"].stored_J == pytest.approx(E, rel=1e-13)
    assert books["tool"].lost_J == pytest.approx(
        sum(work.values()) - (E - E_start), abs=1e-13 * scale
    )
    # What it loses is what the implicit step takes, but for the gyroscopic force.
    assert abs(gyroscopic) > 1e-3 * taken
    assert books["tool"].lost_J == pytest.approx(taken - gyroscopic, rel=1e-12)
    assert books["tool"].beyond_J < 1e-13 * scale


def test_a_tool_that_only_translates_loses_half_the_square_of_each_change():
    tool, ledger = make_ledger(["push"])
    state = tool_at(0.0)
    force = model(2.0 * X)
    for _ in range(50):
        add(ledger, state, [force])
        state = tool.step(state, force, H)
    add(ledger, state, [force])
    # ΔV = h F / m each tick.
    books = ledger.accounts["tool"]
    assert books.lost_J == pytest.approx(50 * 0.5 * MASS * (H * 2.0 / MASS) ** 2)
    assert books.stored_J == pytest.approx(0.5 * MASS * (50 * H * 2.0 / MASS) ** 2)
    assert (books.created_J, books.beyond_J) == (0, 0)


def test_the_gyroscopic_force_alone_explains_what_a_free_spin_gains():
    tool, ledger = make_ledger(c=(0.02, 0, 0))
    state = np.concatenate([IDENTITY, [40.0, 0.1, 30.0, 0, 0, 0]])
    gained = []
    for _ in range(300):
        add(ledger, state)
        gained.append(kinetic_energy(state, np.array([0.02, 0, 0])))
        state = tool.step(state, NO_WRENCH, H)
    books = ledger.accounts["tool"]
    falls = np.max(np.array(gained) - np.minimum.accumulate(gained))
    assert falls > 0.0
    assert books.created_J == pytest.approx(falls, rel=1e-9)
    assert books.beyond_J < 1e-14


def test_a_wrench_that_nobody_told_shows_as_made_by_the_tool():
    tool, ledger = make_ledger()
    state = tool_at(0.0)
    for _ in range(10):
        add(ledger, state)
        state = tool.step(state, model(X), H)
    add(ledger, state)
    books = ledger.accounts["tool"]
    assert books.beyond_J == pytest.approx(0.5 * MASS * (10 * H / MASS) ** 2)


def test_the_device_has_the_sum_of_the_parts():
    rng = np.random.default_rng(3)
    gains = _core.CouplingGains(800, 2, 2, 0.01)
    tool, ledger = make_ledger(["contact"], gains=gains)
    state = tool_at(0.0)
    F_held = np.zeros(6)
    for i in range(300):
        x = 0.01 * np.sin(0.05 * i)
        q_WH = pose(Rotation.from_rotvec([0, 0.3 * x, 0]), [x, 0, 0])
        coupling, F_Ho_W_commanded = coupling_model(
            q_WH, np.zeros(6), IDENTITY, state, gains
        )
        contact = random_model(rng, 0.1)
        add(
            ledger, state, [contact], [0.01 * rng.random()],
            q_WH=q_WH, F_Ho_W_rendered=F_held, coupling=coupling,
        )  # fmt: skip
        state = tool.step(state, coupling + contact, H)
        F_held = 0.9 * F_Ho_W_commanded
    books = ledger.accounts
    assert list(books) == ["device", "display", "coupling", "tool", "contact"]
    parts = [account for name, account in books.items() if name != "device"]
    device = books["device"]
    for what in ("stored_J", "lost_J", "damped_J"):
        assert getattr(device, what) == pytest.approx(
            sum(getattr(part, what) for part in parts), rel=1e-12
        )


def test_a_tick_that_is_not_finite_is_left_out():
    _, ledger = make_ledger(["source"])
    add(ledger, tool_at(0.0), [NO_WRENCH])
    add(ledger, tool_at(1.0, 1000.0), [model(1e308 * X)], [1.0])
    before = ledger.accounts["source"].stored_J
    add(ledger, tool_at(2e9, 1e30), [NO_WRENCH], [3.0])
    account = ledger.accounts["source"]
    assert account.stored_J == before == 1.0
    assert np.isfinite(account.lost_J)


def test_a_wrench_that_is_no_number_is_left_out():
    _, ledger = make_ledger(["source"])
    add(ledger, tool_at(0.0), [model(np.nan * X)])
    add(ledger, tool_at(0.0, 1.0), [NO_WRENCH])
    assert np.isfinite(ledger.accounts["tool"].lost_J)
    assert np.isfinite(ledger.accounts["source"].lost_J)


def test_books_begin_with_the_first_finite_reading():
    _, ledger = make_ledger(["source"])
    add(ledger, tool_at(np.nan), [NO_WRENCH], [1.0])
    assert ledger.accounts["source"].stored_J == 0.0
    add(ledger, tool_at(0.0), [NO_WRENCH], [2.0])
    add(ledger, tool_at(0.0), [NO_WRENCH], [2.0])
    assert ledger.accounts["source"].stored_J == 2.0
    assert ledger.accounts["source"].created_J == 0.0


def test_readings_that_do_not_fit_are_refused():
    tool, ledger = make_ledger(["contact"])
    with pytest.raises(ValueError, match="of each source"):
        add(ledger, tool_at(0.0))
    with pytest.raises(ValueError, match="one value per source"):
        add(ledger, tool_at(0.0), [NO_WRENCH], [])
    with pytest.raises(ValueError, match="two accounts of the name tool"):
        make_ledger(["tool"])
    for h in (0.0, -1e-3, np.nan):
        with pytest.raises(ValueError, match="tick must be above 0"):
            _core.EnergyLedger(tool, NO_GAINS, IDENTITY, h, [])
