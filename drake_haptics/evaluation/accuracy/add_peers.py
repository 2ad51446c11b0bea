"""Puts other libraries beside the settings of a study."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from drake_haptics.evaluation.accuracy.figures import AccuracyStudy
from drake_haptics.evaluation.accuracy.peers.run import run_peers
from drake_haptics.evaluation.accuracy.recorded_motion import record_motion
from drake_haptics.evaluation.accuracy.truth import find_truth
from drake_haptics.scene.schema import Scene


def add_peers(
    study: AccuracyStudy,
    scene: Scene,
    *,
    progress: Callable[[str, float], None] | None = None,
) -> AccuracyStudy:
    """Returns a study with a row for each way of another library.

    Args:
        study: Of the scene.
        scene: Whose motion is recorded again, which is the same again.
        progress: Called with what is done now and the share of all, in [0, 1].

    Raises:
        RunError: The scene diverges.
        KeyboardInterrupt: At Ctrl-C.
    """
    motion = record_motion(scene, study.ticks / scene.device.rate_hz)
    truth = find_truth(study.reference.apply(scene), motion)
    return replace(study, peers=run_peers(scene, motion, truth, progress=progress))
