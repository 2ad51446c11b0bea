"""Runs a scene's recorded motion through other libraries."""

from __future__ import annotations

import copy
import importlib
from dataclasses import dataclass, replace
from importlib.metadata import PackageNotFoundError, version

from drake_haptics.analysis.held_scene import build_without_scene_warnings
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.progress import Progress, ignore_progress
from drake_haptics.evaluation.accuracy.figures import AccuracyStudy, PeerRow
from drake_haptics.evaluation.accuracy.knobs import make_reference
from drake_haptics.evaluation.accuracy.peers.problem import (
    Answer,
    PeerProblem,
    make_peer_problem,
)
from drake_haptics.evaluation.accuracy.recorded_motion import (
    RecordedMotion,
    record_motion,
)
from drake_haptics.evaluation.accuracy.truth import (
    Truth,
    compare,
    find_truth,
    shift_wrench,
)
from drake_haptics.evaluation.measuring.timing import TickTimes
from drake_haptics.scene.schema import Effects, Scene

_SAME_LAW = "of the same pieces, this package's law"


@dataclass(frozen=True)
class PeerMethod:
    """One method of another library.

    Attributes:
        library: Name of the library; that of its package is the same in lower case.
        module: Module of this folder that has the `function`, an `Answer`.
        words: Description of the query, for the report.
        for_pieces: Whether it equals another method if the tool is one piece.
    """

    library: str
    module: str
    function: str
    words: str
    for_pieces: bool = False

    def load(self) -> Answer:
        """Returns the function.

        Raises:
            ImportError: The library is not installed.
        """
        path = f"drake_haptics.evaluation.accuracy.peers.{self.module}"
        return getattr(importlib.import_module(path), self.function)


# fmt: off
METHODS = (
    PeerMethod("coal", "with_native", "answer_with_coal",
               f"signed distances {_SAME_LAW}"),
    PeerMethod("MuJoCo", "with_native", "answer_with_mujoco",
               f"mj_collision {_SAME_LAW}"),
    PeerMethod("Drake", "with_drake", "answer_by_distances",
               f"signed distances {_SAME_LAW}"),
    PeerMethod("Drake", "with_drake", "answer_on_pieces",
               "point contact of the same pieces, without a tolerance"),
    PeerMethod("Drake", "with_drake", "answer_on_meshes",
               "point contact of meshes as it takes them: convex hulls"),
    PeerMethod("Drake", "with_drake", "answer_with_hull",
               "hydroelastic without a tolerance: tool's hull compliant, objects"
               " rigid"),
    PeerMethod("Drake", "with_drake", "answer_with_pieces",
               "hydroelastic without a tolerance: tool's pieces compliant, objects"
               " rigid", for_pieces=True),
)
# fmt: on


def run_peers(
    scene: Scene,
    motion: RecordedMotion,
    truth: Truth,
    *,
    progress: Progress = ignore_progress,
) -> tuple[PeerRow, ...]:
    """Compares other libraries' contact wrenches with the truth.

    At each tick the tool has its recorded pose and velocity; objects rest. All have the
    scene's stiffness and damping and no friction. Effects are left out, also of the
    truth. Times are those inside the library: in C++ around its query (without this
    package's law), in Python around the one call to Drake. The time of a tick is the
    mean of the middle half of several passes.

    Returns:
        A row for each of `METHODS`, with the reason if a library is absent or fails.
    """
    if scene.effects != Effects():
        progress("finding the truth without effects", 0.0)
        scene = _leave_out_effects(scene)
        truth = find_truth(make_reference(scene).apply(scene), motion)
    problem = make_peer_problem(build_without_scene_warnings(scene), motion, truth)
    rows = []
    for done, method in enumerate(METHODS):
        progress(f"{method.library}: {method.words}", done / len(METHODS))
        rows.append(run_peer(method, problem, truth))
    return tuple(rows)


def run_peer(method: PeerMethod, problem: PeerProblem, truth: Truth) -> PeerRow:
    """Returns the row of one method; see `run_peers`."""
    if method.for_pieces and len(problem.tool.pieces) == 1:
        return _explain(method.library, method, "the tool is one piece: its hull")
    package = method.library.lower()
    try:
        library = f"{method.library} {version(package)}"
        answers = method.load()(problem)
    except PackageNotFoundError:
        return _explain(method.library, method, f"{package} is not installed")
    except (ImportError, HapticsError, RuntimeError, ValueError) as error:
        return _explain(library, method, str(error))
    remark = f", {answers.remark}" if answers.remark else ""
    F_Tcm_W = shift_wrench(answers.F_To_W, problem.motion.X_WT, truth.p_TTcm)
    return PeerRow(
        library=library,
        method=method.words + remark,
        native=TickTimes.of(answers.seconds),
        errors=compare(F_Tcm_W, answers.distance, answers.tolerance_m, truth),
    )


def _leave_out_effects(scene: Scene) -> Scene:
    bare = copy.deepcopy(scene)
    bare.effects = Effects()
    for item in bare.environment:
        item.material.friction_coefficient = item.material.shading = None
    return bare


def _explain(library: str, method: PeerMethod, failure_reason: str) -> PeerRow:
    return PeerRow(library, method.words, None, None, failure_reason)


def add_peers(
    study: AccuracyStudy, scene: Scene, *, progress: Progress = ignore_progress
) -> AccuracyStudy:
    """Returns a study with a row for each method of another library.

    Raises:
        RunError: The scene diverges.
    """
    motion = record_motion(scene, study.ticks / scene.device.rate_hz)
    truth = find_truth(study.reference.apply(scene), motion)
    return replace(study, peers=run_peers(scene, motion, truth, progress=progress))
