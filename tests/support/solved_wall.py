"""One axis of a device at a wall whose contact a servo solves between the loop's ticks.

Simulated time: no clock, the same on every machine. The handle is that of `servo_loop`;
contact, tool, slopes and servo are those of the package.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from press_tools import PressTool, hull_mesh, make_tool
from pydrake.math import RigidTransform
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, Diagram, DiagramBuilder
from pydrake.systems.primitives import ZeroOrderHold
from servo_loop import DAMPING_NS_PER_M, MASS_KG, make_flow
from slider_device import Slider

from drake_haptics._core import ConstraintStepper, CouplingGains, ServoLaw, ServoTool
from drake_haptics.bounds.sampled_spring import calc_stable_stiffness
from drake_haptics.loop.add_haptic_loop import AddHapticLoop
from drake_haptics.scene.schema import ContactParameters, CouplingParameters
from drake_haptics.systems.contact.contact_query import ContactObject
from drake_haptics.systems.device.haptic_device import HapticDevice

WALL_DAMPING_NS_PER_M = 1.0
HALF_M, SKIN_M = 5e-3, 3e-4
# Where the tool rests on the plate, and with what the handle is pressed there.
REST_M = HALF_M + SKIN_M
PRESSED_N = 1.0
_MOVED_M = 1e-6
# Of handle and tool, m and m/s: within what a row's spring is linear in.
_DIFFERENCES = [1e-9, 1e-6, 1e-9, 1e-6]
_AT_REST = np.eye(7)[0]


@dataclass(frozen=True)
class Solver:
    """A way to solve contact and to answer the device.

    Attributes:
        name: Name in tables.
        servo_hz: Rate of the device and of its answers.
        solved_hz: Rate at which contact is solved and the tool stepped.
    """

    name: str
    servo_hz: float
    solved_hz: float

    @property
    def every(self) -> int:
        """Samples of the device for each solution."""
        return round(self.servo_hz / self.solved_hz)

    def calc_theory(self) -> float:
        """Returns the limit of a spring behind the hold and a sample of delay, N/m."""
        T = 1.0 / self.servo_hz
        return calc_stable_stiffness(DAMPING_NS_PER_M, WALL_DAMPING_NS_PER_M, T, T)


SOLVERS = (
    Solver("loop alone, 1 kHz", 1000.0, 1000.0),
    Solver("line of a 1 kHz loop, servo at 4 kHz", 4000.0, 1000.0),
    Solver("solved at 2 kHz", 2000.0, 2000.0),
    Solver("solved at 4 kHz", 4000.0, 4000.0),
)


def make_box(half_m: object) -> PressTool:
    """A box about its frame's origin, of 50 g."""
    signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
    return make_tool(hull_mesh(signs * np.array(half_m)), [[0, 0, -1]])


_TOOL, _PLATE = make_box([HALF_M] * 3), make_box([0.1, 0.1, 0.01])


def make_servo_tool(stiffness: float, period_s: float, height_m: float) -> ServoTool:
    """A cube at rest that a handle holds in its middle, over a plate below z = 0."""
    stepper = ConstraintStepper(
        _TOOL.core,
        [_PLATE.core],
        [SKIN_M],
        _TOOL.dynamics,
        CouplingGains(stiffness, WALL_DAMPING_NS_PER_M, 1.0, 4e-3),
        _AT_REST,
        period_s,
    )
    stepper.set_object_pose(0, pose(-0.01))
    return ServoTool(stepper, _AT_REST, np.concatenate([pose(height_m), np.zeros(6)]))


def make_law() -> ServoLaw:
    """The servo's law without limits that would matter, engaged at its first wrench."""
    return ServoLaw(
        max_force_N=1e3, max_torque_Nm=1.0, hold_s=0.02, release_s=0.02, engage_s=1e-9
    )


def pose(height_m: float) -> np.ndarray:
    """A pose (7,) at a height."""
    return np.array([1.0, 0, 0, 0, 0, 0, height_m])


def velocity(speed_m_per_s: float) -> np.ndarray:
    """A spatial velocity (6,) upward."""
    return np.array([0.0, 0, 0, 0, 0, speed_m_per_s])


def simulate(
    solver: Solver,
    stiffness: float,
    start: tuple[float, float],
    duration_s: float,
    pressed_N: float = 0.0,
    is_late: Callable[[int], bool] = lambda sample: False,
) -> np.ndarray:
    """Simulates the handle, the tool and the servo.

    A state of the device is answered by the last solution, and shown a sample later;
    then contact is solved for it.

    Args:
        solver: Way to solve and answer.
        stiffness: Stiffness of the coupling, N/m.
        start: Height and speed of the handle, m and m/s; the tool is where it is, or
            on the plate.
        duration_s: Duration of the run, s.
        pressed_N: Force that presses the handle down, N.
        is_late: Whether contact is not solved in time at a sample.

    Returns:
        (n, 3) height, speed and force of the handle at each sample, m, m/s and N.
    """
    dt = 1.0 / solver.servo_hz
    flow, _ = make_flow(None, dt)
    tool = make_servo_tool(stiffness, 1.0 / solver.solved_hz, max(start[0], REST_M))
    law = make_law()
    x, v = start
    shown = pressed_N if pressed_N else 0.0
    out = np.empty((round(duration_s / dt), 3))
    for i in range(len(out)):
        X, V = pose(x), velocity(v)
        if i == 0:  # the servo has engaged before
            law.adopt(*_solve(tool, X, V), 0.0)
            law.step(-1.0, X, V)
        force = law.step(i * dt, X, V)[5]
        if i % solver.every == 0 and not is_late(i):
            law.adopt(*_solve(tool, X, V), i * dt)
        out[i] = x, v, shown
        x, v, _ = flow @ (x, v, shown - pressed_N)
        shown = force
    return out


def _solve(tool: ServoTool, X: np.ndarray, V: np.ndarray) -> tuple[np.ndarray, ...]:
    F, K, B = tool.step(X, V)
    return F, X, V, K, B


def find_largest_stiffness(is_stable: Callable[[float], bool], near: float) -> float:
    """Returns the stiffness from which it is unstable, to half a percent, N/m.

    Args:
        is_stable: Function that tells whether a stiffness is stable.
        near: Stiffness to search around, from a third of it to three times it, N/m.
    """
    low, high = near / 3.0, near * 3.0
    while high / low > 1.005:
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if is_stable(middle) else (low, middle)
    return low


def comes_to_rest(solver: Solver, stiffness: float) -> bool:
    """Returns whether a pressed handle that is moved by 1 µm is nearer after 2 s."""
    at_rest = REST_M - PRESSED_N / stiffness
    run = simulate(solver, stiffness, (at_rest + _MOVED_M, 0.0), 2.0, PRESSED_N)
    return bool(np.abs(run[-len(run) // 4 :, 0] - at_rest).max() < _MOVED_M)


def calc_spectral_radius(solver: Solver, stiffness: float) -> float:
    """Returns the growth per solution of the slowest motion to die, linearized.

    The state is [x, v, force shown; x, v and force of the last solution; height and
    speed of the tool] about rest at the wall. The steps of handle, link and law are
    matrices; that of the package's tool is differentiated by central differences.
    """
    dt = 1.0 / solver.servo_hz
    tool = make_servo_tool(stiffness, 1.0 / solver.solved_hz, REST_M)
    handle_m = REST_M - PRESSED_N / stiffness
    for _ in range(2000):
        _, K, B = tool.step(pose(handle_m), velocity(0.0))
    at_rest = tool.state.copy()

    def solve(change: np.ndarray) -> np.ndarray:
        state = at_rest.copy()
        state[6] += change[2]
        state[12] += change[3]
        tool.state = state
        F, _, _ = tool.step(pose(handle_m + change[0]), velocity(change[1]))
        return np.array([F[5], tool.state[6], tool.state[12]])

    steps = np.diag(_DIFFERENCES)
    by_state = np.array(
        [(solve(step) - solve(-step)) / (2.0 * step.max()) for step in steps]
    ).T

    flow, _ = make_flow(None, dt)
    sample = np.eye(8)
    sample[:2, :3] = flow[:2]
    sample[2] = [-K[5, 5], -B[5, 5], 0.0, K[5, 5], B[5, 5], 1.0, 0.0, 0.0]
    solution = np.eye(8)
    solution[3:5, :] = np.eye(8)[:2]
    solution[5:, :] = 0.0
    solution[5:, [0, 1, 6, 7]] = by_state
    # A sample is answered before contact is solved for it; both see one handle.
    answered = sample.copy()
    answered[3:] = solution[3:]
    period = np.linalg.matrix_power(sample, solver.every - 1) @ answered
    return float(np.abs(np.linalg.eigvals(period)).max())


class _PressedSlider(Slider):
    """A handle that is pressed down."""

    def DoCalcTimeDerivatives(self, context, derivatives):
        """Overrides Drake's."""
        super().DoCalcTimeDerivatives(context, derivatives)
        acceleration = derivatives.get_mutable_vector()
        acceleration[1] -= PRESSED_N / MASS_KG


class _LateSlider(Diagram):
    """The pressed handle behind a link that takes a sample."""

    def __init__(self, period_s: float):
        super().__init__()
        builder = DiagramBuilder()
        self.slider = builder.AddSystem(_PressedSlider())
        link = builder.AddSystem(ZeroOrderHold(period_s, 6))
        builder.Connect(link.get_output_port(), self.slider.get_input_port())
        builder.ExportInput(link.get_input_port(), "F_Ho_W_rendered")
        for name in ("X_WH", "V_WH"):
            builder.ExportOutput(self.slider.GetOutputPort(name), name)
        builder.BuildInto(self)


def comes_to_rest_in_drake(solver: Solver, stiffness: float) -> bool:
    """Returns whether a pressed handle in a loop of Drake calms down in 2 s.

    The loop is that of `AddHapticLoop`, its tick 1 ms; its device is simulated.
    """
    period_s = 1.0 / solver.solved_hz
    backend = _LateSlider(period_s)
    builder = DiagramBuilder()
    AddHapticLoop(
        builder,
        device=HapticDevice(
            backend, period_s=period_s, max_force_N=100.0, max_torque_Nm=1.0
        ),
        tool=_TOOL.core,
        tool_dynamics=_TOOL.dynamics,
        objects=[
            ContactObject("plate", _PLATE.core, RigidTransform([0.0, 0.0, -0.01]))
        ],
        contact=ContactParameters(law="constraint", skin_m=SKIN_M),
        coupling=CouplingParameters(stiffness, WALL_DAMPING_NS_PER_M, 1.0, 4e-3),
        X_HT=RigidTransform(),
        X_WT=RigidTransform([0.0, 0.0, REST_M]),
        period_s=1e-3,
        servo_period_s=period_s,
    )
    simulator = Simulator(builder.Build())
    context = simulator.get_mutable_context()
    at_rest = REST_M - PRESSED_N / stiffness
    handle = backend.slider.GetMyMutableContextFromRoot(context)
    handle.SetContinuousState([at_rest, 0.0])
    moved = []

    def note(_: Context) -> None:
        moved.append(abs(handle.get_continuous_state_vector()[0] - at_rest))

    simulator.set_monitor(note)
    simulator.AdvanceTo(2.0)
    # It begins without a force for a sample: what the first swing makes of that.
    return max(moved[-len(moved) // 4 :]) < max(moved[: len(moved) // 40])
