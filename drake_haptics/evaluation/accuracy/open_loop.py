"""How far a setting's answers to a recorded motion are from the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.accuracy.tool_replay import replay_tool
from drake_haptics.evaluation.accuracy.truth import Truth, shift_wrench
from drake_haptics.scene.schema import Scene

# A force below this share of the reference's largest has no direction to speak of.
_FIRM_SHARE = 0.1


@dataclass(frozen=True)
class OpenLoopErrors:
    """Errors on the recorded motion, each as `figures.Errors` says.

    Attributes:
        force_rms_N: N.
        force_max_N: N.
        torque_rms_Nm: N·m, at the tool's center of mass.
        torque_max_Nm: N·m.
        depth_max_m: m.
        normal_jump_deg: Degrees.
    """

    force_rms_N: float
    force_max_N: float
    torque_rms_Nm: float
    torque_max_Nm: float
    depth_max_m: float
    normal_jump_deg: float


def measure_open_loop(
    scene: Scene, motion: RecordedMotion, truth: Truth
) -> OpenLoopErrors:
    """Replays a motion in a scene and compares its answers with the truth."""
    replay = replay_tool(scene, motion)
    F_Tcm_W = shift_wrench(replay.F_Tool_W, motion.X_WTool, truth.p_TTcm)
    return compare(F_Tcm_W, replay.distance, scene.contact.tolerance_m, truth)


def compare(
    F_Tcm_W: np.ndarray, distance: np.ndarray, tolerance_m: float, truth: Truth
) -> OpenLoopErrors:
    """Compares the answers of anything with the truth.

    Args:
        F_Tcm_W: (n, 6) wrench [τ; f] at the truth's center of mass, N·m and N.
        distance: (n,) of the deepest contact, m; infinite where there is none.
        tolerance_m: How far contacts were looked for, m. Depths are compared up to
            where both look.
        truth: At the same n ticks.
    """
    error = np.linalg.norm((F_Tcm_W - truth.F_Tcm_W).reshape(-1, 2, 3), axis=2)
    rms, largest = np.sqrt((error**2).mean(axis=0)), error.max(axis=0)
    cap_m = min(tolerance_m, truth.tolerance_m)
    depth = np.minimum(distance, cap_m) - np.minimum(truth.distance, cap_m)
    firm_N = _FIRM_SHARE * float(np.linalg.norm(truth.F_Tcm_W[:, 3:], axis=1).max())
    turn = _calc_turns(F_Tcm_W[:, 3:], firm_N)
    expected = _calc_turns(truth.F_Tcm_W[:, 3:], firm_N)
    return OpenLoopErrors(
        force_rms_N=float(rms[1]),
        force_max_N=float(largest[1]),
        torque_rms_Nm=float(rms[0]),
        torque_max_Nm=float(largest[0]),
        depth_max_m=float(np.abs(depth).max()),
        normal_jump_deg=float(np.rad2deg((turn - expected).max(initial=0.0))),
    )


def _calc_turns(force: np.ndarray, firm_N: float) -> np.ndarray:
    """Returns (n - 1,) how far forces turn from a tick to the next, rad.

    Zero where one of the two is not firm.
    """
    before, after = force[:-1], force[1:]
    # Sine and cosine together are exact for small turns as for large ones.
    sine = np.linalg.norm(np.cross(before, after), axis=1)
    turn = np.arctan2(sine, np.einsum("ni,ni->n", before, after))
    size = np.linalg.norm(force, axis=1)
    firm = (np.minimum(size[:-1], size[1:]) > firm_N) & (firm_N > 0.0)
    return np.where(firm, turn, 0.0)
