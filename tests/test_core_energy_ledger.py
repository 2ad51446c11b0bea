"""The books of a tick against mechanics written out in NumPy, and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drake_haptics import _core

H = 1e-3
MASS = 0.1
INERTIA = np.diag([2e-5, 4e-5, 5e-5])
IDENTITY = np.array([1.0, 0, 0, 0, 0, 0, 0])
NO_GAINS = _core.CouplingGains(0, 0, 0, 0)
NO_WRENCH = np.zeros(78)
X = np.array([0, 0, 0, 1.0, 0, 0])


def make_ledger(sources=(), *, gains=NO_GAINS, c=(0, 0, 0), q_HT=IDENTITY):
    tool = _core.RigidToolDynamics(MASS, np.array(c, float), INERTIA)
    return tool, _core.EnergyLedger(tool, gains, q_HT, H, list(sources))


def add(ledger, tool_state, sources=(), stored=None, **changes):
    """Adds a reading with nothing in it but what is given."""
    reading = {
        "q_WH": IDENTITY,
        "F_applied": np.zeros(6),
        "coupling": NO_WRENCH,
        "wrench_models": list(sources),
        "stored_J": [0.0] * len(sources) if stored is None else stored,
    }
    ledger.add(tool_state=tool_state, **(reading | changes))


def model(F, K=None, B=None):
    K = np.zeros((6, 6)) if K is None else K
    B = np.zeros((6, 6)) if B is None else B
    return np.concatenate([F, np.ravel(K), np.ravel(B)])


def tool_at(x, v=0.0):
    """The state of a tool at x on the first axis, that came there at speed v."""
    return np.concatenate([[1, 0, 0, 0, x, 0, 0], v * X])


def random_model(rng, scale=1.0):
    def spread():
        root = rng.normal(size=(6, 6))
        return root @ root.T

    return model(scale * rng.normal(size=6), spread(), 1e-4 * spread())


def rotation_of(q):
    return Rotation.from_quat(np.roll(q[:4], -1))


def pose(rotation, p):
    return np.concatenate([np.roll(rotation.as_quat(), 1), p])


# --- the tool ---


def kinetic_energy(state, c):
    """From the velocity of the centre of mass and the principal inertia."""
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


# --- sources of wrench ---


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


def drag(ledger, positions, force_at, energy_at):
    """Moves the tool along x against a source without a linear model."""
    before = positions[0]
    for x in positions:
        add(
            ledger,
            tool_at(x, (x - before) / H),
            [model(force_at(x) * X)],
            [energy_at(x)],
        )
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


def test_without_a_linear_model_a_cycle_of_a_spring_makes_half_k_dx_squared_a_tick():
    # Sampled and held on the way in, where it pushes too little, and on the way out.
    k, step, ticks = 1000.0, 1e-4, 20
    _, ledger = make_ledger(["source"])
    way_in = step * np.arange(ticks + 1)
    positions = np.concatenate([way_in, way_in[-2::-1]])
    books = drag(ledger, positions, lambda x: -k * x, lambda x: 0.5 * k * x * x)
    assert books.out_J - books.in_J == pytest.approx(2 * ticks * 0.5 * k * step**2)
    assert books.created_J == pytest.approx(2 * ticks * 0.5 * k * step**2)
    assert books.bound_J == pytest.approx(2 * books.created_J)
    assert books.beyond_J == 0
    assert books.stored_J == 0


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


# --- the coupling and the device ---


def coupling_model(q_WH, V_WH, q_HT, state, gains):
    wrench = _core.coupling_wrench(q_WH, V_WH, q_HT, state[:7], state[7:], gains)
    return wrench[:78], wrench[78:]


def hand_moves(ledger, handles, gains, q_HT=IDENTITY, states=None, shown=1.0):
    """Moves the handle, and the tool where states are given; shows the wrenches."""
    F_held = np.zeros(6)
    for i, q_WH in enumerate(handles):
        state = tool_at(0.0) if states is None else states[i]
        V_WH = np.zeros(6)
        if i:
            before = handles[i - 1]
            turn = (rotation_of(q_WH) * rotation_of(before).inv()).as_rotvec()
            V_WH = np.concatenate([turn, q_WH[4:] - before[4:]]) / H
        wrench, F_display = coupling_model(q_WH, V_WH, q_HT, state, gains)
        add(ledger, state, q_WH=q_WH, F_applied=F_held, coupling=wrench)
        F_held = shown * F_display


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


@pytest.mark.parametrize("seed", range(6))
def test_no_motion_of_handle_and_tool_gets_more_out_than_sampling_explains(seed):
    """Large steps in all axes: also the terms of higher order must be in the bound."""
    rng = np.random.default_rng(seed)
    gains = _core.CouplingGains(800, rng.choice([0, 3]), 2.0, rng.choice([0, 0.02]))
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
    hand_moves(ledger, handles, gains, q_HT, states)
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


def test_the_device_has_the_sum_of_the_parts():
    rng = np.random.default_rng(3)
    gains = _core.CouplingGains(800, 2, 2, 0.01)
    tool, ledger = make_ledger(["contact"], gains=gains)
    state = tool_at(0.0)
    F_held = np.zeros(6)
    for i in range(300):
        x = 0.01 * np.sin(0.05 * i)
        q_WH = pose(Rotation.from_rotvec([0, 0.3 * x, 0]), [x, 0, 0])
        coupling, F_display = coupling_model(q_WH, np.zeros(6), IDENTITY, state, gains)
        contact = random_model(rng, 0.1)
        add(
            ledger, state, [contact], [0.01 * rng.random()],
            q_WH=q_WH, F_applied=F_held, coupling=coupling,
        )  # fmt: skip
        state = tool.step(state, coupling + contact, H)
        F_held = 0.9 * F_display
    books = ledger.accounts
    assert list(books) == ["device", "display", "coupling", "tool", "contact"]
    parts = [account for name, account in books.items() if name != "device"]
    device = books["device"]
    for what in ("stored_J", "lost_J", "damped_J"):
        assert getattr(device, what) == pytest.approx(
            sum(getattr(part, what) for part in parts), rel=1e-12
        )


# --- what is refused ---


def test_a_tick_that_is_not_finite_is_left_out():
    _, ledger = make_ledger(["source"])
    add(ledger, tool_at(0.0), [NO_WRENCH])
    add(ledger, tool_at(1.0, 1000.0), [model(1e308 * X)], [1.0])
    before = ledger.accounts["source"].stored_J
    add(ledger, tool_at(2e9, 1e30), [NO_WRENCH], [3.0])
    account = ledger.accounts["source"]
    assert account.stored_J == before == 1.0
    assert np.isfinite(account.lost_J)


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


# --- stored energies ---


def test_the_weight_s_energy_is_that_of_its_height():
    q = pose(Rotation.from_euler("y", 90, degrees=True), [1, 2, 3])
    weight = np.array([0, 0, -0.5])
    # The centre of mass, on the tool's x axis, hangs 0.1 below its origin.
    energy = _core.weight_energy(q, np.array([0.1, 0, 0]), weight)
    assert energy == pytest.approx(0.5 * 2.9)
