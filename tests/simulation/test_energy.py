"""The books of real loops, against what NumPy finds in what went through them."""

from __future__ import annotations

import json
from types import SimpleNamespace

import numpy as np
import pytest
from box_scenes import TOOL_HALF_HEIGHT, TOOL_MASS, over_a_plate
from diagram_parts import read_port
from scipy.spatial.transform import Rotation

from drake_haptics import EnergyLedger
from drake_haptics.geometry.mesh.mesh import calc_mass_properties
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.schema import (
    BrakingParameters,
    Effects,
    FrictionParameters,
    GravityParameters,
)
from drake_haptics.simulation.run import make_simulator, run

H = 1e-3
ABOVE = (0.0, 0.0, 0.0, TOOL_HALF_HEIGHT + 0.01)
PRESSING = (0.3, 0.0, 0.0, TOOL_HALF_HEIGHT - 0.006)
ASIDE = (0.6, 0.01, 0.005, TOOL_HALF_HEIGHT - 0.006)


def turned(scene):
    """Turns the tool about all axes on its way."""
    for i, waypoint in enumerate(scene.hand.path.waypoints):
        waypoint.rpy_deg = [10.0 * i, -5.0 * i, 15.0 * i]
    return scene


def record(scene, duration_s):
    """Runs a scene; returns its books and all that went through it, by tick."""
    haptic = BuildHapticDiagram(scene)
    loop = haptic.loop
    ports = {
        "X_WT": loop.haptic_tool.GetOutputPort("X_WT"),
        "V_WT": loop.haptic_tool.GetOutputPort("V_WT"),
        "X_WH": loop.device.GetOutputPort("X_WH"),
        "V_WH": loop.device.GetOutputPort("V_WH"),
        "F_Ho_W_rendered": loop.device.GetOutputPort("F_Ho_W_rendered"),
        "F_Ho_W_commanded": loop.virtual_coupling.GetOutputPort("F_Ho_W_commanded"),
        **loop.wrench_sources,
    }
    seen = {name: [] for name in ports}

    def read(root):
        for name, port in ports.items():
            seen[name].append(read_port(port, root).copy())

    read(haptic.diagram.CreateDefaultContext())
    figures = run(haptic, duration_s, energy=True, on_tick=read).to_dict()
    p_TTcm, I_TTcm_T = calc_mass_properties(haptic.tool.mesh, TOOL_MASS)
    return SimpleNamespace(
        books=figures["energy_J"],
        sources=list(loop.wrench_sources),
        p_TTcm=p_TTcm,
        I_TTcm_T=I_TTcm_T,
        **{name: np.array(values) for name, values in seen.items()},
    )


def rotations(poses):
    return Rotation.from_quat(np.roll(poses[:, :4], -1, axis=1))


def displacements(poses):
    R = rotations(poses)
    return np.hstack(
        [(R[1:] * R[:-1].inv()).as_rotvec(), np.diff(poses[:, 4:], axis=0)]
    )


def works_on_tool(seen, name):
    """Of the wrench that the implicit step applies, in each tick."""
    model = getattr(seen, name)[:-1]
    F, K, B = model[:, :6], model[:, 6:42], model[:, 42:]
    V, V_after = seen.V_WT[:-1], seen.V_WT[1:]
    applied = (
        F
        - np.einsum("tij,tj->ti", B.reshape(-1, 6, 6), V_after - V)
        - H * np.einsum("tij,tj->ti", K.reshape(-1, 6, 6), V_after)
    )
    return H * np.einsum("ti,ti->t", V_after, applied)


def kinetic_energies(seen):
    R = rotations(seen.X_WT)
    w, v = seen.V_WT[:, :3], seen.V_WT[:, 3:]
    v_cm = v + np.cross(w, R.apply(seen.p_TTcm))
    w_T = R.inv().apply(w)
    return 0.5 * TOOL_MASS * np.sum(v_cm**2, axis=1) + 0.5 * np.einsum(
        "ti,ij,tj->t", w_T, seen.I_TTcm_T, w_T
    )


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plain")
    scene = turned(over_a_plate(folder, [ABOVE, PRESSING, ASIDE], tool="cube"))
    return record(scene, 0.7)


@pytest.fixture(scope="module")
def rich(tmp_path_factory):
    folder = tmp_path_factory.mktemp("rich")
    scene = turned(over_a_plate(folder, [ABOVE, PRESSING, ASIDE], tool="cube"))
    scene.effects = Effects(
        friction=FrictionParameters(),
        braking=BrakingParameters(),
        gravity=GravityParameters(),
    )
    return record(scene, 0.7)


@pytest.fixture(params=["plain", "rich"])
def seen(request):
    return request.getfixturevalue(request.param)


def test_there_are_books_of_every_part(plain, rich):
    assert list(plain.books) == ["device", "display", "coupling", "tool", "contact"]
    assert list(rich.books)[4:] == ["contact", "friction", "braking", "gravity"]
    assert json.loads(json.dumps(rich.books)) == rich.books


def test_what_goes_into_each_source_is_the_work_of_the_tool_on_it(seen):
    for name in seen.sources:
        if name == "coupling":
            continue
        W = works_on_tool(seen, name)
        books = seen.books[name]
        scale = np.abs(W).sum()
        assert scale > 0.0
        assert books["net"] == pytest.approx(-W.sum(), abs=1e-13 * scale)
        assert books["in"] == pytest.approx(-W[W < 0].sum(), abs=1e-13 * scale)


def test_the_tool_has_the_work_of_all_less_what_the_implicit_step_takes(seen):
    """The identity of the ledger, in a loop that runs: nothing is left out."""
    W = sum(works_on_tool(seen, name) for name in seen.sources)
    E = kinetic_energies(seen)
    books = seen.books["tool"]
    scale = books["in"] + books["out"]
    assert books["net"] == pytest.approx(W.sum(), abs=1e-12 * scale)
    assert books["stored"] == pytest.approx(E[-1], rel=1e-12)
    assert books["lost"] == pytest.approx(W.sum() - (E[-1] - E[0]), abs=1e-12 * scale)
    # ½ ΔVᵀM ΔV and the gyroscopic force, both from energies: M is that of the start.
    R = rotations(seen.X_WT)[:-1]
    V, V_after = seen.V_WT[:-1], seen.V_WT[1:]

    def energies(V):
        return kinetic_energies(
            SimpleNamespace(
                X_WT=seen.X_WT[:-1], V_WT=V, p_TTcm=seen.p_TTcm, I_TTcm_T=seen.I_TTcm_T
            )
        )

    c = R.apply(seen.p_TTcm)
    w = V[:, :3]
    f = TOOL_MASS * np.cross(w, np.cross(w, c))
    L = R.apply(R.inv().apply(w) @ seen.I_TTcm_T)
    b = np.hstack([np.cross(w, L) + np.cross(c, f), f])
    taken = energies(V_after - V)
    gyroscopic = E[1:] - energies(V_after) - H * np.sum(V_after * b, axis=1)
    assert books["lost"] == pytest.approx((taken - gyroscopic).sum(), rel=1e-9)


def test_the_hand_is_charged_for_its_way_against_the_wrench_that_is_held(seen):
    work = -np.sum(seen.F_Ho_W_rendered[1:] * displacements(seen.X_WH), axis=1)
    books = seen.books["device"]
    scale = books["in"] + books["out"]
    assert books["net"] == pytest.approx(work.sum(), abs=1e-12 * scale)
    # The wrench of the right tick: a speed half-way says the same.
    V = (seen.V_WH[1:] + seen.V_WH[:-1]) / 2
    power = -np.sum(seen.F_Ho_W_rendered[1:] * V, axis=1)
    assert books["net"] == pytest.approx(H * power.sum(), abs=5e-4 * scale)


def test_what_the_coupling_gets_from_the_handle_goes_through_the_display(seen):
    asked = -np.sum(seen.F_Ho_W_commanded[:-1] * displacements(seen.X_WH), axis=1)
    to_tool = works_on_tool(seen, "coupling")
    books = seen.books["coupling"]
    scale = books["in"] + books["out"]
    assert books["net"] == pytest.approx((asked - to_tool).sum(), abs=1e-12 * scale)
    # The device shows all it is asked for here.
    assert seen.books["display"]["lost"] == pytest.approx(0.0, abs=1e-12 * scale)


def test_what_the_hand_put_in_is_stored_or_lost(seen):
    books = dict(seen.books)
    device = books.pop("device")
    scale = device["in"] + device["out"]
    grown = sum(part["net"] - part["lost"] for part in books.values())
    lost = sum(part["lost"] for part in books.values())
    assert device["net"] == pytest.approx(grown + lost, abs=1e-12 * scale)
    assert device["lost"] == pytest.approx(lost, abs=1e-12 * scale)
    assert 0.0 < device["damped"] < device["lost"]


def test_a_weight_stores_its_height(rich):
    R = rotations(rich.X_WT)
    z = rich.X_WT[:, 6] + R.apply(rich.p_TTcm)[:, 2]
    assert rich.books["gravity"]["stored"] == pytest.approx(TOOL_MASS * 9.81 * z[-1])


def test_friction_stores_little_and_takes_the_rest(rich):
    books = rich.books["friction"]
    assert 0.0 < books["stored"] < books["lost"]
    assert books["damped"] == 0.0


def test_braking_only_takes(rich):
    books = rich.books["braking"]
    # Two sums of the same 700 terms, in another order.
    assert books["lost"] == pytest.approx(books["damped"], rel=700 * 2.2e-16)
    assert books["damped"] > 0.0
    assert books["created"] == books["stored"] == 0.0


def test_a_ball_pressed_and_let_go_returns_what_the_contact_stored(tmp_path):
    scene = over_a_plate(tmp_path, [ABOVE, PRESSING, (0.6, *ABOVE[1:])], tool="ball")
    scene.contact.damping_Ns_per_m = 0.0
    books = record(scene, 0.7).books["contact"]
    assert (books["stored"], books["damped"]) == (0.0, 0.0)
    assert books["in"] > 1e-4
    assert abs(books["net"]) < books["bound"] + 0.2 * books["in"]
    assert 0.0 < books["created"] <= books["bound"]
    assert books["beyond"] < 1e-15


def test_a_loop_of_one_s_own_has_the_same_books(tmp_path):
    haptic = BuildHapticDiagram(over_a_plate(tmp_path, [ABOVE, PRESSING]))
    simulator = make_simulator(haptic)
    simulator.Initialize()
    ledger = EnergyLedger(haptic.loop, simulator.get_context())
    ledger.add()
    simulator.set_monitor(lambda context: ledger.add())
    simulator.AdvanceTo(0.4)
    assert ledger.to_dict() == run(haptic, 0.4, energy=True).to_dict()["energy_J"]
    assert ledger.to_dict()["contact"]["in"] > 0.0
