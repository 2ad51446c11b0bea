"""Each system's docstring lists the ports that a constructed system really has."""

import inspect
import pkgutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from cube_scene import make_scene
from fake_device import ScriptedDevice
from pydrake.geometry import Meshcat, MeshcatParams
from pydrake.systems.framework import Diagram, System
from slider_device import make_device
from system_block import Port, find_blocks, parse_block
from system_pages import find_systems, list_system_modules

import drake_haptics.systems
from drake_haptics import (
    BuildHapticDiagram,
    TickRecorder,
    find_scene,
    load_scene,
    make_device_port,
    make_log_header,
)
from drake_haptics.scene.schema import (
    BrakingParameters,
    ContactParameters,
    CouplingParameters,
    Effects,
    FrictionParameters,
    PassivityParameters,
    ShadingParameters,
)
from drake_haptics.systems.device.replayed_handle import ReplayedHandle
from drake_haptics.systems.lcm.haptic_command_receiver import HapticCommandReceiver
from drake_haptics.systems.lcm.haptic_command_sender import HapticCommandSender
from drake_haptics.systems.lcm.haptic_status_receiver import HapticStatusReceiver
from drake_haptics.systems.lcm.haptic_status_sender import HapticStatusSender
from drake_haptics.systems.tool.handle_model import HandleModel

DOCS = Path(__file__).parents[2] / "docs"
EVERY_KEY = DOCS / "reference" / "every-key.yaml"
PERIOD_S = 1e-3


def list_systems(diagram: Diagram) -> Iterator[System]:
    """Yields a diagram and all that is in it."""
    yield diagram
    for system in diagram.GetSystems():
        yield from list_systems(system) if isinstance(system, Diagram) else [system]


@pytest.fixture(scope="module")
def systems(tmp_path_factory):
    """Systems of every kind, as programs make them."""
    scene = load_scene(EVERY_KEY)
    meshcat = Meshcat(MeshcatParams(host="localhost"))
    log = tmp_path_factory.mktemp("log") / "a.tick"
    with TickRecorder(log, make_log_header(scene)) as recorder:
        held = BuildHapticDiagram(
            scene, device=ScriptedDevice(), recorder=recorder, meshcat=meshcat
        )
    effects = Effects(
        shading=ShadingParameters(),
        friction=FrictionParameters(),
        braking=BrakingParameters(),
    )
    _, rendering = make_scene(cart=True, effects=effects, coupling=CouplingParameters())
    _, by_proxy = make_scene(
        cart=True,
        contact=ContactParameters(law="constraint"),
        coupling=CouplingParameters(),
    )
    effects.passivity = PassivityParameters()
    _, with_device = make_scene(
        effects=effects, coupling=CouplingParameters(), device=make_device()
    )
    port, _ = make_device_port(
        ScriptedDevice(), period_s=PERIOD_S, max_force_N=1.0, max_torque_Nm=0.1
    )
    _, with_real_device = make_scene(coupling=CouplingParameters(), device=port)
    return [
        *list_systems(BuildHapticDiagram(scene).diagram),
        *list_systems(held.diagram),
        *list_systems(rendering),
        *list_systems(by_proxy),
        with_device,
        with_real_device,
        *list_systems(
            BuildHapticDiagram(load_scene(find_scene("peg_in_hole"))).diagram
        ),
        HandleModel(["contact"]),
        ReplayedHandle(np.eye(1, 7), np.zeros((1, 6)), PERIOD_S),
        HapticStatusReceiver(),
        HapticStatusSender(PERIOD_S),
        HapticCommandSender(PERIOD_S),
        HapticCommandReceiver(PERIOD_S, max_force_N=1.0, max_torque_Nm=0.1),
    ]


def list_all_systems() -> list[tuple[str, type[System]]]:
    """Returns the public systems by the names of their modules."""
    package = drake_haptics.systems
    modules = pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
    names = [m.name for m in modules if not m.ispkg]
    paths = [name.removeprefix("drake_haptics.") for name in names]
    paths.append("rendering.haptic_rendering")
    return [(path, system) for path in paths for system in find_systems(path).values()]


def find_differences(listed: tuple[Port, ...], real: list[str]) -> list[str]:
    """Returns what is wrong with the ports of one side; they are in order."""
    wrong, rest = [], list(real)
    for port in listed:
        of_this = 0
        while rest and port.matches(rest[0]):
            of_this += 1
            rest.pop(0)
        is_one = not port.condition and "<" not in port.name
        if of_this > 1 and "<" not in port.name:
            wrong.append(f"{port.name} is there {of_this} times")
        if of_this == 0 and is_one:
            wrong.append(f"{port.name} is not there")
    return wrong + [f"{name} is not listed there" for name in rest]


@pytest.mark.parametrize(
    "kind",
    [system for _, system in list_all_systems()],
    ids=lambda kind: kind.__module__.rpartition(".")[2],
)
def test_the_ports_are_those_of_the_docstring(kind, systems):
    if not (blocks := find_blocks(inspect.getdoc(kind) or "")):
        # A base of systems, with no ports of its own.
        assert kind.__name__ == "DifferentiableSystem"
        return
    (block,) = blocks
    assert block.name == kind.__name__.partition("_𝓣")[0]
    examples = [system for system in systems if type(system) is kind]
    assert examples
    for system in examples:
        inputs = map(system.get_input_port, range(system.num_input_ports()))
        outputs = map(system.get_output_port, range(system.num_output_ports()))
        assert not find_differences(block.input_ports, [p.get_name() for p in inputs])
        assert not find_differences(block.output_ports, [p.get_name() for p in outputs])


# They hold what they say for a tick, so that no loop is algebraic.
SAMPLED = {
    *("ForceDelay", "HapticCommandReceiver", "HapticDevice", "HapticTool"),
    *("JointEncoder", "PoseSampler", "RenderedForceHold"),
}
STATELESS = {
    *("AppliedWrenches", "BodyMotions", "ContactClustering", "ContactExtrapolator"),
    *("ContactQuery", "ForceShading", "FrictionReaction", "PenaltyForce"),
    *("PreContactBraking", "ToolGravity", "VirtualCoupling"),
}


def test_systems_with_a_tick_of_delay_and_systems_without_state(systems):
    kinds = {type(system).__name__.partition("_")[0]: system for system in systems}
    for name in SAMPLED:
        assert not kinds[name].HasAnyDirectFeedthrough(), name
    for name in STATELESS:
        assert kinds[name].CreateDefaultContext().num_total_states() == 0, name


def test_every_system_is_on_the_page_of_all_systems():
    listed = list_system_modules(DOCS)
    assert len(listed) == len(set(listed))
    assert set(listed) == {
        path
        for path, system in list_all_systems()
        if system.__name__ != "DifferentiableSystem"
    }


def test_a_port_too_many_too_few_or_elsewhere_is_found():
    block = parse_block("name: A\ninput_ports:\n- x\n- X_WO_<name>\n- r (with load)")
    ports = block.input_ports
    assert not find_differences(ports, ["x", "X_WO_a", "X_WO_b", "r"])
    assert not find_differences(ports, ["x"])
    assert find_differences(ports, ["X_WO_a"]) == ["x is not there"]
    assert find_differences(ports, ["x", "y"]) == ["y is not listed there"]
    assert find_differences(ports, ["X_WO_a", "x"])


@pytest.mark.parametrize("text", ["- x", "ports: [x]", "name: A\nports: [x]", "{"])
def test_a_block_that_is_none_is_refused(text):
    with pytest.raises(ValueError, match="pydrake_system"):
        parse_block(text)
