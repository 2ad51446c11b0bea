"""The program whose instructions `effect_costs.py` counts.

python docs/generate/effect_child.py loop|core EFFECT NUMBER

`loop` runs the scene with one effect, or with `none`, for a while and counts as many
ticks more. `core` records the calls that one of its systems makes of the core in such
ticks, and counts so many repetitions of them. The EFFECT `forbidden` is `none` with
what belongs to effects taken away before the count: a touch of it would raise.
`control` is `none` with as much taken away that has nothing to do with effects.
"""

from __future__ import annotations

import gc
import importlib
import sys
from collections.abc import Callable
from dataclasses import fields
from typing import Any

from drake_haptics import _core
from drake_haptics.evaluation.measuring.valgrind import counted
from drake_haptics.loop import add_haptic_loop
from drake_haptics.loop.builder import BuildHapticDiagram
from drake_haptics.scene.library import find_scene
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import Effects, Material, Scene
from drake_haptics.simulation.run import make_simulator

SCENE = "rubbed_sphere"
# Until then the tool touches, and slides on.
WARM_UP = 1000
TICKS = 2000
EFFECTS = [field.name for field in fields(Effects)]
# Where a system gets what it calls: (its module, name there, method of it if a class).
CORE_CALLS = {
    "query": ("contact.contact_query", "SceneTracker", "query"),
    "clustering": ("contact.contact_clustering", "share_stiffness", None),
    "force": ("contact.penalty_force", "penalty_wrench_model", None),
    "shading": ("contact.force_shading", "ContactShading", "shade"),
    "friction": ("contact.stick_slip_friction", "StickSlipModel", "step"),
    "braking": ("contact.pre_contact_braking", "pre_contact_braking", None),
    "gravity": ("tool.tool_gravity", "tool_weight", None),
    "passivity": ("tool.passivity_control", "passivity_control", None),
}


_OTHERS = [
    "ConvexPair",
    "ContactTrajectory",
    "ConvexPolytope",
    "PairTrajectory",
    "cluster_contacts",
]


def make_scene(effect: str) -> Scene:
    """Returns the scene with one of its effects, or with none."""
    scene = load_scene(find_scene(SCENE))
    kept = {effect: getattr(scene.effects, effect)} if effect in EFFECTS else {}
    scene.effects = Effects(**kept)
    if effect != "friction":
        for item in scene.environment:
            item.material = Material()
    return scene


def forbid_effects() -> None:
    """Takes away the modules and the functions of the core that belong to effects."""
    for effect in EFFECTS:
        module, name, _ = CORE_CALLS[effect]
        sys.modules[f"drake_haptics.systems.{module}"] = None  # type: ignore[assignment]
        delattr(_core, name)


def forbid_others() -> None:
    """Takes away as much that no scene needs: the layout of memory changes too."""
    for name in _OTHERS:
        sys.modules[f"drake_haptics.systems.{name}"] = None  # type: ignore[assignment]
        delattr(_core, name)


def record_calls(name: str) -> list[tuple[Callable[..., Any], tuple[Any, ...]]]:
    """Returns the calls that a system makes of the core in the ticks that count."""
    module_name, attribute, method = CORE_CALLS[name]
    module = importlib.import_module(f"drake_haptics.systems.{module_name}")
    owner = module if method is None else getattr(module, attribute)
    called = method or attribute
    original = getattr(owner, called)
    calls: list[tuple[Callable[..., Any], tuple[Any, ...]]] = []

    def noted(*args: Any) -> Any:
        calls.append((original, args))
        return original(*args)

    setattr(owner, called, noted)
    # Otherwise one call of the core does the work of several systems.
    add_haptic_loop.can_chain = lambda *_: False
    haptic = BuildHapticDiagram(make_scene(name))
    simulator = make_simulator(haptic)
    simulator.AdvanceTo(WARM_UP * haptic.period_s)
    calls.clear()
    simulator.AdvanceTo((WARM_UP + TICKS) * haptic.period_s)
    assert calls, f"no system calls {called} of the core"
    return calls


def count_loop(effect: str, ticks: int) -> None:
    """Counts ticks of the whole loop."""
    haptic = BuildHapticDiagram(make_scene(effect))
    simulator = make_simulator(haptic)
    simulator.AdvanceTo(WARM_UP * haptic.period_s)
    if effect == "forbidden":
        forbid_effects()
    if effect == "control":
        forbid_others()
    gc.collect()
    gc.disable()
    with counted():
        simulator.AdvanceTo((WARM_UP + ticks) * haptic.period_s)


def count_core(name: str, repetitions: int) -> None:
    """Counts calls of the core."""
    calls = record_calls(name)
    gc.collect()
    gc.disable()
    with counted():
        for _ in range(repetitions):
            for function, args in calls:
                function(*args)


if __name__ == "__main__":
    kind, chosen, number = sys.argv[1], sys.argv[2], int(sys.argv[3])
    {"loop": count_loop, "core": count_core}[kind](chosen, number)
