"""Held scenes and their analysis, for several tests; made once."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from drake_haptics import find_scene, load_scene
from drake_haptics.analysis.felt_impedance import calc_felt_impedance
from drake_haptics.analysis.held_loop import analyze_held_scene
from drake_haptics.analysis.held_scene import HeldScene, hold_scene
from drake_haptics.analysis.modes import find_modes
from drake_haptics.analysis.passivity import calc_passivity
from drake_haptics.analysis.scene_stability import SceneStability
from drake_haptics.analysis.stiffness_limits import StiffnessLimits
from drake_haptics.bounds.held_handle import calc_scene_handle


@cache
def load_held(name: str) -> HeldScene:
    """Returns a shipped scene at its firmest contact."""
    return hold_scene(load_scene(find_scene(name)))


def hold_with_grip(held: HeldScene, grip: str) -> HeldScene:
    """Returns a held scene whose device another hand holds."""
    scene = held.scene
    return replace(held, scene=replace(scene, hand=replace(scene.hand, grip=grip)))


def make_limits(eigenvalue: float, against: str = "a rigid wall") -> StiffnessLimits:
    """Returns limits of the translation with one figure of one's choice."""
    return StiffnessLimits(
        kind="translation",
        against=against,  # type: ignore[arg-type]
        stiffness=800.0,
        damping=2.0,
        eigenvalue=eigenvalue,
        simulated=eigenvalue if 0.0 < eigenvalue < np.inf else np.nan,
        one_axis=15863.0,
        formula=15748.0,
        limited_by="56.1 Hz; mostly elbow_joint_w",
    )


def skip_search(held, kind, against, progress) -> StiffnessLimits:
    """Takes the place of `find_stiffness_limits`, which takes ten seconds for each."""
    return replace(make_limits(2e4, against), kind=kind)


@cache
def analyze_sample() -> SceneStability:
    """Returns the analysis of a true loop, with limits that were not searched."""
    held = load_held("hammer_block")
    loop = analyze_held_scene(held)
    felt = calc_felt_impedance(loop)
    passivity = calc_passivity(felt, felt.period_s)
    return SceneStability(
        scene=held.scene,
        time_s=held.time_s,
        handle=calc_scene_handle(held.scene, loop.haptic.loop.device, loop.context),
        num_contacts=4,
        contact_force_N=3.07,
        growth=loop.growth,
        linearization=loop.linearization,
        modes=find_modes(loop.linearization),
        delay_margin_s=0.0123,
        limits=(make_limits(249070.0, "this contact"), make_limits(16744.0)),
        felt=passivity,
        damping_usage=passivity.calc_usage(felt.handle_damping),
        broken_bounds=(),
        map=None,
    )
