"""Represents a study: the cost and the error of each setting of a scene."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.report.plain_data import name_number, read_figures, to_plain_data

_Figures = TypeVar("_Figures")

# Smaller errors cannot be felt and count as equal.
ERROR_FLOOR_N = 1e-3
# Reason for an unknown stiffness that was not requested.
NOT_SOUGHT = "not sought"


@dataclass(frozen=True)
class Cost:
    """The time that a setting takes.

    Attributes:
        tick: Whole ticks of the loop, paced by the clock.
        native: The contacts' part inside the core: query, clusters, wrench.
        instructions: Mean per tick of that part; None if not counted.
    """

    tick: TickTimes
    native: TickTimes
    instructions: float | None = None


@dataclass(frozen=True)
class Errors:
    """Errors of a setting against the reference, over a recorded motion of the tool.

    Forces, in N, and torques at the tool's center of mass, in N·m, are differences:
    root mean square and largest.

    Attributes:
        depth_max_m: Largest difference of the deepest contact's distance from the exact
            one, m.
        normal_jump_deg: Largest turn of the force's direction from one tick to the
            next, beyond the reference's own, degrees.
        energy_created_J: Energy that the loop created while it ran, J; NaN without a
            run.
        stable_stiffness_N_per_m: Largest stable stiffness of the coupling against this
            contact, N/m; None if it is not known, infinite if there is no limit.
        stiffness_why_not: Reason why it is not known, empty otherwise.
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
    """The cost and error of one setting; None if they could not be measured.

    Pieces are convex pieces of the tool and of all objects. The unchanged scene is also
    a setting.
    """

    setting: Setting
    is_scene: bool
    cost: Cost | None
    errors: Errors | None
    pieces: tuple[int, int] = (0, 0)
    failure_reason: str = ""

    @property
    def is_measured(self) -> bool:
        """Whether cost and errors are known."""
        return self.cost is not None and self.errors is not None

    @property
    def native_us(self) -> float:
        """Median time inside the core, µs."""
        return self._require(self.cost).native.median_us

    @property
    def tick_us(self) -> float:
        """Median time of the whole tick, µs."""
        return self._require(self.cost).tick.median_us

    @property
    def force_error_N(self) -> float:
        """Force error, root mean square, at least `ERROR_FLOOR_N`, N."""
        return max(self._require(self.errors).force_rms_N, ERROR_FLOOR_N)

    def _require(self, figures: _Figures | None) -> _Figures:
        if figures is None:
            reason = self.failure_reason
            raise ValueError(f"{self.setting.label} was not measured: {reason}")
        return figures


@dataclass(frozen=True)
class PeerRow:
    """Another library's contact wrench on the same motion.

    Figures are None if they could not be measured. Times are those inside the library
    per tick; errors lack energy and stiffness (NaN, None).
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
        machine: Machine of the times; see `describe_machine`.
        ticks: Ticks of the recorded motion, of which `contact_ticks` have a contact.
        reference: Setting with which wrenches are compared, the finest exact one.
        rows: Rows of each knob, its settings in order; the scene as it is first.
        peers: Rows of other libraries on the same motion.
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

    def to_json_data(self) -> dict[str, Any]:
        """Returns the study as data for `json.dumps(allow_nan=False)`.

        Infinite numbers are the text "infinite", NaN is "none", and figures that were
        not sought are null.
        """
        return to_plain_data(self, name_number)

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> AccuracyStudy:
        """Returns the study from the data of `to_json_data`."""
        return read_figures(AccuracyStudy, data)
