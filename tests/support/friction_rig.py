"""A free tool on objects with friction, through the core's chain, without Drake."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from contact_samples import IDENTITY
from friction_bodies import floor, sled
from friction_oracle import Law

from drake_haptics import _core

PERIOD_S = 1e-3
TOLERANCE_M = 1e-3
STIFFNESS_N_PER_M = 2e4
DAMPING_NS_PER_M = 20.0
LAW = Law((0.5,), 1.2, 1e-4, 5e-3)


@dataclass(frozen=True)
class Tick:
    """The values of one tick: SI units, world frame."""

    state: np.ndarray  # (13,) tool's pose and velocity
    clusters: _core.ClusterSet
    wrench: _core.PenaltyWrench
    friction: _core.FrictionStep

    @property
    def normal_force(self) -> float:
        """Sum over the clusters, N."""
        return float(np.linalg.norm(self.wrench.f_cluster_W, axis=1).sum())

    @property
    def friction_force(self) -> np.ndarray:
        """(3,) on the tool, N."""
        return self.friction.f_cluster_W.sum(axis=0)


class FrictionRig:
    """The tool, the objects that it touches, and the memory of friction.

    Attributes:
        state: (13,) pose and velocity of the tool; set it to move the tool.
        q_WO: (m, 7) poses of the objects; set them to move an object that `moves`.
        V_WO: (m, 6) spatial velocities of the objects, for the damping.
        memory: Memory of friction from the last tick.
    """

    def __init__(
        self,
        tool: _core.ConvexPieces,
        objects: Sequence[_core.ConvexPieces],
        model: _core.StickSlipModel,
        *,
        moves: Sequence[bool] = (False,),
        dynamics: _core.RigidToolDynamics | None = None,
    ):
        """Places the tool and all objects at the world's origin."""
        self._tracker = _core.SceneTracker(tool, list(objects), TOLERANCE_M)
        self._model = model
        self._moves = list(moves)
        self._dynamics = dynamics
        self.memory = np.zeros(model.state_size)
        self.state = np.concatenate([IDENTITY, np.zeros(6)])
        self.q_WO = np.tile(IDENTITY, (len(objects), 1))
        self.V_WO = np.zeros((len(objects), 6))

    def look(self) -> Tick:
        """Returns the forces now; changes nothing."""
        for i, q in enumerate(self.q_WO):
            self._tracker.set_object_pose(i, q)
        contacts = self._tracker.query(self.state[:7])
        clusters = _core.share_stiffness(contacts, TOLERANCE_M)
        m = len(self.q_WO)
        wrench = _core.penalty_force(
            clusters,
            self.state[4:7],
            self.state[7:],
            self.q_WO[:, 4:].copy(),
            self.V_WO,
            np.full(m, STIFFNESS_N_PER_M),
            np.full(m, DAMPING_NS_PER_M),
        )
        friction = self._model.step(
            self.memory,
            clusters,
            wrench,
            self.state[:7].copy(),
            self.q_WO[self._moves].ravel(),
        )
        return Tick(self.state.copy(), clusters, wrench, friction)

    def remember(self, tick: Tick) -> None:
        """Takes a tick as the last one."""
        self.memory = tick.friction.next_state

    def forget(self) -> None:
        """Forgets where friction sticks."""
        self.memory = np.zeros(self._model.state_size)

    def advance(self, F_To_W: object = (0,) * 6, K: object = None) -> Tick:
        """Lets the tool move for one period under a wrench on it and its stiffness."""
        tick = self.look()
        self.remember(tick)
        other = np.zeros(78)
        other[:6] = F_To_W
        if K is not None:
            other[6:42] = np.ravel(K)
        model = tick.wrench.wrench_model + tick.friction.wrench_model + other
        self.state = self._dynamics.step(self.state, model, PERIOD_S)
        return tick


def make_model(
    law: Law = LAW, moves: Sequence[bool] = (False,)
) -> _core.StickSlipModel:
    """The core's model of a law."""
    return _core.StickSlipModel(
        law.coefficient, moves, law.static_ratio, law.break_away_m, law.reach_m
    )


def one_foot(law: Law = LAW) -> FrictionRig:
    """A foot whose tip is the tool's origin, on a floor."""
    return FrictionRig(sled([0, 0, 0]), [floor()], make_model(law))


def at(rig: FrictionRig, x: float, y: float, normal_force_N: float) -> Tick:
    """Puts the foot's tip somewhere, under a force, and lets friction see it."""
    rig.state[4:7] = [x, y, TOLERANCE_M - normal_force_N / STIFFNESS_N_PER_M]
    tick = rig.look()
    rig.remember(tick)
    return tick
