"""Repeats the paper's evaluation, all of it or some parts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal, get_args

from drake_haptics.common.progress import Progress, ignore_progress
from drake_haptics.evaluation.measuring.timing import describe_machine
from drake_haptics.evaluation.models import check_folder
from drake_haptics.evaluation.paper.depth_cost import DepthCosts, measure_depth_costs
from drake_haptics.evaluation.paper.pen_pass import PenPass, measure_pen_pass
from drake_haptics.evaluation.paper.profile import Profile, measure_profile, sum_up
from drake_haptics.evaluation.paper.scaling import (
    ForceScaling,
    PairScaling,
    measure_force_scaling,
    measure_pair_scaling,
)
from drake_haptics.evaluation.paper.scenarios import scenario_makers
from drake_haptics.evaluation.paper.table1 import ModelFigures, measure_table1

Part = Literal["table1", "figure11", "figure12", "analysis"]
PARTS: tuple[Part, ...] = get_args(Part)

# Approximate relative durations of the parts, for progress.
_WEIGHTS = {"table1": 1.0, "figure11": 6.0, "figure12": 1.0, "analysis": 3.0}
_FINE_DIVISIONS = 5


@dataclass(frozen=True)
class Effort:
    """The extent of a measurement; None runs the whole paths of Figure 11."""

    profile_s: float | None = None
    pen_s: float = 3.0
    presses: int = 20
    slide_ticks: int = 1000
    force_repeats: int = 1000
    instructions: bool = True


QUICK = Effort(
    profile_s=1.0,
    pen_s=1.0,
    presses=2,
    slide_ticks=100,
    force_repeats=50,
    instructions=False,
)


@dataclass(frozen=True)
class Analysis:
    """The figures of section 6.3, with forces for each kind of clustering."""

    depths: DepthCosts
    pairs: PairScaling
    forces: tuple[ForceScaling, ...]


@dataclass(frozen=True)
class PaperEvaluation:
    """All figures; empty or None for parts that were not requested.

    The machine is that of `describe_machine`. Runs like the paper's come first. The pen
    passes over a coarse and a fine sphere. If it is cut short, only the beginnings of
    Figure 11's paths were run.
    """

    machine: dict[str, str | int]
    table1: tuple[ModelFigures, ...] = ()
    figure11: tuple[Profile, ...] = ()
    figure12: tuple[PenPass, ...] = ()
    analysis: Analysis | None = None
    is_cut_short: bool = False

    def to_dict(self) -> dict[str, Any]:
        """Returns the figures, without the curves, ready for JSON."""
        analysis = None
        if self.analysis is not None:
            depths = self.analysis.depths.to_dict()
            analysis = {**asdict(self.analysis), "depths": depths}
        return {
            "machine": self.machine,
            "is_cut_short": self.is_cut_short,
            "table1": [asdict(row) for row in self.table1],
            "figure11": [sum_up(profile).to_dict() for profile in self.figure11],
            "figure12": [passed.to_dict() for passed in self.figure12],
            "analysis": analysis,
        }


def evaluate_paper(
    parts: Sequence[Part] = PARTS,
    effort: Effort | None = None,
    meshes: Path | None = None,
    progress: Progress = ignore_progress,
) -> PaperEvaluation:
    """Repeats parts of the paper's evaluation on this machine.

    Any of the real meshes in the folder (see `MODELS`) may be missing.

    Raises:
        HapticsError: The folder has none of them.
    """
    check_folder(meshes)
    effort = effort or Effort()
    chosen = [part for part in PARTS if part in parts]
    whole = sum(_WEIGHTS[part] for part in chosen)
    found: dict[Part, Any] = {}
    done = 0.0
    for part in chosen:

        def show(
            what: str, share: float, part: Part = part, done: float = done
        ) -> None:
            progress(f"{part}: {what}", (done + share * _WEIGHTS[part]) / whole)

        found[part] = _MEASURE[part](effort, meshes, show)
        done += _WEIGHTS[part]
    is_cut_short = "figure11" in found and effort.profile_s is not None
    return PaperEvaluation(describe_machine(), is_cut_short=is_cut_short, **found)


def _measure_figure11(
    effort: Effort, meshes: Path | None, show: Progress
) -> tuple[Profile, ...]:
    makers = scenario_makers(meshes)
    profiles = []
    for k, (name, make) in enumerate(makers.items()):
        show(name, k / len(makers))
        profiles.append(measure_profile(make(), effort.profile_s))
    return tuple(profiles)


def _measure_figure12(
    effort: Effort, meshes: Path | None, show: Progress
) -> tuple[PenPass, ...]:
    show("a pen on a sphere", 0.0)
    coarse = measure_pen_pass(seconds=effort.pen_s)
    show("a pen on a fine sphere", 0.5)
    return coarse, measure_pen_pass(_FINE_DIVISIONS, effort.pen_s)


def _measure_analysis(effort: Effort, meshes: Path | None, show: Progress) -> Analysis:
    depths = measure_depth_costs(
        effort.presses, effort.instructions, lambda what, share: show(what, 0.8 * share)
    )
    show("pairs that penetrate", 0.8)
    pairs = measure_pair_scaling(effort.slide_ticks)
    show("forces", 0.9)
    return Analysis(depths, pairs, measure_force_scaling(effort.force_repeats))


_MEASURE: dict[Part, Callable[[Effort, Path | None, Progress], Any]] = {
    "table1": lambda _, meshes, show: measure_table1(meshes, show),
    "figure11": _measure_figure11,
    "figure12": _measure_figure12,
    "analysis": _measure_analysis,
}
