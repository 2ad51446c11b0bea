"""What is of another kind is told by its name, with what it must be and what it is."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path

import numpy as np
import pytest
from pydrake.geometry import Role
from pydrake.math import RigidTransform
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph
from pydrake.systems.framework import DiagramBuilder

import drake_haptics
from drake_haptics import AddHapticRendering, BuildHapticDiagram, find_scene, run
from drake_haptics.common.type_checks import require_kinds
from drake_haptics.scene.scene_file import load_scene
from drake_haptics.scene.schema import (
    ContactParameters,
    CouplingParameters,
    Effects,
    EnvironmentObject,
    FrictionParameters,
    Material,
    Scene,
)


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (3, float),
        (np.float32(3.0), float),
        (np.int64(3), int),
        (True, bool),
        (None, float | None),
        (Path("a.obj"), str),
        ([1.0, 2], list[float]),
        (np.zeros(3), list[float]),
        (("a", 3.0), Sequence[str | float]),
        ({"a": Material()}, Mapping[str, Material] | None),
        (print, Callable | None),
        (Role.kProximity, Role),
        (Scene(environment=[EnvironmentObject(mesh=Path("a.obj"))]), Scene),
    ],
)
def test_what_fits_is_taken(value, kind):
    require_kinds(it=(value, kind))


@pytest.mark.parametrize(
    ("value", "kind", "said"),
    [
        ("3", float, "it must be a number, is the str '3'"),
        (True, float, "it must be a number, is True"),
        (None, int, "it must be a whole number, is None"),
        (3.5, int, "it must be a whole number, is the float 3.5"),
        (1, bool, "it must be True or False, is the int 1"),
        ("abc", list[float], "it must be a list, is the str 'abc'"),
        ([0.0, "1"], list[float], r"it\[1\] must be a number, is the str '1'"),
        ([], Mapping[str, float], "it must be a dict, is of type list"),
        ({"a": []}, Mapping[str, float], r"it\['a'\] must be a number, is of type li"),
        (3, Callable | None, "it must be a function or None, is the int 3"),
        # There are two classes of this name.
        (
            drake_haptics.Contact,
            ContactParameters,
            "it must be a drake_haptics.scene.schema.ContactParameters, is of type",
        ),
        (
            ContactParameters(tolerance_m="1"),
            ContactParameters,
            r"it.tolerance_m must be a number, is the",
        ),
        (
            Scene(effects=Effects(friction=FrictionParameters(coefficient=None))),
            Scene,
            r"it.effects.friction.coefficient must be a number, is None",
        ),
    ],
)
def test_what_does_not_fit_is_told(value, kind, said):
    with pytest.raises(TypeError, match=f"^{said}"):
        require_kinds(it=(value, kind))


def test_help_is_for_the_argument_and_not_for_its_parts():
    with pytest.raises(TypeError, match=r"; read the page$"):
        require_kinds("read the page", it=(3, Scene))
    with pytest.raises(TypeError, match=r"is the int 3$"):
        require_kinds("read the page", it=(Scene(contact=3), Scene))


def list_numbers(part, name):
    """Yields each number of a part of a scene: its place, its name."""
    for field in fields(part):
        value = getattr(part, field.name)
        if is_dataclass(value):
            yield from list_numbers(value, f"{name}.{field.name}")
        elif isinstance(value, float):
            yield part, field.name, f"{name}.{field.name}"


def test_each_number_of_a_scene_is_looked_at():
    scene = load_scene(find_scene("rubbed_sphere"))
    numbers = list(list_numbers(scene, "scene"))
    assert len(numbers) > 15
    for part, key, name in numbers:
        before = getattr(part, key)
        setattr(part, key, "much")
        with pytest.raises(TypeError, match=f"^{name} must be a number"):
            BuildHapticDiagram(scene)
        setattr(part, key, before)


@pytest.fixture(scope="module")
def drake():
    """Builder, plant and scene graph."""
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, time_step=1e-3)
    plant.Finalize()
    return builder, plant, scene_graph


@pytest.mark.parametrize(
    "wrong",
    [
        {"environment": [3]},
        {"role": "proximity"},
        {"chord_error_m": "fine"},
        {"contact": 2000.0},
        {"materials": [Material()]},
        {"effects": {"friction": {}}},
        {"coupling": CouplingParameters},
        {"device": "udp://127.0.0.1:7400"},
        {"X_HT": [0.0, 0.0, 0.0]},
        {"period_s": "1e-3"},
        {"name": 3},
        {"progress": True},
    ],
    ids=lambda wrong: next(iter(wrong)),
)
def test_a_rendering_names_what_is_wrong(drake, wrong):
    (name,) = wrong
    with pytest.raises(TypeError, match=rf"^{name}(\[0\])? must be a"):
        AddHapticRendering(*drake, "world", **wrong)


def test_a_rendering_tells_the_order_of_its_first_arguments(drake):
    builder, plant, scene_graph = drake
    with pytest.raises(TypeError, match=r"^builder must be a .*builder, plant, scene"):
        AddHapticRendering(plant, builder, scene_graph, "world")
    with pytest.raises(TypeError, match=r"^tool_body must be .*RigidBody or a text"):
        AddHapticRendering(builder, plant, scene_graph, 1)


def test_a_name_is_no_scene_and_a_scene_no_diagram():
    with pytest.raises(TypeError, match=r"^scene must be .* load_scene\(find_scene"):
        BuildHapticDiagram("cup_spoon")
    with pytest.raises(TypeError, match=r"^haptic must be .* BuildHapticDiagram"):
        run(load_scene(find_scene("sphere_pen")))


@pytest.mark.parametrize("name", ["device", "meshcat", "progress", "reuse", "X_WH"])
def test_a_diagram_names_what_is_wrong(name):
    scene = load_scene(find_scene("sphere_pen"))
    with pytest.raises(TypeError, match=f"^{name} must be"):
        BuildHapticDiagram(scene, **{name: True})
    BuildHapticDiagram(scene, X_WH=RigidTransform())


@pytest.mark.parametrize("name", ["duration_s", "pace", "on_tick", "statistics"])
def test_a_run_names_what_is_wrong(name):
    haptic = BuildHapticDiagram(load_scene(find_scene("sphere_pen")))
    with pytest.raises(TypeError, match=f"^{name} must be"):
        run(haptic, **{name: "fast"})
