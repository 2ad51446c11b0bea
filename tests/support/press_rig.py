"""A tool pressed into solids through the core's haptic loop, without Drake."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator
from dataclasses import asdict, dataclass
from functools import cached_property

import numpy as np
from press_tools import PressTool
from scipy.spatial.transform import Rotation
from wrench_chain import push

from drake_haptics import _core
from drake_haptics.geometry.mesh.mesh import Mesh
from drake_haptics.scene.device_preset import load_device_preset
from drake_haptics.scene.schema import CouplingParameters, DeviceParameters
from drake_haptics.systems.tool.virtual_coupling import coupling_wrench

PERIOD_S = 1e-3
_DEVICE = load_device_preset(DeviceParameters().preset)
LARGEST_FORCE_N = _DEVICE.max_force_N
START_M = 5e-3  # how far outside a press starts
LONGEST_TRAVEL_M = 40e-3  # where it gives up if nothing resists
HOLD_S = 0.2
_REST = np.array([1.0, 0, 0, 0, 0, 0, 0])


@dataclass(frozen=True)
class Gains:
    """Contact gains of a run: m, m, N/m, N·s/m."""

    tolerance_m: float = 2e-3
    delta_m: float = 5e-3
    stiffness_N_per_m: float = 2e4
    damping_Ns_per_m: float = 5.0


# The builder's defaults and the gains of the shipped scenes answer 8.5 N before the
# shapes touch; the next two sink in: 1.2 mm, less than half of a 3 mm wall, and 3.25
# mm. The last have a skin so thin that a press crosses it ten times over in one tick, a
# jab fifty.
GAINS = {
    "default": Gains(),
    "shipped": Gains(5e-4, 5e-3, 2e4, 5.0),
    "sinking": Gains(5e-4, 5e-3, 5e3, 5.0),
    "soft": Gains(1e-3, 6e-3, 2e3, 4.0),
    "thin skin": Gains(1e-5, 5e-3, 2e4, 5.0),
}
# A scene's own, which yields where its device can show no more.
COUPLING = _core.CouplingGains(
    **asdict(CouplingParameters()),
    max_force_N=_DEVICE.max_force_N,
    max_torque_Nm=_DEVICE.max_torque_Nm,
)
# Of a press's force, where it stops: what yields reaches its limit but for rounding.
_REACHED = 1.0 - 1e-9


@dataclass(frozen=True)
class Press:
    """A scripted motion of the handle, all vectors (3,) in W.

    Attributes:
        p_W: The point of the surface, m.
        nhat_W: Outward normal there.
        push_W: Unit direction in which the tool comes.
        slide_W: Unit tangent along which it goes on, or zero.
        R_WT: (3, 3) orientation of the tool.
        p_TP: Foremost point of the tool, in T, m.
        speed_m_per_s: Speed of the handle.
        stop_N: Coupling force at which a press stops.
        stop_m: Depth inside the surface at which it stops at the latest.
    """

    p_W: np.ndarray
    nhat_W: np.ndarray
    push_W: np.ndarray
    slide_W: np.ndarray
    R_WT: np.ndarray
    p_TP: np.ndarray
    speed_m_per_s: float
    stop_N: float
    stop_m: float

    def q_WH(self, travel_m: float, slid_m: float) -> np.ndarray:
        """The handle's pose (7,) after `travel_m` from the start."""
        p_WP = self.p_W + (travel_m - START_M) * self.push_W + slid_m * self.slide_W
        return np.concatenate([self._quaternion, p_WP - self.R_WT @ self.p_TP])

    @cached_property
    def _quaternion(self) -> np.ndarray:
        x, y, z, w = Rotation.from_matrix(self.R_WT).as_quat()
        return np.array([w, x, y, z])


MOTIONS = ("press", "oblique", "slide", "jab")


def sample_presses(
    mesh: Mesh, tool: PressTool, motion: str, points: Iterable[int], seed: int
) -> list[Press]:
    """Returns presses on points of a surface, spread evenly over its area.

    Args:
        mesh: The surface.
        tool: Tool that is pressed.
        motion: One of MOTIONS.
        points: Numbers of points; a number and a seed always mean the same press.
        seed: Seed of the random points.
    """
    corners = mesh.vertices[mesh.triangles]
    area_vectors = (
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    )
    areas = np.linalg.norm(area_vectors, axis=1)
    shares = np.cumsum(areas) / areas.sum()
    presses = []
    for i in points:
        rng = np.random.default_rng([seed, i])
        t = int(np.searchsorted(shares, rng.random()))
        u, v = rng.random(2)
        if u + v > 1:
            u, v = 1 - u, 1 - v
        p_W = corners[t, 0] * (1 - u - v) + corners[t, 1] * u + corners[t, 2] * v
        n = area_vectors[t] / areas[t]
        tangent = np.cross(n, rng.normal(size=3))
        tangent /= np.linalg.norm(tangent)
        tilt = np.deg2rad(30.0) if motion == "oblique" else 0.0
        push_W = -np.cos(tilt) * n + np.sin(tilt) * tangent
        k = int(rng.integers(len(tool.pushes_T)))
        R, _ = Rotation.align_vectors([push_W], [tool.pushes_T[k]])
        twist = Rotation.from_rotvec(push_W * rng.uniform(0, 2 * np.pi))
        presses.append(
            Press(
                p_W=p_W,
                nhat_W=n,
                push_W=push_W,
                slide_W=tangent if motion == "slide" else np.zeros(3),
                R_WT=(twist * R).as_matrix(),
                p_TP=tool.probe(k),
                speed_m_per_s=0.5 if motion == "jab" else 0.1,
                stop_N=np.inf if motion == "jab" else LARGEST_FORCE_N,
                stop_m=10e-3 if motion == "jab" else LONGEST_TRAVEL_M,
            )
        )
    return presses


@dataclass(frozen=True)
class Tick:
    """The values of one tick."""

    phase: str  # "in", "slide", "hold", "out" or "away"
    q_WH: np.ndarray  # (7,)
    state: np.ndarray  # (13,) tool's pose and velocity at the query
    contacts: _core.ContactSet
    clusters: _core.ClusterSet
    F_contact_W: np.ndarray  # (6,) N·m, N, on the tool at To
    F_coupling_W: np.ndarray  # (6,) N·m, N, on the tool at To


class PenaltyLoop:
    """Steps a tool by a handle against the springs of a solid, as `AddHapticLoop` does.

    Attributes:
        state: Pose and velocity (13,) of the tool after the last tick.
        q_WH: Pose (7,) of the handle at the last tick.
    """

    def __init__(
        self, tool: PressTool, solid: _core.ConvexPieces, gains: Gains, q_WT: np.ndarray
    ) -> None:
        self.state = np.concatenate([q_WT, np.zeros(6)])
        self.q_WH = np.array(q_WT, dtype=float)
        self._gains = gains
        self._dynamics = tool.dynamics
        self._tracker = _core.SceneTracker(tool.core, [solid], gains.tolerance_m)

    def tick(self, q_WH: np.ndarray, phase: str = "in") -> Tick:
        """Advances by a tick in which the handle does not turn."""
        state, gains = self.state, self._gains
        V_WH = np.concatenate([np.zeros(3), (q_WH[4:] - self.q_WH[4:]) / PERIOD_S])
        self.q_WH = q_WH.copy()
        contacts = self._tracker.query(state[:7])
        clusters = _core.share_stiffness(contacts, gains.tolerance_m)
        contact = push(
            clusters,
            gains.stiffness_N_per_m,
            gains.damping_Ns_per_m,
            p_WTo=state[4:7],
            V_WT=state[7:],
        ).wrench_model
        coupling = coupling_wrench(q_WH, V_WH, _REST, state[:7], state[7:], COUPLING)[
            :78
        ]
        self.state = self._dynamics.step(state, contact + coupling, PERIOD_S)
        return Tick(phase, q_WH, state, contacts, clusters, contact[:6], coupling[:6])


def run_press(
    press: Press, tool: PressTool, solid: _core.ConvexPieces, gains: Gains
) -> Iterator[Tick]:
    """Runs a press tick by tick."""
    loop = PenaltyLoop(tool, solid, gains, press.q_WH(0.0, 0.0))
    script = move_handle(press)
    phase, q_WH = next(script)
    while True:
        tick = loop.tick(q_WH, phase)
        yield tick
        try:
            phase, q_WH = script.send(float(np.linalg.norm(tick.F_coupling_W[3:])))
        except StopIteration:
            return


def move_handle(
    press: Press, period_s: float = PERIOD_S
) -> Generator[tuple[str, np.ndarray], float, None]:
    """Yields the handle's poses: in, perhaps along the surface, hold, out, away.

    It is sent the coupling's force after each, N.
    """
    step = press.speed_m_per_s * period_s
    travel, slid = 0.0, 0.0
    force_N = yield "in", press.q_WH(travel, slid)
    while travel < START_M + press.stop_m and force_N < _REACHED * press.stop_N:
        travel += step
        force_N = yield "in", press.q_WH(travel, slid)
    if press.slide_W.any():
        while slid < 15e-3:
            slid += step
            yield "slide", press.q_WH(travel, slid)
    for _ in range(round(HOLD_S / period_s)):
        yield "hold", press.q_WH(travel, slid)
    while travel > 0:
        travel = max(0.0, travel - step)
        yield "out", press.q_WH(travel, slid)
    for _ in range(50):
        yield "away", press.q_WH(travel, slid)
