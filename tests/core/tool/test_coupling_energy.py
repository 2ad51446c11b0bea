"""The energy of a coupling that is sampled and held, and its bound."""

from __future__ import annotations

import numpy as np
import pytest
from energy_rig import (
    IDENTITY,
    H,
    add,
    coupling_model,
    make_ledger,
    pose,
    rotation_of,
    tool_at,
)
from scipy.spatial.transform import Rotation

from drake_haptics import _core


def hand_moves(
    ledger, handles, gains, q_HT=IDENTITY, states=None, shown=1.0, explicit=False
):
    """Moves the handle, and the tool where states are given; shows the wrenches.

    An explicit step knows no stiffness and no damping.
    """
    F_held = np.zeros(6)
    for i, q_WH in enumerate(handles):
        state = tool_at(0.0) if states is None else states[i]
        V_WH = np.zeros(6)
        if i:
            before = handles[i - 1]
            turn = (rotation_of(q_WH) * rotation_of(before).inv()).as_rotvec()
            V_WH = np.concatenate([turn, q_WH[4:] - before[4:]]) / H
        wrench, F_Ho_W_commanded = coupling_model(q_WH, V_WH, q_HT, state, gains)
        if explicit:
            wrench[6:] = 0.0
        add(ledger, state, q_WH=q_WH, F_Ho_W_rendered=F_held, coupling=wrench)
        F_held = shown * F_Ho_W_commanded


def test_a_sampled_wall_makes_half_k_dx_squared_a_tick_and_no_more():
    k, step, ticks = 800.0, 2e-4, 30
    gains = _core.CouplingGains(k, 0, 0, 0)
    way_in = step * np.arange(ticks + 1)
    handles = [
        np.concatenate([IDENTITY[:4], [x, 0, 0]])
        for x in np.concatenate([way_in, way_in[-2::-1]])
    ]
    _, ledger = make_ledger(gains=gains)
    hand_moves(ledger, handles, gains)
    made = 2 * ticks * 0.5 * k * step**2
    for name in ("coupling", "device"):
        books = ledger.accounts[name]
        assert books.out_J - books.in_J == pytest.approx(made)
        assert books.created_J == pytest.approx(made)
        # The bound is reached.
        assert books.bound_J == pytest.approx(made)
        assert books.beyond_J < 1e-15
        assert books.stored_J == pytest.approx(0, abs=1e-15)
    # In on the way in: each force is that of the tick before.
    assert ledger.accounts["device"].in_J == pytest.approx(
        k * step**2 * ticks * (ticks - 1) / 2
    )


def test_a_sampled_torsional_wall_does_the_same():
    kr, step, ticks = 0.5, 0.01, 30
    gains = _core.CouplingGains(0, 0, kr, 0)
    axis = np.array([1, 2, 2]) / 3
    handles = [
        pose(Rotation.from_rotvec(step * i * axis), np.zeros(3))
        for i in [*range(ticks + 1), *range(ticks - 1, -1, -1)]
    ]
    _, ledger = make_ledger(gains=gains)
    hand_moves(ledger, handles, gains)
    books = ledger.accounts["device"]
    made = 2 * ticks * 0.5 * kr * step**2
    assert books.created_J == pytest.approx(made)
    assert books.bound_J == pytest.approx(made)


def test_a_damped_wall_stays_within_the_bound_of_its_sampled_damper():
    gains = _core.CouplingGains(0.0, 2.0, 0.0, 0.0)
    times = H * np.arange(400)
    path = 0.01 * np.sin(2 * np.pi * 40 * times)
    handles = [np.concatenate([IDENTITY[:4], [x, 0, 0]]) for x in path]
    _, ledger = make_ledger(gains=gains)
    hand_moves(ledger, handles, gains)
    books = ledger.accounts["coupling"]
    # Held for a tick, it makes energy at each turn; on the whole it takes.
    assert 0.0 < books.created_J <= books.bound_J
    assert books.beyond_J < 1e-15
    assert books.damped_J == pytest.approx(
        np.sum(2.0 * np.diff(path) ** 2 / H), rel=1e-12
    )
    assert books.lost_J == pytest.approx(
        -np.sum(2.0 * np.diff(path)[:-1] / H * -np.diff(path)[1:]), rel=1e-9
    )


def test_what_the_implicit_step_takes_is_not_in_the_bound():
    # The tool follows by a share c: k ((1 - c)²/2 - c²) dx² a tick, exactly.
    k, step, ticks, c = 800.0, 2e-4, 30, 0.3
    gains = _core.CouplingGains(k, 0, 0, 0)
    x = step * np.arange(ticks + 1)
    handles = [np.concatenate([IDENTITY[:4], [x, 0, 0]]) for x in x]
    states = [tool_at(c * x, c * step / H) for x in x]
    _, ledger = make_ledger(gains=gains)
    hand_moves(ledger, handles, gains, states=states)
    made = ticks * k * ((1 - c) ** 2 / 2 - c**2) * step**2
    books = ledger.accounts["coupling"]
    assert books.created_J == pytest.approx(made)
    assert books.bound_J == pytest.approx(made)


@pytest.mark.parametrize("limits", [(), (8.5, 0.188)])
@pytest.mark.parametrize("explicit", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_no_motion_of_handle_and_tool_gets_more_out_than_sampling_explains(
    seed, explicit, limits
):
    """Large steps in all axes: also the terms of higher order must be in the bound."""
    rng = np.random.default_rng(seed)
    dampings = rng.choice([0, 3]), rng.choice([0, 0.02])
    gains = _core.CouplingGains(800, dampings[0], 2.0, dampings[1], *limits)
    q_HT = pose(Rotation.random(random_state=seed), rng.normal(size=3))
    _, ledger = make_ledger(gains=gains, q_HT=q_HT)
    size = 10 ** rng.uniform(-4, -1)
    R_WH, p_WH = Rotation.random(random_state=seed + 1), np.zeros(3)
    held = R_WH * rotation_of(q_HT)
    R_WT, p_WT = held, p_WH + R_WH.apply(q_HT[4:])
    handles, states = [], []
    for i in range(300):
        V = np.zeros(6)
        if i:
            R_WH = Rotation.from_rotvec(size * rng.normal(size=3)) * R_WH
            p_WH = p_WH + 0.1 * size * rng.normal(size=3)
            V = size * rng.normal(size=6) * [1, 1, 1, 0.1, 0.1, 0.1] / H
            R_WT = Rotation.from_rotvec(H * V[:3]) * R_WT
            p_WT = p_WT + H * V[3:]
        handles.append(pose(R_WH, p_WH))
        states.append(np.concatenate([pose(R_WT, p_WT), V]))
    hand_moves(ledger, handles, gains, q_HT, states, explicit=explicit)
    books = ledger.accounts["coupling"]
    assert books.created_J > 0.0
    assert books.beyond_J < 1e-12 * (books.in_J + books.out_J)


def test_the_spring_s_energy_is_what_the_coupling_stores():
    gains = _core.CouplingGains(800, 1, 2, 0.01)
    q_HT = pose(Rotation.from_euler("x", 0.3), [0.1, 0, 0])
    _, ledger = make_ledger(gains=gains, q_HT=q_HT)
    q_WH = pose(Rotation.identity(), [0.02, 0, 0])
    add(ledger, tool_at(0.1), q_WH=q_WH)
    assert ledger.accounts["coupling"].stored_J == pytest.approx(
        0.5 * 800 * 0.02**2 + 0.5 * 2 * 0.3**2
    )


def test_a_spring_that_yields_stores_the_work_against_its_limit():
    gains = _core.CouplingGains(800, 1, 2, 0.01, 8.5, 0.188)
    _, ledger = make_ledger(gains=gains)
    add(ledger, tool_at(0.0), q_WH=pose(Rotation.from_euler("x", 0.3), [0, 0.2, 0]))
    yields_m, yields_rad = 8.5 / 800, 0.188 / 2
    assert ledger.accounts["coupling"].stored_J == pytest.approx(
        8.5 * (0.2 - yields_m / 2) + 0.188 * (0.3 - yields_rad / 2)
    )


def test_pulled_far_beyond_its_limit_and_back_it_gives_what_it_got():
    """A constant force makes no energy by being sampled; only its spring does."""
    k, step, ticks = 800.0, 2e-4, 400
    gains = _core.CouplingGains(k, 0, 0, 0, 8.5)
    x = step * np.concatenate([np.arange(ticks + 1), np.arange(ticks - 1, -1, -1)])
    _, ledger = make_ledger(gains=gains)
    hand_moves(ledger, [np.concatenate([IDENTITY[:4], [x, 0, 0]]) for x in x], gains)
    books = ledger.accounts["device"]
    # Up to the limit as any sampled wall, half a step's work each way.
    assert books.out_J - books.in_J == pytest.approx(8.5 * step)
    assert 0.0 < books.created_J <= books.bound_J
    assert books.beyond_J < 1e-15
    assert books.stored_J == pytest.approx(0, abs=1e-15)


def test_a_limit_of_the_device_shows_in_the_display():
    # The hand pushes in against half of what the coupling asks for.
    k, step, ticks = 800.0, 2e-4, 30
    gains = _core.CouplingGains(k, 0, 0, 0)
    _, ledger = make_ledger(gains=gains)
    handles = [
        np.concatenate([IDENTITY[:4], [i * step, 0, 0]]) for i in range(ticks + 1)
    ]
    hand_moves(ledger, handles, gains, shown=0.5)
    asked = k * step**2 * ticks * (ticks - 1) / 2
    books = ledger.accounts
    assert books["device"].in_J == pytest.approx(0.5 * asked)
    assert books["coupling"].in_J == pytest.approx(asked)
    assert books["display"].beyond_J == pytest.approx(0.5 * asked)
