"""The check of a coupling on a device in a hand."""

from pathlib import Path

import pytest

from drake_haptics import _core
from drake_haptics.bounds.coupling import HeldHandle, find_broken_bounds
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import CouplingParameters
from drake_haptics.systems.arm.hand_impedance import HAND_GRIPS, NOMINAL_GRIP

PERIOD = 1e-3
SCENES = sorted((Path(__file__).parents[2] / "models" / "scenes").glob("*.yaml"))


def check_coupling(*arguments):
    return [bound.sentence for bound in find_broken_bounds(*arguments)]


def held_by(grip):
    """What the hand alone is: a device adds to it."""
    return HeldHandle(
        grip.mass_kg,
        grip.damping_Ns_per_m,
        grip.inertia_kgm2,
        grip.rotational_damping_Nms_per_rad,
    )


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_the_shipped_scenes_break_no_bound(path):
    scene = load_scene(path)
    handle = held_by(HAND_GRIPS[scene.hand.grip])
    assert check_coupling(scene.coupling, handle, 1 / scene.device.rate_hz) == []


@pytest.mark.parametrize("grip", ["nominal", "firm"])
def test_the_default_coupling_breaks_no_bound_in_a_hand(grip):
    assert check_coupling(CouplingParameters(), held_by(HAND_GRIPS[grip]), PERIOD) == []


def test_gains_of_the_core_are_checked_as_well():
    gains = _core.CouplingGains(800.0, 2.0, 1.0, 0.004)
    assert check_coupling(gains, held_by(NOMINAL_GRIP), PERIOD) == []


def test_without_the_hands_damping_the_default_is_not_passive():
    found = check_coupling(CouplingParameters(), held_by(HAND_GRIPS["light"]), PERIOD)
    (sentence,) = found
    assert sentence.startswith("damping_Ns_per_m is 2: not passive")
    assert "b = 1 N·s/m" in sentence
    assert "K (T/2 + t_d) + |B| is 2.4 (Colgate and Schenkel)" in sentence


@pytest.mark.parametrize(
    ("change", "begins", "names"),
    [
        # Nominal: 0.2 kg, 5 N·s/m, 3e-4 kg·m², 0.02 N·m·s/rad.
        ({"stiffness_N_per_m": 6100.0}, "stiffness_N_per_m is 6100", "Colgate"),
        ({"stiffness_N_per_m": 14100.0}, "stiffness_N_per_m is 14100", "14000"),
        ({"damping_Ns_per_m": 4.7}, "damping_Ns_per_m is 4.7", "Colgate"),
        ({"damping_Ns_per_m": 400.0}, "damping_Ns_per_m is 400", "Jury"),
        (
            {"rotational_stiffness_Nm_per_rad": 33.0},
            "rotational_stiffness_Nm_per_rad is 33: not passive",
            "Colgate",
        ),
        (
            {"rotational_stiffness_Nm_per_rad": 49.0},
            "rotational_stiffness_Nm_per_rad is 49, but stable only up to 48",
            "Gil",
        ),
        (
            {"rotational_damping_Nms_per_rad": 0.7},
            "rotational_damping_Nms_per_rad is 0.7, but stable only up to 0.59",
            "Jury",
        ),
        (
            {"rotational_stiffness_Nm_per_rad": 300.0},
            "rotational_stiffness_Nm_per_rad is 300, too stiff for any damping",
            "Jury",
        ),
    ],
)
def test_each_bound_is_named_with_the_value(change, begins, names):
    found = check_coupling(CouplingParameters(**change), held_by(NOMINAL_GRIP), PERIOD)
    assert any(begins in text and names in text for text in found), found
    # Only what was changed is blamed.
    kind = "rotational" if "rotational" in begins else "_N"
    assert all(kind in text for text in found)


def test_a_slower_rate_and_a_delay_count():
    coupling = CouplingParameters(stiffness_N_per_m=3000.0)
    handle = held_by(NOMINAL_GRIP)
    assert check_coupling(coupling, handle, PERIOD) == []
    assert "Gil" in check_coupling(coupling, handle, 10 * PERIOD)[0]
    assert "Gil" in check_coupling(coupling, handle, PERIOD, 3 * PERIOD)[0]
    # 3000 N/m times 1.5 periods and 2 N·s/m are more than the hand's 5 N·s/m.
    assert "is 6.5 (Colgate" in check_coupling(coupling, handle, PERIOD, PERIOD)[0]


@pytest.mark.parametrize("bad", [0.0, -1.0, float("nan")])
def test_what_cannot_be_is_refused(bad):
    handle = held_by(NOMINAL_GRIP)
    with pytest.raises(ValueError, match="period_s must be positive"):
        check_coupling(CouplingParameters(), handle, bad)
    with pytest.raises(ValueError, match="mass_kg must be positive"):
        check_coupling(CouplingParameters(), HeldHandle(bad, 5, 1e-4, 0.1), PERIOD)
    with pytest.raises(ValueError, match="inertia_kgm2 must be positive"):
        check_coupling(CouplingParameters(), HeldHandle(0.1, 5, bad, 0.1), PERIOD)
