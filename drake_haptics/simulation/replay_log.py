"""Runs a recorded motion through a scene again."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from pydrake.common.yaml import yaml_load_data, yaml_load_typed
from pydrake.systems.framework import Context, EventStatus

from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.loop.device_placement import find_device_site
from drake_haptics.loop.outputs import make_log_header
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import check_values
from drake_haptics.scene.yaml_loading import check_keys
from drake_haptics.simulation.run import make_simulator
from drake_haptics.systems.device.haptic_device import HapticDevice
from drake_haptics.systems.device.replayed_handle import ReplayedHandle
from drake_haptics.tick_log.log_format import TickLogError
from drake_haptics.tick_log.tick_log import TickLog, read_tick_log
from drake_haptics.tick_log.tick_recorder import TickRecorder

_TICKS_PER_REPORT = 256


def load_log_scene(log: TickLog) -> Scene:
    """Returns the scene that a log was recorded in.

    Raises:
        TickLogError: This program cannot read it.
    """
    try:
        check_keys(Scene, yaml_load_data(log.header.scene))
        scene: Scene = yaml_load_typed(schema=Scene, data=log.header.scene)
        check_values(scene)
    except Exception as error:  # Drake passes on whatever its YAML parser raises.
        raise TickLogError(
            f"the scene in the log, of drake_haptics {log.header.program_version},"
            f" cannot be used: {error}; name a scene file to replay into"
        ) from error
    return scene


def replay(
    log: TickLog,
    scene: Scene | None = None,
    *,
    out: str | os.PathLike[str] | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> TickLog:
    """Moves the handle as recorded, and computes everything else again.

    The tool starts as in the log. In the scene of the log, the same program computes
    the same values bit for bit, up to the first gap of the log. In a scene with another
    rate the handle is held between the ticks of the log.

    Args:
        log: Return value of `read_tick_log`.
        scene: Scene to run. Defaults to the log's.
        out: File for the log of this run. Defaults to a temporary one.
        progress: Function that is called with the current work and the share done, from
            0 to 1.

    Returns:
        The log of this run.

    Raises:
        TickLogError: The log has no first tick or no usable scene, a pose has no unit
            quaternion, or a value is no longer finite.
        SceneError: The scene is invalid.
        MeshError: A mesh cannot be used.
        OSError: A file cannot be read or written.
    """
    if out is None:
        with tempfile.TemporaryDirectory() as folder:
            return replay(log, scene, out=Path(folder) / "log", progress=progress)
    log.check_replayable()
    if scene is None:
        scene = load_log_scene(log)
    with TickRecorder(out, make_log_header(scene)) as recorder:
        _run(log, log.count_ticks_from_start(), scene, recorder, progress)
    return read_tick_log(out)


def _run(
    log: TickLog,
    ticks: int,
    scene: Scene,
    recorder: TickRecorder,
    progress: Callable[[str, float], None] | None,
) -> None:
    """Runs the scene at the log's handle for a number of the log's ticks."""
    rows, period_s = log.rows, log.header.period_s
    site = find_device_site(scene)
    device = HapticDevice(
        ReplayedHandle(rows["X_WH"][:ticks], rows["V_WH"][:ticks], period_s),
        period_s=1.0 / scene.device.rate_hz,
        max_force_N=site.max_force_N,
        max_torque_Nm=site.max_torque_Nm,
    )

    def report_cut(name: str, share: float) -> None:
        if progress is not None:
            progress(f"Cutting {name} into convex pieces", share)

    # The tick times of the recorded run do not matter here.
    unhurried = replace(scene, device=replace(scene.device, tick_budget_us=None))
    haptic = BuildHapticDiagram(
        unhurried, device=device, recorder=recorder, progress=report_cut
    )
    simulator = make_simulator(haptic)
    tool = haptic.loop.haptic_tool.GetMyMutableContextFromRoot(
        simulator.get_mutable_context()
    )
    tool.SetDiscreteState(0, np.concatenate([rows["X_WT"][0], rows["V_WT"][0]]))
    end_s = ticks * period_s

    def end_tick(context: Context) -> EventStatus:
        # A tool whose pose is not finite has no contacts.
        if not math.isfinite(sum(tool.get_discrete_state(0).value().tolist())):
            raise TickLogError(
                f"stopped at {context.get_time():.4f} s: the tool's state is not"
                " finite; the scene is unstable under this motion"
            )
        if progress is not None and recorder.ticks % _TICKS_PER_REPORT == 0:
            progress("Replaying", context.get_time() / end_s)
        return EventStatus.Succeeded()

    simulator.set_monitor(end_tick)
    simulator.Initialize()
    simulator.AdvanceTo(end_s)
