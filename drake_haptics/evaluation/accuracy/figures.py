"""Holds the price list: the cost and the error of each setting of a scene."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.report.plain_data import (
    name_number,
    read_figures,
    to_plain_data,
)

# Why a stiffness is not known that nobody asked for.
NOT_SOUGHT = "not sought"


@dataclass(frozen=True)
class Cost:
    """The time that a setting costs.

    Attributes:
        tick: Whole ticks of the loop, paced by the clock.
        native: The contacts' part inside the core: query, clusters, wrench.
        instructions: Of that part, mean per tick; None where they were not counted.
    """

    tick: TickTimes
    native: TickTimes
    instructions: float | None = None


@dataclass(frozen=True)
class Errors:
    """Errors of a setting against the truth, over a recorded motion of the tool.

    Attributes:
        force_rms_N: Root mean square of the force's difference from the reference
            setting's, N.
        force_max_N: The largest, N.
        torque_rms_Nm: The same of the torque at the tool's center of mass, N·m.
        torque_max_Nm: The largest, N·m.
        depth_max_m: Largest difference of the deepest contact's distance from the
            exact one, m.
        normal_jump_deg: Largest turn of the force's direction from one tick to the
            next, beyond the reference's own, degrees.
        energy_created_J: What the loop made of nothing while it ran, J; NaN where no
            loop was run.
        stable_stiffness_N_per_m: Largest stable stiffness of the coupling against
            this contact, N/m; None where it is not known, infinite where there is no
            limit.
        stiffness_why_not: Why it is not known, empty otherwise.
    """

    force_rms_N: float
    force_max_N: float
    torque_rms_Nm: float
    torque_max_Nm: float
    depth_max_m: float
    normal_jump_deg: float
    energy_created_J: float = math.nan
    stable_stiffness_N_per_m: float | None = None
    stiffness_why_not: str = ""


@dataclass(frozen=True)
class Row:
    """One setting's price and error.

    Attributes:
        setting: What was set.
        is_scene: Whether this is the scene as it is.
        cost: What it takes; None where it could not be measured.
        errors: How wrong it is; None where it could not be measured.
        pieces: Convex pieces of the tool and of all objects.
        failure_reason: Why it could not be measured, empty otherwise.
    """

    setting: Setting
    is_scene: bool
    cost: Cost | None
    errors: Errors | None
    pieces: tuple[int, int] = (0, 0)
    failure_reason: str = ""


@dataclass(frozen=True)
class PeerRow:
    """Another way to the contact wrench, on the same motion.

    Attributes:
        library: Its name and version.
        method: What it was asked for, in words.
        native: Time inside the library per tick.
        errors: As for ours; without energy and stiffness (NaN, None).
        failure_reason: Why there are no figures, empty otherwise.
    """

    library: str
    method: str
    native: TickTimes | None
    errors: Errors | None
    failure_reason: str = ""


@dataclass(frozen=True)
class AccuracyStudy:
    """All rows of a scene.

    Attributes:
        scene: Its name.
        description: Its sentence.
        machine: See `drake_haptics.evaluation.measuring.timing.describe_machine`.
        ticks: Of the recorded motion.
        contact_ticks: Those of them with a contact.
        reference: What the wrench is compared with: the finest exact setting.
        rows: Of each knob, its settings in order; the scene as it is first.
        peers: Other libraries on the same motion, those that are installed.
    """

    scene: str
    description: str
    machine: Mapping[str, str | int]
    ticks: int
    contact_ticks: int
    reference: Setting
    rows: tuple[Row, ...]
    peers: tuple[PeerRow, ...] = ()

    def __repr__(self) -> str:
        return (
            f"AccuracyStudy({self.scene!r}, {len(self.rows)} settings and "
            f"{len(self.peers)} peers over {self.ticks} ticks, {self.contact_ticks} in "
            f"contact)"
        )

    def to_dict(self) -> dict[str, Any]:
        """Returns the study as plain data."""
        return asdict(self)

    def to_json_data(self) -> dict[str, Any]:
        """Returns the study as what `json.dumps(allow_nan=False)` takes.

        Infinite numbers are the text "infinite", and NaN is "none"; a null is a figure
        that was not sought.
        """
        data: dict[str, Any] = to_plain_data(self, name_number)
        return data

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> AccuracyStudy:
        """Returns the study that `to_dict` or `to_json_data` made data of."""
        return read_figures(AccuracyStudy, data)
