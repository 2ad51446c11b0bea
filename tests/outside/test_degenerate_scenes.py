"""Ten scenes of degenerate contact: no overlap, no jam, no energy.

Source: K. Erleben, "Methodology for assessing mesh-based contact point methods", ACM
Transactions on Graphics 37(3), 2018. The shapes are made in `degenerate_scenes`; truth
is the enumerated Minkowski difference of the posed shapes, and the trapezoidal rule.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from degenerate_scenes import (
    MASS_KG,
    PERIOD_S,
    SCENES,
    SPEED_M_PER_S,
    DegenerateScene,
    Run,
    exact_distances,
    run_scene,
)

from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    DeviceParameters,
)

LARGEST_FORCE_N = load_device_preset(DeviceParameters().preset).max_force_N
# Far below what can be felt, far above what the rule leaves of a smooth force.
ROUNDING_J = 2e-6
LOOK_EVERY = 40  # ticks between two looks at the truth, which is slow
SLIDES = ["sliding spike", "sliding wedge", "internal edges"]
BLOCKS = "internal edges, each block an object"


def calc_spring_distance(contact: ContactParameters, case: DegenerateScene) -> float:
    """Where one spring holds the largest force, less a blow of the tool's mass, m."""
    k = contact.stiffness_N_per_m
    blow_m = SPEED_M_PER_S * np.sqrt(MASS_KG / k)
    return contact.tolerance_m - LARGEST_FORCE_N / (k * case.least_rise) - blow_m


@dataclass(frozen=True)
class Law:
    """A law of contact, and what it may do.

    Attributes:
        contact: Its parameters.
        calc_least_distance: Returns how near tool and solid may come in a scene, m.
        made_J: Energy that it is known to make, by the name of the scene, J: of
            `penalty` flush faces store less than they give, of
            `constraint` the force of a tick is that of its beginning where a spike
            slips off. What was measured, and a tenth.
        bump: Largest force against a slide from one object to the next, whose faces
            are flush, as a share of the press; 0 were it not felt.
    """

    contact: ContactParameters
    calc_least_distance: Callable[[ContactParameters, DegenerateScene], float]
    made_J: Mapping[str, float] = field(default_factory=dict)
    bump: float = 1e-9


LAWS = {
    "penalty": Law(
        ContactParameters(),
        calc_spring_distance,
        {"spike on the ridge of a wedge": 1.34e-4, BLOCKS: 1.52e-5},
        # Objects do not know of each other: an edge between two is felt as round.
        bump=0.057,
    ),
    "constraint": Law(
        ContactParameters(law="constraint", skin_m=3e-4),
        # The shapes turn while they move: what a turn takes of the skin is of second
        # order, 10 µm at most (tests/core/constraint).
        lambda contact, case: contact.skin_m - 1e-5,
        {"spikes, tip on tip": 2.4e-5, "spike on the ridge of a wedge": 1.9e-5},
        bump=1.4e-3,
    ),
}


@cache
def run_once(law: str, scene: str) -> Run:
    """The run of a scene under a law, which several tests look at."""
    with TemporaryDirectory() as folder:
        return run_scene(SCENES[scene], LAWS[law].contact, Path(folder))


laws = pytest.mark.parametrize("law", LAWS)
scenes = pytest.mark.parametrize("scene", SCENES)


@laws
@scenes
def test_shapes_do_not_overlap(law: str, scene: str) -> None:
    case, contact = SCENES[scene], LAWS[law].contact
    least_m = LAWS[law].calc_least_distance(contact, case)
    assert least_m >= 0
    X_WT = run_once(law, scene).X_WT[::LOOK_EVERY]
    distances = np.array(list(exact_distances(case, X_WT)))
    assert distances.min() > least_m
    assert distances[0] > contact.tolerance_m


@laws
@scenes
def test_contact_is_felt_and_lets_go(law: str, scene: str) -> None:
    shown = run_once(law, scene)
    felt_N = np.linalg.norm(shown.F_Ho_W[:, 3:], axis=1)
    assert felt_N.max() > 1.0
    assert not shown.F_To_W[-1].any()
    away_m = np.linalg.norm(shown.X_WT[-1, 4:] - shown.X_WH[-1, 4:])
    turned = np.linalg.norm(shown.X_WT[-1, 1:4] - shown.X_WH[-1, 1:4])
    assert away_m < 2e-5 and turned < 1e-5


@laws
@pytest.mark.parametrize("scene", [*SLIDES, BLOCKS])
def test_a_slide_goes_on_with_the_handle(law: str, scene: str) -> None:
    """No edge holds the tool: it is never farther behind than its own mass explains."""
    shown = run_once(law, scene)
    behind_m = np.abs(shown.X_WT[:, 4] - shown.X_WH[:, 4])
    K = CouplingParameters().stiffness_N_per_m
    assert behind_m.max() < 1.1 * SPEED_M_PER_S * np.sqrt(MASS_KG / K)


@laws
@pytest.mark.parametrize("scene", [*SLIDES, BLOCKS])
def test_a_slide_is_not_held_back(law: str, scene: str) -> None:
    shown = run_once(law, scene)
    (slides,) = np.nonzero(np.diff(shown.X_WH[:, 4]) > 0)
    assert len(slides) > 0.3 / PERIOD_S
    # Where it begins the tool still swings.
    F_W = shown.F_To_W[slides[len(slides) // 2 :], 3:]
    share = np.abs(F_W[:, 0]).max() / F_W[:, 2].mean()
    assert share < (LAWS[law].bump if scene == BLOCKS else 1e-6)


@laws
@scenes
def test_contact_makes_no_energy(law: str, scene: str) -> None:
    """It begins with none, so at no time may it have given any."""
    work_J = run_once(law, scene).work_J
    assert work_J.min() < -2e-5
    assert work_J.max() < LAWS[law].made_J.get(scene, ROUNDING_J)


def test_a_spring_that_is_too_soft_is_seen_to_let_shapes_overlap(
    tmp_path: Path,
) -> None:
    case = SCENES["sliding wedge"]
    soft = ContactParameters(stiffness_N_per_m=1e3)
    assert calc_spring_distance(soft, case) < 0
    X_WT = run_scene(case, soft, tmp_path).X_WT[::LOOK_EVERY]
    assert min(exact_distances(case, X_WT)) < -5e-4
