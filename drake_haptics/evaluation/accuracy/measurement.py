"""What is measured of one setting: the tasks of a study."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from subprocess import SubprocessError
from typing import Any

from drake_haptics.common.errors import UserError
from drake_haptics.evaluation.accuracy.built_scenes import build_once
from drake_haptics.evaluation.accuracy.closed_loop import (
    PressedPlace,
    StableStiffness,
    find_stable_stiffness,
    measure_created_energy,
)
from drake_haptics.evaluation.accuracy.figures import NOT_SOUGHT, Errors
from drake_haptics.evaluation.accuracy.instruction_count import count_native
from drake_haptics.evaluation.accuracy.native_cost import make_native_part, time_native
from drake_haptics.evaluation.accuracy.open_loop import measure_open_loop
from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.accuracy.setting import Setting
from drake_haptics.evaluation.accuracy.tick_cost import time_ticks
from drake_haptics.evaluation.accuracy.truth import Truth
from drake_haptics.scene.schema import Scene

# Under valgrind a tick takes fifty times as long; no more are needed, as counts do not
# scatter.
_COUNTED_TICKS = 500


@dataclass(frozen=True, eq=False)
class Measurement:
    """Measures one thing of a setting; for a `run_study`.

    Attributes:
        scene: As it is.
        motion: Of its tool.
        truth: On that motion.
        place: Where its hand stops to press, for the stable stiffness; None where that
            is not sought.
    """

    scene: Scene
    motion: RecordedMotion
    truth: Truth
    place: PressedPlace | None

    def __call__(self, task: dict[str, Any]) -> dict[str, Any]:
        """Returns what is asked for, or why it cannot be had.

        Args:
            task: `what` ("errors", "instructions", "native" or "ticks") and the
                `setting`; of times also the machine and the number of the repeat.
        """
        scene = Setting.from_dict(task["setting"]).apply(self.scene)
        measure = getattr(self, f"_measure_{task['what']}")
        try:
            result: dict[str, Any] = measure(scene)
        # Drake raises RuntimeError, as a run that diverges does.
        except (UserError, ValueError, RuntimeError, SubprocessError) as error:
            return {"why_not": str(error)}
        return result

    @property
    def duration_s(self) -> float:
        """Of the motion, s."""
        return len(self.motion) * self.motion.period_s

    def _measure_errors(self, scene: Scene) -> dict[str, Any]:
        haptic = build_once(scene)
        stiffness = StableStiffness(None, NOT_SOUGHT)
        if self.place is not None:
            stiffness = find_stable_stiffness(scene, self.place)
        errors = Errors(
            **asdict(measure_open_loop(scene, self.motion, self.truth)),
            energy_created_J=measure_created_energy(scene, self.duration_s),
            stable_stiffness_N_per_m=stiffness.stiffness_N_per_m,
            stiffness_why_not=stiffness.why_not,
        )
        num_objects = sum(len(part.pieces) for part in haptic.environment)
        pieces = [len(haptic.tool.pieces), num_objects]
        return {"errors": asdict(errors), "pieces": pieces}

    def _measure_ticks(self, scene: Scene) -> dict[str, Any]:
        return asdict(time_ticks(scene, self.duration_s))

    def _measure_instructions(self, scene: Scene) -> dict[str, Any]:
        haptic = build_once(scene)
        busiest = self.motion.cut(*self.truth.find_busiest(_COUNTED_TICKS))
        motion = busiest.sample(haptic.period_s)
        part = make_native_part(haptic)
        return {"instructions": count_native(part, motion.X_WTool, motion.V_WTool)}

    def _measure_native(self, scene: Scene) -> dict[str, Any]:
        haptic = build_once(scene)
        motion = self.motion.sample(haptic.period_s)
        return asdict(time_native(make_native_part(haptic), motion))
