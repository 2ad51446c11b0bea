"""The energy of a source of wrench in a tick, and its bound, by closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from energy_rig import MASS, H, X, add, make_ledger, model, tool_at


def test_a_spring_gives_back_what_it_got_less_what_the_step_takes():
    k = 500.0
    tool, ledger = make_ledger(["spring"])
    state = tool_at(0.01)
    taken = 0.0
    for _ in range(1000):
        x = state[4]
        spring = model(-k * x * X, k * np.outer(X, X))
        add(ledger, state, [spring], [0.5 * k * x * x])
        state = tool.step(state, spring, H)
        taken += 0.5 * k * (H * state[10]) ** 2
    x = state[4]
    spring = model(-k * x * X, k * np.outer(X, X))
    add(ledger, state, [spring], [0.5 * k * x * x])
    spring, tool = ledger.accounts["spring"], ledger.accounts["tool"]
    assert spring.lost_J == pytest.approx(taken, rel=1e-10)
    assert spring.created_J == spring.bound_J == spring.beyond_J == 0
    left = spring.stored_J + tool.stored_J + spring.lost_J + tool.lost_J
    assert left == pytest.approx(0.5 * k * 0.01**2, rel=1e-12)


def drag(ledger, positions, force_at, energy_at, K=0.0, b=0.0):
    """Moves the tool along x against a spring with a linear model and a damper."""
    before = positions[0]
    for x in positions:
        v = (x - before) / H
        source = model((force_at(x) - b * v) * X, K * np.outer(X, X), b * np.eye(6))
        add(ledger, tool_at(x, v), [source], [energy_at(x)])
        before = x
    return ledger.accounts["source"]


@pytest.mark.parametrize("gap", [0.0, 0.3, 0.9])
def test_a_wall_met_within_a_tick_has_got_half_a_square_for_nothing(gap):
    k, step = 1000.0, 1e-3
    _, ledger = make_ledger(["source"])
    depth = (1 - gap) * step
    books = drag(
        ledger,
        [-gap * step, depth],
        lambda x: -k * max(0.0, x),
        lambda x: 0.5 * k * max(0.0, x) ** 2,
    )
    assert books.created_J == pytest.approx(0.5 * k * depth**2)
    assert books.bound_J == pytest.approx(k * depth * step)
    assert books.beyond_J == 0
    # The bound is tight: half of it is reached.
    assert gap > 0 or books.created_J == pytest.approx(0.5 * books.bound_J)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.4])
def test_a_spring_that_the_step_knows_in_part_makes_the_rest(share):
    # Pushed in and out again. In closed form a tick makes (1/2 - share) k dx².
    k, step, ticks = 1000.0, 1e-4, 20
    _, ledger = make_ledger(["source"])
    way_in = step * np.arange(ticks + 1)
    positions = np.concatenate([way_in, way_in[-2::-1]])
    books = drag(
        ledger, positions, lambda x: -k * x, lambda x: 0.5 * k * x * x, share * k
    )
    ticks_dx2 = 2 * ticks * k * step**2
    assert books.out_J - books.in_J == pytest.approx((0.5 - share) * ticks_dx2)
    assert books.created_J == pytest.approx((0.5 - share) * ticks_dx2)
    assert books.bound_J == pytest.approx((1.0 - share) * ticks_dx2)
    assert books.beyond_J == 0
    assert books.stored_J == 0


def test_what_a_damper_takes_widens_no_bound():
    k, b, step, ticks = 1000.0, 0.2, 1e-4, 20
    _, ledger = make_ledger(["source"])
    positions = step * np.arange(ticks + 1)
    books = drag(ledger, positions, lambda x: -k * x, lambda x: 0.5 * k * x * x, b=b)
    taken = ticks * b * step**2 / H
    assert books.damped_J == pytest.approx(taken)
    assert books.created_J == pytest.approx(ticks * 0.5 * k * step**2 - taken)
    assert books.bound_J == pytest.approx(ticks * k * step**2)


def test_energy_that_a_force_jumps_to_is_beyond_the_bound():
    # A spring that is twice as stiff on the way out.
    k, step = 1000.0, 1e-6
    way_in = step * np.arange(1001)
    _, ledger = make_ledger(["source"])
    positions = np.concatenate([way_in, way_in[::-1]])
    stiffness = iter(np.repeat([k, 2 * k], 1001))
    now = [k]

    def force(x):
        now[0] = next(stiffness)
        return -now[0] * x

    books = drag(ledger, positions, force, lambda x: 0.5 * now[0] * x * x)
    assert books.out_J - books.in_J == pytest.approx(0.5 * k * 1e-6, rel=5e-3)
    assert books.beyond_J == pytest.approx(0.5 * k * 1e-6, rel=5e-3)


def test_a_force_that_turns_makes_half_its_bound():
    # A tool dragged around inside a bowl: the force always points to the middle.
    radius, F, step = 0.05, 3.0, 1e-3
    _, ledger = make_ledger(["bowl"])
    before = np.zeros(3)
    for i in range(201):
        angle = i * step / radius
        n = np.array([np.cos(angle), np.sin(angle), 0.0])
        # A straight way in each tick; the tool stays at its radius.
        p = radius * n
        V = np.concatenate([np.zeros(3), (p - before) / H]) if i else np.zeros(6)
        state = np.concatenate([[1, 0, 0, 0], p, V])
        add(ledger, state, [model(np.concatenate([np.zeros(3), -F * n]))], [1.0])
        before = p
    books = ledger.accounts["bowl"]
    assert books.created_J == pytest.approx(200 * 0.5 * F / radius * step**2, rel=1e-3)
    assert books.bound_J == pytest.approx(2 * books.created_J, rel=1e-3)
    assert books.beyond_J == 0


@pytest.mark.parametrize("b", [0.7, -0.7])
def test_a_damper_takes_and_a_negative_one_makes(b):
    tool, ledger = make_ledger(["damper"])
    state = tool_at(0.0, 0.3)
    taken = 0.0
    for _ in range(100):
        damper = model(-b * state[7:], None, b * np.eye(6))
        add(ledger, state, [damper])
        state = tool.step(state, damper, H)
        taken += H * b * state[7:] @ state[7:]
    add(ledger, state, [model(-b * state[7:], None, b * np.eye(6))])
    books = ledger.accounts["damper"]
    assert books.lost_J == pytest.approx(taken)
    assert books.damped_J == pytest.approx(taken)
    assert books.created_J == pytest.approx(max(0.0, -taken))
    assert books.beyond_J == pytest.approx(max(0.0, -taken), rel=1e-2)
    left = ledger.accounts["tool"]
    assert left.stored_J + left.lost_J + taken == pytest.approx(0.5 * MASS * 0.3**2)
