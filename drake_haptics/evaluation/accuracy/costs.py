"""Measures the tick times of a scene: whole, inside the core, or in a new process.

`python -m drake_haptics.evaluation.accuracy.costs FILE` is the new process.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, astuple
from pathlib import Path
from typing import cast

import numpy as np
from pydrake.systems.framework import Context

from drake_haptics.analysis.held_scene import build_without_scene_warnings
from drake_haptics.common.errors import HapticsError
from drake_haptics.common.pose_vector import pose_to_vector
from drake_haptics.common.real_time import RealTimePacer
from drake_haptics.evaluation.accuracy.native_part import ContactSearch, NativePart
from drake_haptics.evaluation.accuracy.recorded_motion import RecordedMotion
from drake_haptics.evaluation.measuring.timing import CallTimer, TickTimes, typical
from drake_haptics.loop.builder import HapticDiagram
from drake_haptics.loop.contact import find_contact_gains, find_query_tolerance
from drake_haptics.loop.simulated_device import make_hand_path
from drake_haptics.scene.scene_file import load_scene, write_scene
from drake_haptics.scene.schema import Scene
from drake_haptics.simulation.run import RunError, run
from drake_haptics.simulation.statistics import RunStatistics
from drake_haptics.systems.contact.contact_query import DepthSearch

# A diagram with Python systems is never freed, so keep it for the scene's next
# measurement.
_BUILT: dict[str, HapticDiagram] = {}
# Number of passes that time each tick, and latest start of a pass, s.
_PASSES = 3
_LONGEST_S = 1.0
# Distance at which nothing touches the tool, m.
_FAR_M = 1e3
# Duration of a turn of a scene, s.
_PART_S = 0.25
# Longest part of a lap, s.
_LONGEST_LAP_S = 5.0


def cached_build(scene: Scene) -> HapticDiagram:
    """Returns the diagram of a scene, the same one for the same scene.

    A run only changes its context, so that runs are independent. Changed mesh files are
    not read again.
    """
    key = repr(asdict(scene))  # complete, unlike a scene's repr
    if key not in _BUILT:
        _BUILT[key] = build_without_scene_warnings(scene)
    return _BUILT[key]


def time_in_turns(scenes: Sequence[Scene], duration_s: float) -> list[TickTimes]:
    """Runs scenes in real time, in turns of a quarter of a second; returns their times.

    Between ticks the processor rests and other programs use its caches, so that a tick
    takes longer than in a loop that never waits. Disturbances of the machine affect all
    scenes alike, so that the ratios of their times are reliable.

    Raises:
        RunError: A loop diverges.
    """
    loops = [cached_build(scene) for scene in scenes]
    paces = [RealTimePacer(loop.period_s) for loop in loops]
    done = [
        RunStatistics(loop.period_s, pace=pace)
        for loop, pace in zip(loops, paces, strict=True)
    ]
    turns = [
        _run_in_parts(*each, duration_s)
        for each in zip(loops, paces, done, strict=True)
    ]
    while turns:
        turns = [turn for turn in reversed(turns) if next(turn, None)]
    return [
        TickTimes(each.ticks, times.median, times.p99, times.p99_9)
        for each, times in ((each, each.tick_us) for each in done)
    ]


def _run_in_parts(
    haptic: HapticDiagram,
    pace: RealTimePacer,
    statistics: RunStatistics,
    duration_s: float,
) -> Iterator[bool]:
    """Runs a scene and yields True after each part but the last."""
    context: Context | None = None
    total = round(duration_s / haptic.period_s)

    def end_tick(root: Context) -> bool:
        nonlocal context
        # This tick is already counted.
        is_end = statistics.ticks in (total, part_end)
        if is_end:
            context = root.Clone()
        return is_end

    while statistics.ticks < total:
        part_end = statistics.ticks + round(_PART_S / haptic.period_s)
        pace.pause()
        run(haptic, pace=pace, on_tick=end_tick, context=context, statistics=statistics)
        if statistics.ticks < total:
            yield True


def scale_times(times: TickTimes, ours: TickTimes, other: TickTimes) -> TickTimes:
    """Returns others' times as if the machine had run ours as fast as in `times`.

    The speed of the machine is one factor, so that percentiles keep their order: the
    ratio of the medians, or of our lowest percentile that the clock resolves. If it
    resolves none, the others are unchanged.
    """
    shown = [
        (time_us, our_us)
        for time_us, our_us in zip(astuple(times)[1:], astuple(ours)[1:], strict=True)
        if our_us > 0.0
    ]
    time_us, our_us = shown[0] if shown else (1.0, 1.0)
    ratio = time_us / our_us
    return TickTimes(other.ticks, *(ratio * each for each in astuple(other)[1:]))


def combine(repeats: Sequence[TickTimes]) -> TickTimes:
    """Returns the median of each figure over several runs.

    The percentiles of each run include interruptions by the system, as for a user; the
    median drops a disturbed run.
    """
    ticks, *times_us = np.median([astuple(r) for r in repeats], axis=0).tolist()
    return TickTimes(int(ticks), *times_us)


def make_native_part(haptic: HapticDiagram) -> NativePart:
    """Returns the calls of a scene's systems to the core.

    Effects are not included; work that a loop may drop under load is.
    """
    scene, contact = haptic.scene, haptic.scene.contact
    items, query_hz = scene.environment, contact.query_rate_hz
    gains = find_contact_gains(contact, [item.material for item in items])
    return NativePart(
        tool=haptic.tool,
        objects=haptic.environment,
        X_WO=np.array(
            [pose_to_vector(item.pose.to_rigid_transform()) for item in items]
        ),
        search_m=find_query_tolerance(contact, scene.effects),
        depth=cast(DepthSearch, contact.depth),
        max_walk_steps=contact.max_walk_steps,
        query_every=None
        if query_hz is None
        else round(scene.device.rate_hz / query_hz),
        tolerance_m=contact.tolerance_m,
        cluster_size_m=contact.cluster_size_m,
        stiffness_N_per_m=gains.stiffness_N_per_m,
        damping_Ns_per_m=gains.damping_Ns_per_m,
    )


def time_native(parts: Sequence[tuple[NativePart, RecordedMotion]]) -> list[TickTimes]:
    """Times query, clusters and wrench of recorded motions, without Python, in turns.

    The time of a tick is the mean of the middle half of several passes, without
    disturbances.
    """
    passes: list[list[np.ndarray]] = [[] for _ in parts]
    begin_s = time.perf_counter()
    while len(passes[0]) < _PASSES and (
        time.perf_counter() < begin_s + len(parts) * _LONGEST_S
    ):
        for part, done in zip(parts, passes, strict=True):
            done.append(_time_pass(*part))
    return [TickTimes.of(np.maximum(typical(np.array(x)), 0.0)) for x in passes]


def _time_pass(part: NativePart, motion: RecordedMotion) -> np.ndarray:
    """Returns the times (n,) of the ticks of a motion, s.

    The query is timed inside the core; extrapolation, clusters and wrench are timed by
    the difference to a call without contacts.
    """
    far = np.array([1.0, 0.0, 0.0, 0.0, _FAR_M, 0.0, 0.0])
    nothing, _ = ContactSearch(part).look(far)
    none = part.make_clustering()(nothing)
    search = ContactSearch(part)
    carry = CallTimer(search.carry, (nothing, far))
    cluster = CallTimer(part.make_clustering(), (nothing,))
    force = CallTimer(part.make_force(), (none, far[4:], np.zeros(6)))
    seconds = np.zeros(len(motion))
    for tick, X_WT in enumerate(motion.X_WT):
        found, query_s = search.look(X_WT)
        contacts, carry_s = carry.call((found, X_WT))
        clusters, cluster_s = cluster.call((contacts,))
        _, force_s = force.call((clusters, X_WT[4:], motion.V_WT[tick]))
        seconds[tick] = query_s + carry_s + cluster_s + force_s
    return seconds


def measure_p99(scene: Scene) -> float:
    """Runs a scene in a new process and returns the 99th percentile of its ticks, µs.

    The process, its memory and its caches are new, as they are for a user who runs the
    scene. It runs one lap of the hand's path, at most 5 s of it.

    Raises:
        HapticsError: The scene cannot be built or diverges.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.yaml"
        write_scene(scene, file)
        done = subprocess.run(
            [sys.executable, "-m", __name__, str(file)],
            capture_output=True,
            text=True,
            check=False,
        )
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines()
        raise HapticsError(f"the scene does not run: {lines[-1] if lines else '?'}")
    return float(done.stdout)


def _main(file: str) -> None:
    scene = load_scene(file)
    lap_s = make_hand_path(scene.hand.path).duration_s
    try:
        (times,) = time_in_turns([scene], min(lap_s, _LONGEST_LAP_S))
    except (HapticsError, RunError) as error:
        sys.exit(str(error))
    print(repr(times.p99_us))


if __name__ == "__main__":
    _main(sys.argv[1])
