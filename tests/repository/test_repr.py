"""Test that every public object says in one line what it is."""

from __future__ import annotations

import enum
from pathlib import Path

import numpy as np
import pytest
from accuracy_samples import make_study, make_usual_rows
from fake_device import ScriptedDevice, make_reading
from tick_log_samples import HEADER, make_rows

import drake_haptics
from drake_haptics import _core
from drake_haptics.analysis.modes import PeriodMap
from drake_haptics.device.backend import DeviceCommand
from drake_haptics.tick_log.tick_log import TickLog

IDENTITY = np.eye(4)


@pytest.fixture(scope="module")
def spoken(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The repr of an object of each kind, by the name of its class."""
    return {
        type(one).__name__: repr(one)
        for one in (
            *make_geometry(),
            *make_loop(tmp_path_factory.mktemp("repr")),
            *make_results(),
        )
    }


def make_geometry() -> list[object]:
    """Returns what a program without Drake deals with."""
    corners = 0.01 * np.array(
        [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    )
    box = drake_haptics.ConvexPolytope(corners)
    pair = drake_haptics.ConvexPair(box, box)
    mesh = drake_haptics.load_mesh("models/meshes/cup.obj")
    cup = drake_haptics.decompose(mesh)
    pen = drake_haptics.decompose(drake_haptics.load_mesh("models/meshes/pen.obj"))
    scene = drake_haptics.SceneTracker(pen, [cup], 1e-3)
    contacts = scene.query(IDENTITY)
    clusters = _core.cluster_contacts(contacts, 0.01, 1e-3)
    return [
        mesh,
        cup.core,
        cup,
        box,
        pair,
        pair.query_trajectory(IDENTITY[None], IDENTITY),
        drake_haptics.ContactTracker(pen, cup, 1e-3),
        scene,
        scene.query_trajectory(IDENTITY[None]),
        contacts,
        contacts[0],
        contacts[0].feature_A,
        clusters,
        _core.CouplingGains(800.0, 4.0, 1.0, 0.01),
    ]


def make_loop(folder: Path) -> list[object]:
    """Returns what a program with a scene deals with."""
    scene = drake_haptics.load_scene(drake_haptics.find_scene("sphere_pen"))
    haptic = drake_haptics.BuildHapticDiagram(scene)
    simulator = drake_haptics.make_simulator(haptic)
    with drake_haptics.TickRecorder(folder / "run.tick", HEADER) as recorder:
        pass
    zero = np.zeros(6)
    return [
        scene,
        scene.coupling,
        scene.contact,
        drake_haptics.Pose(),
        drake_haptics.HapticRenderingConfig(),
        drake_haptics.Material(),
        drake_haptics.Effects(),
        drake_haptics.ShadingParameters(),
        drake_haptics.FrictionParameters(),
        drake_haptics.BrakingParameters(),
        drake_haptics.GravityParameters(),
        drake_haptics.PassivityParameters(),
        drake_haptics.DeviceImperfections(),
        scene.tool,
        scene.environment[0],
        scene.device,
        scene.hand,
        scene.hand.path,
        scene.hand.path.waypoints[0],
        drake_haptics.load_device_preset(scene.device.preset),
        haptic,
        haptic.loop,
        drake_haptics.run(haptic, 0.01),
        drake_haptics.CallbackTimer(),
        drake_haptics.RealTimePacer(1e-3),
        drake_haptics.CallbackTimer(),
        drake_haptics.EnergyLedger(haptic.loop, simulator.get_context()),
        recorder,
        TickLog(HEADER, make_rows(2), (), 0),
        make_reading(),
        DeviceCommand(zero, np.array([1.0, 0, 0, 0, 0, 0, 0]), zero),
        ScriptedDevice([]),
    ]


def make_results() -> list[object]:
    """Returns figures of an analysis."""
    names = tuple(f"x[{i}]" for i in range(30))
    return [
        PeriodMap(np.eye(30), 1e-3, names, np.zeros(30), (), 0.0),
        make_study(*make_usual_rows()),
        drake_haptics.HeldHandle(0.1, 0.5, 5e-5, 1e-3),
        drake_haptics.OutsideContact(0.0, np.zeros(3), np.zeros(3), np.zeros(3)),
    ]


def test_no_public_class_is_forgotten(spoken: dict[str, str]) -> None:
    objects = {name: getattr(drake_haptics, name) for name in drake_haptics.__all__}
    classes = {
        name
        for name, one in objects.items()
        if isinstance(one, type)
        # Every device has the line of `DeviceBackend`, which `ScriptedDevice` says.
        and not issubclass(one, Exception | enum.Enum | drake_haptics.DeviceBackend)
    }
    # The one is in test_haptic_rendering.py, the other is abstract.
    assert classes - spoken.keys() == {"HapticRendering", "OutsideLibrary"}


def test_every_device_has_the_line_of_its_base() -> None:
    for name in ("UdpDevice", "HaplyDevice", "LcmDevice", "MouseDevice"):
        device = getattr(drake_haptics, name)
        assert device.__repr__ is drake_haptics.DeviceBackend.__repr__


def test_each_is_one_line_that_names_its_class_and_no_address(
    spoken: dict[str, str],
) -> None:
    for name, text in spoken.items():
        assert text.startswith(f"{name}("), text
        assert len(text) < 250 and "\n" not in text, text
        assert "0x" not in text and "array(" not in text, text


@pytest.mark.parametrize(
    ("name", "first_question"),
    [
        ("Mesh", "252 vertices, 504 triangles, 108.2 × 78.46 × 71.8 mm"),
        ("ConvexPieces", "75 pieces"),
        ("ConvexPolytope", "8 vertices, 12 edges, 6 facets"),
        ("SceneTracker", "1 object, tolerance=0.001 m"),
        ("CouplingGains", "800 N/m, 4 N·s/m, 1 N·m/rad, 0.01 N·m·s/rad"),
        ("HapticDiagram", "pen.obj and 1 object, ticks of 1 ms, held by a simulated"),
        ("HapticLoop", "coupling, contact"),
        ("Scene", "tool pen.obj, environment sphere.obj"),
        ("RunStatistics", "10 ticks of 1 ms, at most"),
        ("TickLog", "2 ticks of 1 ms, 0 gaps"),
        ("PeriodMap", "30×30 numbers"),
        ("AccuracyStudy", "settings and 0 peers"),
        ("ScriptedDevice", "0 samples, 0 lost, 0 refused"),
    ],
)
def test_it_tells_what_is_asked_first(
    spoken: dict[str, str], name: str, first_question: str
) -> None:
    assert first_question in spoken[name]
